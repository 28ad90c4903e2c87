# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact solutions of validation/energy, and errors of cell means against them."""

import numpy as np

from validate_energy import LENGTH, Frame, behind_shock, cell_means


def plateau(run, x, speed, h):
    """Errors in per cent of e and T behind the shock (between .3 and .7 of its way), and of e in the first cells."""
    exact, frame = behind_shock(x, speed), Frame(run)
    z, m = frame.all("coordinates")[:, 2], frame.all("mass")[:, 0]
    front = (exact["U"] - speed) * frame.time
    inside = (z > 0.3 * front) & (z < 0.7 * front)
    near = z < 2 * h

    def error(field, which, value):
        return 100 * (np.average(frame.all(field)[which, 0], weights=m[which]) / value - 1)
    return {"e": error("internal_energy", inside, exact["e"]), "T": error("temperature", inside, exact["T"]),
            "wall": error("internal_energy", near, exact["e"]), "exact": exact}


def noh_errors(run, kind, h):
    """L1 of cell means of rho and e over r < 0.4 by that of the solution; rho between .08 and .16; front; wall."""
    d = {"planar": 1, "cylindrical": 2, "spherical": 3}[kind]
    frame = Frame(run)
    r = frame.radius({1: (2,), 2: (0, 2), 3: (0, 2)}[d])
    m, rho, e = (frame.all(name)[:, 0] for name in ("mass", "density", "internal_energy"))
    at, mean_rho = cell_means(r, rho, m / rho, h)
    _, mean_e = cell_means(r, e, m, h)
    fine = at[:, None] + h * ((np.arange(50) + 0.5) / 50 - 0.5)
    exact_rho = np.where(fine < 0.2, 4.0 ** d, (1 + 0.6 / fine) ** (d - 1)).mean(axis=1)
    exact_e = np.where(fine < 0.2, 0.5, 0.0).mean(axis=1)
    near, inside = at < 0.4, (at > 0.08) & (at < 0.16)
    middle = 0.5 * (4.0 ** d + 4.0 ** (d - 1))
    front = np.nan  # where the density comes nowhere near
    if np.any(mean_rho > middle):
        behind = np.flatnonzero(mean_rho > middle)[-1]
        share = (mean_rho[behind] - middle) / (mean_rho[behind] - mean_rho[behind + 1])
        front = 100 * ((at[behind] + h * share) / 0.2 - 1)
    return {"rho": np.abs(mean_rho - exact_rho)[near].sum() / exact_rho[near].sum(),
            "e": np.abs(mean_e - exact_e)[near].sum() / exact_e[near].sum(),
            "plateau": 100 * (mean_rho[inside].mean() / 4.0 ** d - 1), "at": at, "mean_rho": mean_rho,
            "front": front, "wall": 100 * (mean_e[0] / 0.5 - 1)}


def sod_exact(z, t=0.2, gamma=1.4):
    """Density and energy of Sod's tube (1, 1 | 0.125, 0.1; gamma 1.4): p* = .30313, v* = .92745."""
    p, v, c = 0.303130178, 0.927452620, np.sqrt(gamma)
    x = (z - 0.5) / t
    left = p ** (1 / gamma)
    right = 0.125 * (p / 0.1 + (gamma - 1) / (gamma + 1)) / ((gamma - 1) / (gamma + 1) * p / 0.1 + 1)
    shock = v * right / (right - 0.125)
    inner = 2 / (gamma + 1) + (gamma - 1) / (gamma + 1) / c * -x
    fan = np.maximum(inner, 0) ** (2 / (gamma - 1))
    tail = v - np.sqrt(gamma * p / left)
    rho = np.select([x < -c, x < tail, x < v, x < shock], [1.0, fan, left, right], 0.125)
    pressure = np.select([x < -c, x < tail, x < shock], [1.0, fan ** gamma, p], 0.1)
    return rho, pressure / rho / (gamma - 1)


def sod_errors(run, h):
    """L1 of cell means of rho and e by that of the solution."""
    frame = Frame(run)
    z = frame.all("coordinates")[:, 2]
    m, rho, e = (frame.all(name)[:, 0] for name in ("mass", "density", "internal_energy"))
    at, mean_rho = cell_means(z, rho, m / rho, h)
    _, mean_e = cell_means(z, e, m, h)
    fine_rho, fine_e = sod_exact(at[:, None] + h * ((np.arange(50) + 0.5) / 50 - 0.5))
    exact_rho, exact_e = fine_rho.mean(axis=1), (fine_rho * fine_e).mean(axis=1) / fine_rho.mean(axis=1)
    return {"rho": np.abs(mean_rho - exact_rho).sum() / exact_rho.sum(),
            "e": np.abs(mean_e - exact_e).sum() / exact_e.sum()}


def sedov(run, h):
    """Place and value of the greatest density of rings, pressure of the core, volume of the hot gas."""
    frame = Frame(run)
    r, m, rho = frame.radius((0, 2)), frame.all("mass")[:, 0], frame.all("density")[:, 0]
    at, ring = cell_means(r, rho, m / rho, h)
    core = r < 0.2
    hot = frame.bodies["c"]
    return {"front": at[np.argmax(ring)], "rho": ring.max(), "p": frame.all("pressure")[core, 0].mean(),
            "volume": float(np.sum(hot["mass"].ravel() / hot["density"].ravel()))}


def entropy_gain(run, gamma=1.4):
    """p/rho^gamma - 1 of a gas that started with 1, in per cent: mean and extremes of the half by the plane, mean and
    greatest of the half by the free end."""
    frame = Frame(run)
    m, rho, p = (frame.all(name)[:, 0] for name in ("mass", "density", "pressure"))
    order = np.argsort(frame.all("coordinates")[:, 2])
    gain, m = 100 * (p / rho ** gamma - 1)[order], m[order]
    half = len(m) // 2
    inner, outer = gain[:half], gain[half:]
    return (np.average(inner, weights=m[:half]), inner.min(), inner.max(), np.average(outer, weights=m[half:]),
            outer.max())


def boosted(rest, moving, x, speed):
    """e of the points at .3 to .7 of the shocks' way, in per cent of u^2/2: (mean at rest, mean moving, root mean square
    of the differences point by point, noise at rest)."""
    def state(run):
        bodies = [body for _, body in sorted(Frame(run).bodies.items())]
        ids = [np.argsort(body["id"].ravel()) for body in bodies]
        return (np.concatenate([body[field][order].reshape(len(order), -1) for body, order in zip(bodies, ids)])
                for field in ("internal_energy", "coordinates"))
    (a, z), (b, _) = state(rest), state(moving)
    way = (x["c0"] + x["s"] * speed - speed) * Frame(rest).time
    inside = (np.abs(z[:, 2]) > 0.3 * way) & (np.abs(z[:, 2]) < 0.7 * way)
    a, b = (100 * (q[inside, 0] / (0.5 * speed ** 2) - 1) for q in (a, b))
    return a.mean(), b.mean(), float(np.sqrt(((b - a) ** 2).mean())), float(a.std())


def observed(errors):
    """Orders between neighbours of a refinement by two."""
    return ["-"] + [f"{np.log2(a / b):.2f}" for a, b in zip(errors, errors[1:])]


__all__ = ["LENGTH", "boosted", "entropy_gain", "noh_errors", "observed", "plateau", "sedov", "sod_errors"]
