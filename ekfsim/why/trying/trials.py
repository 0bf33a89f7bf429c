"""One run, played again with one change after another, within a budget."""

from collections.abc import Iterable, Sequence

from ekfsim.geometry import Integers
from ekfsim.localization import belief_of, filter_of, localize
from ekfsim.records import Entry, Step
from ekfsim.scene import Scene
from ekfsim.study.block import watched_along
from ekfsim.why.changes.groups import Group, instants
from ekfsim.why.changes.groups import abreast as groups_abreast
from ekfsim.why.changes.singles import abreast, numbers
from ekfsim.why.records import REPLAYS, Change, Heard, Outcome, Tried
from ekfsim.why.trying.crowd import outcomes
from ekfsim.why.trying.minimal import SpentError
from ekfsim.why.trying.replaying import cured, ending, replayed


class Trials:
    """What came of each change of one run."""

    def __init__(
        self, scene: Scene, steps: Sequence[Step], budget: int, heard: Heard | None
    ) -> None:
        self.scene, self.steps, self.budget, self._heard = scene, steps, budget, heard
        self.was = ending(steps)
        self.replays = 0
        self.tried: list[Tried] = []

    @staticmethod
    def first(scene: Scene) -> Iterable[Step]:
        """The run as it stands."""
        return replayed(scene, ())

    def again(self, changes: Sequence[Change]) -> Iterable[Step]:
        """The run with changes that are known to cure: no trial."""
        return replayed(self.scene, changes)

    def alone(self, change: Change) -> bool:
        """Whether a change alone cures. Raises SpentError where that is not to be known."""
        for one in self.tried:
            if one.change == change:
                return one.cures
        now = ending(self.played((change,)))
        found = Tried(
            change, cured(self.was.outcome, now.outcome), now.nees, now.lost_from, now.outcome
        )
        self.tried.append(found)
        return found.cures

    def together(self, changes: Sequence[Change]) -> bool:
        """Whether several changes cure."""
        return cured(self.was.outcome, self.ends(changes))

    def ends(self, changes: Sequence[Change]) -> Outcome:
        """How the run ends with several changes."""
        if len(changes) == 1:
            self.alone(changes[0])
            return next(one.outcome for one in self.tried if one.change == changes[0])
        return ending(self.played(changes)).outcome

    def played(self, changes: Sequence[Change]) -> tuple[Step, ...]:
        """The run with changes."""
        self._count(1)
        return tuple(replayed(self.scene, changes))

    def each(self, changes: Sequence[Change]) -> None:
        """Try single readings and moves side by side: as many as the budget allows, from the step
        since which the run is lost backwards.
        """
        last = self.was.lost_from
        some = [one for one in changes if last is None or (one.step or 0) <= last]
        some = some[::-1][: max(self.budget - self.replays, 0)]
        if not some:
            return
        self._count(len(some))
        entries = abreast([step.entry for step in self.steps], some)
        self._side_by_side(some, entries, None)

    def groups(self, groups: Sequence[Group]) -> None:
        """Try groups of readings and of moves side by side: as many as the budget allows."""
        some = groups[: max(self.budget - self.replays, 0)]
        if some:
            self._count(len(some))
            entries = groups_abreast([step.entry for step in self.steps], some)
            self._side_by_side([one.change for one in some], entries, instants(self.steps))

    def _side_by_side(
        self, some: Sequence[Change], entries: Iterable[Entry], at: Integers | None
    ) -> None:
        """at : (k,) the entry of each instant, where one may have several"""
        scene, runs = self.scene, numbers(self.scene, len(some))
        steps = localize(
            entries, filter_of(scene, runs), belief_of(scene, runs), scene.guard,
            scene.world.layout,
        )  # fmt: skip
        watched = watched_along(scene, runs, steps)
        found = outcomes(watched)
        for row, change in reversed(list(enumerate(some))):
            outcome: Outcome = next(word for word in found if found[word][row])
            since = int(watched.lost_from[row])
            since = since if at is None or since < 0 else int(at[since])
            self.tried.append(
                Tried(
                    change, cured(self.was.outcome, outcome), float(watched.ends.nees.value[row]),
                    since if since >= 0 else None, outcome,
                )
            )  # fmt: skip

    def _count(self, replays: int) -> None:
        if self.replays + replays > self.budget:
            raise SpentError
        self.replays += replays
        if self._heard is not None:
            self._heard(self.replays, self.budget, REPLAYS)
