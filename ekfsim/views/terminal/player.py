"""The interactive run: keys in, narrative and pictures out."""

from collections.abc import Callable, Iterable
from dataclasses import InitVar, dataclass, field
from typing import Protocol, TextIO

from ekfsim.diagnostics.summary import Summary
from ekfsim.files.results.outputs import kept
from ekfsim.localization import play
from ekfsim.printable import shown
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import Playback
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.keyboard import HELP, Action, Counted, Key
from ekfsim.views.words.closing import conclude_all
from ekfsim.views.words.long_form import WORDS
from ekfsim.views.words.narrative import narrate


class Screen(Protocol):
    """Where the pictures of an interactive run are seen."""

    def show(self, view: View) -> None:
        """Draw this view in place of the last one."""


@dataclass
class Player:
    """Steps through a run as keys are pressed.
    What it says goes to `out`, what it draws to `screen`.
    """

    scene: Scene
    steps: InitVar[Iterable[Step]]
    screen: Screen
    save: Callable[[View], str]  # saves the picture of a view and says where
    out: TextIO
    probability: float
    explain: bool = False  # whether the narrative is in its long form
    number: int = 0  # of the view on the screen
    # that there is no view further on, while the key that asks for one is held
    told_to_stay: bool = False
    playback: Playback = field(init=False)
    # of the steps so far, by filter; ahead of what is shown by a view
    _summaries: list[Summary] = field(init=False)

    def __post_init__(self, steps: Iterable[Step]) -> None:
        alone = self.scene.alone()
        self._summaries = [Summary.of(one) for one in alone]
        runs = (steps, *map(play, alone[1:]))
        first, *others = (kept(run, [s.add]) for run, s in zip(runs, self._summaries, strict=True))
        self.playback = Playback(first, others, (self.scene.filter, *self.scene.beside))

    def play(self, next_key: Callable[[], Key]) -> None:
        """From the first view until a key quits."""
        self._tell(self._view(0))
        self.screen.show(self._view(0))
        counted = Counted()
        while True:
            pressed = counted.press(next_key())
            if pressed is None:
                continue
            action, count = pressed
            if action is Action.QUIT:
                if self.playback.failure is not None:
                    raise self.playback.failure
                return
            self.press(action, count)
            self.out.flush()

    def press(self, action: Action, count: int = 1) -> None:
        """Do what one key asks for."""
        match action:
            case Action.NEXT:
                self._forward(count)
            case Action.BACK if self.number == 0:
                self._stay("This is the start: n goes on, q quits")
            case Action.BACK:
                self._jump(max(self.number - count, 0))
            case Action.RESTART:
                self._jump(0)
            case Action.SAVE:
                self.out.write(f"{self.save(self._view(self.number))}\n")
            case Action.EXPLAIN:
                self.explain = not self.explain
                self.out.write(
                    f"The narrative in its {'long' if self.explain else 'short'} form, "
                    "from this view on:\n"
                )
                self.out.write(self._narrated(self._view(self.number)))
            case Action.HELP:
                self.out.write(f"{HELP}\n\n{WORDS}\n")
            case _:
                self.out.write("That key does nothing here; ? shows those that do\n")

    def _forward(self, count: int) -> None:
        start = self.number
        for _ in range(count):
            view = self.playback.view(self.number + 1)
            if view is None:
                break
            self.number = view.number
            self._tell(view)
        if self.number == start:
            over = "is over" if self.playback.failure is None else "failed here"
            self._stay(f"The run {over}: q quits, p goes back, r starts again")
        else:
            self.told_to_stay = False
            self.screen.show(self._view(self.number))

    def _stay(self, why: str) -> None:
        """Say once why the view stays."""
        if not self.told_to_stay:
            self.out.write(f"{why}\n")
        self.told_to_stay = True

    def _jump(self, number: int) -> None:
        """Go back: what was told stays told, the picture is the old one."""
        self.number, self.told_to_stay = number, False
        self.out.write(f"<==Back at view {number}\n\n")
        self.screen.show(self._view(number))

    def _tell(self, view: View) -> None:
        """The narrative of a view, and after the last one the closing summary, or what failed."""
        self.out.write(self._narrated(view))
        if self.playback.view(view.number + 1) is not None:
            return
        if self.playback.failure is not None:
            self.out.write(f"The run failed: {shown(self.playback.failure)}\n")
        else:
            self.out.write(conclude_all(self.scene, self._summaries, parted=view.apart))

    def _narrated(self, view: View) -> str:
        return narrate(view, self.scene, self.probability, self.explain)

    def _view(self, number: int) -> View:
        view = self.playback.view(number)
        assert view is not None
        return view
