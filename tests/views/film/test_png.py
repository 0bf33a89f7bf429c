import zlib
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from ekfsim.views.film.png import BAND, SIGNATURE, Encoder


def picture(height=3 * BAND + 7, width=31, seed=1):
    """Random opaque pixels : (h, w, 4)"""
    rgba = np.random.default_rng(seed).integers(0, 256, (height, width, 4), np.uint8)
    rgba[..., 3] = 255
    return rgba


def decoded(png):
    with Image.open(BytesIO(png)) as opened:
        return np.asarray(opened)


@pytest.mark.parametrize(("height", "width"), [(1, 1), (BAND, 2), (BAND + 1, 3), (67, 31)])
def test_a_picture_comes_back_as_it_was(height, width):
    rgba = picture(height, width)
    assert np.array_equal(decoded(Encoder(height, width).encode(rgba, {})), rgba[..., :3])


@pytest.mark.parametrize("row", [0, 1, BAND - 1, BAND, 2 * BAND + 5, 3 * BAND + 6])
def test_whatever_changed_is_written_and_the_bytes_do_not_tell_what_came_before(row):
    one, other = picture(), picture()
    other[row, 5, 1] ^= 1
    encoder = Encoder(*one.shape[:2])
    first = encoder.encode(one, {})
    second = encoder.encode(other, {})
    assert np.array_equal(decoded(second), other[..., :3])
    assert second == Encoder(*one.shape[:2]).encode(other, {})
    assert encoder.encode(one, {}) == first


def test_bands_are_deflated_each_for_itself():
    rgba = picture()
    encoder = Encoder(*rgba.shape[:2])
    encoder.encode(rgba, {})
    kept = dict(encoder.bands)
    rgba[BAND - 1, 0, 0] ^= 1  # the last row of the first, from which the second goes on
    encoder.encode(rgba, {})
    same = [band is kept[rows] for rows, band in encoder.bands.items()]
    assert same == [False, False, True, True]


def test_texts_are_latin_1_where_they_can_be():
    rgba = picture(2, 2)
    png = Encoder(2, 2).encode(rgba, {"World": "Zürich", "View": "日本"})
    assert png.startswith(SIGNATURE)
    assert "Zürich".encode("latin-1") in png
    assert "日本".encode() in png
    with Image.open(BytesIO(png)) as opened:
        opened.load()
        assert opened.text == {"World": "Zürich", "View": "日本"}


def test_the_check_sum_is_that_of_the_whole():
    rgba = picture(2 * BAND, 2)
    png = Encoder(2 * BAND, 2).encode(rgba, {})
    data = png[png.index(b"IDAT") + 4 : png.index(b"IEND") - 8]
    assert len(zlib.decompress(data)) == 2 * BAND * (1 + 3 * 2)  # refuses a wrong one
