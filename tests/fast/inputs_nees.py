"""Errors of poses and their covariances, of every rank and on the edges between them."""

import numpy as np
from twin_inputs import axes_of, inputs

from ekfsim.filters.belief import Gaussian
from ekfsim.models.layout import INERTIAL, POSE

TURNS = np.array([0.0, np.pi / 2, np.pi, -np.pi / 2, np.pi / 4, 1e-9, np.pi / 2 + 1e-5])


def errors_of(random, P):
    """Errors as P lets them be."""
    λ, V = np.linalg.eigh(P)
    y = np.sqrt(np.maximum(λ, 0.0)) * random.normal(size=λ.shape)
    return np.matvec(V, np.where(λ > 1e-14 * λ[..., -1:], y, 0.0))


def clear(random, axes, n, rank):
    """Covariances that are clearly of a rank."""
    Q = np.linalg.qr(random.normal(size=(*axes, n, n)))[0]
    A = Q[..., :rank] * random.uniform(0.1, 0.3, rank)
    return A @ A.mT


def covariances(random, axes, n):
    """Of every rank."""
    for rank in range(n + 1):
        yield clear(random, axes, n, rank)
    yield straight_ways(random, axes)[..., :n, :n]
    cut = clear(random, axes, n, n)
    k = random.integers(n)
    cut[..., k, :] = cut[..., :, k] = 0.0
    yield cut
    scale = np.array([1e3, 1.0, 1e-3])[:n]
    yield clear(random, axes, n, n) * scale[:, None] * scale
    mixed = clear(random, axes, n, n)
    if axes:
        mixed[::3] = 0.0
        mixed[1::3, -1, :] = mixed[1::3, :, -1] = 0.0
    yield mixed
    yield np.eye(n) * np.array([0.9e-12, 0.2, 0.1])[:n] ** 2  # σ is rounding; the same for all runs


def straight_ways(random, axes):
    """The start certain, then straight ahead: of rank 1 with a certain heading, and of 2."""
    θ = random.choice(TURNS, axes)
    way = np.stack([np.cos(θ), np.sin(θ), np.zeros(axes)], axis=-1)
    F = np.zeros((*axes, 3, 3)) + np.eye(3)
    F[..., 0, 2], F[..., 1, 2] = -2 * np.sin(θ), 2 * np.cos(θ)
    known = F @ np.diag([0.0, 0.0, 0.02**2]) @ F.mT
    return known * random.integers(2) + 0.04 * way[..., :, None] * way[..., None, :]


def cases(random, axes, n):
    """Errors and covariances."""
    for P in covariances(random, axes, n):
        P = np.array(np.broadcast_to(P, (*axes, n, n)))
        e = errors_of(random, P)
        yield e, P
        yield 0.9e-6 * e / max(np.abs(e).max(), 1e-30) + e, P
        yield e + 1e-3, P  # impossible, where P is singular
    yield np.full((*axes, n), np.nan), np.array(np.broadcast_to(np.eye(n), (*axes, n, n)))


@inputs("ekfsim.diagnostics.nees:squared_mahalanobis")
def errors(random, runs):
    for n in (2, 3):
        yield from cases(random, axes_of(runs), n)


@inputs("ekfsim.diagnostics.nees:nees")
def beliefs(random, runs):
    axes = axes_of(runs)
    for e, P in cases(random, axes, 3):
        truth = random.uniform(-3, 3, (*axes, 3))
        truth[..., 2] = random.choice([np.pi, -3.0, 0.0, 1.5], axes)
        yield Gaussian(truth + e, P), truth, POSE
    whole = clear(random, axes, 7, 7)
    yield Gaussian(random.normal(size=(*axes, 7)), whole), np.zeros((*axes, 3)), INERTIAL
