"""The mower's files against the MATLAB listing of document 000, transcribed here line by line."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from log_worlds import lay, read, steps_of, world

from ekfsim.errors import InputError, UsageError
from ekfsim.files.logs.writing.written import write_log
from ekfsim.files.scenes.load import load_scene
from ekfsim.simulation import simulate
from ekfsim.systems.drive import Course

MAP = np.array([[0, 4.0, 1.0], [1, 2.0, -3.0], [2, -3.0, 0.5]])


def small_log(first=1000.0):
    """A mower that turns across ±π, and sees markers now and then: two at once, one in a gap, none
    for a while."""
    rng = np.random.default_rng(5)
    rows = 260
    poses = rng.normal(0, 1, (rows, 21))
    t = first + 0.01 * np.arange(rows)
    t[150:] += 0.5
    poses[:, 2], poses[:, 3] = t, 0.01 + rng.normal(0, 1e-3, rows)
    poses[:, 4], poses[:, 8] = 0.011 + rng.normal(0, 1e-3, rows), 0.9 + rng.normal(0, 0.05, rows)
    heading = 2.5 + np.cumsum(poses[:, 8]) * 0.01
    poses[:, 18:21] = np.column_stack(
        [np.cumsum(0.01 * np.cos(heading)), np.cumsum(0.01 * np.sin(heading)), heading]
    )
    angles = [
        [first - 0.004, 0],
        *([t[20] - 0.004, marker] for marker in (1, 0)),
        [t[60] - 0.006, 2],
        [t[149] + 0.2, 1],
        *([t[200] - 0.001, marker] for marker in (0, 1, 2)),
    ]
    seen = []
    for stamp, marker in angles:
        x, y, θ = poses[np.argmin(np.abs(t - stamp)), 18:21]
        dx, dy = MAP[marker, 1:] - (x, y)
        α = math.remainder(math.atan2(dy, dx) - θ + rng.normal(0, 0.05), 2 * math.pi)
        seen.append(
            [stamp, marker, α, -math.atan(0.226 / math.hypot(dx, dy)) + rng.normal(0, 0.006)]
        )
    return poses, np.array(seen)


def short_log():
    """The first 60 rows, with three markers."""
    poses, angles = small_log()
    return poses[:60], angles[:3]


def write(folder, poses, angles, separator=" "):
    text = {
        name: "".join(separator.join(f"{value:.17g}" for value in row) + "\n" for row in rows)
        for name, rows in (("poselog", poses), ("003-angles", angles), ("map", MAP))
    }
    return lay(folder, **{f"marker-001-{name}.txt": lines for name, lines in text.items()})


def listing(poses, angles, stale):
    """Appendix A with bgn = 1; unless `stale`, as the text has it: with initHead from row 1, xM yM
    Phi refreshed

    before each marker, and each marker at the first row that is not before it.
    """

    def within(angle):  # mod(angle, sign(angle)*2*pi)
        return math.fmod(angle, 2 * math.pi)

    b, dT, h, var_in = 1.41, 0.01, 0.226, 1e-4
    Q, R = np.diag([1e-4, 1e-4, 7.62e-5]), np.diag([0.048**2, 0.006**2])
    headings = [within(angle) for angle in poses[:, 20]]
    x = np.array([*poses[0, 18:20], within(np.mean(headings[1:100])) if stale else headings[0]])
    P, states = Q.copy(), []
    first = np.array([np.argmax(poses[:, 2] >= stamp) for stamp in angles[:, 0]])
    for number, row in enumerate(poses):
        left, right, fog, t = row[3], row[4], row[8], row[2]
        xM, yM, Phi = x
        dD = (left + right) / 2
        argument = Phi + fog / 2 * dT
        x = np.array(
            [xM + dD * math.cos(argument), yM + dD * math.sin(argument), within(Phi + fog * dT)]
        )
        A = np.eye(3)
        A[0, 2], A[1, 2] = -dD * math.sin(argument), dD * math.cos(argument)
        c, s = 0.5 * math.cos(argument), 0.5 * math.sin(argument)
        ds, dc = dD / 2 / b * math.sin(argument), dD / 2 / b * math.cos(argument)
        B = np.array([[c + ds, c - ds], [s - dc, s + dc], [-1 / b, 1 / b]])
        P = A @ P @ A.T + var_in * B @ B.T + Q
        window = (angles[:, 0] >= t - 0.01) & (angles[:, 0] <= t)
        for _, marker, α, η in angles[window if stale else first == number]:
            if not stale:
                xM, yM, Phi = x
            xB, yB = MAP[int(marker), 1:]
            square = (xB - xM) ** 2 + (yB - yM) ** 2
            d = math.sqrt(square)
            H = np.array(
                [
                    [-(-yB + yM) / square, -(xB - xM) / square, -1],
                    [
                        -h * (xB - xM) / (d * (h**2 + square)),
                        -h * (yB - yM) / (d * (h**2 + square)),
                        0,
                    ],
                ]
            )
            hx = np.array([math.atan2(yB - yM, xB - xM) - Phi, -math.atan(h / d)])
            if abs(hx[0]) > math.pi:
                hx[0] -= math.copysign(2 * math.pi, hx[0])
            K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
            innovation = np.array([α, η]) - hx
            if abs(innovation[0]) > math.pi:
                innovation[0] -= math.copysign(2 * math.pi, innovation[0])
            x = x + K @ innovation
            P = (np.eye(3) - K @ H) @ P @ (np.eye(3) - K @ H).T + K @ R @ K.T
        states.append((t, x, P))
    return states


def ours(folder, reading):
    steps, _, warnings = steps_of("mower", folder, reading=reading)
    return {step.entry.t: step for step in steps[1:]}, steps, warnings


@pytest.mark.parametrize("reading", ["corrected", "coded"])
@pytest.mark.parametrize("separator", [" ", ",", "\t", " , "])
def test_our_states_are_those_of_the_listing(tmp_path, reading, separator):
    poses, angles = small_log()
    last, _, warnings = ours(write(tmp_path / "log", poses, angles, separator), reading)
    for t, x, P in listing(poses, angles, stale=reading == "coded"):
        e = last[t].posterior.mean - x
        e[2] = math.remainder(e[2], 2 * math.pi)
        assert np.abs(e).max() < 1e-9
        np.testing.assert_allclose(last[t].posterior.covariance, P, rtol=1e-9, atol=1e-15)
    gap = {  # of the marker in it
        "coded": "the stamp 1001.69 lies in no row's last 0.01 s: left out",
        "corrected": "the stamp 1001.69 is 0.1 s or more before any row: taken there all the "
        "same; the longest wait is "
        "0.31 s",
    }
    assert [told.partition("angles.txt:5: ")[2] for told in warnings if "angles.txt" in told] == [
        gap[reading]
    ]


def test_every_row_is_a_time_update_and_then_come_its_markers(tmp_path):
    poses, angles = small_log()
    _, steps, _ = ours(write(tmp_path / "log", poses, angles), "corrected")
    assert sum(step.prediction is not None for step in steps) == len(poses)
    seen = [step.entry for step in steps if step.correction is not None]
    assert [entry.given.name for entry in seen] == [f"marker {n}" for n in (0, 1, 0, 2, 1, 0, 1, 2)]
    assert [entry.t for entry in seen] == [
        float(poses[row, 2]) for row in (0, 20, 20, 60, 150, 200, 200, 200)
    ]
    assert [step.entry.index for step in steps] == list(range(len(steps)))
    first = steps[0]
    np.testing.assert_allclose(first.posterior.mean, poses[0, 18:21])
    np.testing.assert_allclose(first.posterior.covariance, np.diag([1e-4, 1e-4, 7.62e-5]))
    for step, row in zip([s for s in steps if s.prediction is not None], poses, strict=True):
        np.testing.assert_allclose(step.entry.truth[:2], row[18:20])
        assert math.remainder(step.entry.truth[2] - row[20], 2 * math.pi) == pytest.approx(
            0, abs=1e-12
        )
        np.testing.assert_array_equal(step.entry.given.u, [row[3], row[4], row[8], 0.01])


def test_a_reading_is_used_once_where_two_rows_share_a_stamp(tmp_path):
    poses, angles = short_log()
    poses[20:22, 2] = poses[20, 2]
    _, steps, warnings = ours(write(tmp_path / "log", poses, angles[1:3]), "corrected")
    assert sum(step.correction is not None for step in steps) == 2
    assert sum(step.prediction is not None for step in steps) == 60
    assert any(":22: the time 1000.2 is that of the row above, too" in told for told in warnings)
    _, steps, warnings = ours(tmp_path / "log", "coded")
    assert [s.entry.given.name for s in steps if s.correction is not None] == [
        "marker 1",
        "marker 0",
    ] * 2
    assert sum("and so do 1 more: used at each, by the listing" in told for told in warnings) == 1


@pytest.fixture(scope="module")
def shared_stamps(tmp_path_factory):
    """12 000 rows of a simulated mower's log, in groups of one to four that bear the stamp of the
    last of them."""
    scene = load_scene("mower")
    course = scene.drive.course(0.01)
    scene = replace(
        scene,
        drive=Cut(Course(course.speed[:12_000], course.turn_rate[:12_000], course.held)),
        seed=5,
    )
    folder = tmp_path_factory.mktemp("mower") / "log"
    write_log(scene, simulate(scene), folder, force=False, format="own")
    poses, angles, marks = (
        np.loadtxt(folder / f"marker-001-{name}.txt") for name in ("poselog", "003-angles", "map")
    )
    sizes = np.random.default_rng(3).integers(1, 5, 12_000)
    ends = np.minimum(np.cumsum(sizes) - 1, 11_999)
    poses[:, 2] = poses[ends[np.searchsorted(ends, np.arange(12_000))], 2]
    np.savetxt(folder / "marker-001-poselog.txt", poses, fmt="%.17g")
    return folder, poses, angles, marks


class Cut(NamedTuple):
    """A drive that is a course already."""

    way: Course

    def course(self, dt):
        return self.way


def of_the_listing(poses, angles, marks):
    """The loop of the listing once more, from its print, with nothing but what its states need :
    (rows, 3)"""
    x = np.array(
        [
            poses[0, 18],
            poses[0, 19],
            np.fmod(np.fmod(poses[1:100, 20], 2 * np.pi).mean(), 2 * np.pi),
        ]
    )
    Q, R = np.diag([1e-4, 1e-4, 7.62e-5]), np.diag([0.048**2, 0.006**2])
    P, b, h, states, used = Q, 1.41, 0.226, [], 0
    for stamp, ΔL, ΔR, ω in poses[:, [2, 3, 4, 8]]:
        (X, Y, Φ), D, a = x, (ΔL + ΔR) / 2, x[2] + ω / 2 * 0.01
        x = np.array([X + D * np.cos(a), Y + D * np.sin(a), np.fmod(Φ + ω * 0.01, 2 * np.pi)])
        A = np.array([[1, 0, -D * np.sin(a)], [0, 1, D * np.cos(a)], [0, 0, 1]])
        along, across = (
            np.array([np.cos(a), np.sin(a)]) / 2,
            D / 2 / b * np.array([np.sin(a), -np.cos(a)]),
        )
        B = np.vstack([np.column_stack([along + across, along - across]), [-1 / b, 1 / b]])
        P = A @ P @ A.T + 1e-4 * B @ B.T + Q
        for entry in np.flatnonzero((angles[:, 0] >= stamp - 0.01) & (angles[:, 0] <= stamp)):
            used += 1
            dx, dy = marks[int(angles[entry, 1]), 1:] - (X, Y)
            d2 = dx**2 + dy**2
            d = np.sqrt(d2)
            slope = -h / (d * (h**2 + d2))
            H = np.array([[dy / d2, -dx / d2, -1], [slope * dx, slope * dy, 0]])
            ν = angles[entry, 2:4] - (
                np.angle(np.exp(1j * (np.arctan2(dy, dx) - Φ))),
                -np.arctan(h / d),
            )
            ν[0] = np.angle(np.exp(1j * ν[0]))
            K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
            x, I_KH = x + K @ ν, np.eye(3) - K @ H
            P = I_KH @ P @ I_KH.T + K @ R @ K.T
        states.append(x)
    return np.array(states), used


def after_each_row(steps):
    """(rows, 3) the state after a row's time update and all its markers"""
    states = []
    for step in steps[1:]:
        if step.prediction is not None:
            states.append(step.posterior.mean)
        states[-1] = step.posterior.mean
    return np.array(states)


def test_on_shared_stamps_the_listing_uses_a_reading_at_every_row_that_bears_them(shared_stamps):
    folder, poses, angles, marks = shared_stamps
    _, steps, warnings = ours(folder, "coded")
    theirs, used = of_the_listing(poses, angles, marks)
    assert sum(step.correction is not None for step in steps) == used != len(angles)
    e = after_each_row(steps) - theirs
    e[:, 2] = np.remainder(e[:, 2] + math.pi, 2 * math.pi) - math.pi
    assert np.abs(e).max() < 1e-6
    assert sum("used at each, by the listing" in told for told in warnings) == 1


def test_on_shared_stamps_the_text_uses_every_reading_once_at_the_first_row_that_is_not_before_it(
    shared_stamps,
):
    folder, poses, angles, _ = shared_stamps
    _, steps, warnings = ours(folder, "corrected")
    row, used = -1, []
    for step in steps[1:]:
        row += step.prediction is not None
        if step.correction is not None:
            used.append((row, step.entry.given.z.tolist()))
    assert len(used) == len(angles) > 100
    for (row, z), (stamp, _, *seen) in zip(used, angles, strict=True):
        assert z == seen
        assert poses[row, 2] >= stamp
        assert row == 0 or poses[row - 1, 2] < stamp
    assert not any("angles.txt" in told for told in warnings)


def test_what_is_not_of_the_time_of_the_poselog_is_left_out_and_told(tmp_path):
    poses, angles = short_log()
    angles = angles[[0, 0, 1, 1]].copy()
    angles[:, 0] = [990, 999.95, 1000.196, 1000.7]
    for reading, used, told in (
        ("corrected", 2, "the stamp 990 is not of the time of"),
        ("coded", 1, "the stamp 990 lies in no row's last 0.01 s, and so do 2 more: left out"),
    ):
        _, steps, warnings = ours(write(tmp_path / "log", poses, angles), reading)
        assert sum(step.correction is not None for step in steps) == used
        assert sum(told in warning for warning in warnings) == 1


def test_markers_out_of_order_are_put_in_order_and_told(tmp_path):
    poses, angles = short_log()
    _, steps, warnings = ours(write(tmp_path / "log", poses, angles[::-1]), "corrected")
    assert [step.entry.given.name for step in steps if step.correction is not None] == [
        "marker 0",
        "marker 0",
        "marker 1",
    ]
    assert [told.partition("angles.txt")[2] for told in warnings if "angles.txt" in told] == [
        ":3: the time 999.996 lies before that of the row above: the rows are put in order of time"
    ]


def test_a_stamp_that_goes_back_is_refused_at_its_line(tmp_path):
    poses, angles = short_log()
    poses[[30, 31], 2] = poses[[31, 30], 2]
    with pytest.raises(InputError) as refused:
        read("mower", write(tmp_path / "log", poses, angles[:3]))
    assert str(refused.value) == (
        f"{tmp_path}/log/marker-001-poselog.txt:32:1: column 3: the stamp 1000.3 lies before that "
        f"of the row above, "
        "1000.31; every row is a time update: put the rows in their order"
    )


def test_markers_that_the_map_has_not_are_left_out_and_told(tmp_path):
    poses, angles = short_log()
    angles = angles[:3].copy()
    angles[:, 1] = [0, 7, 1.5]
    _, steps, warnings = ours(write(tmp_path / "log", poses, angles), "corrected")
    assert sum(step.correction is not None for step in steps) == 1
    assert any(
        ":2: the map has no row 7, nor those of 1 more rows: left out" in told for told in warnings
    )


def test_a_map_whose_ids_are_not_its_rows(tmp_path):
    poses, angles = short_log()
    folder = write(tmp_path / "log", poses, angles[:3])
    (folder / "marker-001-map.txt").write_text(
        "".join(f"{i + 11} {x} {y}\n" for i, x, y in MAP.tolist())
    )
    _, steps, warnings = ours(folder, "corrected")
    assert [step.entry.given.name for step in steps if step.correction] == [
        "marker 11",
        "marker 12",
        "marker 11",
    ]
    assert any("the angles name a marker by its row, from 0" in told for told in warnings)
    (folder / "marker-001-map.txt").write_text("".join(f"5 {x} {y}\n" for _, x, y in MAP.tolist()))
    _, steps, warnings = ours(folder, "corrected")
    assert [step.entry.given.name for step in steps if step.correction] == [
        "marker 0",
        "marker 1",
        "marker 0",
    ]
    assert any("the markers go by their rows" in told for told in warnings)


def test_files_of_other_numbers_are_found_and_a_missing_one_is_told(tmp_path):
    poses, angles = short_log()
    folder = write(tmp_path / "log", poses, angles[:3])
    for name in ("poselog", "003-angles", "map"):
        (folder / f"marker-001-{name}.txt").rename(folder / f"day2-{name}.txt")
    assert len(read("mower", folder).log.entries) == 1 + 60 + 3
    (folder / "day2-map.txt").unlink()
    with pytest.raises(UsageError) as refused:
        read("mower", folder)
    assert str(refused.value) == (
        f"{folder}: no file 'marker-001-map.txt' or '*map.txt' in it; it would hold the map of "
        "the markers; found day2-003-angles.txt, day2-poselog.txt"
    )


def test_a_log_without_markers_is_dead_reckoning(tmp_path):
    poses, angles = short_log()
    folder = write(tmp_path / "log", poses, angles[:0])
    assert len(read("mower", folder).log.entries) == 1 + 60


def test_a_log_of_another_robot_is_refused(tmp_path):
    poses, angles = short_log()
    with pytest.raises(
        UsageError,
        match="format mower belongs to a world with system: mower; 'test' has system: gnss",
    ):
        read("mower", write(tmp_path / "log", poses, angles), world("gnss"))
