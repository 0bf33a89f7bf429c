import math

import numpy as np
import pytest

from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly

MARKER = MarkerAngles(4.0, 3.0, 0.226, 0.048, 0.006)


def test_a_marker_by_hand():
    """From the origin, 0.3 rad to the left of east: 5 m away, at atan2(3, 4)."""
    z, H, R = MARKER.linearize(np.array([0.0, 0.0, 0.3]))
    assert z == pytest.approx([math.atan2(3, 4) - 0.3, -math.atan(0.226 / 5)])
    slope = 0.226 / (5 * (0.226**2 + 25))
    np.testing.assert_allclose(H, [[3 / 25, -4 / 25, -1], [-slope * 4, -slope * 3, 0]], atol=1e-15)
    assert np.array_equal(R, np.diag([0.048**2, 0.006**2]))


def test_a_marker_is_lower_the_nearer_it_is():
    far, near = MARKER.h(np.array([-1.0, 3.0, 0.0])), MARKER.h(np.array([3.0, 3.0, 0.0]))
    assert near[1] < far[1] < 0


@pytest.mark.parametrize("position", [(5.0, 3.0), (3.0, 3.0), (4.0, 5.0), (4.0, 1.0)])
def test_all_four_quadrants(position):
    x = np.array([*position, 0.0])
    α = MARKER.h(x)[0]
    assert [math.cos(α), math.sin(α)] == pytest.approx(
        np.array([4 - position[0], 3 - position[1]]) / math.dist(position, (4, 3)), abs=1e-12
    )
    assert -math.pi < α <= math.pi


def test_above_the_marker_it_is_straight_down():
    assert MARKER.h(np.array([4.0, 3.0, 1.0]))[1] == -math.pi / 2


def test_range_and_bearing_are_range_only_and_bearing_only():
    both, r, β = (
        RangeBearing(4.0, 3.0, 0.3, 0.02),
        RangeOnly(4.0, 3.0, 0.3),
        BearingOnly(4.0, 3.0, 0.02),
    )
    x = np.random.default_rng(1).uniform(-3, 3, (8, 3))
    h, H, R = both.linearize(x)
    for row, single in enumerate((r, β)):
        one = single.linearize(x)
        assert h[:, row] == pytest.approx(one[0][:, 0])
        assert H[:, row] == pytest.approx(one[1][:, 0])
        assert R[:, row, row] == pytest.approx(one[2][:, 0, 0])


def test_far_away_and_very_near_are_finite():
    """Readers let no such number through, but a diverging filter may make them."""
    for x in ([1e200, -1e200, 0.0], [4.0, 3.0 + 2e-9, 0.0]):
        for sensor in (MARKER, RangeBearing(4.0, 3.0, 0.3, 0.02)):
            for single, batch in zip(
                sensor.linearize(np.array(x)), sensor.linearize(np.array([x])), strict=True
            ):
                assert np.isfinite(single).all()
                np.testing.assert_allclose(batch[0], single, rtol=1e-12)
