"""A study beside the floor: a compiled loop over runs of the tour that does no more than it must.

It draws, drives, casts among all walls, predicts, updates and judges, on the draws of the study, so
that it finds as many runs lost. It keeps no steps and no tallies, and knows no world but one whose
filter is told the truth. The draws are NumPy's; the extra `bench` brings Numba.

python benchmarks/floor.py [--quick]
"""

import argparse
import csv
import math
import tempfile
from dataclasses import astuple
from pathlib import Path

import numpy as np
from builds import HERE, obey
from numba import njit
from scipy.stats import chi2
from timing import ratios

import ekfsim

BLOCK, BLOCKS = 1024, 20  # runs that share their draws, and how many such
RUNS = BLOCK * BLOCKS
LOST = float(chi2.ppf(0.999, 3))


@njit(cache=True)
def cast(walls, x, y, θ):  # type: ignore[no-untyped-def]
    """Range of a beam, and the wall it meets; −1 where there is none."""
    c, s, nearest, met = math.cos(θ), math.sin(θ), math.inf, -1
    for wall in range(len(walls)):
        ax, ay, ex, ey = walls[wall]
        across = c * ey - s * ex
        if across != 0.0:
            r, t = ((ax - x) * ey - (ay - y) * ex) / across, ((ax - x) * s - (ay - y) * c) / across
            if 0.0 <= t <= 1.0 and 0.0 <= r < nearest:
                nearest, met = r, wall
    return nearest, met


@njit(cache=True)
def wrap(θ):  # type: ignore[no-untyped-def]
    return θ - 2 * math.pi * math.ceil((θ - math.pi) / (2 * math.pi))


# P = [[a, b, p], [b, d, q], [p, q, r]] is (a, b, d, p, q, r).
@njit(cache=True)
def predicted(P, v1, v2, D, c, s, A):  # type: ignore[no-untyped-def]
    """F P Fᵀ + G M Gᵀ, where F is I but for v1, v2 = ∂(x, y)/∂θ"""
    a, b, d, p, q, r = P
    a, b = a + v1 * (2 * p + v1 * r) + D * c * c, b + v1 * q + v2 * (p + v1 * r) + D * c * s
    return a, b, d + v2 * (2 * q + v2 * r) + D * s * s, p + v1 * r, q + v2 * r, r + A


@njit(cache=True)
def updated(P, H, R):  # type: ignore[no-untyped-def]
    """K and (I − K H) P"""
    (a, b, d, p, q, r), (h1, h2, h3) = P, H
    v1, v2, v3 = a * h1 + b * h2 + p * h3, b * h1 + d * h2 + q * h3, p * h1 + q * h2 + r * h3
    S = h1 * v1 + h2 * v2 + h3 * v3 + R
    k1, k2, k3 = v1 / S, v2 / S, v3 / S
    P = a - k1 * v1, b - k1 * v2, d - k2 * v2, p - k1 * v3, q - k2 * v3, r - k3 * v3
    return (k1, k2, k3), P


@njit(cache=True)
def squared(e, P):  # type: ignore[no-untyped-def]
    """eᵀ P⁺ e by P = L D Lᵀ, where a pivot that is nothing but rounding tells nothing."""
    (e1, e2, e3), (a, b, d, p, q, r), total = e, P, 0.0
    d2, d3 = d, r
    if a > 1e-24:
        k, m = b / a, p / a
        total += e1 * e1 / a
        e2, e3, d2, q, d3 = e2 - k * e1, e3 - m * e1, d - k * b, q - m * b, r - m * p
    if d2 > max(1e-10 * d, 1e-24):
        n = q / d2
        total += e2 * e2 / d2
        e3, d3 = e3 - n * e2, d3 - n * q
    return total + e3 * e3 / d3 if d3 > max(1e-10 * r, 1e-24) else total


@njit(cache=True)
def play(walls, start, σ, commands, normals, nees):  # type: ignore[no-untyped-def]
    """NEES after every command : (commands, runs); commands : is it a move, distance, angle"""
    for run in range(nees.shape[1]):
        x, y, θ = start
        mx, my, mθ = start
        P = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(len(commands)):
            is_move, d, a = commands[i]
            n1, n2, n3, n4 = normals[i, run]
            if is_move:
                d, a = d * (1 + σ[0] * n1), a * (1 + σ[1] * n2)
                free = cast(walls, x, y, θ + math.pi if d < 0 else θ)[0] - 1e-3
                d = math.copysign(min(abs(d), max(free, 0.0)), d)
                x, y, θ = x + d * math.cos(θ), y + d * math.sin(θ), wrap(θ + a)
                d, a = d * (1 + σ[2] * n3), a * (1 + σ[3] * n4)
                c, s = math.cos(mθ), math.sin(mθ)
                mx, my, mθ = mx + d * c, my + d * s, wrap(mθ + a)
                P = predicted(P, -d * s, d * c, (σ[2] * d) ** 2, c, s, (σ[3] * a) ** 2)
            else:
                z = cast(walls, x, y, θ + a)[0] * (1 + σ[4] * n1)
                h, wall = cast(walls, mx, my, mθ + a)
                if wall >= 0 and z < math.inf:
                    c, s = math.cos(mθ + a), math.sin(mθ + a)
                    ex, ey = walls[wall, 2], walls[wall, 3]
                    n_d = c * ey - s * ex
                    H = -ey / n_d, ex / n_d, h * (c * ex + s * ey) / n_d
                    K, P = updated(P, H, (σ[4] * h) ** 2)
                    ν = z - h
                    mx, my, mθ = mx + K[0] * ν, my + K[1] * ν, wrap(mθ + K[2] * ν)
            nees[i, run] = squared((mx - x, my - y, wrap(mθ - θ)), P)


class Floor:
    """The tour, ready to be played in blocks."""

    def __init__(self) -> None:
        scene = ekfsim.load_scene(HERE / "commands" / "tour.yaml")
        rings = [ring for _, ring in scene.world.map.rings()]
        edges = [np.hstack([ring, np.roll(ring, -1, axis=0) - ring]) for ring in rings]
        self.walls, self.start, self.seed = np.vstack(edges), tuple(scene.world.start), scene.seed
        self.ratios = astuple(scene.world.noise)  # execution, odometry: of distance, angle; range
        commands = [c for c in scene.commands if hasattr(c, "angle")]  # all but what is said
        ways = [getattr(command, "distance", None) for command in commands]
        self.commands = np.array(
            [(d is not None, d or 0.0, c.angle) for d, c in zip(ways, commands, strict=True)]
        )

    def drawn(self, block: int) -> np.ndarray:
        """The normals of a block's runs : (commands, runs, 4)"""
        seeds = ([self.seed, i, block] for i in range(1, len(self.commands) + 1))
        bits = (np.random.PCG64(np.random.SeedSequence(seed)) for seed in seeds)
        return np.stack([np.random.Generator(b).standard_normal((BLOCK, 4)) for b in bits])

    def lost(self) -> int:
        """How many of the runs end lost."""
        nees, total = np.empty((len(self.commands), BLOCK)), 0
        for block in range(BLOCKS):
            play(self.walls, self.start, self.ratios, self.commands, self.drawn(block), nees)
            total += np.count_nonzero(nees[-1] > LOST)
        return total


def lost_of_study() -> int:
    """How many of the same runs the study tells to be lost."""
    with tempfile.TemporaryDirectory() as folder:
        obey("study", "tour", "--runs", str(RUNS), "--out", folder, "--force")
        with (Path(folder) / "summary.csv").open(newline="") as file:
            (row,) = csv.DictReader(file)
    return round(float(row["lost"]) * RUNS)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    rounds = 3 if parser.parse_args().quick else 9
    floor = Floor()
    print(f"lost of {RUNS} runs: {floor.lost()} by the loop, {lost_of_study()} by the study")
    words = ["study", "tour", "--runs", str(RUNS)]
    peers = {
        "draws alone": lambda: [floor.drawn(block) for block in range(BLOCKS)],
        "study tour": lambda: obey(*words),
        "study tour --fast": lambda: obey(*words, "--fast"),
    }
    for ratio in ratios(floor.lost, peers, rounds, parts=RUNS):
        times = f"{ratio.seconds * 1e6:8.2f} µs a run, floor {ratio.ours * 1e6:.2f} µs"
        print(f"{ratio.ratio:9.2f} × the floor: {ratio.peer:20s} {times}")


if __name__ == "__main__":
    main()
