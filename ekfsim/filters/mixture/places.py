"""The places that a mixture has for hypotheses: more of them, those of some runs, put together."""

from dataclasses import replace

import numpy as np

from ekfsim.filters.belief import Belief, Mixture, Refused
from ekfsim.geometry import Array, Booleans, Integers


def mixed(belief: Belief) -> Mixture:
    """The belief as a mixture; a Gaussian is one hypothesis."""
    if isinstance(belief, Mixture):
        return belief
    x, P = belief
    one, none = np.ones((*x.shape[:-1], 1)), np.full((*x.shape[:-1], 1), -1)
    return Mixture(
        x, P, x[..., None, :], P[..., None, :, :], one, none, one.astype(np.int64),
        none[..., 0] + 1, none + 1,
    )  # fmt: skip


def placed(mixture: Mixture, h: int) -> Mixture:
    """The same with h places, those that are added unused."""
    more = h - mixture.weights.shape[-1]
    if not more:
        return mixture
    axes = mixture.mean.shape[:-1]
    x, P = mixture.means[..., :1, :], mixture.covariances[..., :1, :, :]
    nothing = np.zeros((*axes, more), np.int64)
    return replace(
        mixture,
        means=np.concatenate([mixture.means, np.repeat(x, more, -2)], -2),
        covariances=np.concatenate([mixture.covariances, np.repeat(P, more, -3)], -3),
        weights=np.concatenate([mixture.weights, 0.0 * nothing], -1),
        walls=np.concatenate([mixture.walls, nothing - 1], -1),
        merged=np.concatenate([mixture.merged, nothing], -1),
        parents=np.concatenate([mixture.parents, nothing], -1),
    )


def where_used(refused: Integers, after: Mixture, before: Mixture) -> Mixture:
    """After the reading where it is used, before it where it is refused."""
    used = np.asarray(refused == Refused.NOT)
    if used.all():
        return after
    h = max(after.weights.shape[-1], before.weights.shape[-1])
    new, old = placed(after, h), placed(before, h)

    def either(a: Array, b: Array) -> Array:
        return np.where(used.reshape(*used.shape, *(1,) * (a.ndim - used.ndim)), a, b)

    return Mixture(
        either(new.mean, old.mean), either(new.covariance, old.covariance),
        either(new.means, old.means), either(new.covariances, old.covariances),
        either(new.weights, old.weights), np.where(used[..., None], new.walls, old.walls),
        np.where(used[..., None], new.merged, 1), np.where(used, new.pruned, 0),
        np.where(used[..., None], new.parents, np.arange(h)),
    )  # fmt: skip


def part(mixture: Mixture, rows: Booleans) -> Mixture:
    """The mixtures of some runs : (r, …). rows : (…)"""
    m = mixture
    return Mixture(
        m.mean[rows], m.covariance[rows], m.means[rows], m.covariances[rows], m.weights[rows],
        m.walls[rows], m.merged[rows], m.pruned[rows], m.parents[rows],
    )  # fmt: skip


def inserted(mixture: Mixture, rows: Booleans, more: Mixture) -> Mixture:
    """The same with the mixtures of some runs in place of theirs. rows : (…), more : (r, …)"""

    def put(numbers: Array, new: Array) -> Array:
        changed = np.array(numbers)
        changed[rows] = new
        return changed

    def put_whole(numbers: Integers, new: Integers) -> Integers:
        changed = np.array(numbers)
        changed[rows] = new
        return changed

    return replace(
        mixture,
        mean=put(mixture.mean, more.mean),
        covariance=put(mixture.covariance, more.covariance),
        means=put(mixture.means, more.means),
        covariances=put(mixture.covariances, more.covariances),
        weights=put(mixture.weights, more.weights),
        walls=put_whole(mixture.walls, more.walls),
        merged=put_whole(mixture.merged, more.merged),
        pruned=put_whole(mixture.pruned, more.pruned),
        parents=put_whole(mixture.parents, more.parents),
    )
