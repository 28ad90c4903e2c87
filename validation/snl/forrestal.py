# SPDX-License-Identifier: GPL-3.0-or-later
"""Forrestal's cavity expansion: the engineer's yardstick beside the runs of validation/snl.

Crater: F = c x to a depth of 4a. Tunnel: F = pi a^2 (R + N rho v^2), a the radius of the shank, N = (8 psi - 1)/(24 psi^2)
of an ogive of calibre radius psi, rho the density of the target. With V1 the velocity at x = 4a,
    V1^2 = (m V^2 - 4 pi a^3 R)/(m + 4 pi a^3 N rho),  P = m/(2 pi a^2 N rho) ln(1 + N rho V1^2/R) + 4a,
Forrestal, Altman, Cargile, Hanchak, Int. J. Impact Engng. 15 (1994) 395. Rigid, no friction; valid for P > 4a.
R = S f with S = 82.6 (f/MPa)^-0.544 fits smaller projectiles (Forrestal et al. 1996, Frew et al. 1998). A value of R that was
found from a measured depth, or a depth predicted by it, goes into no run: it is a yardstick in the report.
"""

import math


class Shot:
    """Mass kg, radius m, calibre radius of the nose, velocity m/s, density kg/m^3 of the target."""

    def __init__(self, mass, radius, crh, velocity, density):
        self.mass, self.radius, self.velocity = mass, radius, velocity
        self.drag = (8 * crh - 1) / (24 * crh ** 2) * density  # N rho
        self.area = math.pi * radius ** 2

    def tunnel_velocity(self, resistance):
        """V1 at the end of the crater, m/s; 0 where the crater stops the projectile."""
        left = self.mass * self.velocity ** 2 - 4 * self.area * self.radius * resistance
        return math.sqrt(max(left, 0) / (self.mass + 4 * self.area * self.radius * self.drag))

    def depth(self, resistance):
        """Depth m for R in Pa."""
        v1 = self.tunnel_velocity(resistance)
        return (self.mass / (2 * self.area * self.drag) * math.log1p(self.drag * v1 ** 2 / resistance)
                + 4 * self.radius)

    def peak_deceleration(self, resistance):
        """m/s^2, at a depth of 4a."""
        return self.area * (resistance + self.drag * self.tunnel_velocity(resistance) ** 2) / self.mass

    def duration(self, resistance):
        """s from touch to rest."""
        v1 = self.tunnel_velocity(resistance)
        omega = math.sqrt(self.peak_deceleration(resistance) / (4 * self.radius))
        return (math.acos(v1 / self.velocity) / omega + self.mass / (self.area * math.sqrt(resistance * self.drag))
                * math.atan(v1 * math.sqrt(self.drag / resistance)))

    def fitted(self, depth):
        """R in Pa with which depth() gives `depth`, by bisection: depth falls with R."""
        low, high = 1e6, 1e10
        for _ in range(200):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if self.depth(middle) > depth else (low, middle)
        return math.sqrt(low * high)


def resistance(strength):
    """R = S f in Pa from the unconfined strength f in Pa."""
    return 82.6 * (strength * 1e-6) ** -0.544 * strength
