"""A run that is driven with keys: what it has come to can be looked back at as in `play`."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ekfsim.commands import Expanded, Move, Sense
from ekfsim.errors import EkfsimError
from ekfsim.printable import in_a_line
from ekfsim.records import Entry, Step, called
from ekfsim.views.driving.course import Course
from ekfsim.views.driving.saving import Saving
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.driving.help import HELP
from ekfsim.views.terminal.driving.keys import KEYS, Order, Typed
from ekfsim.views.terminal.keys.bindings import Action, action_of, meant
from ekfsim.views.terminal.keys.keyboard import NO_MORE
from ekfsim.views.terminal.player import Player
from ekfsim.views.words.beams.beam import called as wall_called

STEP, TURN = 0.25, 15.0  # m and degrees that an arrow key moves and turns by at first
LEAST, MOST = 1 / 1024, 1024.0  # of both
FARTHEST, ROUND = 1000.0, 360.0  # m and degrees of one command
HINTS = "arrows drive", "? keys", "90b beam", "u undo", "w write", "p back", "q quit"


@dataclass
class Driver(Player):
    """Drives a course as keys are pressed."""

    hints: ClassVar[tuple[str, ...]] = HINTS
    course: Course = field(kw_only=True)
    saving: Saving = field(kw_only=True)
    step: float = STEP  # m
    turn: float = TURN  # degrees
    beam: float = 0.0  # degrees, where the last one went
    written: str = ""  # what was said when the file was written last
    _typed: Typed = field(default_factory=Typed)
    _warned: bool = False  # that something is not saved

    def __post_init__(self, steps: Iterable[Step]) -> None:
        self.playback = self.course
        self._length = None
        self.number = self.course.last.number
        if left := self.course.undone:
            comes = "command comes" if left == 1 else "commands come"
            self.greeting = f"{left} more {comes} here: U does them, what is driven leaves them out"
        if self.course.failure is not None:
            self.greeting = self._come_of_it()

    def _take(self, name: str) -> bool:
        if self._typed.take(name):
            self._show()
            return True
        number, order = self._typed.end(), KEYS.get(name)
        action = Action.UNKNOWN if order is not None else action_of(name)
        action = Action.UNKNOWN if action is Action.WHY else action  # w writes here
        if action is Action.QUIT:
            return self._stays(name)
        self._warned = False
        if order is not None:
            self.obey(order, number)
        elif action is Action.HELP:
            self._show(page=HELP)
        else:
            self.press(action, meant(action, int(abs(number or 0))))
        return True

    def obey(self, order: Order, number: float | None = None) -> None:
        """Do what a key of driving asks for. number : what was typed before it"""
        match order:
            case Order.FORWARD | Order.BACKWARD:
                way = self.step if number is None else number
                self._move(way if order is Order.FORWARD else -way, 0.0)
            case Order.LEFT | Order.RIGHT:
                turn = self.turn if number is None else number
                self._move(0.0, turn if order is Order.LEFT else -turn)
            case Order.BEAM:
                self._sense(self.beam if number is None else number)
            case Order.SHORTER | Order.LONGER:
                self.step = _changed(self.step, 2.0 if order is Order.LONGER else 0.5, number)
                self._show(note=f"Up and down move by {self.step:g} m")
            case Order.NARROWER | Order.WIDER:
                self.turn = _changed(self.turn, 2.0 if order is Order.WIDER else 0.5, number)
                self._show(note=f"Left and right turn by {self.turn:g}°")
            case Order.UNDO:
                self._back(self.course.undo(_times(number)), "Undone", "There is nothing to undo")
            case Order.REDO:
                self._back(self.course.redo(_times(number)), "Again", "There is nothing to redo")
            case Order.FROM_HERE:
                self._from_here()
            case Order.WRITE:
                self._show(note=self.write())

    def write(self) -> str:
        """Save the commands so far; says where, or why not."""
        try:
            self.written = self.saving.save(self.course)
        except EkfsimError as refusal:
            return str(refusal)
        return self.written

    def _move(self, distance: float, turn: float) -> None:
        if abs(distance) > FARTHEST or abs(turn) > ROUND:
            self._show(note=f"A command moves by {FARTHEST:g} m and turns by {ROUND:g}° at most")
        else:  # + 0: no file has a −0
            self._drive(Move(distance + 0.0, float(np.radians(turn + 0.0))))

    def _sense(self, angle: float) -> None:
        if abs(angle) > ROUND:
            self._show(note=f"A beam goes at -{ROUND:g}° to {ROUND:g}°")
        else:
            self.beam = angle + 0.0
            self._drive(Sense(float(np.radians(self.beam))))

    def _drive(self, command: Expanded) -> None:
        """One command more, and on to what has come of it."""
        start = len(self.course)
        if self.course.failure is None:
            self.course.add(command)
        self.number = self.course.last.number
        passed = range(start, self.number) if self.screen.keeps else ()
        told = "".join(self._told(self._view(number)) for number in passed)
        self._show(note=self._come_of_it(), passed=told)

    def _come_of_it(self) -> str:
        """What should not be overlooked of the last command."""
        if self.course.failure is not None:
            return f"The filter failed: {in_a_line(self.course.failure)}; u undoes the command"
        bump = self.course.last.step.entry.bump
        if bump is None or bump < 0 or self.screen.keeps:  # the narrative says it, too
            return ""
        walls = self.scene.world.map.walls
        return f"The robot bumped into {wall_called(walls.name(int(bump))[0])}"

    def _from_here(self) -> None:
        index = self._view(self.number).step.entry.index
        nothing = "Nothing comes after this view: what you drive does"
        self._back(self.course.undo(len(self.course.commands) - index), "Undone", nothing)

    def _back(self, commands: Sequence[Expanded], what: str, nothing: str) -> None:
        """To where the run has come to, where commands were undone or done again."""
        if not commands:
            self._show(note=nothing)
            return
        index = len(self.course.commands) + (what == "Undone")
        one = called(Entry(index, None, command=commands[0]))
        told = one if len(commands) == 1 else f"{len(commands)} commands from {one} on"
        self._to(self.course.last.number, f"{what}: {told}")

    def _stays(self, name: str) -> bool:
        """Whether the run goes on although a key asked to quit: nothing is to be lost unseen."""
        unsaved = self._unsaved
        if unsaved and name == NO_MORE:  # nobody is there to be asked
            self._show(note=self.write())
        elif unsaved and not self._warned:
            self._warned = True
            out = in_a_line(self.saving.out)
            self._show(note=f"{unsaved}: w saves it to {out}, q leaves without")
            return True
        return False

    @property
    def _unsaved(self) -> str:
        """What the file does not hold: "not saved: 5 commands"; "" where it holds all."""
        added, gone = self.course.unsaved
        n = added or gone
        what = f"{n} command{'' if n == 1 else 's'}{'' if added else ' undone'}"
        return f"not saved: {what}" if n else ""

    def _last_words(self, view: View) -> str:
        return ""  # the run is not over

    def _over(self) -> str:
        return "This is where the run has come to: drive on"

    @property
    def _place(self) -> str:
        index = self._view(self.number).step.entry.index
        left = len(self.course.commands) - index
        back = f", {left} before the last" if left else ""
        aims = f"move {self.step:g} m, turn {self.turn:g}°, beam {self.beam:g}°"
        return " · ".join(
            filter(None, (f"step {index}{back}", self._typed.text, aims, self._unsaved))
        )


def _times(number: float | None) -> int:
    """How often, by the number that was typed."""
    return max(int(abs(number)), 1) if number is not None else 1


def _changed(value: float, factor: float, number: float | None) -> float:
    """The number that was typed, or else the value changed by the factor."""
    return min(max(abs(number) if number else value * factor, LEAST), MOST)
