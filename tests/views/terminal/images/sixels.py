"""Sixels read back into pixels, as a terminal reads them."""

import re

import numpy as np

IMAGE = re.compile(r'\x1bP0;1;0q"1;1;(\d+);(\d+)([^\x1b]*)\x1b\\')
COLOUR = re.compile(r"#(\d+);2;(\d+);(\d+);(\d+)")
PAINTED = re.compile(
    r"#(?P<colour>\d+)|!(?P<times>\d+)(?P<again>[?-~])|(?P<sign>[?-~])|(?P<go>[$-])"
)


def decoded(text):
    """The one image in a text : (h, w, 3) in percent, nan where nothing paints."""
    width, height, painted = IMAGE.search(text).groups()
    shares = {n: tuple(map(int, rgb)) for n, *rgb in COLOUR.findall(painted)}
    painted = COLOUR.sub("", painted)
    assert PAINTED.sub("", painted) == ""
    pixels = np.full((int(height) + 5, int(width), 3), np.nan)
    x = y = 0
    for one in PAINTED.finditer(painted):
        if one["go"]:
            x, y = 0, y + 6 * (one["go"] == "-")
        elif one["colour"]:
            colour = shares[one["colour"]]
        else:
            times, sign = int(one["times"] or 1), ord(one["again"] or one["sign"]) - 63
            for bit in range(6):
                if sign >> bit & 1:
                    assert x + times <= int(width)
                    assert np.isnan(pixels[y + bit, x : x + times]).all()  # no pixel twice
                    pixels[y + bit, x : x + times] = colour
            x += times
    assert np.isnan(pixels[int(height) :]).all()
    return pixels[: int(height)]
