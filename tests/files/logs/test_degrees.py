"""Angles in a log of the classroom are read back as they were, to the last bit."""

import math

import numpy as np
import pytest

from ekfsim.files.logs.degrees import degrees, radians


def test_every_angle_comes_back():
    """Some have no float of degrees that leads to them: the plain way loses their last bit."""
    random = np.random.default_rng(3)
    angles = [
        *random.uniform(-7, 7, 3000).tolist(),
        *(10.0 ** random.uniform(-20, 3, 500)).tolist(),
    ]
    assert [radians(degrees(angle)) for angle in angles] == angles
    assert any(math.radians(math.degrees(angle)) != angle for angle in angles)


@pytest.mark.parametrize("written", [0, 90, -86, 12.5, 0.1, -179.9, 33.3, 1e-9, 720])
def test_what_a_person_wrote_is_written_so_again(written):
    assert float(degrees(math.radians(written))) == written
    assert len(degrees(math.radians(written))) <= max(6, len(str(written)))
    assert radians(str(written)) == pytest.approx(float(np.radians(written)), rel=1e-15)
