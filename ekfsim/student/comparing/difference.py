"""Two answers to one question: which entries of x and P differ, and by how much."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.student.asked import Answer
from ekfsim.student.comparing.rounding import LEAST, Rounding, deviations

DIFFERENT = 1e-6  # σ; what is less is no difference
SURELY = 1000  # σ; how many more it is matters to nobody
SIGNS = {"theta": "θ", "phi": "φ"}


@dataclass(frozen=True, slots=True)
class Difference:
    """One entry that is not as it should be."""

    entry: str  # "x", "θ", "P_xθ"
    theirs: float
    right: float
    size: float  # in σ of the entry, or in σᵢ σⱼ


def unit(right: Gaussian) -> Array:
    """σ, of at least 1e-6, in which differences are counted : (n,)"""
    return np.maximum(deviations(right.covariance), LEAST)


def sizes(theirs: Answer, right: Gaussian, layout: Layout) -> tuple[Array, Array]:
    """How far an answer is from the right one, in σ : (n,), (n, n)"""
    σ, apart = unit(right), theirs.x - right.mean
    for i in layout.headings:
        apart[i] = wrap(apart[i])
    return np.abs(apart) / σ, np.abs(theirs.P - right.covariance) / np.outer(σ, σ)


def in_sigmas(size: float) -> str:
    """A size in a sentence."""
    return f"{size:.3g} σ" if size <= SURELY else f"more than {SURELY} σ"


def differences(
    theirs: Answer, right: Gaussian, rounding: Rounding, layout: Layout
) -> tuple[Difference, ...]:
    """The entries that differ by more than 1e-6 σ, and by more than rounding; x first, and of a
    symmetric P the upper half.
    """
    σ = unit(right)
    in_x, in_P = sizes(theirs, right, layout)
    x = (in_x > DIFFERENT) & (in_x > rounding.x / σ)
    P = (in_P > DIFFERENT) & (in_P > rounding.P / np.outer(σ, σ))
    lopsided = np.abs(theirs.P - theirs.P.T) > DIFFERENT * np.outer(σ, σ)
    found = [
        Difference(name, float(theirs.x[i]), float(right.mean[i]), float(in_x[i]))
        for i, name in enumerate(symbols(layout)) if x[i]
    ]  # fmt: skip
    found += [
        Difference(name, float(theirs.P[ij]), float(right.covariance[ij]), float(in_P[ij]))
        for ij, name in _pairs(layout)
        if P[ij] and (ij[0] <= ij[1] or lopsided[ij])
    ]
    return tuple(found)


def symbols(layout: Layout) -> tuple[str, ...]:
    """The entries of a state, as equations have them."""
    return tuple(SIGNS.get(name, name) for name in layout.names)


def _pairs(layout: Layout) -> Iterator[tuple[tuple[int, int], str]]:
    """The entries of P row by row, each with its name: P_xθ."""
    names = symbols(layout)
    between = "" if max(map(len, names)) == 1 else ","
    for i, row in enumerate(names):
        for j, column in enumerate(names):
            yield (i, j), f"P_{row}{between}{column}"
