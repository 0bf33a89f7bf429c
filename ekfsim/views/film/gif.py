"""An animated GIF, written frame by frame:
what is in memory is one picture and the one before it.
"""

from collections.abc import Iterable, Iterator
from functools import cache
from itertools import product
from typing import BinaryIO

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image, ImageChops
from PIL.GifImagePlugin import getdata, getheader

from ekfsim.geometry import Array
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

KEEP = 1  # disposal: the next picture is painted over this one
END = b";"


def write(file: BinaryIO, pictures: Iterable[tuple[Pixels, float]], comment: str) -> None:
    """Write pictures, each with the seconds that it stays, as a GIF that runs for ever.
    Each is (h, w, 3).

    Only the rectangle that changed is written, and all pictures share one palette, so that no
    colour flickers.
    """
    before: Image.Image | None = None
    for pixels, seconds in pictures:
        picture = Image.fromarray(pixels).quantize(palette=palette(), dither=Image.Dither.NONE)
        if before is None:
            header, _ = getheader(picture, info={"loop": 0, "comment": comment.encode()})
            file.writelines(header)
            changed: tuple[int, int, int, int] | None = (0, 0, *picture.size)
        else:
            changed = ImageChops.difference(before, picture).getbbox()
        box = changed or (0, 0, 1, 1)  # an equal picture is still one
        file.writelines(
            getdata(picture.crop(box), box[:2], duration=round(1000 * seconds), disposal=KEEP)
        )
        before = picture
    file.write(END)


@cache
def palette() -> Image.Image:
    """The 256 colours of all pictures:
    greys, and every ink on every ground at all strengths that soft edges need.
    """
    colors = list(dict.fromkeys(_colors()))
    assert len(colors) <= 256
    picture = Image.new("P", (1, 1))
    picture.putpalette([level for color in colors for level in color])
    return picture


def _colors() -> Iterator[tuple[int, ...]]:
    grounds = [np.array(to_rgb(ground)) for ground in (FLOOR, OUTSIDE, OBSTACLE)]
    inks = [np.array(to_rgb(ink)) for ink in (BLUE, GREEN, VERMILLION, SKY, PURPLE, ORANGE)]
    fills = [(SKY, 0.35), (GREEN, 0.18), (BLUE, 0.55)]
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
