"""The extended Kalman filter of many runs, entry by entry: the twin of the readable one, a few
times as fast.

A product of N matrices of 3 × 3 is slow in numpy, the same sums over entries that lie side by side
are not. Here every array has its entries in front, (3, 3, N), and the runs behind. What needs care
(a reading that is nan, a sensor far sharper than the belief) is left to the readable text, for
those runs alone. A test holds the two equal.
"""

import numpy as np

from ekfsim import twins
from ekfsim.filters.algebra import SHARP
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.chi_square import quantile
from ekfsim.filters.conditioning import covariance as as_covariance
from ekfsim.filters.correcting import Linearized, corrected
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import back, front

MANY = 64  # runs from which on this pays
# what the first two columns of F are where no motion depends on the place
STILL = np.eye(3)[:, :2, None]


def predicted(P: Array, F: Array, G: Array, M: Array, Q: Array | float) -> Array | None:
    """F P Fᵀ + G M Gᵀ + Q : (N, 3, 3), exactly symmetric; None where this twin does not know how

    F = [1 0 α; 0 1 β; 0 0 1], as that of any robot which moves alike wherever it stands; M
    diagonal.
    """
    if F.shape[-1] != 3 or len(F) < MANY or not len(P) == len(G) == len(M) == len(F):
        return None
    propagated = _propagated
    if twins.taken() == "compiled":
        from ekfsim.filters.compiled import propagated
    new = propagated(front(P), front(F), front(G), front(M))
    if new is None:
        return None
    if np.ndim(Q):
        Q = np.asarray(Q)
        new += front(Q) if Q.ndim == 3 else Q[..., None]
    return back(_forced(new))


def _propagated(P: Array, F: Array, G: Array, M: Array) -> Array | None:
    """F P Fᵀ + G M Gᵀ : (3, 3, N)"""
    noisy: list[list[bool]] = np.any(M, axis=-1).tolist()
    if any(noisy[k][i] for k in range(len(M)) for i in range(len(M)) if i != k):
        return None
    if not ((F[:, :2] == STILL).all() and (F[2, 2] == 1).all()):
        return None
    (a, b, c), (_, d, e), (_, _, v) = P
    α, β = F[0, 2], F[1, 2]
    new = np.empty(P.shape)
    new[0, 2] = c + α * v
    new[1, 2] = e + β * v
    new[0, 0] = a + α * (c + new[0, 2])
    new[0, 1] = b + β * c + α * new[1, 2]
    new[1, 1] = d + β * (e + new[1, 2])
    new[2, 2] = v
    moves: list[list[bool]] = np.any(G, axis=-1).tolist()
    for k in range(len(M)):
        reached = [i for i in range(3) if noisy[k][k] and moves[i][k]]
        for at, i in enumerate(reached):
            shared = G[i, k] * M[k, k]
            for j in reached[at:]:
                new[i, j] += shared * G[j, k]
    new[1, 0], new[2, 0], new[2, 1] = new[0, 1], new[0, 2], new[1, 2]
    return new


def knows(x: Array, z: Array, H: Array) -> bool:
    """Whether `updated` may be asked: one number in each of many runs, from a state of three."""
    return (
        x.ndim == 2
        and len(x) >= MANY
        and x.shape[-1] == 3
        and z.shape == (len(x), 1)
        and H.shape == (len(x), 1, 3)
    )


def updated(
    prior: Gaussian, reading: Linearized, skip: Booleans | bool, gate: float | None, heading: int
) -> tuple[Gaussian, Correction]:
    """K = P⁻ Hᵀ/S      x = x⁻ + K ν      P = P⁻ − P⁻ Hᵀ H P⁻/S          of one number in N runs"""
    revised = _revised
    if twins.taken() == "compiled":
        from ekfsim.filters.compiled import revised
    _, h, ν, H, R = reading
    x, P = front(prior.mean, 1), front(prior.covariance)
    s, K, mean, covariance, nis, clear = revised(x, P, front(H)[0], R[..., 0, 0], ν[..., 0], SHARP)
    mean[heading] = wrap(mean[heading])
    refused = np.full(len(s), np.int64(Refused.NOT))
    if gate is not None:
        refused[nis > quantile(gate, 1)] = Refused.GATE
    if skip is not False:
        refused[np.broadcast_to(skip, refused.shape)] = Refused.GUARD
    # of those that are not clear nan may be in it: they are done again below
    covariance = _forced(covariance)
    posterior = Gaussian(back(mean, 1), back(covariance))
    correction = Correction(h, ν, R, s[:, None, None], H, back(K, 1)[..., None], nis, refused)
    kept = refused != Refused.NOT
    if kept.any():
        np.copyto(mean, x, where=kept)
        np.copyto(covariance, P, where=kept)
    if not clear.all():
        _with_care(~clear, prior, reading, skip, gate, heading, posterior, correction)
    return posterior, correction


def _revised(
    x: Array, P: Array, H: Array, r: Array, ν: Array, sharp: float
) -> tuple[Array, Array, Array, Array, Array, Booleans]:
    """S, K, x, P and NIS, and for which runs they may be trusted."""
    PHt = _summed(P * H)
    p = _summed(H * PHt)
    s = p + r
    clear = (r > sharp * _summed(H * H * np.stack([P[0, 0], P[1, 1], P[2, 2]]))) & (ν == ν)
    with np.errstate(all="ignore"):
        per_s = 1 / s
        K = PHt * per_s
        return s, K, x + K * ν, P - PHt[:, None] * PHt * per_s, ν * ν * per_s, clear


def _forced(P: Array) -> Array:
    """P as a covariance must be : (3, 3, N), see conditioning.covariance; mostly all are, which is
    soon seen.
    """
    sound = _sound
    if twins.taken() == "compiled":
        from ekfsim.filters.compiled import sound
    with np.errstate(invalid="ignore"):
        return P if sound(P) else front(as_covariance(back(P)))


def _sound(P: Array) -> bool:
    """Whether no variance is negative and no correlation beyond ±1."""
    (a, b, c), (_, d, e), (_, _, v) = P
    none_beyond = (
        (a >= 0) & (d >= 0) & (v >= 0) & (b * b <= a * d) & (c * c <= a * v) & (e * e <= d * v)
    )
    return bool(none_beyond.all())


def _with_care(
    some: Booleans,
    prior: Gaussian,
    reading: Linearized,
    skip: Booleans | bool,
    gate: float | None,
    heading: int,
    posterior: Gaussian,
    correction: Correction,
) -> None:
    """Do these runs again as the readable text does, and write what differs over the rest."""
    theirs = Linearized(*(part[some] for part in reading))
    left_out = np.broadcast_to(skip, some.shape)[some]
    before = Gaussian(prior.mean[some], prior.covariance[some])
    belief, careful = corrected(before, theirs, left_out, gate, (heading,))
    posterior.mean[some], posterior.covariance[some] = belief
    for array, right in (
        (correction.S, careful.S),
        (correction.K, careful.K),
        (correction.nis, careful.nis),
        (correction.refused, careful.refused),
    ):
        array[some] = right


def _summed(M: Array) -> Array:
    """The sum over the three entries of the last axis but the runs."""
    total: Array = M[..., 0, :] + M[..., 1, :]
    total += M[..., 2, :]
    return total
