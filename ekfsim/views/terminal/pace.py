"""A run that goes on by itself."""

import time
from dataclasses import dataclass

PACES = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)  # s that a view stays
FIRST = 2.0


@dataclass
class Pace:
    """How fast a run goes on by itself; not at all where `seconds` is None."""

    seconds: float | None = None  # that a view stays
    asked: float = FIRST  # the pace that it takes up again
    _shown: float = 0.0  # when the last view came

    def __post_init__(self) -> None:
        self.asked = self.seconds or self.asked

    def faster(self) -> None:
        """Begin, or take the next shorter time."""
        if self.seconds is None:
            self.seconds = self.asked
        else:
            self.seconds = max((s for s in PACES if s < self.seconds), default=PACES[0])
        self.asked = self.seconds

    def slower(self) -> None:
        """Take the next longer time; slower than the slowest is not at all."""
        if self.seconds is not None:
            self.seconds = min((s for s in PACES if s > self.seconds), default=None)
            self.asked = self.seconds or PACES[-1]

    def stop(self) -> None:
        """Wait for keys again."""
        self.seconds = None

    def begin(self) -> None:
        """A view has come."""
        self._shown = time.monotonic()

    @property
    def left(self) -> float | None:
        """How many s the view stays from now on; None where only a key ends it."""
        if self.seconds is None:
            return None
        return max(0.0, self._shown + self.seconds - time.monotonic())
