"""A run under the reference, each step from the belief that a file of results has before it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric, wrapped
from ekfsim.filters.belief import Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Control, Entry
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.comparing.compare import Compared, believed
from ekfsim.student.comparing.difference import differences, sizes, symbols, unit
from ekfsim.student.comparing.reference import made_by
from ekfsim.student.comparing.rounding import LEAST, Rounding, deviations, rounding
from ekfsim.student.fault import FaultError
from ekfsim.student.mistakes.guessing import LAST_DIGITS, SAME
from ekfsim.student.mistakes.mistake import outcome
from ekfsim.student.mistakes.working import FORMS, Pieces, Working
from ekfsim.student.printed.digits import SLACK, Halves, carried, exact
from ekfsim.student.printed.results import Results, steps_named
from ekfsim.student.printed.table import Row

COARSE = 0.1  # σ; an entry that is open by more cannot be judged
BENT = 5  # per σ that is left open; so much more, as what a reading carries is no straight line
FAR = 100  # times what the reference leaves open: mistakes farther off are no candidates


@dataclass(frozen=True, slots=True)
class Open:
    """What the digits of one step leave open."""

    before: Halves  # of the belief that it begins with
    after: Halves  # of its result
    carried: Halves  # what those before make of the reference's result

    @property
    def x(self) -> Array:
        """Of the mean, at worst : (n,)"""
        return self.after.x + self.carried.x

    @property
    def P(self) -> Array:
        """Of the covariance, at worst : (n, n)"""
        return self.after.P + self.carried.P


@dataclass
class PrintedSteps:
    """The steps of one run that a file of results has, compared as they are asked for."""

    results: Results
    reference: Filter
    layout: Layout = POSE
    open: dict[int, Open] = field(default_factory=dict)  # of each step that was compared
    _spreads: dict[int, tuple[Open, Array]] = field(default_factory=dict)  # and its σ

    def compared(self, entries: Iterable[Entry], first: Gaussian) -> Iterator[Compared]:
        """Each step whose belief before and after are known; before them the start, where it
        differs. A step without a row is left out, and so is the one after it.
        """
        belief: Gaussian | None = first
        halves = exact(len(first.mean))
        started, earlier = False, None
        for entry in entries:
            if entry.given is None:
                continue
            row = self.results.rows.get(entry.index)
            if not started and (begun := self.results.rows.get(0)) is not None:
                asked = Asked(*first, entry.given, self.layout.headings)
                start = self._compared(asked, begun, first, None, halves)
                if start.differences:
                    yield start
                    belief, halves = _belief(begun, self.layout), begun.halves
            started = True
            kept = False  # whether the belief stays as it is
            if belief is not None:
                asked = Asked.at(entry, belief, self.layout.headings, earlier)
                right, made = made_by(self.reference, asked)
                kept = isinstance(made, Correction) and not made.used
                if row is not None:
                    yield self._compared(asked, row, right, None if kept else made, halves)
                earlier = asked.as_earlier()
            if row is not None:
                belief, halves = _belief(row, self.layout), row.halves
            elif not kept:
                belief = earlier = None

    def gives(self, asked: Asked, changes: tuple[Pieces, ...], theirs: Answer, unit: Array) -> bool:
        """Whether a step with these changes has the printed numbers, as far as they go."""
        left = self.open[asked.index]
        with np.errstate(all="ignore"):
            if not self._near_mean(Working(asked, *changes).mean, theirs, unit, FAR * left.x):
                return False
        forms: tuple[tuple[Pieces, ...], ...] = ((),)
        if not isinstance(asked.given, Control):
            forms = ((), *((form,) for form in FORMS))
        return any(self._given_by((*form, *changes), asked, theirs, unit, left) for form in forms)

    def unjudged(self) -> list[str]:
        """Where the digits do not suffice, a sentence for each kind of number."""
        found = dict[str, list[int]]()
        names = symbols(self.layout)
        for index, (left, σ) in self._spreads.items():
            judged = σ > LEAST
            for i, name in enumerate(names):
                if judged[i] and left.x[i] > COARSE * σ[i]:
                    found.setdefault(name, []).append(index)
                for j in range(i, len(names)):
                    if judged[i] and judged[j] and left.P[i, j] > COARSE * σ[i] * σ[j]:
                        found.setdefault(f"P_{name}{names[j]}", []).append(index)
        return [
            f"{name} of {steps_named(indices)} cannot be judged: the printed digits leave more "
            f"than {COARSE:g} σ open; print more of them"
            for name, indices in found.items()
        ]

    def _compared(
        self, asked: Asked, row: Row, right: Gaussian, made: Prediction | Correction | None,
        halves: Halves,
    ) -> Compared:  # fmt: skip
        """What a row says beside the reference. Raises FaultError where it says no number."""
        self._refuse_nan(asked, row)
        theirs = Answer(row.x, row.P)

        def step(belief: Gaussian) -> Gaussian:
            if asked.index == 0:  # the start, which is given
                return right
            return made_by(self.reference, replace(asked, x=belief.mean, P=belief.covariance))[0]

        moved = carried(step, Gaussian(asked.x, asked.P), halves, self.layout.headings)
        left = self.open[asked.index] = Open(halves, row.halves, moved)
        self._spreads[asked.index] = left, unit(right)
        in_x, in_P = sizes(theirs, right, self.layout)
        rounded = Rounding(0.0, 0.0) if made is None else rounding(asked, made, right.covariance)
        σ, bent = unit(right), BENT * isinstance(made, Correction)
        much_x, much_P = left.x / σ, left.P / np.outer(σ, σ)
        allowed = Rounding(
            rounded.x + left.x * (SLACK + bent * much_x),
            rounded.P + left.P * (SLACK + bent * much_P),
        )
        with np.errstate(over="ignore"):  # numbers may be absurd
            apart = differences(theirs, right, allowed, self.layout)
        return Compared(asked, theirs, right, float(max(in_x.max(), in_P.max())), apart)

    def _refuse_nan(self, asked: Asked, row: Row) -> None:
        names = symbols(self.layout)
        known = [*zip(names, row.x.tolist(), strict=True)]
        known += [
            (f"P_{a}{b}", value)
            for a, values in zip(names, row.P.tolist(), strict=True)
            for b, value in zip(names, values, strict=True)
        ]
        for name, value in known:
            if not np.isfinite(value):
                place = f"{self.results.file}:{row.line}"
                raise FaultError(place, f"{name} is no number", asked.step)

    def _given_by(
        self, changes: tuple[Pieces, ...], asked: Asked, theirs: Answer, unit: Array, left: Open
    ) -> bool:
        def step(belief: Gaussian) -> Gaussian | None:
            return outcome(replace(asked, x=belief.mean, P=belief.covariance), *changes)

        belief = Gaussian(asked.x, asked.P)
        base = step(belief)
        if base is None or not self._near(base, theirs, unit, FAR * left.x, FAR * left.P):
            return False
        own = carried(step, belief, left.before, self.layout.headings)
        return self._near(base, theirs, unit, own.x + left.after.x, own.P + left.after.P)

    def _near(
        self, ours: Gaussian, theirs: Answer, unit: Array, open_x: Array, open_P: Array
    ) -> bool:
        if not self._near_mean(ours.mean, theirs, unit, open_x):
            return False
        σ = np.maximum(unit, deviations(theirs.P))
        allowed = SLACK * open_P + SAME * np.outer(σ, σ)
        P = ours.covariance
        return any(np.all(np.abs(theirs.P - form) <= allowed) for form in (P, symmetric(P)))

    def _near_mean(self, ours: Array, theirs: Answer, unit: Array, open_x: Array) -> bool:
        apart = theirs.x - ours
        for i in self.layout.headings:
            apart[i] = wrap(apart[i])
        allowed = SLACK * open_x + SAME * unit + LAST_DIGITS * np.abs(theirs.x)
        return bool(np.all(np.abs(apart) <= allowed))


def _belief(row: Row, layout: Layout) -> Gaussian:
    """The belief that goes on from a row."""
    return believed(Answer(wrapped(row.x.copy(), layout.headings), row.P), layout)
