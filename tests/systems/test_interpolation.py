"""What the authors of document 003 give to their filter: a fix at every row of the wheels."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recordings import speeds

from ekfsim.figures.track import Track, rmse
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.variants.listing import ListingEKF
from ekfsim.localization import filter_of, play
from ekfsim.models.layout import SPEED_POSE
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.records import Control, Entry, Reading
from ekfsim.systems.interpolation import stretched

FIX = Position(1.0, 1.0)
LOG = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "mower_gnss"
LOGGED = pytest.mark.skipif(not LOG.is_dir(), reason="the recorded logs are not here")


def controls(entries):
    return [entry for entry in entries if isinstance(entry.given, Control)]


def readings(entries):
    return [entry for entry in entries if isinstance(entry.given, Reading)]


def test_each_motion_input_is_followed_by_a_fix_stretched_over_the_rows_by_number():
    log = speeds(40, 7).log.entries
    made = list(stretched(log))
    assert [entry.index for entry in made] == list(range(81))
    assert [type(entry.given) for entry in made] == [type(None)] + [Control, Reading] * 40
    assert [entry.given.u.tolist() for entry in controls(made)] == [
        entry.given.u.tolist() for entry in controls(log)
    ]
    z = np.array([entry.given.z for entry in readings(log)])
    for axis in (0, 1):
        # row 0 is the start
        wanted = np.interp(np.linspace(0, len(z) - 1, 41), np.arange(len(z)), z[:, axis])[1:]
        assert [entry.given.z[axis] for entry in readings(made)] == pytest.approx(wanted, abs=1e-12)
    assert {entry.given.name for entry in readings(made)} == {"gnss"}


def test_no_stamp_of_a_fix_counts():
    log = speeds(40, 7).log.entries
    late = [
        replace(entry, t=entry.t + 0.03) if isinstance(entry.given, Reading) else entry
        for entry in log
    ]
    one, other = (
        [entry.given.z for entry in readings(stretched(entries))] for entries in (log, late)
    )
    assert np.array_equal(one, other)


def test_of_several_runs_each_has_its_own_fixes():
    log = [
        Entry(e.index, Reading(FIX, np.stack([e.given.z, -e.given.z])), t=e.t)
        if isinstance(e.given, Reading)
        else e
        for e in speeds(20, 5).log.entries
    ]
    z = np.array([entry.given.z for entry in readings(stretched(log))])
    assert z.shape == (20, 2, 2)
    assert np.array_equal(z[:, 0], -z[:, 1])


def test_readings_of_other_instruments_stay_where_they_are():
    log = speeds(12, 3).log.entries
    north = Reading(Yaw(0.0, 0.1), np.array([0.5]), "compass")
    seen = [*log[:9], Entry(0, north, t=log[8].t), *log[9:]]
    made = list(stretched(seen))
    assert [entry.index for entry in made] == list(range(len(made)))
    assert [entry.given for entry in made if entry.given is north] == [north]
    fixes = [
        [e.given.z.tolist() for e in readings(stretched(entries)) if e.given.name == "gnss"]
        for entries in (log, seen)
    ]
    assert fixes[0] == fixes[1]
    assert len(fixes[0]) == 12


@pytest.mark.parametrize("fixes", ["0.003,1,2\n0.011,3,4", "-5,1,2\n70,3,4", "0.01,1,2\n0.01,3,4"])
def test_a_log_has_all_its_fixes_whatever_their_stamps_and_no_row_cut_in_two(tmp_path, fixes):
    (tmp_path / "wheelspeeds-1.csv").write_text(
        "time,vr,vl\n0,0,0\n0.005,1,1\n0.01,1,1\n0.01,1,2\n0.02,1,1\n"
    )
    (tmp_path / "gnss-1.csv").write_text(f"t,x,y\n{fixes}\n")
    made = list(stretched(load_scene("gnss_log", log=tmp_path, reading="coded").log.entries))
    assert [entry.given.u[2] for entry in controls(made)] == pytest.approx([0.005, 0.005, 0, 0.01])
    assert [entry.given.z.tolist() for entry in readings(made)] == [
        [1.5, 2.5],
        [2, 3],
        [2.5, 3.5],
        [3, 4],
    ]


def test_without_a_fix_there_is_nothing_to_interpolate():
    log = [entry for entry in speeds(5, 1).log.entries if not isinstance(entry.given, Reading)]
    assert [type(entry.given) for entry in stretched(log)] == [type(None)] + [Control] * 5


def test_the_coded_reading_corrects_at_every_row_by_the_state_before_the_prediction():
    scene = replace(speeds(30, 10), reading="coded")
    steps = list(play(scene))
    assert isinstance(filter_of(scene), ListingEKF)
    corrected = [k for k, step in enumerate(steps) if step.correction is not None]
    assert len(corrected) == 30
    for k in corrected:
        assert steps[k].correction.predicted == pytest.approx(steps[k - 1].prior.mean[2:])
    assert len([step for step in play(speeds(30, 10)) if step.correction is not None]) == 3


@LOGGED
def test_the_coded_reading_equals_an_independent_rewrite_of_the_authors_program():
    """On the first 26 s of their data. Over the whole run they have 1.5006, 1.3674, 2.0302 m and
    0.7549 rad."""
    wheels, fixes, truth = (
        np.genfromtxt(LOG / f"{name}-1.csv", delimiter=",", skip_header=1)
        for name in ("wheelspeeds", "gnss", "groundtruth")
    )
    rows, given = len(wheels), len(fixes)
    place = np.linspace(0, given - 1, rows)
    fix = np.column_stack(
        [np.interp(place, np.arange(given), fixes[:, column]) for column in (1, 2)]
    )
    H, identity = np.eye(4)[2:], np.eye(4)
    X, P, states = np.array([0.0, truth[0, 3], *truth[0, 1:3]]), np.eye(4), []
    for i in range(rows):
        if i:
            V, dt, (_, φ, x, y) = wheels[i, 1:].mean(), wheels[i, 0] - wheels[i - 1, 0], X
            F = np.array([[0.5, 0, 0, 0], [0, 1, 0, 0], [np.cos(φ), -V * np.sin(φ), 1, 0],
                          [np.sin(φ), V * np.cos(φ), 0, 1]])  # fmt: skip
            P = F @ P @ F.T + identity
            K = P @ H.T @ np.linalg.inv(H @ P @ H.T + np.eye(2))
            predicted = np.array([V, φ + 0.27 * V * dt, x + V * np.cos(φ), y + V * np.sin(φ)])
            X, P = predicted + K @ (fix[i] - [x, y]), (identity - K @ H) @ P
        states.append(X)
    track = Track.of(play(load_scene("gnss_log", log=LOG, reading="coded")), SPEED_POSE)
    assert track.pose[:, :2] == pytest.approx(np.array(states)[:, 2:], abs=1e-8)
    off = np.array(states)[:, 2:] - truth[:, 1:3]
    assert np.sqrt(np.mean(off**2, axis=0)) == pytest.approx([1.4495, 1.1881], abs=1e-4)
    assert rmse(track.position_error) == pytest.approx(
        np.sqrt(np.mean(np.sum(off**2, axis=1))), abs=1e-9
    )
