"""kalman.py of many runs, of a state of three and readings of one number, entry by entry.

What needs care (a reading that is nan, a sensor far sharper than the belief) is left to the text,
for those runs alone.
"""

from collections.abc import Callable

import numpy as np

from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.arithmetic.square_root import covariance as as_covariance
from ekfsim.filters.arithmetic.tolerances import SHARP
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.kalman import Linearized, Rule
from ekfsim.filters.kalman import update as update_of_any
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.soa import from_soa, to_soa
from ekfsim.twins import as_written

MANY = 64  # runs from which on this pays
# what the first two columns of F are where no motion depends on the place
STILL = np.eye(3)[:, :2, None]

Propagate = Callable[[Array, Array, Array, Array], Array | None]
Revise = Callable[
    [Array, Array, Array, Array, Array, float], tuple[Array, Array, Array, Array, Array, Booleans]
]
Sound = Callable[[Array], bool]


def predict(P: Array, F: Array, G: Array, M: Array, Q: Array | float) -> Array | None:
    """F P Fᵀ + G M Gᵀ + Q : (N, 3, 3), exactly symmetric"""
    return predicted(P, F, G, M, Q, propagated, sound)


def update(prior: Gaussian, reading: Linearized, rule: Rule) -> tuple[Gaussian, Correction] | None:
    """K = P⁻ Hᵀ/S      x = x⁻ + K ν      P = P⁻ − P⁻ Hᵀ H P⁻/S          of one number in N runs"""
    return updated(prior, reading, rule, revised, sound)


def predicted(
    P: Array, F: Array, G: Array, M: Array, Q: Array | float, propagate: Propagate, sound: Sound
) -> Array | None:
    """`predict` by one that propagates and one that sees whether covariances are sound.

    F = [1 0 α; 0 1 β; 0 0 1], as that of any robot which moves alike wherever it stands; M
    diagonal.
    """
    if F.ndim != 3 or F.shape[-1] != 3 or len(F) < MANY or P.ndim != 3:
        return None
    if not len(P) == len(G) == len(M) == len(F):
        return None
    new = propagate(to_soa(P), to_soa(F), to_soa(G), to_soa(M))
    if new is None:
        return None
    if np.ndim(Q):
        Q = np.asarray(Q)
        new += to_soa(Q) if Q.ndim == 3 else Q[..., None]
    return from_soa(_forced(new, sound))


def updated(
    prior: Gaussian, reading: Linearized, rule: Rule, revise: Revise, sound: Sound
) -> tuple[Gaussian, Correction] | None:
    """`update` by one that revises and one that sees whether covariances are sound."""
    z, h, ν, H, R = reading
    N = len(z)
    if N < MANY or not (z.shape == h.shape == (N, 1) and prior.mean.shape == (N, 3)):
        return None
    if not (H.shape == (N, 1, 3) and R.shape == (N, 1, 1) and len(rule.headings) == 1):
        return None
    x, P = to_soa(prior.mean, 1), to_soa(prior.covariance)
    s, K, mean, covariance, nis, clear = revise(x, P, to_soa(H)[0], R[..., 0, 0], ν[..., 0], SHARP)
    (heading,) = rule.headings
    mean[heading] = wrap(mean[heading])
    refused = np.full(N, np.int64(Refused.NOT))
    if rule.gate is not None:
        refused[nis > quantile(rule.gate, 1)] = Refused.GATE
    if rule.skip is not False:
        refused[np.broadcast_to(rule.skip, refused.shape)] = Refused.GUARD
    # of those that are not clear nan may be in it: they are done again below
    covariance = _forced(covariance, sound)
    posterior = Gaussian(from_soa(mean, 1), from_soa(covariance))
    correction = Correction(h, ν, R, s[:, None, None], H, from_soa(K, 1)[..., None], nis, refused)
    kept = refused != Refused.NOT
    if kept.any():
        np.copyto(mean, x, where=kept)
        np.copyto(covariance, P, where=kept)
    if not clear.all():
        _with_care(~clear, prior, reading, rule, posterior, correction)
    return posterior, correction


def propagated(P: Array, F: Array, G: Array, M: Array) -> Array | None:
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


def revised(
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


def sound(P: Array) -> bool:
    """Whether no variance is negative and no correlation beyond ±1."""
    (a, b, c), (_, d, e), (_, _, v) = P
    none_beyond = (
        (a >= 0) & (d >= 0) & (v >= 0) & (b * b <= a * d) & (c * c <= a * v) & (e * e <= d * v)
    )
    return bool(none_beyond.all())


def _forced(P: Array, sound: Sound) -> Array:
    """P as a covariance must be : (3, 3, N); mostly all are, which is soon seen."""
    with np.errstate(invalid="ignore"):
        return P if sound(P) else to_soa(as_covariance(from_soa(P)))


def _with_care(
    some: Booleans,
    prior: Gaussian,
    reading: Linearized,
    rule: Rule,
    posterior: Gaussian,
    correction: Correction,
) -> None:
    """Do these runs again as the text does, and write what differs over the rest."""
    theirs = Linearized(*(part[some] for part in reading))
    left_out = np.broadcast_to(rule.skip, some.shape)[some]
    before = Gaussian(prior.mean[some], prior.covariance[some])
    belief, careful = as_written(update_of_any)(before, theirs, rule._replace(skip=left_out))
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
