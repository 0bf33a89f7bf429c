"""What the authors of document 003 give to their filter: a fix at every row of the wheels."""

from dataclasses import replace

import numpy as np
import pytest
from recordings import speeds

from ekfsim.filters.listing import ListingEKF
from ekfsim.localization import filter_of, play
from ekfsim.models.position import Position
from ekfsim.records import Control, Entry, Reading
from ekfsim.simulation.interpolation import interpolated

FIX = Position(1.0, 1.0)


def controls(entries):
    return [entry for entry in entries if isinstance(entry.given, Control)]


def readings(entries):
    return [entry for entry in entries if isinstance(entry.given, Reading)]


def test_each_motion_input_is_followed_by_a_fix_on_the_straight_line_between_the_recorded_ones():
    log = speeds(40, 7).log.entries
    made = list(interpolated(log))
    assert [entry.index for entry in made] == list(range(81))
    assert [type(entry.given) for entry in made] == [type(None)] + [Control, Reading] * 40
    assert [entry.given.u.tolist() for entry in controls(made)] == [entry.given.u.tolist() for entry in controls(log)]
    t, z = [entry.t for entry in readings(log)], np.array([entry.given.z for entry in readings(log)])
    for axis in (0, 1):
        wanted = np.interp([entry.t for entry in readings(made)], t, z[:, axis])  # it holds the first and the last
        assert [entry.given.z[axis] for entry in readings(made)] == pytest.approx(wanted, abs=1e-12)
    assert {entry.given.name for entry in readings(made)} == {"gnss"}


def test_of_several_runs_each_has_its_own_fixes():
    log = [
        Entry(e.index, Reading(FIX, np.stack([e.given.z, -e.given.z])), t=e.t) if isinstance(e.given, Reading) else e
        for e in speeds(20, 5).log.entries
    ]
    z = np.array([entry.given.z for entry in readings(interpolated(log))])
    assert z.shape == (20, 2, 2)
    assert np.array_equal(z[:, 0], -z[:, 1])


def test_without_a_fix_there_is_nothing_to_interpolate():
    log = [entry for entry in speeds(5, 1).log.entries if not isinstance(entry.given, Reading)]
    assert [type(entry.given) for entry in interpolated(log)] == [type(None)] + [Control] * 5


def test_the_coded_reading_corrects_at_every_row_by_the_state_before_the_prediction():
    scene = replace(speeds(30, 10), reading="coded")
    steps = list(play(scene))
    assert isinstance(filter_of(scene), ListingEKF)
    corrected = [k for k, step in enumerate(steps) if step.correction is not None]
    assert len(corrected) == 30
    for k in corrected:
        assert steps[k].correction.predicted == pytest.approx(steps[k - 1].prior.mean[2:])
    assert len([step for step in play(speeds(30, 10)) if step.correction is not None]) == 3
