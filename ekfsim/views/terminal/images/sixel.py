"""Pixels → sixels: a picture in bands of six rows, each painted colour by colour.

A sign stands for six pixels below each other, the lowest bit for the topmost: 63 more than the bits
that are painted. "!n" repeats the sign after it n times, "$" goes back to the start of the band,
"-" on to the next one. (VT330/VT340 Programmer Reference Manual, volume 2, chapter 14.)
"""

import numpy as np
from PIL import Image

from ekfsim.views.film.png import Pixels

HIGH = 6  # rows of a band
NOTHING = 63  # the sign that paints no pixel
REPEATED = 4  # signs from which on to repeat one is shorter


def quantized(rgb: Pixels, colours: int) -> tuple[Pixels, Pixels]:
    """Each pixel's colour by its number : (h, w), and the colours : (n, 3). rgb : (h, w, 3)"""
    image = Image.fromarray(rgb).quantize(colours, dither=Image.Dither.NONE)
    palette = np.asarray(image.getpalette(), np.uint8).reshape(-1, 3)
    return np.asarray(image), palette


def encoded(numbers: Pixels, palette: Pixels) -> str:
    """A picture that paints every pixel, at the cursor."""
    height, width = numbers.shape
    shares = np.rint(palette / 255 * 100).astype(int)  # %
    colours = "".join(f"#{n};2;{r};{g};{b}" for n, (r, g, b) in enumerate(shares.tolist()))
    bands = (_band(numbers[first : first + HIGH]) for first in range(0, height, HIGH))
    return f'\x1bP0;1;0q"1;1;{width};{height}{colours}{"-".join(bands)}\x1b\\'


def _band(rows: Pixels) -> str:
    """At most six rows. Of each colour the signs up to the last that paints."""
    present, place = np.unique(rows, return_inverse=True)
    signs = np.zeros((len(present), rows.shape[1]), np.uint8)
    columns = np.arange(rows.shape[1])
    for bit, colour in enumerate(place.reshape(rows.shape)):
        signs[colour, columns] |= 1 << bit
    starts = np.diff(signs, axis=1, prepend=1 << HIGH) != 0
    colour, start = np.nonzero(starts)
    length = np.diff(start, append=0)
    length[length <= 0] += rows.shape[1]  # the next run is another colour's
    empty = (signs[starts] == 0) & (start + length == rows.shape[1])  # to the end
    painted = {number: [f"#{number}"] for number in present.tolist()}
    told = (present[colour], signs[starts], length)
    runs = zip(*(each[~empty].tolist() for each in told), strict=True)
    for number, sign, times in runs:
        letter = chr(NOTHING + sign)
        painted[number].append(letter * times if times < REPEATED else f"!{times}{letter}")
    return "$".join("".join(signs) for signs in painted.values())
