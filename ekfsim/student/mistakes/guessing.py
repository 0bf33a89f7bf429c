"""Which mistakes a student's numbers are those of."""

from collections.abc import Callable, Iterator
from itertools import combinations, product

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.records import Reading
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.working import FORMS, Pieces, Working

SAME = 1e-9  # σ; numbers that are nearer than this are the same
LAST_DIGITS = 16 * float(np.finfo(float).eps)  # of a number: what the order of its terms changes

Guess = tuple[Mistake, ...]
# whether a step with some changes leads to a student's numbers; its last argument is `unit`
Gives = Callable[[Asked, tuple[Pieces, ...], Answer, Array], bool]


def gives(asked: Asked, changes: tuple[Pieces, ...], theirs: Answer, unit: Array) -> bool:
    """Whether these changes lead to the student's numbers, eq. 12 being written as one likes."""
    with np.errstate(all="ignore"):
        step = Working(asked, *changes)
        if not _same_mean(asked, step.result.mean, theirs.x, unit):
            return False
        if _same_covariance(step.result.covariance, theirs.P, unit):
            return True
        return isinstance(asked.given, Reading) and any(
            _same_covariance(Working(asked, form, *changes).covariance, theirs.P, unit)
            for form in FORMS
        )


def guesses(asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> list[Guess]:
    """The mistakes that reproduce a student's numbers, the most common first; only where no single
    one does, the pairs that do.

    unit : (n,) σ of each entry of the state, at least 1e-6 m or rad
    """
    here = [mistake for mistake in KNOWN if mistake.where(asked)]
    alone = [(mistake,) for mistake in here if fits((mistake,), asked, theirs, unit, gives)]
    if alone:
        return list(alone)
    return [pair for pair in combinations(here, 2) if fits(pair, asked, theirs, unit, gives)]


def fits(mistakes: Guess, asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> bool:
    """Whether a step with these mistakes, all together, has the student's numbers."""
    return all(mistake.where(asked) for mistake in mistakes) and any(
        gives(asked, changes, theirs, unit)
        for ways in product(*(mistake.ways for mistake in mistakes))
        for changes in (_orders(ways))
    )


def _orders(ways: tuple[Pieces, ...]) -> Iterator[tuple[Pieces, ...]]:
    """Changes one upon the other; the other way round as well, where both change one symbol."""
    yield ways
    if len(ways) > 1 and any(symbol in ways[1] for symbol in ways[0]):
        yield ways[::-1]


def _same_mean(asked: Asked, ours: Array, theirs: Array, unit: Array) -> bool:
    apart = theirs - ours
    for i in asked.headings:
        apart[i] = wrap(apart[i])
    return bool(np.all(np.abs(apart) <= SAME * unit + LAST_DIGITS * np.abs(theirs)))


def _same_covariance(ours: Array, theirs: Array, unit: Array) -> bool:
    """As it is, or made symmetric afterwards."""
    unit = np.maximum(unit, np.sqrt(np.abs(np.diag(theirs))))
    allowed = SAME * np.outer(unit, unit)
    return bool(
        np.all(np.abs(theirs - ours) <= allowed)
        or np.all(np.abs(theirs - symmetric(ours)) <= allowed)
    )
