import base64
import re

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from scenes import scene
from sixels import decoded

from ekfsim.commands import Move, Sense
from ekfsim.localization import play
from ekfsim.views.picture.artists import BLUE, GREEN, TRUTH
from ekfsim.views.picture.extent import scope
from ekfsim.views.picture.frames import Frame
from ekfsim.views.picture.look import STANDARD, Paper
from ekfsim.views.playback.playback import together
from ekfsim.views.terminal.images.asking import Means, Protocol
from ekfsim.views.terminal.images.images import Box, Images
from ekfsim.views.terminal.images.sixel import quantized

PLACE = scene(Move(1.0, 0.5), Sense(0.2))
EXTENT = scope.of(PLACE, play(PLACE))
VIEWS = list(together(play(PLACE), [], (PLACE.filter,)))
BOX = Box(2, 3, 64, 30)
KITTY = re.compile(r"\x1b_G([^;]*)(?:;([^\x1b]*))?\x1b\\")


def images(protocol, cell=(8, 16), **more):
    return Images(PLACE, EXTENT, STANDARD, Means(protocol, cell, **more))


@pytest.fixture(scope="module")
def frame():
    return Frame(PLACE, EXTENT, STANDARD, Paper((512, 480), 67))


def told(text):
    """What kitty is told, each as its keys and its payload."""
    return [
        (dict(key.split("=") for key in keys.split(",")), payload or "")
        for keys, payload in KITTY.findall(text)
    ]


def test_kitty_gets_the_frame_in_chunks_over_the_cells_of_the_box(frame):
    text = images(Protocol.KITTY).draw(VIEWS[2], BOX)
    chunks = told(text)
    assert text.startswith("\x1b[3;4H\x1b_G")
    assert KITTY.sub("", text) == "\x1b[3;4H"
    assert base64.b64decode("".join(payload for _, payload in chunks)) == frame.png(VIEWS[2])
    head = chunks[0][0]
    assert (head["a"], head["f"], head["c"], head["r"]) == ("T", "100", "64", "30")
    assert (head["C"], head["q"]) == ("1", "2")  # the cursor stays, and no answer comes
    assert [keys["m"] for keys, _ in chunks] == ["1"] * (len(chunks) - 1) + ["0"]
    assert all(set(keys) == {"m"} for keys, _ in chunks[1:])
    assert len(chunks) > 2
    assert max(len(payload) for _, payload in chunks) <= 4096
    assert all(len(payload) % 4 == 0 for _, payload in chunks)


def test_of_kitty_the_last_image_goes_when_the_next_one_is_there():
    drawing = images(Protocol.KITTY)
    standing = set()
    for view in VIEWS:
        shown = told(drawing.draw(view, BOX))
        new, gone = shown[0][0]["i"], [keys["i"] for keys, _ in shown if keys.get("a") == "d"]
        assert new not in standing
        assert set(gone) == standing
        standing = {new}
    assert [keys["i"] for keys, _ in told(drawing.removed())] == [new]
    assert drawing.removed() == ""


def test_iterm2_gets_the_frame_over_the_cells_of_the_box(frame):
    text = images(Protocol.ITERM2).draw(VIEWS[1], BOX)
    head, payload = re.fullmatch(r"\x1b\[3;4H\x1b]1337;File=([^:]*):(.*)\a", text).groups()
    png = frame.png(VIEWS[1])
    assert base64.b64decode(payload) == png
    assert {"inline=1", "width=64", "height=30", f"size={len(png)}"} <= set(head.split(";"))


@pytest.mark.parametrize("colours", [16, 256])
def test_sixels_are_the_frame_in_few_colours(frame, colours):
    text = images(Protocol.SIXEL, colours=colours).draw(VIEWS[2], BOX)
    numbers, palette = quantized(frame.rgb(VIEWS[2]), colours)
    assert text.startswith("\x1b[3;4H")
    assert np.array_equal(decoded(text), np.rint(palette / 2.55)[numbers])
    pixels = frame.rgb(VIEWS[2]).astype(float)
    away = np.abs(palette[numbers] - pixels).max(axis=2)
    assert (away > 40).mean() < 0.001
    for ink in BLUE, GREEN, TRUTH:
        there = (pixels == np.rint(255 * np.array(to_rgb(ink)))).all(axis=2)
        assert there.any()
        assert away[there].max() <= (25 if colours == 16 else 0)


def test_sixels_stay_within_their_cells_and_within_what_the_terminal_takes():
    text = images(Protocol.SIXEL, (8, 17), largest=(500, 1000)).draw(VIEWS[0], Box(0, 0, 64, 29))
    assert decoded(text).shape == (492, 500, 3)  # of 29 · 17 = 493 rows what whole bands fill


def test_what_cannot_be_read_does_not_fit():
    assert images(Protocol.KITTY).fits(Box(0, 0, 79, 23))
    assert images(Protocol.KITTY, (20, 40)).fits(Box(0, 0, 79, 23))  # however fine the pixels
    assert not images(Protocol.KITTY, (20, 40)).fits(Box(0, 0, 39, 14))
    assert not images(Protocol.SIXEL).fits(Box(0, 0, 20, 60))
