"""A few Gaussians in place of many: near ones merged, light ones left out."""

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.arithmetic.unscented import weighted_mean
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans, Integers

NEAR = 1.0  # squared distance, in the heavier one's covariance, within which two are one
LIGHT = 1e-6  # a weight below it is left out
T = TypeVar("T", bound=np.generic)

TOO_SMALL = 1e-6  # m, rad: nothing is told apart by less


class Few(NamedTuple):
    """At most h Gaussians, the heaviest first. Arrays carry leading axes (…)."""

    means: Array  # (…, h, n)
    covariances: Array  # (…, h, n, n)
    weights: Array  # (…, h), their sum is 1; 0 where there is none
    heaviest: Integers  # (…, h) which of the many is the heaviest in each
    merged: Integers  # (…, h) how many of the many are one in each
    pruned: Integers  # (…) how many of some weight were left out


class _One(NamedTuple):
    """A Gaussian that some of the many are one in. Arrays carry leading axes (…)."""

    mean: Array
    covariance: Array
    total: Array  # (…) the sum of their weights
    heaviest: Integers
    merged: Integers


def moments(
    means: Array, covariances: Array, weights: Array, headings: tuple[int, ...]
) -> Gaussian:
    """x = Σ wᵢ xᵢ      P = Σ wᵢ (Pᵢ + (xᵢ − x)(xᵢ − x)ᵀ), headings wrapped : (…, n), (…, n, n)

    Summed about the heaviest, so that one alone is given back as it is.
    means : (…, h, n), covariances : (…, h, n, n), weights : (…, h), their sum is 1
    """
    first = np.argmax(weights, axis=-1)[..., None]
    about = np.take_along_axis(means, first[..., None], axis=-2)
    alone = np.take_along_axis(weights, first, axis=-1)[..., 0] == 1.0
    x = weighted_mean(means, weights, headings, about[..., 0, :])
    δ = wrapped(means - x[..., None, :], headings)
    w = weights[..., None]
    P = np.sum(w[..., None] * covariances, axis=-3) + symmetric((w * δ).mT @ δ)
    P_first = np.take_along_axis(covariances, first[..., None, None], axis=-3)[..., 0, :, :]
    return Gaussian(
        np.where(alone[..., None], about[..., 0, :], x),
        np.where(alone[..., None, None], P_first, symmetric(P)),
    )


def reduced(
    means: Array, covariances: Array, weights: Array, most: int, headings: tuple[int, ...]
) -> Few:
    """The heaviest Gaussian and all within reach of it are one; then so the heaviest that is left,
    until `most` are made: Salmond, Mixture reduction algorithms for target tracking, 1990.

    Those that are one keep their mean and covariance (`moments`).
    means : (…, c, n), covariances : (…, c, n, n), weights : (…, c), their sum is 1
    """
    axes, (c, n) = weights.shape[:-1], means.shape[-2:]
    x, P = means.reshape(-1, c, n), covariances.reshape(-1, c, n, n)
    weights = weights.reshape(-1, c)
    left: Booleans = weights > LIGHT
    made: list[_One] = []
    for _ in range(most):
        rows = np.flatnonzero(left.any(axis=-1))
        if made and not len(rows):
            break
        first = np.argmax(np.where(left, weights, 0.0), axis=-1)
        one = left & (np.arange(c) == first[:, None])
        some = rows[np.count_nonzero(left[rows], axis=-1) > 1]
        near = _distances(x[some], P[some], first[some, None], headings) < NEAR
        one[some] |= left[some] & near
        made.append(_together(x, P, weights, one, first, headings))
        left &= ~one
    w = np.stack([one.total for one in made], axis=-1)
    order = np.argsort(-w, axis=-1, kind="stable")
    light = (weights > 0) & (weights <= LIGHT)
    few = Few(
        _stacked([one.mean for one in made], order),
        _stacked([one.covariance for one in made], order),
        np.take_along_axis(w, order, axis=-1) / w.sum(axis=-1, keepdims=True),
        _stacked([one.heaviest for one in made], order),
        _stacked([one.merged for one in made], order),
        np.count_nonzero(left | light, axis=-1),
    )
    return Few(*(part.reshape((*axes, *part.shape[1:])) for part in few))


def _together(
    x: Array, P: Array, weights: Array, one: Booleans, first: Integers, headings: tuple[int, ...]
) -> _One:
    """What is one in each of N mixtures : (N, c); the heaviest of them, `first` : (N,), as it is
    where there is no other.
    """
    n, merged = np.arange(len(x)), np.count_nonzero(one, axis=-1)
    mean, covariance = x[n, first], P[n, first]
    w = np.where(one, weights, 0.0)
    total, several = w.sum(axis=-1), np.flatnonzero(merged > 1)
    if len(several):
        inside = w[several] / total[several, None]
        mean[several], covariance[several] = moments(x[several], P[several], inside, headings)
    return _One(mean, covariance, total, first, merged)


def _stacked(each: list[NDArray[T]], order: Integers) -> NDArray[T]:
    """(N, …) of each → (N, h, …), in an order of their own. order : (N, h)"""
    return np.stack(each, axis=1)[np.arange(len(order))[:, None], order]


def _distances(
    means: Array, covariances: Array, first: Integers, headings: tuple[int, ...]
) -> Array:
    """(xᵢ − x)ᵀ P⁻¹ (xᵢ − x) : (…, c), x and P those of the first : (…, 1)"""
    δ = means - np.take_along_axis(means, first[..., None], axis=-2)
    δ = np.nan_to_num(wrapped(δ, headings), nan=np.inf, posinf=1e9, neginf=-1e9)
    P = np.take_along_axis(covariances, first[..., None, None], axis=-3)[..., 0, :, :]
    P = np.nan_to_num(P) + TOO_SMALL**2 * np.eye(P.shape[-1])
    solved = np.linalg.solve(P, δ.mT).mT
    d: Array = np.vecdot(δ, solved)
    return d
