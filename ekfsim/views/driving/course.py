"""A run that is being driven: one command more, or one less, and what filters make of it."""

import itertools
from collections.abc import Sequence
from contextlib import nullcontext, redirect_stderr
from dataclasses import replace
from io import StringIO

import numpy as np

from ekfsim.commands import Command, Expanded, Move, Sense, expand, first
from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import StepError, UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.place import forward, is_smoothed, label
from ekfsim.filters.protocol import Filter
from ekfsim.filters.tuning import CROWDS
from ekfsim.localization import advance, belief_of, filter_of
from ekfsim.records import Entry, Step
from ekfsim.scene import Scene
from ekfsim.simulation import Draws
from ekfsim.simulation.classroom import obeyed
from ekfsim.views.playback.parting import Parting
from ekfsim.views.playback.playback import Unrolling, side_by_side
from ekfsim.views.playback.view import View

RECORDED = "it is a recorded log, and what happened in it stays as it is"
DRAWING = Move | Sense  # the commands that draw numbers


class Course:
    """The run of a scene as far as it was driven; what the scene commands is driven first. Where
    that is only a part of it, the rest waits to be done again.

    Draws belong to a command's number, so that a command more leaves all before it as it was: what
    is added is simulated and filtered alone, what is undone is cut off. A run that fails at a
    command has no view of it; until that is undone, nothing can be added.
    """

    def __init__(self, scene: Scene, length: int | None = None) -> None:
        """length : how many of the scene's commands are driven; None: all

        Raises UsageError where the robot of the scene obeys no commands.
        """
        refuse_what_is_not_driven(scene)
        self.scene = replace(scene, commands=(), expect=None, description="")
        self._given = scene.commands
        self._draws = Draws(scene.seed, np.asarray(scene.run, dtype=np.int64))
        self.commands: list[Expanded] = []
        self._undone: list[Expanded] = []  # the last of them first
        self._entries = list(obeyed(scene.world, self._draws, ()))
        self._watches = [Watch(one) for one in self.scene.alone()]
        self._drawn = 0
        self.failure: StepError | None = None
        self._saved: tuple[Expanded, ...] = ()
        self._alike = 0  # commands from the start on that are those saved
        self._unroll()
        self._go_on()
        if self.failure is not None:  # the filter cannot begin
            raise self.failure
        own = list(expand(scene.commands))
        self._obey(own[:length])
        if length is not None:
            self._undone += reversed(own[length:])
        self.mark_as_saved()

    def add(self, *commands: Expanded) -> None:
        """Obey them. What was undone can be done again no more."""
        self._undone.clear()
        self._obey(commands)

    def undo(self, count: int = 1) -> Sequence[Expanded]:
        """Take the last commands back: those, the first of them first; none at the start."""
        left = max(len(self.commands) - count, 0)
        taken = self.commands[left:]
        if taken:
            self._undone += reversed(taken)
            self._cut(left)
        return taken

    def redo(self, count: int = 1) -> Sequence[Expanded]:
        """Obey again what was last taken back: that; none where nothing was, or the run failed."""
        if self.failure is not None:
            return []
        again = self._undone[: -count - 1 : -1]
        del self._undone[len(self._undone) - len(again) :]
        self._obey(again)
        return again

    over = True  # all views there are have been made

    def __len__(self) -> int:
        """How many views there are."""
        return len(self._views)

    def view(self, number: int) -> View | None:
        """View `number`, or None where the run has not come so far."""
        return self._views[number] if number < len(self._views) else None

    @property
    def undone(self) -> int:
        """How many commands can be done again."""
        return len(self._undone)

    @property
    def last(self) -> View:
        """Where the run has come to."""
        return self._views[-1]

    @property
    def driven(self) -> tuple[Command, ...]:
        """All commands so far; of the scene's own, repetitions that are whole as they were."""
        kept = self._kept
        return *first(self._given, kept), *self.commands[kept:]

    @property
    def _kept(self) -> int:
        """How many commands from the start on are the scene's own."""
        pairs = zip(self.commands, expand(self._given), strict=False)
        return sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], pairs))

    @property
    def scene_so_far(self) -> Scene:
        """The scene of all commands so far, which a file may hold."""
        kept = self._kept
        whence = f" from step {kept} of {self.scene.commands_source} on" if kept else ""
        return replace(self.scene, commands=self.driven, description=f"Driven by hand{whence}.")

    @property
    def steps(self) -> list[list[Step]]:
        """Of each filter that watches."""
        return [watch.steps for watch in self._watches]

    @property
    def summaries(self) -> list[Summary]:
        """What is left of the run as it is now, by filter."""
        made = []
        for watch in self._watches:
            made.append(Summary.of(watch.scene))
            for step in watch.steps:
                made[-1].add(step)
        return made

    @property
    def unsaved(self) -> tuple[int, int]:
        """How many commands there are that were not saved, and how many that were saved and are
        gone.
        """
        return len(self.commands) - self._alike, len(self._saved) - self._alike

    def mark_as_saved(self) -> None:
        """As it is now it is known elsewhere."""
        self._saved = tuple(self.commands)
        self._compare()

    def _obey(self, commands: Sequence[Expanded]) -> None:
        assert self.failure is None
        self.commands += commands
        self._compare()
        last = self._entries[-1]
        self._entries += obeyed(self.scene.world, self._draws, commands, last, self._drawn)
        self._drawn += sum(isinstance(one, DRAWING) for one in commands)
        self._go_on()

    def _cut(self, left: int) -> None:
        self._drawn -= sum(isinstance(one, DRAWING) for one in self.commands[left:])
        del self.commands[left:], self._entries[left + 1 :]
        self._compare()
        for watch in self._watches:
            watch.cut(left + 1)
        self.failure = None
        self._unroll()
        self._go_on()

    def _go_on(self) -> None:
        """Filter what is new, and make views of it, as far as no filter fails."""
        try:
            for watch in self._watches:
                watch.go_on(self._entries, self.commands)
        except StepError as failure:
            self.failure = failure
        while self._shown < min(len(watch.steps) for watch in self._watches):
            self._show([watch.steps[self._shown] for watch in self._watches])
            self._shown += 1

    def _compare(self) -> None:
        """Count the commands from the start on that are those saved."""
        self._alike = min(self._alike, len(self.commands))
        while self._alike < min(len(self.commands), len(self._saved)) and (
            self.commands[self._alike] == self._saved[self._alike]
        ):
            self._alike += 1

    def _unroll(self) -> None:
        """Begin with the views anew: the ways that they share only ever grow."""
        names = self.scene.filter, *self.scene.beside
        self._views: list[View] = []
        self._shown = 0  # steps of which there are views
        self._unrolled = [Unrolling() for _ in names]
        self._partings = [Parting(names[0], name) for name in names[1:]]

    def _show(self, steps: Sequence[Step]) -> None:
        step, *others = steps
        for parting, other in zip(self._partings, others, strict=True):
            parting.take(step)
            parting.hold(other)
        made = (one.take([step]) for one, step in zip(self._unrolled, steps, strict=True))
        for view, *same in zip(*made, strict=True):
            self._views.append(side_by_side(view, same, self._partings) if same else view)


class Watch:
    """A filter that watches a course, and its steps so far."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.steps: list[Step] = []
        self._filter: Filter | None = None
        self._again = False  # whether it is told what it was told before
        # whether what it makes of an entry depends on more than the belief before it
        self._remembers = scene.filter in CROWDS or scene.filter not in FILTERS

    def go_on(self, entries: Sequence[Entry], commands: Sequence[Expanded]) -> None:
        """What it makes of the entries that it does not know yet. Raises StepError."""
        with redirect_stderr(StringIO()) if self._again else nullcontext():
            if self._filter is None or not self._remembers:  # it may know the plan, which grew
                self._filter = filter_of(replace(self.scene, commands=tuple(commands)))
            belief = self.steps[-1].posterior if self.steps else belief_of(self.scene)
            for entry in entries[len(self.steps) :]:
                step = advance(
                    self._filter, belief, entry, self.scene.guard, self.scene.world.layout
                )
                self.steps.append(step)
                belief = step.posterior
        self._again = False

    def cut(self, left: int) -> None:
        """Forget all steps but so many. A filter that remembers begins anew."""
        self._again = self._remembers
        del self.steps[0 if self._remembers else left :]
        self._filter = None


def refuse_what_is_not_driven(scene: Scene) -> None:
    """Raise UsageError where the robot of a scene obeys no commands, or a filter waits for the end
    of its run.
    """
    for name in (scene.filter, *scene.beside):
        if is_smoothed(name):
            wrong = f"{label(name)} knows what it believes when the run is over"
            right = f"play what you have driven with --filter {label(forward(name))} --smooth"
            raise UsageError(f"{scene.commands_source}: cannot be driven: {wrong}; {right}")
    if scene.log is not None:
        raise refusal(scene.commands_source, RECORDED)
    if not scene.commanded:
        wrong = f"the robot of the system {scene.world.system} follows its way and no commands"
        raise refusal(scene.commands_source, wrong)


def refusal(source: str, wrong: str) -> UsageError:
    """Why what was named cannot be driven, and what can."""
    return UsageError(f"{source}: cannot be driven: {wrong}; drive a world of the classroom")
