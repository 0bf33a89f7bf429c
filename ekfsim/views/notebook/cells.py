"""What a cell of a notebook is made of: words as they are printed, and pictures."""

import base64
import io
from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PRE = "white-space: pre; overflow-x: auto; line-height: 1.3; font-size: 12px"


def page(told: str, pictures: Iterable[bytes] = ()) -> str:
    """Words as they are printed, and beneath them pictures, which are PNG files."""
    images = (
        f'<img alt="" style="max-width: 100%" src="data:image/png;base64,{encoded}">'
        for encoded in (base64.b64encode(picture).decode() for picture in pictures)
    )
    return f'<div><pre style="{PRE}">{escape(told)}</pre>{"".join(images)}</div>'


def png(figure: "Figure") -> bytes:
    """The picture that a figure is, as a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return file.getvalue()
