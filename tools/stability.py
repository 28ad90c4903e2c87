#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The longest stable step of tflip with update usl and quadratic B-splines: c_L dt/h at which a step begins to grow.

One step of the linear problem (small motions about rest, theory 16-18) is applied again and again to a random state of
points that stand still; where it grows by more than 1 % a step, the step is too long. h = rho = c_L = 1.

  interior   points of one cell, periodic with the phase exp(i theta) from cell to cell
  free       a block of three cells with free sides, at several places between the nodes
  threads    two to six points in a line, anyhow between the nodes, about what a point bears by itself: the highest frequency
             of all is at most that of the stiffest part with its share of the masses, sum_a g_a c^2 with g_a = sum (S')^2/S
             <= 6/h^2, so c dt/h = 1/sqrt(1.5 dim); by eigenvalues
  moving     as interior, while points and grid pass each other by v dt a step

Linear viscosity Q = Qv/c_L damps in compression only; `always` damps in tension too, as within a steady compression.
src/THEORY.md 12 states what follows.
"""

import argparse
import itertools

import numpy as np

GROWTH = 0.01  # a step; below it the affine velocity makes up to 0.001 at any step, with one point per cell
STEPS = 240


def weights(f):
    """Values and slopes of the three functions at f in [1/2, 3/2) from the first node."""
    return np.array([(1.5 - f) ** 2 / 2, 0.75 - (f - 1) ** 2, (f - 0.5) ** 2 / 2]), np.array([f - 1.5, 2 - 2 * f, f - 0.5])


class Points:
    """Points of equal volumes at x (points, axes) and what one step does to them."""

    def __init__(self, x, volume, shear=0.23, viscosity=0.0, always=False, averages=True, theta=None):
        self.count, self.dim = x.shape
        self.V, self.G, self.Q = volume, shear, viscosity
        self.K = 1 - 4 * shear / 3
        self.always, self.averages, self.theta = always, averages, theta
        self.place(x)

    def place(self, x):
        """Operators between points and nodes: S, its slopes and levers, and the mean over a cell."""
        n, dim, base = self.count, self.dim, np.floor(x - 0.5).astype(int)
        nodes, entries = {}, []
        for p, j in itertools.product(range(n), itertools.product(range(3), repeat=dim)):
            per_axis = [weights(x[p, a] - base[p, a]) for a in range(dim)]
            place = base[p] + np.array(j)
            phase = 1.0 if self.theta is None else np.exp(1j * np.dot(self.theta, place))
            node = nodes.setdefault(tuple(place) if self.theta is None else 0, len(nodes))
            S = np.prod([per_axis[a][0][j[a]] for a in range(dim)])
            slope = [np.prod([per_axis[b][int(a == b)][j[b]] for b in range(dim)]) for a in range(dim)]
            entries.append((p, node, phase, S, slope, place - x[p]))
        kind = float if self.theta is None else complex
        self.S = np.zeros((n, len(nodes)), kind)
        self.slopes, levers = np.zeros((dim,) + self.S.shape, kind), np.zeros((dim,) + self.S.shape, kind)
        mass = np.zeros(len(nodes))
        for p, node, phase, S, slope, lever in entries:
            self.S[p, node] += S * phase
            mass[node] += S * self.V
            for a in range(dim):
                self.slopes[a, p, node] += slope[a] * phase
                levers[a, p, node] += S * lever[a] * phase
        self.to_nodes, self.lever = self.S.conj().T, levers.conj().transpose(0, 2, 1)
        self.force = self.slopes.conj().transpose(0, 2, 1)
        self.per_mass = np.where(mass > 1e-30, self.V / np.maximum(mass, 1e-30), 0)[:, None]
        if self.theta is None:
            same = (base[:, None, :] == base[None, :, :]).all(2)
        else:  # the images of all points in one cell
            at = np.exp(1j * base @ self.theta)
            same = np.outer(at, at.conj())
        self.mean = same / np.abs(same).sum(1)[:, None]

    def start(self, rng):
        """Velocities, affine velocities, pressure, viscous pressure, deviator."""
        n, dim = self.count, self.dim
        return [rng.standard_normal(shape) for shape in ((dim, n, 1), (dim, dim, n, 1), (n, 1), (n, 1), (dim, dim, n, 1))]

    def averaged(self, q):
        return self.mean @ q if self.averages else q

    def step(self, state, dt, alpha=0.99):
        v, L, p, q, s = state
        axes = range(self.dim)
        P = self.averaged(p + q)
        v_new, L_new = [], []
        for i in axes:
            momentum = self.to_nodes @ v[i] + sum(self.lever[a] @ L[i][a] for a in axes)
            force = self.force[i] @ P - sum(self.force[a] @ s[i][a] for a in axes)
            before = self.per_mass * momentum
            after = before + dt * self.per_mass * force
            residual = v[i] - self.S @ before
            kept = self.mean @ residual
            v_new.append(self.S @ after + kept + alpha * (residual - kept))
            L_new.append([self.slopes[a] @ after for a in axes])
        trace = sum(L_new[i][i] for i in axes)
        closing = self.averaged(trace)
        p_new = p - dt * self.K * closing
        q_new = -self.Q * (closing if self.always else np.minimum(closing.real, 0))
        s_new = [[s[i][a] + dt * self.G * (L_new[i][a] + L_new[a][i] - (i == a) * 2 / 3 * trace) for a in axes]
                 for i in axes]
        return [np.array(v_new), np.array(L_new), p_new, q_new, np.array(s_new)]


def norm(state):
    return np.sqrt(sum(np.vdot(part, part).real for part in state))


def growth(points, dt, seed=0):
    """Per step, over the second half of the steps."""
    state, log = points.start(np.random.default_rng(seed)), 0.0
    for k in range(STEPS):
        state = points.step(state, dt)
        size = norm(state)
        state = [part / size for part in state]
        log += np.log(size) if k >= STEPS // 2 else 0
    return log / (STEPS - STEPS // 2)


def limit(points, low=0.3, high=2.0, width=0.01):
    while high - low > width:
        middle = (low + high) / 2
        low, high = (low, middle) if growth(points, middle) > GROWTH else (middle, high)
    return low


def lattice(per_axis, dim, first, spacing):
    return np.array(list(itertools.product(*[first + spacing * np.arange(per_axis)] * dim)))


def interior(dim, averages):
    """Least limit of lattices with one, two, three points per direction, and of points at random places."""
    rng, worst = np.random.default_rng(1), []
    angles = [np.array(t) for t in itertools.product((0, 1.6, np.pi), repeat=dim) if max(t) > 0]
    sets = [[lattice(n, dim, 0.5 + f / n, 1 / n) for f in (0, 0.3, 0.5)] for n in (1, 2, 3)]
    sets.append([0.5 + rng.random((2 ** dim, dim)) for _ in range(8)])
    for group in sets:
        worst.append(min(limit(Points(x, 1 / len(x), averages=averages, theta=t)) for x in group for t in angles))
    return worst


def free(dim, shear, viscosity, always=False):
    """Least limit of a free block of three cells; it stands at four places between the nodes."""
    blocks = [lattice(6, dim, 10 + first, 0.5) for first in (0, 0.125, 0.25, 0.4)]
    return min(limit(Points(x, 0.5 ** dim, shear, viscosity, always)) for x in blocks)


def radius(points, dt):
    """Spectral radius of a step."""
    shapes = [(points.dim, points.count), (points.dim, points.dim, points.count), (points.count,), (points.count,),
              (points.dim, points.dim, points.count)]
    ends = np.cumsum([np.prod(shape) for shape in shapes])
    parts = [part.reshape(shape + (ends[-1],)) for part, shape in zip(np.split(np.eye(ends[-1]), ends[:-1]), shapes)]
    return np.abs(np.linalg.eigvals(np.concatenate([out.reshape(-1, ends[-1]) for out in points.step(parts, dt)]))).max()


def threads(dim, shear, viscosity, tried=40):
    """Least limit of threads, and that over what a point bears by itself."""
    rng, least = np.random.default_rng(3), 9.0
    for k in range(tried):
        along = rng.standard_normal(dim)
        x = 10 + rng.random(dim) + np.outer(np.arange(2 + k % 5) * rng.uniform(0.3, 0.9), along / np.linalg.norm(along))
        points, low, high = Points(x, 0.5 ** dim, shear, viscosity, True), 0.2, 1.6
        while high - low > 0.01:
            middle = (low + high) / 2
            low, high = (low, middle) if radius(points, middle) > 1 + GROWTH / 2 else (middle, high)
        least = min(least, low)
    return least, least * np.sqrt(1.5 * dim * (1 - 4 * shear / 3))


def moving(dt, travel):
    """Greatest growth of a lattice of two points per cell along which the grid passes."""
    worst = -1.0
    for angle in (0.8, 1.6, 2.4, 3.0):
        x = np.array([[0.6234], [1.1234]])
        points = Points(x, 0.5, averages=False, theta=np.array([angle]))
        state, log = points.start(np.random.default_rng(0)), 0.0
        for k in range(STEPS):
            points.place(x + k * travel)
            state = points.step(state, dt)
            size = norm(state)
            state = [part / size for part in state]
            log += np.log(size) if k >= STEPS // 2 else 0
        worst = max(worst, log / (STEPS - STEPS // 2))
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--space", action="store_true", help="3d too (minutes)")
    dims = (1, 2, 3) if parser.parse_args().space else (1, 2)
    for dim in dims[:2]:
        for averages in (False, True):
            values = interior(dim, averages)
            print(f"interior, {dim} dimensions, {'means of cells' if averages else 'points alone'}: "
                  + ", ".join(f"{name} {v:.2f}" for name, v in zip(("1", "2", "3 per direction", "random"), values)))
    for dim in dims:
        for shear in (0.23, 0.0):
            print(f"free block, {dim} dimensions, G/(rho c_L^2) = {shear}: {free(dim, shear, 0):.2f}; Q = 0.25: "
                  f"{free(dim, shear, 0.25):.2f}, always {free(dim, shear, 0.25, True):.2f}", flush=True)
    for dim, shear, viscosity in itertools.product((2, 3), (0.33, 0.23, 0.0), (0, 0.1)):
        print(f"threads, {dim} dimensions, G/(rho c_L^2) = {shear}, always damped by Q = {viscosity}: "
              "{:.2f}, of the bound {:.2f}".format(*threads(dim, shear, viscosity)), flush=True)
    for dt in (0.9, 1.0, 1.2):
        print(f"moving, c dt/h = {dt}: " + ", ".join(f"v dt/h = {t}: {moving(dt, t):+.3f}" for t in (0.1, 0.5, 0.9)))


if __name__ == "__main__":
    main()
