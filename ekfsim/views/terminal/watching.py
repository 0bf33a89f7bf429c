"""Files that are read again when they are saved, however their editor saves them: over the old
text, beside it and then renamed, or in two goes.
"""

import itertools
import math
import time
from collections.abc import Callable, Iterable
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path

from ekfsim.errors import EkfsimError
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import Run
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.player import CHANGED, NextKey

LOOK = 0.1  # s between two looks at the files
SETTLED = 0.15  # s without a change before they are read
MOMENT = 1.0  # s that a mistake must stand: who is still writing has made none


def counterpart(run: Run, view: View) -> View:
    """The view of a run that shows the same as one of another; its last where it ends before."""
    wanted = view.step.entry.index, not view.beam
    for number in itertools.count():
        found = run.view(number)
        if found is None:
            break
        last = found
        if (last.step.entry.index, not last.beam) >= wanted:
            break
    return last


class Watch:
    """What the files hold, as they are saved."""

    news = False  # whether the last of what `keys` gave was CHANGED

    def __init__(
        self,
        scene: Scene,
        read: Callable[[], Scene],
        files: Callable[[Scene], Iterable[Path]],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.scene = scene  # of the last files without a mistake
        self.mistake = ""  # of the last ones, all its lines
        self.remarks = ""  # what was said as they were read
        # what was on show when the last were read, and what is since: where the run does not get
        # that far, the next one may again
        self.meant: View | None = None
        self.shown: View | None = None
        self._read, self._files_of, self._clock = read, files, clock
        self._files = tuple(files(scene))
        self._known = self._seen = self._signs()  # when there was news last, at the last look
        self._since = clock()  # when what was seen at the last look came
        self._wrong = False  # whether that has been read, and there was a mistake

    def look(self) -> bool:
        """Whether there is news: another scene, or a mistake that stays."""
        now, signs = self._clock(), self._signs()
        if signs != self._seen:
            self._seen, self._since, self._wrong = signs, now, False
        patience = MOMENT if self._wrong else SETTLED
        if signs == self._known or now - self._since < patience:
            return False
        told = StringIO()
        try:
            with redirect_stderr(told):
                scene = self._read()
        except EkfsimError as mistake:
            again, self._wrong = self._wrong, True
            if again:
                self._known, self.mistake = signs, str(mistake)
            return again
        self.scene, self.mistake, self.remarks = scene, "", told.getvalue()
        files = tuple(self._files_of(scene))
        if files != self._files:  # it names others now
            self._files, signs = files, _signs(files)
        self._known = self._seen = signs
        return True

    def keys(self, next_key: NextKey) -> NextKey:
        """The same keys, and CHANGED where there is news."""

        def watched(timeout: float | None) -> str | None:
            deadline = math.inf if timeout is None else self._clock() + timeout
            while True:
                left = max(0.0, deadline - self._clock())
                name = next_key(min(LOOK, left))
                self.news = name is None and self.look()
                if self.news:
                    return CHANGED
                if name is not None or left <= LOOK:
                    return name

        return watched

    def _signs(self) -> tuple[object, ...]:
        return _signs(self._files)


def _signs(files: Iterable[Path]) -> tuple[object, ...]:
    """What differs where one of the files was saved; None of one that is not there."""
    signs: list[object] = []
    for file in files:
        try:
            found = file.stat()
        except OSError:
            signs.append(None)
        else:
            signs.append((found.st_mtime_ns, found.st_size, found.st_ino))
    return tuple(signs)
