"""Whether innovations are white around zero: what a log without a truth tells of its filter.

A filter that is told the truth makes innovations that are independent of one another and of mean 0
(Mehra, IEEE Transactions on Automatic Control 15(2), 1970). Their mean is never taken away: else
every constant bias would pass. All is asked of one sensor at a time and in units of the size that
its innovations have, so that noises which are merely told too small, as the NIS shows, are no lack
of whiteness.
Lags count readings of the sensor, not instants.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.diagnostics.chances import at_most_heads, below_beta, beyond_chi_square
from ekfsim.geometry import Array, Booleans, Integers

LAGS = 5
LEAST = 10  # readings of a sensor; fewer are no evidence
PART = 5  # a lag is shorter than this part of the readings
FEW = 5  # readings of one target; those of rarer ones are taken together
OTHERS = "others"


@dataclass(frozen=True, slots=True)
class Whiteness:
    """What is found of one sensor's innovations. Arrays carry leading axes (…), one for each run.

    A p is the chance of what was found, or of more, where all is right; nan where it was not asked.
    """

    sensor: str
    quantities: tuple[str, ...]  # k, that it reads: ("range", "bearing")
    targets: tuple[str, ...]  # T, what it read: "node 3"; of a beam the side that it looked to
    readings: Integers  # (…) that are judged
    numbers: Integers  # (…) of them: two of a reading of range and bearing
    lags: Array  # (…, 5) Σ ν_k ν_(k+j) / Σ ν², nan from a fifth of the readings on
    target_lags: Array  # (…, 5) the same among the readings of each target by itself
    means: Array  # (…, T, k) of each target's numbers, in units of their own σ
    target_readings: Integers  # (…, T)
    changes: Integers  # (…) of sign, from one reading to the next
    p_lags: Array  # (…)
    p_target_lags: Array  # (…)
    p_mean: Array  # (…) of all targets' means together
    p_runs: Array  # (…) of the changes of sign: told beside, and judged by nobody

    @property
    def tests(self) -> Array:
        """The p of the three tests that are judged : (…, 3)"""
        return np.stack([self.p_lags, self.p_target_lags, self.p_mean], axis=-1)


def whiteness(sensor: str, quantities: tuple[str, ...], read: Sequence[str], w: Array) -> Whiteness:
    """What is found of one sensor's whitened innovations w : (…, n, k), nan where one is left out.

    read : of what each is, n names

    Where all is right w / |w| is drawn evenly from a sphere, whatever the size of w. Hence the sum
    over all pairs of readings that lie j apart, divided by Σw², has the mean 0 and the variance
    m / (D (D + 2)), for m pairs and D numbers; and the share of Σw² that lies along K means,
    Σ n mean² / Σw², is a Beta(K/2, (D − K)/2) variable.
    """
    often = Counter(read)
    names = [one if often[one] >= FEW else OTHERS for one in read]
    targets = tuple(dict.fromkeys(names))
    of_targets = [w[..., np.array([one == target for one in names]), :] for target in targets]
    there = ~np.isnan(w)
    square, numbers = np.nansum(w * w, axis=(-2, -1)), np.count_nonzero(there, axis=(-2, -1))
    readings = np.count_nonzero(there.any(axis=-1), axis=-1)
    enough = (readings >= LEAST) & (square > 0)

    lags, p_lags = autocorrelation([w], square, numbers, enough)
    target_lags, p_target_lags = autocorrelation(of_targets, square, numbers, enough)
    if len(targets) == 1:  # the same again is no other test
        p_target_lags = np.full_like(p_lags, np.nan)
    counted = np.stack([np.count_nonzero(~np.isnan(one), axis=-2) for one in of_targets], axis=-2)
    sums = np.stack([np.nansum(one, axis=-2) for one in of_targets], axis=-2)
    means = np.divide(sums, counted, out=np.full(sums.shape, np.nan), where=counted > 0)
    changes, p_runs = changes_of_sign(w, enough)
    return Whiteness(
        sensor, quantities, targets, readings, numbers, lags, target_lags, means,
        counted.max(axis=-1), changes, p_lags, p_target_lags,
        p_of_means(sums, counted, square, enough), p_runs,
    )  # fmt: skip


def autocorrelation(
    series: Sequence[Array], square: Array, numbers: Integers, enough: Booleans
) -> tuple[Array, Array]:
    """Of one or several series together at lags 1 to 5, and its p : (…, 5), (…)

    One number a run: the sum of squares, each in units of its own σ, is χ².
    """
    products, pairs = np.zeros((2, *np.shape(square), LAGS))
    readings = np.zeros(np.shape(square), np.int64)
    for one in map(closed_up, series):
        readings += np.count_nonzero(~np.isnan(one).all(axis=-1), axis=-1)
        for j in range(1, min(LAGS, one.shape[-2] - 1) + 1):
            product = one[..., j:, :] * one[..., :-j, :]
            products[..., j - 1] += np.nansum(product, axis=(-2, -1))
            pairs[..., j - 1] += np.count_nonzero(~np.isnan(product), axis=(-2, -1))
    asked = np.arange(1, LAGS + 1) * PART < readings[..., None]
    asked = asked & np.asarray(enough)[..., None] & (pairs > 0)
    total, freedom = np.asarray(square)[..., None], np.asarray(numbers * (numbers + 2.0))[..., None]
    r = np.divide(products, total, out=np.full(products.shape, np.nan), where=asked)
    z2 = np.divide(r * r * freedom, pairs, out=np.zeros(r.shape), where=asked)
    return r, beyond(np.count_nonzero(asked, axis=-1), z2.sum(axis=-1))


def closed_up(w: Array) -> Array:
    """The readings that are there one after another, before those that are not : (…, n, k)"""
    order = np.argsort(np.isnan(w).all(axis=-1), axis=-1, kind="stable")
    return np.take_along_axis(w, order[..., None], axis=-2)


def beyond(dof: Integers, value: Array) -> Array:
    """The chance of a larger value of χ² : (…), nan for no freedom"""
    return np.where(dof > 0, beyond_chi_square(np.maximum(dof, 1), value), np.nan)


def p_of_means(sums: Array, counted: Integers, square: Array, enough: Booleans) -> Array:
    """The p of all means together. sums, counted : (…, T, k) → (…)"""
    shares = np.divide(sums**2, counted, out=np.zeros(sums.shape), where=counted > 0)
    K = np.count_nonzero(counted, axis=(-2, -1))
    rest = counted.sum(axis=(-2, -1)) - K
    asked = enough & (K > 0) & (rest > 0)
    off = 1 - shares.sum(axis=(-2, -1)) / np.where(asked, square, 1.0)
    p = below_beta(np.maximum(rest, 1) / 2, np.maximum(K, 1) / 2, np.clip(off, 0.0, 1.0))
    return np.where(asked, p, np.nan)


def changes_of_sign(w: Array, enough: Booleans) -> tuple[Integers, Array]:
    """How often a number has another sign than that of the reading before, and its two-sided p.

    Around zero each change is a fair coin's toss; the usual runs test takes the number of either
    sign as given, and so takes the mean away.
    """
    w = closed_up(w)
    product = w[..., 1:, :] * w[..., :-1, :]
    tossed = np.count_nonzero(~np.isnan(product), axis=(-2, -1))
    changes = np.count_nonzero(product < 0, axis=(-2, -1))
    rare = np.minimum(changes, tossed - changes)
    p = np.minimum(2 * at_most_heads(np.maximum(rare, 0), np.maximum(tossed, 1)), 1.0)
    return changes, np.where(enough & (tossed > 0), p, np.nan)
