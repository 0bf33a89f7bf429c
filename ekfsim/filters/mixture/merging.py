"""A few Gaussians in place of many: near ones merged, light ones left out."""

from typing import NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.arithmetic.unscented import weighted_mean
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans, Integers

NEAR = 1.0  # squared distance, in the heavier one's covariance, within which two are one
LIGHT = 1e-6  # a weight below it is left out
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
    left: Booleans = weights > LIGHT
    made: list[_One] = []
    for _ in range(most):
        w = np.where(left, weights, 0.0)
        first = np.argmax(w, axis=-1)[..., None]
        one = left & (np.arange(weights.shape[-1]) == first)
        several = np.count_nonzero(left, axis=-1).max(initial=0) > 1
        if several:
            one |= left & (_distances(means, covariances, first, headings) < NEAR)
        w = np.where(one, weights, 0.0)
        total = w.sum(axis=-1)
        inside = np.divide(w, total[..., None], out=np.zeros_like(w), where=total[..., None] > 0)
        x, P = moments(means, covariances, inside, headings)
        made.append(_One(x, P, total, first[..., 0], np.count_nonzero(one, axis=-1)))
        left = left & ~one
        if not left.any():
            break
    w = np.stack([one.total for one in made], axis=-1)
    order = np.argsort(-w, axis=-1, kind="stable")
    w = np.take_along_axis(w, order, axis=-1)
    x = np.stack([one.mean for one in made], axis=-2)
    P = np.stack([one.covariance for one in made], axis=-3)
    heaviest = np.stack([one.heaviest for one in made], axis=-1)
    merged = np.stack([one.merged for one in made], axis=-1)
    light = (weights > 0) & (weights <= LIGHT)
    return Few(
        np.take_along_axis(x, order[..., None], axis=-2),
        np.take_along_axis(P, order[..., None, None], axis=-3),
        w / w.sum(axis=-1, keepdims=True),
        np.take_along_axis(heaviest, order, axis=-1),
        np.take_along_axis(merged, order, axis=-1),
        np.count_nonzero(left | light, axis=-1),
    )


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
