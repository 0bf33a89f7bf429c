"""What a picture is to show besides; apart from the drawing, so that who asks need not import matplotlib."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Look:
    """The options of a picture."""

    probability: float = 0.954  # of ellipse and cone
    conditional: bool = False  # also the ellipses were the heading at either edge of its cone


STANDARD = Look()
