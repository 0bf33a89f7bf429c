"""By which known mistakes a student's numbers are explained, over many steps."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from ekfsim.student.comparing.compare import Compared
from ekfsim.student.comparing.difference import unit
from ekfsim.student.mistakes.guessing import (
    Gives,
    Guess,
    alone,
    fits,
    gives,
    kept,
    pairs,
    special,
)
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.beliefs import BELIEF_KEPT, OWN_FIRST_P, OWN_FIRST_X

# a search goes through the whole table; what it has found is looked for at every other step, too
SEARCHED = 6  # differing steps at which all single mistakes are looked for, whatever is known
IN_VAIN = 20  # searches without a find, after which no more are made
IN_PAIRS = 3  # searches among all pairs, which take seconds: no more after one in vain
WITNESSES = 24  # steps without a difference, at which a mistake that is there must not show
FITTED = 0.5  # what a step counts for a mistake that fits itself to its numbers
CLEAN = 1e-10  # σ; a witness is nearer to the reference than this


@dataclass(frozen=True, slots=True)
class At:
    """A step of a run."""

    run: int
    step: Compared


@dataclass(frozen=True, slots=True)
class Seen:
    """Steps that are alike in what explains them."""

    steps: int
    first: At


@dataclass
class Naming:
    """The steps of one kind, moves or readings, as they come; and what explains those that differ.

    One step seldom tells two mistakes apart. Of those that explain a step that one is believed
    which explains the most steps, and which would show at none that is right.
    """

    gives: Gives = gives  # what is taken for the same number
    clean: float = CLEAN
    _alike: dict[frozenset[Guess], Seen] = field(default_factory=dict)
    _candidates: dict[Guess, None] = field(default_factory=dict)  # in the order of their finds
    _witnesses: list[Compared] = field(default_factory=list)
    _searches: Counter[str] = field(default_factory=Counter)

    def add(self, at: At) -> None:
        """One more step of this kind."""
        if at.step.differences:
            explained = frozenset(self._explaining(at.step))
            before = self._alike.get(explained)
            self._alike[explained] = Seen(1, at) if before is None else Seen(
                before.steps + 1, before.first
            )  # fmt: skip
        elif len(self._witnesses) < WITNESSES and at.step.size < self.clean:
            self._witnesses.append(at.step)

    def explanations(self, at: At) -> list[Guess]:
        """What is believed of one differing step: the best, and those that are as good."""
        alike = next(
            (guesses for guesses, seen in self._alike.items() if seen.first is at), frozenset()
        )
        return self._best(alike, at.step)

    def named(self) -> dict[Mistake, Seen]:
        """Each mistake that is believed, with the steps at which it shows."""
        found: dict[Mistake, Seen] = {}
        for alike, seen in self._alike.items():
            for mistake in next(iter(self._best(alike, seen.first.step)), ()):
                before = found.get(mistake)
                found[mistake] = seen if before is None else Seen(
                    before.steps + seen.steps, before.first
                )  # fmt: skip
        return found

    def unnamed(self) -> Seen | None:
        """The steps that nothing explains."""
        return self._alike.get(frozenset())

    def _explaining(self, step: Compared) -> list[Guess]:
        """The candidates that explain a step; the whole table is searched for more while few steps
        were, and where none does.
        """
        if step.asked.index == 0:
            return [_begun(step)]
        if textbook(step, self.gives):
            return []
        σ = unit(step.right)
        found = [
            one for one in self._candidates if fits(one, step.asked, step.theirs, σ, self.gives)
        ]
        searches = self._searches
        if searches["all"] < SEARCHED or (not found and searches["in vain"] < IN_VAIN):
            searches["all"] += 1
            more = self._searched(step)
            searches["in vain"] += not more
            found += [one for one in more if one not in found]
            self._candidates.update(dict.fromkeys(found))
        return found

    def _searched(self, step: Compared) -> list[Guess]:
        σ = unit(step.right)
        found = alone(step.asked, step.theirs, σ, self.gives)
        if special(found) or self._searches["pairs"] >= IN_PAIRS:
            return found
        together = pairs(step.asked, step.theirs, σ, self.gives)
        self._searches["pairs"] += 1 if together else IN_PAIRS
        return together + found

    def _best(self, alike: Iterable[Guess], step: Compared) -> list[Guess]:
        """The guesses that are believed most, in the order of the table. Where nothing has changed
        to the last bit nothing was calculated, whatever else would give the same numbers there.
        """
        worth = {guess: self._worth(guess) for guess in self._plain(alike)}
        best = [guess for guess in worth if worth[guess] == max(worth.values())]
        if (BELIEF_KEPT,) in best and kept(step.asked, step.theirs):
            return [(BELIEF_KEPT,)]
        order = {mistake: place for place, mistake in enumerate(KNOWN)}
        return sorted(best, key=lambda guess: [order[mistake] for mistake in guess])

    def _plain(self, alike: Iterable[Guess]) -> list[Guess]:
        """Without what fits itself to the numbers of no more steps than a plain mistake explains;
        that may be chance where it is a single one.
        """
        steps = {guess: min(map(self._support, guess)) for guess in alike}
        most = max((n for guess, n in steps.items() if special([guess])), default=0)
        return [guess for guess, n in steps.items() if special([guess]) or n > most or most == 1]

    def _worth(self, guess: Guess) -> tuple[bool, float]:
        """Whether nothing speaks against a guess, and how many steps speak for it; for one that
        fits itself to each of them, half as many.
        """
        silent = all(
            fits((mistake,), one.asked, one.theirs, unit(one.right), self.gives)
            for mistake in guess
            for one in self._witnesses
            if mistake.where(one.asked)
        )
        return silent, min(
            self._support(mistake) * (FITTED if mistake.general else 1) for mistake in guess
        )

    def _support(self, mistake: Mistake) -> int:
        return sum(
            seen.steps
            for alike, seen in self._alike.items()
            if any(mistake in guess for guess in alike)
        )


def _begun(step: Compared) -> Guess:
    """What is wrong with the belief that a run begins with: x, P, or both."""
    in_P = {one.entry.startswith("P_") for one in step.differences}
    return tuple(
        mistake for mistake, of_P in ((OWN_FIRST_X, False), (OWN_FIRST_P, True)) if of_P in in_P
    )


def textbook(step: Compared, gives: Gives = gives) -> bool:
    """Whether a student's numbers are an EKF's of the models as they are handed out."""
    return step.asked.index > 0 and fits((), step.asked, step.theirs, unit(step.right), gives)
