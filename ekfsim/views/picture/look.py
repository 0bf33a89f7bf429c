"""What a picture is to show besides;
apart from the drawing, so that who asks need not import matplotlib.
"""

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ekfsim.errors import UsageError

if TYPE_CHECKING:
    import logging

NARROWEST, LOWEST = 6.0, 4.5  # inches of a picture


@dataclass(frozen=True, slots=True)
class Look:
    """The options of a picture."""

    probability: float = 0.954  # of ellipse and cone
    conditional: bool = False  # also the ellipses were the heading at either edge of its cone


STANDARD = Look()


@dataclass(frozen=True, slots=True)
class Paper:
    """What a picture is drawn on: of so many pixels, or as high as what it shows asks for."""

    size: tuple[int, int] | None = None  # width and height
    dpi: int = 100

    def check(self) -> None:
        """Raises UsageError where the letters would leave no room for anything else."""
        if self.size is None:
            return
        width, height = (side / self.dpi for side in self.size)
        if width < NARROWEST or height < LOWEST:
            raise UsageError(
                f"--size {self.size[0]}x{self.size[1]} at {self.dpi} dpi is {width:.3g} by "
                f"{height:.3g} inches, which the letters fill; choose at least {NARROWEST:g} by "
                f"{LOWEST:g} inches, by a larger --size or a smaller --dpi"
            )


SCREEN = Paper()


def get_ready() -> None:
    """Import matplotlib to draw into files, which takes no backend of windows.

    The one that its user's settings name is not looked at: a notebook names its own to all that is
    started from it, and it need not be installed here. Raises UsageError where matplotlib does not
    take other settings.
    """
    import logging

    named = os.environ.get("MPLBACKEND")
    os.environ["MPLBACKEND"] = "agg"  # read once, as matplotlib is imported
    logging.getLogger("matplotlib").addFilter(_of_no_backend)
    # to the end: it looks for one now and again
    logging.getLogger("matplotlib").addFilter(_of_no_folder)
    try:
        import matplotlib  # noqa: F401 (to see whether it can be)
    except ValueError as refusal:
        raise UsageError(f"matplotlib does not accept its settings: {refusal}") from refusal
    finally:
        logging.getLogger("matplotlib").removeFilter(_of_no_backend)
        if named is None:
            del os.environ["MPLBACKEND"]
        else:
            os.environ["MPLBACKEND"] = named


def _of_no_backend(record: "logging.LogRecord") -> bool:
    """Whether matplotlib's warning is of another setting than the backend of a matplotlibrc."""
    return "Key backend: " not in record.getMessage()


def _of_no_folder(record: "logging.LogRecord") -> bool:
    """Whether matplotlib's warning is of another thing than its folder:
    without a writable home it uses another.
    """
    return not any(
        words in record.getMessage()
        for words in ("mkdir -p failed", "writable directory", "cache directory")
    )
