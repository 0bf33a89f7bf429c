"""The interactive run: keys in, narrative and pictures out."""

import itertools
import time
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from dataclasses import InitVar, dataclass, field
from typing import ClassVar

from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import UsageError
from ekfsim.localization import play
from ekfsim.printable import shown
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.playback.kept import heard, kept, nobody
from ekfsim.views.playback.length import Length, length_of
from ekfsim.views.playback.playback import Playback, Run
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keys.bindings import Action, Counted
from ekfsim.views.terminal.keys.help import HELP
from ekfsim.views.terminal.keys.interrupts import unnoticed
from ekfsim.views.terminal.pace import Pace
from ekfsim.views.terminal.reason import Reason
from ekfsim.views.terminal.screens.moment import HINTS, Moment, Screen
from ekfsim.views.words.closing import conclude_all
from ekfsim.views.words.narrative.long_form import WORDS
from ekfsim.views.words.narrative.narrating import narrate

CHANGED = "changed"  # comes in place of a key where the files of the run were saved anew
OFTEN = 0.2  # s between two words on how far a long way has come
STEPPING = (Action.NEXT, Action.BACK, Action.RESTART, Action.STEP, Action.END, Action.AMBIGUOUS,
            Action.LOST)  # fmt: skip

# Waits at most so many s (None: without end) → the name of a key, None where none came
NextKey = Callable[[float | None], str | None]


@dataclass
class Player:
    """Steps through a run as keys are pressed. What is to be seen goes to `screen`."""

    hints: ClassVar[tuple[str, ...]] = HINTS
    scene: Scene
    steps: InitVar[Iterable[Step]]
    screen: Screen
    save: Callable[[View], str]  # saves the picture of a view and says where
    probability: float
    explain: bool = False  # whether the narrative is in its long form
    pace: Pace = field(default_factory=Pace)
    # a block in which a long way asks whether it is to stop
    interruptible: Callable[[], AbstractContextManager[Callable[[], bool]]] = unnoticed
    number: int = 0  # of the view on the screen
    greeting: str = ""  # what there is to say before any key
    # is told of each step as it is made, which may be long before it is shown
    hear: Callable[[int], None] = nobody
    remark: str = ""  # what there is to say of the whole run, beside its place
    drives: bool = False  # whether it ended because somebody wants to drive on from there
    playback: Run = field(init=False)
    # of the steps so far, by filter; ahead of what is shown by a view
    _summaries: list[Summary] = field(init=False)
    _length: Length | None = field(init=False)
    _page: str = ""  # what is read in place of the run
    _page_name: str = ""  # what that is called, where it is not the help
    _reason: Reason | None = None  # why it was lost, once that was asked
    _stayed: tuple[str, int] = ("", 0)  # why the view stayed at the last key, and which
    _counted: Counted = field(default_factory=Counted)

    def __post_init__(self, steps: Iterable[Step]) -> None:
        alone = self.scene.alone()
        self._summaries = [Summary.of(one) for one in alone]
        runs = [heard(run, self.hear) for run in (steps, *map(play, alone[1:]))]
        first, *others = (kept(run, [s.add]) for run, s in zip(runs, self._summaries, strict=True))
        self.playback = Playback(first, others, (self.scene.filter, *self.scene.beside))
        self._length = length_of(self.scene)

    def play(self, next_key: NextKey) -> None:
        """Until a key quits."""
        self._show(note=self.greeting)
        self.pace.begin()
        goes_on = True
        while goes_on:
            name = next_key(self.pace.left)
            if name is None:
                self._go_on()
            else:
                goes_on = self._take(name)

    def _take(self, name: str) -> bool:
        """Do what one key asks for; whether the run goes on."""
        if name == CHANGED:
            return False
        pressed = self._counted.press(name)
        if pressed is None:
            self._show(typed=self._counted.typed)
            return True
        action, count = pressed
        if action is Action.QUIT:
            if self.playback.failure is not None:
                raise self.playback.failure
            return False
        self.press(action, count)
        return not self.drives

    def press(self, action: Action, count: int = 1) -> None:
        """Do what one key asks for. count : how often, or of STEP to which one"""
        running = self.pace.seconds is not None
        if action in STEPPING:
            self.pace.stop()
        match action:
            case Action.NEXT if running:
                self._show(note="It waits; + goes on by itself again")
            case Action.NEXT:
                self._forward(count)
            case Action.BACK | Action.RESTART if self.number == 0:
                self._stay("This is the start: n goes on, q quits")
            case Action.BACK:
                self._to(max(self.number - count, 0))
            case Action.RESTART:
                self._to(0)
            case Action.STEP:
                self._to_step(count)
            case Action.END:
                self._to_end()
            case Action.AMBIGUOUS:
                self._to_ambiguous()
            case Action.LOST:
                self._to_lost()
            case Action.FASTER | Action.SLOWER:
                self._show(note=self._paced(action))
            case Action.EXPLAIN:
                self.explain = not self.explain
                form = "long" if self.explain else "short"
                self._show(note=f"The narrative in its {form} form, from this view on:")
            case Action.PANES | Action.UP | Action.DOWN:
                page = "" if action is Action.PANES else self._page
                told = self.screen.arrange(action, count)
                self._show(note=told, page=page, named=self._page_name)
            case Action.SAVE:
                self._show(note=self.save(self._view(self.number)))
            case Action.WHY:
                self._tell_why()
            case Action.DRIVE:
                self._drive_on()
            case Action.HELP:
                self._show(page=f"{HELP}\n\n{WORDS}")
            case _:
                self._show(note="That key does nothing here; ? shows those that do")

    def _tell_why(self) -> None:
        """Why the run was lost, calculated when it is first asked; Ctrl-C stops that."""
        if self._reason is None:
            self._reason = Reason.of(self.scene, self.screen.wait, self.interruptible)
        if self._reason is None:
            self._show(note="Stopped on the way; Ctrl-C again ends the program")
        else:
            self._show(page=self._reason.page(), named=self._reason.name)

    def _drive_on(self) -> None:
        from ekfsim.views.driving.course import refuse_what_is_not_driven

        try:
            refuse_what_is_not_driven(self.scene)
        except UsageError as refusal:
            self._show(note=str(refusal))
        else:
            self.drives = True

    def _forward(self, count: int) -> None:
        """So many views on, or to the end."""
        start = self.number
        found = self._search(
            lambda view: view.number >= start + count, f"{count} views on", start + 1
        )
        if found is None and not self.playback.over:
            return  # Ctrl-C
        self.number = len(self.playback) - 1 if found is None else found
        if self.number == start:
            self._stay(self._over())
        else:
            passed = range(start + 1, self.number) if self.screen.keeps else ()
            self._show(passed="".join(self._told(self._view(number)) for number in passed))

    def _stay(self, why: str) -> None:
        """Say why the view stays, of a held key once."""
        if self._stayed != (why, self.number):
            self._show(note=why)
            self._stayed = (why, self.number)

    def _go_on(self) -> None:
        """The next view, as its time has come."""
        self.pace.begin()
        if self.playback.view(self.number + 1) is None:
            self.pace.stop()
        self._forward(1)

    def _paced(self, action: Action) -> str:
        """Take another pace, and say which."""
        if action is Action.SLOWER and self.pace.seconds is None:
            return "It waits for keys; + goes on by itself"
        if action is Action.FASTER:
            self.pace.faster()
        else:
            self.pace.slower()
        if self.pace.seconds is None:
            return "It waits for keys again"
        return "+ faster, - slower, space waits"

    def _to_step(self, step: int) -> None:
        """To the first view of a step: of a reading the beam."""
        found = self._search(lambda view: view.step.entry.index >= step, f"to step {step}")
        if found is not None:
            self._to(found)
        elif self.playback.over:
            last = self._view(len(self.playback) - 1)
            self._to(last.number, f"There is no step {step}: the run ends at step "
                                  f"{last.step.entry.index}")  # fmt: skip

    def _to_end(self) -> None:
        self._search(lambda view: False, "to the end")
        if self.playback.over:
            self._to(len(self.playback) - 1)

    def _to_ambiguous(self) -> None:
        """To the next beam that might have met another wall."""
        found = self._search(_ambiguous, "to the next ambiguous beam", self.number + 1)
        if found is not None:
            self._to(found)
        elif self.playback.over:
            self._show(note="No beam is ambiguous from here on")

    def _to_lost(self) -> None:
        """To the first view since which the filter is lost up to the end."""
        self._search(lambda view: False, "to the end, from where it is told since when it is lost")
        if not self.playback.over:
            return
        since = self._view(len(self.playback) - 1).judged.lost_from
        if since is None:
            self._show(note="The filter is not lost at the end")
            return
        found = self._search(
            lambda view: not view.beam and view.step.entry.index >= since, f"to step {since}"
        )
        if found is not None:
            self._to(found, f"Lost since step {since}, up to the end")

    def _search(self, wanted: Callable[[View], bool], whither: str, start: int = 0) -> int | None:
        """The number of the first view from `start` on that is wanted; None where there is none, or
        where Ctrl-C has stopped the search.
        """
        begun = time.monotonic()
        with self.interruptible() as stopped:
            for number in itertools.count(start):
                view = self.playback.view(number)
                if view is None:
                    return None
                if wanted(view):
                    break
                if stopped():
                    self._show(note="Stopped on the way; Ctrl-C again ends the program")
                    return None
                if time.monotonic() - begun > OFTEN:
                    begun = time.monotonic()
                    self.screen.wait(
                        f"{whither}: step {view.step.entry.index}{self._of_steps} · Ctrl-C stops"
                    )
        return number

    def _to(self, number: int, note: str = "") -> None:
        """To another view; those between are not told."""
        whither = "Back at" if number < self.number else "On to"
        moved, self.number = number != self.number, number
        self._show(note, passed=f"<=={whither} {self._place}\n\n" if moved else "")

    def _show(
        self, note: str = "", page: str = "", passed: str = "", typed: int = 0, named: str = ""
    ) -> None:
        self._stayed = ("", 0)
        view = self._view(self.number)
        revised = self.number > 0 and not view.beam and self._view(self.number - 1).beam
        before = self._narrated(self._view(self.number - 1)) if revised else ""
        told = self._told(view)  # looks ahead, whether the run is over
        last = self.playback.over and self.number == len(self.playback) - 1
        if last and not note and self.playback.failure is not None and not self.screen.keeps:
            note = self._over()  # the picture alone does not say so
        self._page, self._page_name = page, named if page else ""
        pace = "" if self.pace.seconds is None else f" · every {self.pace.seconds:g} s"
        moment = Moment(
            view, told, self._place + pace + self.remark, self.explain, before, passed, note, page,
            self._page_name, typed, self.hints,
        )  # fmt: skip
        self.screen.show(moment)

    def _told(self, view: View) -> str:
        """The narrative of a view, and after the last one the closing summary, or what failed."""
        text = self._narrated(view)
        if self.playback.view(view.number + 1) is not None:
            return text
        if self.playback.failure is not None:
            return f"{text}The run failed: {shown(self.playback.failure)}\n"
        return text + self._last_words(view)

    def _last_words(self, view: View) -> str:
        """What stands below the narrative of the last view."""
        return conclude_all(self.scene, self._summaries, parted=view.apart)

    def _narrated(self, view: View) -> str:
        return narrate(view, self.scene, self.probability, self.explain)

    def _over(self) -> str:
        over = "is over" if self.playback.failure is None else "failed here"
        return f"The run {over}: q quits, p goes back, r starts again"

    @property
    def _place(self) -> str:
        """Where in the run it is: steps as the commands are counted, views as the key n counts."""
        of = "" if self._length is None else f" of {self._length.views}"
        index = self._view(self.number).step.entry.index
        return f"step {index}{self._of_steps}, view {self.number}{of}"

    @property
    def _of_steps(self) -> str:
        return "" if self._length is None else f" of {self._length.steps}"

    def _view(self, number: int) -> View:
        view = self.playback.view(number)
        assert view is not None
        return view


def _ambiguous(view: View) -> bool:
    return view.beam and view.step.remark is not None and bool(view.step.remark.ambiguous)
