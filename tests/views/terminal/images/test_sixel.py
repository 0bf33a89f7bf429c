import numpy as np
import pytest
from sixels import decoded

from ekfsim.views.terminal.images.sixel import encoded, quantized


@pytest.mark.parametrize("shape", [(1, 1), (6, 5), (7, 40), (23, 9)])
@pytest.mark.parametrize("colours", [1, 2, 16])
def test_a_picture_is_read_back_pixel_by_pixel(shape, colours):
    numbers = np.random.default_rng(1).integers(0, colours, shape).astype(np.uint8)
    numbers[:, : shape[1] // 2] = 0  # something to repeat
    palette = np.random.default_rng(2).integers(0, 256, (colours, 3)).astype(np.uint8)
    assert np.array_equal(decoded(encoded(numbers, palette)), np.rint(palette / 2.55)[numbers])


def test_runs_are_told_once():
    told = encoded(np.zeros((6, 500), np.uint8), np.zeros((1, 3), np.uint8))
    assert told.endswith("#0;2;0;0;0#0!500~\x1b\\")


def test_few_colours_stay_what_they_are():
    rgb = np.random.default_rng(3).choice(np.array([0, 90, 213], np.uint8), (12, 12, 1))
    rgb = np.repeat(rgb, 3, axis=2)
    numbers, palette = quantized(rgb, 16)
    assert np.array_equal(palette[numbers], rgb)
