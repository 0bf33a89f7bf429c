"""Which mistakes a student's numbers are those of."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import combinations, product

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.working import FORMS, Pieces, Working, right, usable

SAME = 1e-9  # σ; numbers that are nearer than this are the same
LAST_DIGITS = 16 * float(np.finfo(float).eps)  # of a number: what the order of its terms changes
USUAL = {Control: 3, Reading: 2}  # ways of a mistake that are tried together with another
FEW = 3  # ways that are found of the numbers themselves; of more, none is tried with another

Guess = tuple[Mistake, ...]
# whether a step with some changes leads to a student's numbers; its last argument is `unit`
Gives = Callable[[Asked, tuple[Pieces, ...], Answer, Array], bool]


def gives(asked: Asked, changes: tuple[Pieces, ...], theirs: Answer, unit: Array) -> bool:
    """Whether these changes lead to the student's numbers, eq. 12 being written as one likes."""
    with np.errstate(all="ignore"):
        step = Working(asked, *changes)
        if not _same_mean(asked, step.mean, theirs.x, unit):
            return False
        if _same_covariance(step.covariance, theirs.P, unit):
            return True
        return isinstance(asked.given, Reading) and any(
            _same_covariance(Working(asked, form, *changes).covariance, theirs.P, unit)
            for form in FORMS
        )


def guesses(asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> list[Guess]:
    """The mistakes that reproduce a student's numbers, the most common first; only where no single
    one does, or none but a general one, the pairs that do.

    unit : (n,) σ of each entry of the state, at least 1e-6 m or rad
    """
    found = alone(asked, theirs, unit, gives)
    return found if special(found) else pairs(asked, theirs, unit, gives) + found


def kept(asked: Asked, theirs: Answer) -> bool:
    """Whether a reading has left the belief as it was, to the last bit."""
    return (
        isinstance(asked.given, Reading)
        and np.array_equal(theirs.x, asked.x)
        and np.array_equal(theirs.P, asked.P)
    )


def alone(asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> list[Guess]:
    """Each mistake that reproduces the numbers by itself."""
    return [(one,) for one in KNOWN if fits((one,), asked, theirs, unit, gives)]


def special(found: list[Guess]) -> bool:
    """Whether one is among them that does not fit itself to the numbers."""
    return any(not mistake.general for guess in found for mistake in guess)


def fits(mistakes: Guess, asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> bool:
    """Whether a step with these mistakes, all together, has the student's numbers."""
    return (
        all(mistake.where(asked) for mistake in mistakes)
        and usable(asked)
        and _made(
            [(*mistake.ways, *mistake.fitted(asked, theirs)) for mistake in mistakes],
            asked, theirs, unit, gives,
        )
    )  # fmt: skip


def pairs(asked: Asked, theirs: Answer, unit: Array, gives: Gives = gives) -> list[Guess]:
    """The pairs of mistakes that show in this step, each made in one of its most usual ways; where
    there is none, a mistake together with one that fits itself to the numbers, and not by itself.
    """
    if not usable(asked):
        return []
    same = Answer(*right(asked))
    most = USUAL[type(asked.given)]
    showing = {
        mistake: [way for way in mistake.ways[:most] if not _shows_nothing(asked, way, same, unit)]
        for mistake in KNOWN
        if mistake.where(asked) and not mistake.general
    }
    fitted = {
        mistake: list(mistake.fitted(asked, theirs))
        for mistake in KNOWN
        if mistake.where(asked) and mistake.general
    }
    ways = showing | fitted

    def made(pairs: Iterable[Guess]) -> list[Guess]:
        return [
            pair
            for pair in pairs
            if _made([ways[mistake] for mistake in pair], asked, theirs, unit, gives)
        ]

    found = made(combinations(showing, 2))
    if found or any(fits((mistake,), asked, theirs, unit, gives) for mistake in fitted):
        return found
    return made(product(showing, (mistake for mistake in fitted if len(fitted[mistake]) <= FEW)))


def _shows_nothing(asked: Asked, way: Pieces, same: Answer, unit: Array) -> bool:
    return gives(asked, (way,), same, unit)


def _made(
    mistakes: Sequence[Sequence[Pieces]], asked: Asked, theirs: Answer, unit: Array, gives: Gives
) -> bool:
    """Whether some way of making each of these mistakes leads to the numbers."""
    return any(
        gives(asked, changes, theirs, unit)
        for ways in product(*mistakes)
        for changes in _orders(ways)
    )


def _orders(ways: tuple[Pieces, ...]) -> Iterator[tuple[Pieces, ...]]:
    """Changes one upon the other; the other way round as well, where both change one symbol."""
    yield ways
    if len(ways) > 1 and not ways[0].keys().isdisjoint(ways[1]):
        yield ways[::-1]


def _same_mean(asked: Asked, ours: Array, theirs: Array, unit: Array) -> bool:
    """Headings may be unwrapped. Number by number: most are told by the first of them."""
    for i, (x, other, σ) in enumerate(
        zip(theirs.tolist(), ours.tolist(), unit.tolist(), strict=True)
    ):
        near = SAME * σ + LAST_DIGITS * abs(x)
        apart = x - other
        if i in asked.headings and not abs(apart) <= near:
            apart = float(wrap(np.array(apart)))
        if not abs(apart) <= near:  # nan is not near
            return False
    return True


def _same_covariance(ours: Array, theirs: Array, unit: Array) -> bool:
    """As it is, or made symmetric afterwards."""
    unit = np.maximum(unit, np.sqrt(np.abs(np.diag(theirs))))
    allowed = SAME * np.outer(unit, unit)
    return any(bool(np.all(np.abs(theirs - P) <= allowed)) for P in (ours, symmetric(ours)))
