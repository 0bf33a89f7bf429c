"""Beliefs, motions and readings as the filters meet them."""

import math

import numpy as np
from numerics import covariance
from twin_inputs import axes_of, inputs

from ekfsim.filters.arithmetic.descent import Search
from ekfsim.filters.arithmetic.square_root import seen, square_root
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.kalman import Linearized, Rule
from ekfsim.models.motions.unicycle import Unicycle
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels
from ekfsim.models.sensors.landmarks import RangeBearing
from ekfsim.models.sensors.laser import Laser
from ekfsim.raycast.walls import BOUNDARY, Walls

ROOM = Walls.of({BOUNDARY: np.array([[-9, -9], [9, -9], [9, 9], [-9, 9.0]])})
SQUARE_ROOT = "ekfsim.filters.arithmetic.square_root"
ANGLES = np.array([math.pi, -math.pi, math.nextafter(math.pi, 0), 0.0, 3.1, -3.1])


def beliefs(random, axes, n=3):
    """P : (…, n, n) of full rank, of less, of none, and of all these side by side."""
    full = covariance(random, *axes, n) * 0.01
    yield full
    # all of it in one direction, or all but that; one that lies along no axis, nor nearly, for then
    # the text's own square root has fewer digits
    line = random.choice([-1, 1], (*axes, n, 1)) * random.uniform(0.5, 1, (*axes, n, 1))
    yield 0.01 * line @ line.mT
    across = np.eye(n) - line @ line.mT / np.square(line).sum(axis=-2, keepdims=True)
    flat = across @ full @ across
    yield 0.5 * (flat + flat.mT)
    certain = full.copy()  # of the last number
    certain[..., -1, :] = certain[..., :, -1] = 0.0
    yield certain
    yield np.zeros_like(full)
    choice = random.integers(0, 4, (*axes, 1, 1))
    yield np.select(
        [choice == 0, choice == 1, choice == 2], [full, certain, 0.0 * full], 100 * full
    )


def states(random, axes, n=3):
    """x : (…, n), the third of them at the turn of the circle or anywhere."""
    x = random.uniform(-5, 5, (*axes, n))
    x[..., 2] = np.where(
        random.random(axes) < 0.5, random.choice(ANGLES, axes), random.uniform(-3, 3, axes)
    )
    return x


@inputs("ekfsim.filters.kalman:predict")
def motions(random, runs):
    axes = axes_of(runs)
    F = np.zeros((*axes, 3, 3)) + np.eye(3)
    F[..., :2, 2] = random.normal(size=(*axes, 2))
    G = random.normal(size=(*axes, 3, 2))
    wheels, along = G.copy(), G.copy()
    wheels[..., 2, 0] = along[..., :2, 1] = 0.0
    M = np.zeros((*axes, 2, 2))
    M[..., 0, 0], M[..., 1, 1] = random.uniform(0, 0.1, (2, *axes))
    still = M * (random.random((*axes, 1, 1)) < 0.5)
    Q = np.diag([1e-3, 2e-3, 0.0])
    for P in beliefs(random, axes):
        yield P, F, G, M, 0.0
        yield P, F, wheels, still, Q
        yield P, F, along, 0.0 * M, np.broadcast_to(Q, P.shape)
        yield P, F + 0.1 * random.normal(size=F.shape), G, M, 0.0  # no such motion
        yield P, F, G, M + 0.01 * (1 - np.eye(2)), 0.0  # noises with something in common
    for P in beliefs(random, axes, 4):
        yield P, random.normal(size=P.shape), random.normal(size=(*axes, 4, 2)), M, 0.0


@inputs("ekfsim.filters.kalman:update", within=1e-11)  # of a sharp sensor four digits are lost
def readings(random, runs):
    axes = axes_of(runs)
    for n, k in ((3, 1), (3, 2), (4, 3)):
        for P in beliefs(random, axes, n):
            x, H = states(random, axes, n), random.normal(size=(*axes, k, n))
            h, ν = random.uniform(1, 5, (*axes, k)), 0.1 * random.normal(size=(*axes, k))
            R = 0.02 * np.eye(k) + np.zeros((*axes, k, k))
            common = covariance(random, *axes, k) * 0.01 + R
            blind = np.where(random.random((*axes, 1, 1)) < 0.5, 0.0, H)
            yield from ruled(random, axes, Gaussian(x, P), Linearized(h + ν, h, ν, H, R))
            yield from ruled(random, axes, Gaussian(x, P), Linearized(h + ν, h, ν, H, common))
            yield from ruled(random, axes, Gaussian(x, P), Linearized(h + ν, h, ν, blind, R))
            yield from ruled(random, axes, Gaussian(x, P), Linearized(h + ν, h, ν, H, 1e-12 * R))
            yield from ruled(random, axes, Gaussian(x, P), unmet(random, axes, h, ν, H, R))


def unmet(random, axes, h, ν, H, R):
    """A reading of which some have no echo, some no wall, and some neither."""
    echo, wall = random.random((2, *axes, 1)) < 0.8
    h = np.where(wall, h, np.nan)
    z = np.where(echo, h + ν, np.nan)
    met = wall[..., None]
    return Linearized(z, h, z - h, np.where(met, H, 0.0), np.where(met, R, np.nan))


def ruled(random, axes, prior, reading):
    """The same with a gate, with a guard, and with neither."""
    yield prior, reading, Rule(None, False, (2,))
    yield prior, reading, Rule(0.5, random.random(axes) < 0.3, (2,))
    yield prior, reading, Rule(0.99, True, ())


@inputs(f"{SQUARE_ROOT}:covariance")
def covariances(random, runs):
    axes = axes_of(runs)
    for n in (1, 2, 3, 5):
        for P in beliefs(random, axes, n):
            yield (P,)
            yield (P + 1e-18 * random.normal(size=P.shape),)
            yield (np.where(random.random((*axes, 1, 1)) < 0.5, np.nan, P),)


@inputs(f"{SQUARE_ROOT}:square_root")
def roots(random, runs):
    axes = axes_of(runs)
    for n in (1, 2, 3, 5):
        yield from ((P,) for P in beliefs(random, axes, n))
        yield from ((P, random.uniform(0, 1, (*axes, n))) for P in beliefs(random, axes, n))
        yield from ((P, np.zeros((*axes, n))) for P in beliefs(random, axes, n))


@inputs(f"{SQUARE_ROOT}:slope")
def slopes(random, runs):
    axes = axes_of(runs)
    for n, k in ((3, 1), (3, 2), (5, 3)):
        L, H = random.normal(size=(*axes, n, n)), random.normal(size=(*axes, k, n))
        yield H, L
        yield 0.0 * H, L
        yield H, np.tril(L)
        yield np.nextafter(L[..., :k, :], 0), np.linalg.inv(L)  # some of it is rounding


@inputs(f"{SQUARE_ROOT}:conditioned")
def known(random, runs):
    axes = axes_of(runs)
    for n, k in ((3, 1), (3, 2), (5, 3)):
        L, D = np.tril(random.normal(size=(*axes, n, n))), random.normal(size=(*axes, k, n))
        h, R = random.uniform(-5, 5, (*axes, k)), covariance(random, *axes, k) + 0.01 * np.eye(k)
        yield L, D, R * np.eye(k), h
        yield L, D, R, h
        yield L, D, 1e-10 * R, h
        yield L, D, 0.0 * R, h
        yield 0.0 * L, 0.0 * D, R, h
        yield 0.0 * L, 0.0 * D, 0.0 * R, h
        yield L, np.where(random.random((*axes, k, 1)) < 0.5, 0.0, D), R, h
        yield L, D, R, np.where(random.random((*axes, k)) < 0.3, 1e17, h)


@inputs("ekfsim.filters.arithmetic.descent:Search.descend", within=1e-9)  # ends at 1e-10 σ
def searches(random, runs):
    axes = axes_of(runs)
    if runs is not None and runs > 1:
        return
    for P in beliefs(random, axes):
        x = states(random, axes)
        for sensor in (Laser(ROOM, 0.3, 0.01), RangeBearing(6.0, 6.0, 0.1, 0.02)):
            h, H, R = sensor.linearize(x)
            L = square_root(P, seen(H))
            for z in (h, 1.05 * h, 0.97 * h, np.full_like(h, np.nan)):
                search = Search(sensor, z, x, L, R, H @ P @ H.mT + R, (2,))
                ν, used = sensor.residual(z, h), ~np.isnan(h).any(axis=-1)
                yield search, ν, h, H, used, 50
                yield search, ν, h, H, used, 2
                yield search, ν, h, H, np.zeros(axes, bool), 50


@inputs("ekfsim.filters.stretch:stretch", within=1e-11)
def stretches(random, runs):
    axes, Q = axes_of(runs), np.diag([1e-6, 2e-6, 3e-7])
    if runs is not None and runs > 63:
        return
    ways = 0.02 + 0.002 * random.normal(size=(40, *axes, 2))
    t, turns = np.full((40, *axes, 1), 0.05), random.normal(size=(40, *axes, 1))
    for P in beliefs(random, axes):
        belief = Gaussian(states(random, axes), P)
        yield belief, TwoWheels(0.5, 0.002, Q), ways
        yield belief, GyroWheels(0.5, 0.002, Q, 0.01), np.concatenate([ways, turns, t], axis=-1)
        yield belief, Unicycle(0.02, 0.1), np.concatenate([ways[..., :1], turns, t], axis=-1)
        yield belief, TwoWheels(0.5, 0.002), ways[:0]
