"""What is drawn again with kept strokes is what matplotlib would draw."""

import numpy as np
import pytest
from scenes import DESK, rich, scene

from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.localization import play
from ekfsim.views.picture import replay
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame
from ekfsim.views.picture.look import Look
from ekfsim.views.playback.playback import views

SIGMA = (0.1, 0.1, 0.1)


@pytest.mark.parametrize(
    "run",
    [
        rich(),
        # beams that are taken and refused, with ends in the air and in a wall: styles change
        scene(
            *(Sense(0.3), Kidnap(1.0, 1.0, 0.0), Sense(0.3), Move(0.5, 0.0), Sense(0.3)),
            sigma=SIGMA,
            obstacles=(DESK,),
            gate=0.9,
        ),
    ],
)
def test_pixels_are_those_of_matplotlib(run, monkeypatch):
    frame = Frame(run, scopes.of(run, play(run)), Look(conditional=True))
    every = list(views(play(run)))
    shown = [frame.rgb(view) for view in [*every, *every]][len(every) :]
    assert len({pixels.tobytes() for pixels in shown}) == len(every)
    monkeypatch.setattr(replay, "_repeatable", lambda artist: False)
    for view, pixels in zip(every, shown, strict=True):
        assert np.array_equal(frame.rgb(view), pixels)
