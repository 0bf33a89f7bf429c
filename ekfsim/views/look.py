"""What a picture is to show besides; apart from the drawing, so that who asks need not import matplotlib."""

from dataclasses import dataclass

from ekfsim.errors import UsageError


@dataclass(frozen=True, slots=True)
class Look:
    """The options of a picture."""

    probability: float = 0.954  # of ellipse and cone
    conditional: bool = False  # also the ellipses were the heading at either edge of its cone


STANDARD = Look()


def get_ready() -> None:
    """Import matplotlib, which reads its user's settings as it is imported.

    Raises UsageError where one of them is wrong, such as the environment's MPLBACKEND.
    """
    try:
        import matplotlib  # noqa: F401 (to see whether it can be)
    except ValueError as refusal:
        raise UsageError(f"matplotlib does not accept its settings: {refusal}") from refusal
