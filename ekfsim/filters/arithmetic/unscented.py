"""The unscented transform: a mean and a covariance through any function, without its derivative."""

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.filters.arithmetic.square_root import covariance as as_covariance
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap

QUARTER = math.pi / 2  # of a turn


class Weights(NamedTuple):
    """How far the sigma points of n numbers lie from the mean, and how much each of the 2n + 1
    counts.
    """

    spread: float  # √(n + λ), in columns of the root of P
    mean: Array  # (2n + 1,) Wᵐ
    covariance: Array  # (2n + 1,) Wᶜ

    def definite(self, P: Array) -> Array:
        """P, which need not be a covariance where the first point counts negatively."""
        return nearest_definite(P) if self.covariance[0] < 0 else P


class Transformed(NamedTuple):
    """A Gaussian after a function y = g(x)."""

    mean: Array  # ȳ : (…, k)
    covariance: Array  # P_yy : (…, k, k)
    cross: Array  # P_xy : (…, n, k)
    root: Array  # L : (…, n, n), P = L Lᵀ
    # D = Δy/Δ√P : (…, k, n), the central differences along the columns of L; P_xy = L Dᵀ
    slope: Array
    bend: Array  # Ω = P_yy − D Dᵀ : (…, k, k), what no straight line through the points explains

    @property
    def jacobian(self) -> Array:
        """P_yx P⁺ : (…, k, n), what stands for a derivative"""
        return statistical_slope(self.slope, self.root)


@lru_cache(maxsize=64)
def weights(n: int, alpha: float = 1.0, beta: float = 0.0, kappa: float | None = None) -> Weights:
    """λ = α² (n + κ) − n      W₀ᵐ = λ/(n + λ)      W₀ᶜ = W₀ᵐ + 1 − α² + β      Wᵢ = 1/(2(n + λ))

    Wan & van der Merwe, The unscented Kalman filter, 2001, eq. 7.30. With α = 1 and β = 0 these are
    Julier's own, W₀ = κ/(n + κ): document 001, eq. 14. κ None is max(3 − n, 0): his choice for a
    Gaussian while no weight is negative.

    >>> weights(2).mean.round(3).tolist()
    [0.333, 0.167, 0.167, 0.167, 0.167]
    """
    kappa = max(3.0 - n, 0.0) if kappa is None else kappa
    scale = alpha**2 * (n + kappa)  # n + λ
    if not scale > 0:
        raise ValueError(
            f"alpha² (n + kappa) must be positive, not {scale:g}: alpha={alpha:g}, n={n}, "
            f"kappa={kappa:g}"
        )
    outer = np.full(2 * n, 1 / (2 * scale))
    first = 1 - n / scale
    return Weights(
        math.sqrt(scale), np.append(first, outer), np.append(first + 1 - alpha**2 + beta, outer)
    )


def sigma_points(mean: Array, L: Array, spread: float | Array) -> Array:
    """x̄, x̄ + √(n+λ) Lᵢ, x̄ − √(n+λ) Lᵢ, Lᵢ the columns of the root of P : (…, 2n + 1, n)
    eq. 14

    spread : one for all columns, or (…, n)
    """
    arms = np.asarray(spread)[..., None] * L.mT
    points: Array = mean[..., None, :] + np.concatenate(
        [np.zeros_like(arms[..., :1, :]), arms, -arms], axis=-2
    )
    return points


def reach(L: Array, spread: float, headings: tuple[int, ...]) -> Array:
    """How far along each column of L the sigma points lie : (…, n), the spread, or less where a
    heading turns with it.

    None turns by more than a quarter of a turn. Two that are a turn apart are the same place, and
    one beyond half a turn tells of the wrong side: a robot whose heading nobody knows would learn
    from its fixes that it is a sure one.
    """
    turns = np.abs(L[..., np.array(headings, int), :]).max(axis=-2, initial=0.0)
    wide = spread * turns > QUARTER
    return np.where(wide, np.divide(QUARTER, turns, out=np.zeros_like(turns), where=wide), spread)


def weighted_mean(
    points: Array, weights: Array, angles: tuple[int, ...] = (), about: Array | None = None
) -> Array:
    """Σ Wᵢ yᵢ : (…, k), of an angle atan2(Σ Wᵢ sin yᵢ, Σ Wᵢ cos yᵢ). points : (…, p, k), weights :
    (…, p)

    The weights sum to 1. Summed as differences to one point (…, k), the first where none is given,
    so that large weights of opposite signs cost no digits and equal points have exactly their own
    mean.
    """
    centre = points[..., 0, :] if about is None else about
    differences = points - centre[..., None, :]
    mean: Array = centre + np.vecmat(weights, differences)
    for i in angles:
        δ = differences[..., i]
        sine, cosine = np.vecdot(weights, np.sin(δ)), 1 + np.vecdot(weights, np.cos(δ) - 1)
        mean[..., i] = wrap(centre[..., i] + np.arctan2(sine, cosine))
    return mean


def unscented_transform(
    mean: Array,
    covariance: Array,
    function: Callable[[Array], Array],
    weights: Weights,
    angles: tuple[int, ...] = (),
    J: Array | None = None,
    headings: tuple[int, ...] = (),
) -> Transformed:
    """ȳ = Σ Wᵢᵐ yᵢ      P_yy = Σ Wᵢᶜ (yᵢ − ȳ)(yᵢ − ȳ)ᵀ      P_xy = Σ Wᵢᶜ (xᵢ − x̄)(yᵢ − ȳ)ᵀ
    eqs 15 to 17

    function : (…, n) → (…, k), whose entries `angles` are directions. All is summed in differences
    δᵢ = yᵢ − y₀ to the first point. That of a direction is not known but for whole turns, and a
    heading may be uncertain by more than one. So it is taken next to T (xᵢ − x̄), what the state's
    own headings turn y by, however far. J : (…, k, n) is the function's Jacobian at x̄, of which T
    has the columns of the headings; None: it is turned by none.

    The points come in pairs, δᵢ± = δ̄ + sᵢ ± dᵢ, and 2 Wᵢ (n + λ) = 1. So the sums are, without a
    small difference of large numbers,

        D = [dᵢ] / √(n+λ)      Ω = W₀ᶜ δ̄ δ̄ᵀ + Σ 2 Wᵢ sᵢ sᵢᵀ      P_yy = D Dᵀ + Ω      P_xy = L Dᵀ

    Which entries of x are `headings` is told for `reach`: where it is less than √(n+λ) it stands in
    its place in D, the slope of a shorter chord; the weights stay.
    """
    n, L = mean.shape[-1], square_root(covariance)
    far = reach(L, weights.spread, headings)
    X = sigma_points(mean, L, far)
    y = function(X)
    δ = y - y[..., :1, :]
    if angles:
        arms = L * far[..., None, :]
        # X − x̄, never wrapped
        arms = np.concatenate([np.zeros_like(L[..., :1]), arms, -arms], axis=-1)
        turned = np.zeros_like(δ) if J is None else (_turning(J, headings) @ arms).mT
        for i in angles:
            δ[..., i] = turned[..., i] + wrap(δ[..., i] - turned[..., i])
    δ_mean = np.vecmat(weights.mean, δ)
    y_mean = y[..., 0, :] + δ_mean
    for i in angles:
        y_mean[..., i] = wrap(y_mean[..., i])
    δ = δ - δ_mean[..., None, :]
    ahead, behind = δ[..., 1 : n + 1, :], δ[..., n + 1 :, :]
    D = ((ahead - behind) / (2 * far[..., None])).mT
    s = np.concatenate([δ[..., :1, :], (ahead + behind) / 2], axis=-2)
    W = np.append(weights.covariance[0], 2 * weights.covariance[1 : n + 1])
    bend = s.mT @ (W[:, None] * s)
    return Transformed(y_mean, as_covariance(D @ D.mT + bend), L @ D.mT, L, D, bend)


def _turning(J: Array, headings: tuple[int, ...]) -> Array:
    """T : (…, k, n), what of a Jacobian the headings of the state do"""
    T = np.zeros_like(J)
    for i in headings:
        T[..., i] = J[..., i]
    return T


def statistical_slope(D: Array, L: Array) -> Array:
    """P_yx P⁺ = D L⁺ : (…, k, n), the Jacobian that stands for a function between its sigma points;
    P = L Lᵀ
    """
    D, n = np.nan_to_num(D), L.shape[-1]
    pivots = np.diagonal(L, axis1=-2, axis2=-1)
    H = np.zeros(np.broadcast_shapes(D.shape, (*L.shape[:-2], 1, n)))
    for j in reversed(range(n)):
        rest = D[..., j] - np.vecdot(H[..., j + 1 :], L[..., None, j + 1 :, j])
        pivot = pivots[..., None, j]
        H[..., j] = np.divide(rest, pivot, out=np.zeros_like(rest), where=pivot > 0)
    # a number that depends on the others
    singular = np.any((pivots == 0) & np.any(L != 0, axis=-1), axis=-1)
    if np.any(singular):
        H[singular] = np.broadcast_to(D, H.shape)[singular] @ np.linalg.pinv(L[singular])
    return H


def nearest_definite(P: Array) -> Array:
    """P with its negative eigenvalues at 0 : (…, n, n), which only negative weights can make
    necessary.
    """
    known = np.isfinite(P).all(axis=(-2, -1), keepdims=True)
    λ, V = np.linalg.eigh(np.where(known, P, 0.0))
    return np.where(known, symmetric((V * np.maximum(λ, 0.0)[..., None, :]) @ V.mT), np.nan)
