# SPDX-License-Identifier: GPL-3.0-or-later
"""Empirical formulas of craters in thick metal and holes in plates, hit by spheres at 2 to 8 km/s.

d, t: diameter of the sphere, thickness of the plate; rho_p, rho_t: densities; V: speed; C = sqrt(E/rho) of the target; H: its Brinell
hardness. All are given here from memory of the handbooks that quote them (NASA/TM-2009-214785, NASA/TP-2003-210788; Herrmann and
Jones 1961; Maiden and McMillan 1964; Sawle 1969; Lundeberg, Stern, Bristow 1965): none was read for this report.
How far they lie from each other is therefore used as their scatter; shots scatter about each by 10 to 20 % (from memory as well).
"""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Metal:
    name: str
    density: float    # kg/m^3
    modulus: float    # Pa
    hardness: float   # Brinell, kgf/mm^2

    @property
    def sound(self):
        return math.sqrt(self.modulus / self.density)


ALUMINIUM = Metal("6061-T6", 2703, 68.9e9, 95)
COPPER = Metal("OFHC copper, annealed", 8960, 124e9, 45)
SPHERES = {ALUMINIUM: 2770, COPPER: 8960}  # density of what hits it
KGF_PER_MM2 = 9.80665e6  # Pa


def cour_palais(d, V, rho_p, target):
    """Depth of a crater; d, depth [m], fitted in cm."""
    cm = 100 * d
    return 0.01 * 5.24 * cm ** (19 / 18) * target.hardness ** -0.25 * (rho_p / target.density) ** 0.5 * (V / target.sound) ** (2 / 3)


def herrmann_jones(d, V, rho_p, target):
    """Depth of a crater [m]."""
    K = (rho_p / target.density) ** (2 / 3)
    return 0.6 * d * K * math.log(1 + K * target.density * V ** 2 / (4 * KGF_PER_MM2 * target.hardness))


def maiden(d, t, V, rho_p, target):
    """Diameter of a hole [m]; aluminium on aluminium."""
    return d * (2.40 * V / target.sound * (t / d) ** (2 / 3) + 0.90)


def sawle(d, t, V, rho_p, target):
    """Diameter of a hole [m]."""
    return d * (3.2 * (rho_p * V / (target.density * target.sound)) ** 0.22 * (t / d) ** (2 / 3) + 1)


def lundeberg(d, t, V, rho_p, target):
    """Diameter of a hole [m]."""
    return d * 3.4 * (t / d) ** (1 / 3) * (V / target.sound) ** (1 / 3) * (1 - 0.0308 * target.density / rho_p)


CRATERS = {"Cour-Palais": cour_palais, "Herrmann and Jones": herrmann_jones}
HOLES = {"Maiden": maiden, "Sawle": sawle, "Lundeberg": lundeberg}
