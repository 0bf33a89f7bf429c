"""A picture → how bright its pixels are.

PGM is read here, so that a pixel is divided by the file's own greatest value and not rounded to 255
steps before; all else by Pillow.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.looking import contents, read_from
from ekfsim.geometry import Array

if TYPE_CHECKING:
    from PIL import Image

MOST_PIXELS = 100_000_000
MOST_BYTES = 4 * MOST_PIXELS
HEADER = re.compile(rb"(P[25])((?:\s|#[^\n]*\n)+\d+){3}\s")
FIELD = re.compile(rb"#[^\n]*\n|\d+")


@dataclass(frozen=True, slots=True)
class Grey:
    """A picture: how bright each pixel is, 0 to 1, row 0 at the top."""

    bright: Array  # (rows, columns), the mean of its channels
    clear: Array | None = None  # (rows, columns), how opaque: 1 is; None where none is transparent
    channels: int = 1  # of colour


def grey_of(path: Path, shown: str) -> Grey:
    """How bright a picture is. Raises UsageError where it cannot be read."""
    with read_from(shown):
        try:
            raw = contents(path, MOST_BYTES)
        except FileNotFoundError:
            raise UsageError(f"{shown}: no such file; the map's `image` names it") from None
        except IsADirectoryError:
            raise UsageError(f"{shown}: is a folder; the map's `image` names a picture") from None
    if len(raw) > MOST_BYTES:
        raise UsageError(f"{shown}: the picture is too large to be read")
    return pgm(raw, shown) if raw[:2] in (b"P2", b"P5") else _by_pillow(path, shown)


def pgm(raw: bytes, shown: str) -> Grey:
    """A PGM picture: P2, numbers as text, or P5, one byte each, or two, the high one first."""
    header = HEADER.match(raw)
    if header is None:
        raise UsageError(f"{shown}: this PGM file tells no width, height and greatest value")
    width, height, most = (
        int(field) for field in FIELD.findall(header[0][2:]) if not field.startswith(b"#")
    )
    if not (0 < width * height <= MOST_PIXELS and 0 < most < 65536):
        raise UsageError(
            f"{shown}: this PGM file says {width} by {height} pixels of 0 to {most}, which is no "
            "picture that can be read"
        )
    body = raw[header.end() :]
    if header[1] == b"P2":
        try:
            values = np.array(re.sub(rb"#[^\n]*", b"", body).split(), np.float64)
        except ValueError:
            raise UsageError(f"{shown}: a pixel of this PGM file is no number") from None
    else:
        wide = np.dtype(">u2" if most > 255 else "u1")
        whole = len(body) // wide.itemsize
        values = np.frombuffer(body, wide, whole)
    if len(values) < width * height:
        raise UsageError(
            f"{shown}: the file ends after {len(values)} of {width * height} pixels; copy it whole"
        )
    values = values[: width * height].astype(np.float64)
    if values.min() < 0 or values.max() > most:
        raise UsageError(f"{shown}: a pixel is not in 0 to {most}, as the file says of them all")
    return Grey(values.reshape(height, width) / most)


def _by_pillow(path: Path, shown: str) -> Grey:
    """Any picture that Pillow reads."""
    import warnings

    from PIL import Image, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(path) as picture:
                if picture.width * picture.height > MOST_PIXELS:
                    raise UsageError(f"{shown}: the picture is too large to be read")
                return _grey(picture)
    except UnidentifiedImageError:
        raise UsageError(f"{shown}: this is no picture that can be read") from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as refusal:
        raise UsageError(f"{shown}: the picture cannot be read: {refusal}") from None


def _grey(picture: "Image.Image") -> Grey:
    """How bright an open picture is."""
    if picture.mode == "PA" or "transparency" in picture.info:
        picture = picture.convert("RGBA")
    elif picture.mode in ("1", "P"):
        picture = picture.convert("L" if picture.mode == "1" else "RGB")
    bright = np.asarray(picture, np.float64) / (65535 if picture.mode.startswith("I") else 255)
    if bright.ndim == 2:
        return Grey(bright)
    if picture.mode in ("LA", "RGBA"):
        colours, clear = bright[..., :-1], bright[..., -1]
        return Grey(colours.mean(axis=-1), clear, colours.shape[-1])
    return Grey(bright.mean(axis=-1), None, bright.shape[-1])
