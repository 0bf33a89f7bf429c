"""Central differences, and random covariances."""

import numpy as np


def jacobian(f, x, step=1e-6):
    """∂f/∂x by central differences. f : (n,) → (m,)"""
    x = np.asarray(x, float)
    columns = []
    for i in range(len(x)):
        h = np.zeros_like(x)
        h[i] = step
        columns.append((f(x + h) - f(x - h)) / (2 * step))
    return np.stack(columns, axis=-1)


def covariance(random, *shape, rank=None):
    """A random covariance of the shape (…, n), of full rank where none is given."""
    n = shape[-1]
    A = random.normal(size=(*shape, rank or n))
    return A @ A.mT


def definite(P, slack=1e-12):
    """Symmetric, and no eigenvalue below rounding."""
    λ = np.linalg.eigvalsh(P)
    return bool(np.array_equal(P, P.mT) and (λ >= -slack * np.abs(λ).max(-1, keepdims=True)).all())
