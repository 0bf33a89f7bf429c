"""An animated GIF, written frame by frame:
what is in memory is one picture and the one before it.
"""

from collections.abc import Iterable, Iterator
from functools import cache
from itertools import product
from typing import BinaryIO

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from PIL import Image
from PIL.GifImagePlugin import getdata, getheader

from ekfsim.geometry import Array, Integers
from ekfsim.views.film.png import Pixels
from ekfsim.views.picture.artists import (
    BLUE,
    FLOOR,
    GREEN,
    OBSTACLE,
    ORANGE,
    OUTSIDE,
    PURPLE,
    SKY,
    TRUTH,
    VERMILLION,
)
from ekfsim.views.picture.belief.warned import ALARM, ALARM_FILL

KEEP = 1  # disposal: the next picture is painted over this one
UNCHANGED = 255  # the index of no colour: what was there before is seen
END = b";"


def write(file: BinaryIO, pictures: Iterable[tuple[Pixels, float]], comment: str) -> None:
    """Write pictures, each with the seconds that it stays, as a GIF that runs for ever.
    Each is (h, w, 4), without any transparency, and looked at until the next is asked for.

    Only the rectangle that changed is written, what did not change in it as nothing, and all
    pictures share one palette, so that no colour flickers.
    """
    shown: NDArray[np.uint32] | None = None
    for pixels, seconds in pictures:
        now = pixels.view(np.uint32)[..., 0]
        if shown is None:
            shown = np.zeros_like(now)  # transparent
            indices, differs = np.full(now.shape, UNCHANGED, np.uint8), np.empty(now.shape, bool)
            info = {"loop": 0, "comment": comment.encode()}
            header, _ = getheader(palette().resize(now.shape[::-1]), info=info)
            file.writelines(header)
        np.not_equal(now, shown, out=differs)
        changed = np.flatnonzero(differs)  # few of all, so all else is asked of them alone
        colors = now.ravel()[changed]
        shown.ravel()[changed] = colors
        indices.ravel()[changed] = _nearest(colors)
        rows, columns = map(_span, np.divmod(changed, now.shape[1]))
        picture, corner = Image.fromarray(indices[rows, columns]), (columns.start, rows.start)
        duration = round(1000 * seconds)
        file.writelines(
            getdata(picture, corner, duration=duration, disposal=KEEP, transparency=UNCHANGED)
        )
        indices.ravel()[changed] = UNCHANGED
    file.write(END)


def _span(places: Integers) -> slice:
    """From the first to the last; one where there is none, as an equal picture is still one.

    >>> _span(np.array([3, 1])), _span(np.array([], int))
    (slice(1, 4, None), slice(0, 1, None))
    """
    return slice(int(places.min()), int(places.max()) + 1) if len(places) else slice(0, 1)


def _nearest(colors: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """The palette's colour for each. colors : (n,), of red, green, blue and what does not count"""
    if not len(colors):
        return np.empty(0, np.uint8)
    rgb = Image.frombytes("RGB", (len(colors), 1), colors.tobytes(), "raw", "RGBX")
    matched = rgb.quantize(palette=palette(), dither=Image.Dither.NONE)
    indices: NDArray[np.uint8] = np.asarray(matched)[0]
    return indices


@cache
def palette() -> Image.Image:
    """The colours of all pictures:
    greys, and every ink on every ground at all strengths that soft edges need.
    """
    colors = list(dict.fromkeys(_colors()))
    assert len(colors) <= UNCHANGED
    picture = Image.new("P", (1, 1))
    picture.putpalette([level for color in colors for level in color])
    return picture


def _colors() -> Iterator[tuple[int, ...]]:
    grounds = [np.array(to_rgb(ground)) for ground in (FLOOR, OUTSIDE, OBSTACLE)]
    inks = [np.array(to_rgb(ink)) for ink in (BLUE, GREEN, VERMILLION, SKY, PURPLE, ORANGE)]
    fills = [(SKY, 0.35), (GREEN, 0.18), (BLUE, 0.55), (ALARM, ALARM_FILL)]
    for ground in grounds:
        yield _bytes(ground)
        for (below, some), (above, more) in product(fills, fills):
            once = _mixed(ground, np.array(to_rgb(below)), some)
            yield _bytes(once)
            yield _bytes(_mixed(once, np.array(to_rgb(above)), more))
    for ink, share in product(inks, (1.0, 0.85, 0.7, 0.55, 0.4, 0.25, 0.12)):
        for ground in grounds if share < 1 else grounds[:1]:
            yield _bytes(_mixed(ground, ink, share))
    # nothing closer to white: Pillow rounds down and would take that for it
    for level in np.linspace(0.06, 1, 50):
        yield _bytes(_mixed(grounds[0], np.array(to_rgb(TRUTH)), level))


def _mixed(ground: Array, ink: Array, share: float) -> Array:
    return (1 - share) * ground + share * ink


def _bytes(color: Array) -> tuple[int, ...]:
    return tuple(np.rint(255 * color).astype(int).tolist())
