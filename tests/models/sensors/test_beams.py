"""The beams of document 001: ultrasonic ranges and infrared intensities."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numerics import jacobian

from ekfsim.diagnostics.ambiguity import sighting
from ekfsim.models.sensors.infrared import COLOURS, InfraredBeam
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.raycast.walls import Walls

WALLS = Walls.of({"boundary": np.array([[0, 0], [4, 0], [4, 4], [0, 4.0]])})
poses = st.tuples(st.floats(0.1, 3.9), st.floats(0.1, 3.9), st.floats(-3.14, 3.14)).map(np.array)
bearings = st.floats(-3.14, 3.14)
BEAMS = {
    "ultrasonic": lambda bearing: UltrasonicBeam(WALLS, bearing, 0.005, 0.01),
    "infrared": lambda bearing: InfraredBeam(WALLS, bearing, 1.0, 1.2, 0.6, 0.05),
}
EVERY = pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)


@EVERY
@given(poses, bearings)
def test_H_equals_central_differences(beam, x, bearing):
    sensor = beam(bearing)
    seen = sighting(sensor, x, np.eye(3) * 1e-10)
    assume(not seen.ambiguous)
    assume(seen.incidence > 0.05)
    h, H, _ = sensor.linearize(x)
    r = Laser(WALLS, bearing, 0.0).h(x)[0]
    assume(min(abs(r - sensor.nearest), abs(r - sensor.farthest)) > 1e-4)
    if np.isnan(h):
        assert not H.any()
    else:
        np.testing.assert_allclose(H, jacobian(sensor.h, x), atol=1e-4, rtol=1e-6)


@EVERY
@pytest.mark.parametrize("axes", [(1,), (30,), (3, 2)])
def test_a_batch_equals_its_runs(beam, axes):
    random, sensor = np.random.default_rng(1), beam(0.3)
    x = random.uniform(0.1, 3.9, (*axes, 3))
    batch = sensor.linearize(x)
    assert [values.shape for values in batch] == [(*axes, 1), (*axes, 1, 3), (*axes, 1, 1)]
    for k in np.ndindex(axes):
        for values, alone in zip(batch, sensor.linearize(x[k]), strict=True):
            np.testing.assert_allclose(values[k], alone, atol=1e-12)


@EVERY
@pytest.mark.parametrize("x", [3.95, 0.5], ids=["too near", "too far"])
def test_out_of_reach_there_is_no_echo(beam, x):
    h, H, R = beam(0.0).linearize(np.array([x, 2.0, 0.0]))
    assert np.isnan(h).all()
    assert np.isnan(R).all()
    assert not H.any()


@EVERY
def test_where_there_are_no_walls_there_is_no_echo(beam):
    h, H, R = type(beam(0))(
        Walls.of({}), *(getattr(beam(0), n) for n in beam(0).__slots__[1:])
    ).linearize(np.zeros(3))
    assert np.isnan([h[0], R[0, 0]]).all()
    assert not H.any()


@EVERY
def test_it_knows_when_it_may_meet_another_wall(beam):
    x, P = np.array([3.0, 3.0, math.pi / 4]), np.eye(3) * 1e-4
    assert sighting(beam(0.0), x, P).ambiguous
    assert not sighting(beam(math.pi / 4), x, P).ambiguous
    assert len(beam(0.0).outputs) == 1
    assert beam(0.0).residual(np.array([2.0]), np.array([0.5])) == [1.5]


def test_an_ultrasonic_reading_is_less_certain_the_further_it_goes():
    sensor = UltrasonicBeam(WALLS, 0.0, 0.005, 0.01)
    for x, r in ((3.0, 1.0), (2.0, 2.0)):
        h, _, R = sensor.linearize(np.array([x, 2.0, 0.0]))
        assert h == pytest.approx([r])
        assert R[0, 0] == pytest.approx((0.005 + 0.01 * r) ** 2)


def test_infrared_by_hand():
    sensor = InfraredBeam(WALLS, 0.0, 0.8, 1.2, 0.5, 0.05)
    intensity, H, R = sensor.linearize(np.array([3.5, 2.0, 0.0]))
    assert intensity == pytest.approx([0.5 * (1.2 - 0.8 * math.log(0.5))])
    assert H[0] == pytest.approx([0.5 * 0.8 / 0.5, 0, 0])  # nearer to the wall it is brighter
    assert pytest.approx(0.05**2) == R[0, 0]


def test_bright_walls_send_back_more_than_dark_ones():
    at = np.array([3.5, 2.0, 0.0])
    seen = {
        name: InfraredBeam(WALLS, 0.0, 1.0, 1.0, colour, 0.05).h(at)[0]
        for name, colour in COLOURS.items()
    }
    assert seen["white"] > seen["grey"] > seen["black"] > 0
    assert all(0 < reflectance <= 1 for reflectance in COLOURS.values())
