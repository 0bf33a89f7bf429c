"""What a picture is to show besides;
apart from the drawing, so that who asks need not import matplotlib.
"""

import logging
import os
from dataclasses import dataclass

from ekfsim.errors import UsageError


@dataclass(frozen=True, slots=True)
class Look:
    """The options of a picture."""

    probability: float = 0.954  # of ellipse and cone
    conditional: bool = False  # also the ellipses were the heading at either edge of its cone


STANDARD = Look()


def get_ready() -> None:
    """Import matplotlib to draw into files, which takes no backend of windows.

    The one that its user's settings name is not looked at: a notebook names its own to all that is
    started from it, and it need not be installed here. Raises UsageError where matplotlib does not
    take other settings.
    """
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


def _of_no_backend(record: logging.LogRecord) -> bool:
    """Whether matplotlib's warning is of another setting than the backend of a matplotlibrc."""
    return "Key backend: " not in record.getMessage()


def _of_no_folder(record: logging.LogRecord) -> bool:
    """Whether matplotlib's warning is of another thing than its folder:
    without a writable home it uses another.
    """
    return not any(
        words in record.getMessage()
        for words in ("mkdir -p failed", "writable directory", "cache directory")
    )
