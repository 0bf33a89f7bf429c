"""What every submission is held against: the runs, the same for all, and the reference.

They are made once in a process and kept, as far as they fit: no result depends on which submission
came first.
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ekfsim.files.homework import Homework
from ekfsim.filters.protocol import Filter
from ekfsim.localization import entries_of, filter_of, first_belief
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Entry
from ekfsim.scene import Scene
from ekfsim.student.asked import Answer
from ekfsim.student.comparing.compare import Compared, compare
from ekfsim.student.comparing.difference import DIFFERENT, sizes
from ekfsim.student.comparing.reference import Around

MOST_KEPT = 100_000  # entries


class Reached(NamedTuple):
    """How many steps a run has in which a filter has something to do."""

    moves: int
    readings: int


@dataclass
class Bench:
    """The scenes of a homework, played."""

    homework: Homework
    _entries: dict[tuple[str, int], tuple[Entry, ...]] = field(default_factory=dict)
    _reached: dict[tuple[str, int, str], Reached] = field(default_factory=dict)

    def scene(self, name: str, run: int = 0, filter: str = "ekf") -> Scene:
        """A scene of the homework, its run, and who watches it. Readings are judged by nobody: a
        student's filter has no gate.
        """
        return replace(self.homework.scenes[name], run=run, filter=filter, gate=None)

    def entries(self, name: str, run: int) -> tuple[Entry, ...]:
        """What happens in a run, as a filter of this system is given it."""
        if (name, run) not in self._entries:
            if sum(map(len, self._entries.values())) > MOST_KEPT:
                self._entries.clear()
            self._entries[name, run] = tuple(entries_of(self.scene(name, run)))
        return self._entries[name, run]

    def runs(self, name: str, asked_for: int) -> range:
        """The runs of a scene; of a log there is one."""
        return range(1 if self.homework.scenes[name].log is not None else asked_for)

    def reference(self, name: str, run: int, filter: str) -> Filter:
        """The reference at the beginning of a run."""
        return filter_of(self.scene(name, run, filter))

    def by_itself(self, name: str, run: int, filter: str) -> list[Compared]:
        """The reference in the place of a student's filter: every step in which that is asked."""
        reference, scene = self.reference(name, run, filter), self.scene(name, run)
        entries, layout = self.entries(name, run), scene.world.layout
        first, caller = first_belief(scene), Around(reference)
        return list(compare(entries, first, caller, reference, layout, scene.guard))

    def reached(self, name: str, run: int, filter: str) -> Reached:
        """In how many steps of a run the reference changes its belief."""
        key = name, run, filter
        if key not in self._reached:
            layout = self.scene(name).world.layout
            steps = self.by_itself(*key)
            given = [step.asked.given for step in steps if tells(step, layout)]
            moves = sum(isinstance(one, Control) for one in given)
            self._reached[key] = Reached(moves, len(given) - moves)
        return self._reached[key]


def tells(step: Compared, layout: Layout) -> bool:
    """Whether a step tells right from wrong: there is something to do, or something else was done.
    Where P is 0 no reading is worth anything, and who does nothing is right by chance.
    """
    before = Answer(step.asked.x.copy(), step.asked.P)
    changes = (float(size.max()) > DIFFERENT for size in sizes(before, step.right, layout))
    return bool(step.differences) or any(changes)
