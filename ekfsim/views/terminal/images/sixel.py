"""Pixels → sixels: a picture in bands of six rows, each painted colour by colour.

A sign stands for six pixels below each other, the lowest bit for the topmost: 63 more than the bits
that are painted. "!n" repeats the sign after it n times, "$" goes back to the start of the band,
"-" on to the next one. (VT330/VT340 Programmer Reference Manual, volume 2, chapter 14.)
"""

import numpy as np
from PIL import Image

from ekfsim.views.film.gif import palette
from ekfsim.views.film.png import Pixels

HIGH = 6  # rows of a band
NOTHING = 63  # the sign that paints no pixel
REPEATED = 4  # signs from which on to repeat one is shorter


def quantized(rgb: Pixels, colours: int) -> tuple[Pixels, Pixels]:
    """Each pixel's colour by its number : (h, w), and the colours : (n, 3). rgb : (h, w, 3)

    The colours are those of a GIF, or, where there may not be so many, what comes near the
    picture's own.
    """
    image, own = Image.fromarray(rgb), palette()
    if colours >= len(own.getpalette() or ()) // 3:
        matched = image.quantize(palette=own, dither=Image.Dither.NONE)
    else:
        spread = Image.Quantize.MAXCOVERAGE  # the median cut has none for an ink of few pixels
        matched = image.quantize(colours, spread, kmeans=1, dither=Image.Dither.NONE)
    return np.asarray(matched), np.asarray(matched.getpalette(), np.uint8).reshape(-1, 3)


def encoded(numbers: Pixels, colours: Pixels) -> str:
    """A picture that paints every pixel, at the cursor. numbers, colours : as of `quantized`"""
    height, width = numbers.shape
    shares = np.rint(colours / 255 * 100).astype(int).tolist()  # %
    inks = "".join("#{};2;{};{};{}".format(n, *shares[n]) for n in np.unique(numbers))
    bands = (_band(numbers[first : first + HIGH]) for first in range(0, height, HIGH))
    return f'\x1bP0;1;0q"1;1;{width};{height}{inks}{"-".join(bands)}\x1b\\'


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
