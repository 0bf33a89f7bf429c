"""Why a run was lost, as `play` tells it: calculated once, then a page in place of the run."""

import shutil
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from ekfsim.errors import EkfsimError
from ekfsim.printable import shown
from ekfsim.scene import Scene

if TYPE_CHECKING:
    from ekfsim.why import Explanation

OFTEN = 0.2  # s between two words on how far it has come
CALCULATING = "calculating why · Ctrl-C stops"


class StoppedError(Exception):
    """Ctrl-C has stopped the calculation."""


@dataclass(frozen=True, slots=True)
class Reason:
    """Why a run was lost, or why that cannot be said."""

    found: "Explanation | None"
    refusal: str = ""

    @classmethod
    def of(
        cls, scene: Scene, wait: Callable[[str], None],
        interruptible: Callable[[], AbstractContextManager[Callable[[], bool]]],
    ) -> Self | None:  # fmt: skip
        """Of a scene's first filter; None where Ctrl-C has stopped it. wait : says how far it is"""
        from ekfsim.views.why.asked import runs_for  # asked seldom
        from ekfsim.why import explain

        begun = 0.0
        wait(CALCULATING)
        with interruptible() as stopped:

            def heard(done: int, of: int, what: str) -> None:
                nonlocal begun
                if stopped():
                    raise StoppedError
                if time.monotonic() - begun > OFTEN:
                    begun = time.monotonic()
                    wait(f"{CALCULATING} · {what} {done} of {of}")

            try:
                one = scene.alone()[0]
                return cls(explain(one, runs_for(one), heard=heard))
            except StoppedError:
                return None
            except EkfsimError as refusal:
                return cls(None, str(refusal))

    @property
    def name(self) -> str:
        """What its page is called."""
        from ekfsim.views.why.answer import cause

        return "why" if self.found is None else f"why: {cause(self.found)}"

    def page(self) -> str:
        """All that is to be read, as wide as the terminal."""
        from ekfsim.views.why.answer import answer

        if self.found is None:
            return shown(f"It cannot be said why: {self.refusal}")
        return shown(answer(self.found, shutil.get_terminal_size().columns - 1)).rstrip("\n")
