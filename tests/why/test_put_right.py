"""What a change leaves as it was: every other draw, and the run itself where nothing is changed."""

from dataclasses import replace

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.commands import Kidnap
from ekfsim.localization import entries_of, play
from ekfsim.records import Control, Reading
from ekfsim.why.changes import beams, faults, maps, singles, told
from ekfsim.why.changes.suspects import suspects_of
from ekfsim.why.trying.replaying import changed, replayed

ROOM = [[0, 0], [8, 0], [8, 6], [0, 6]]
NOISE = {
    "executionDstSigmaRatio": 0.02,
    "executionAngSigmaRatio": 0.02,
    "odometryDstSigmaRatio": 0.01,
    "odometryAngSigmaRatio": 0.02,
    "rangeSigmaRatio": 0.02,
}
WRONG = {  # everything that can be wrong
    "name": "wrong",
    "boundary": ROOM,
    "obstacles": [
        {"name": "desk", "points": [[5, 3], [6, 3], [6, 4], [5, 4]]},
        {"name": "chest", "points": [[1, 4], [2, 4], [2, 5], [1, 5]]},
    ],
    "start": {"x": 2, "y": 1.5, "theta": 0, "sigma": {"x": 0.02, "y": 0.02, "theta": 1}},
    "noise": NOISE,
    "faults": {
        "rangeBias": 0.05,
        "rangeScale": 1.02,
        "shortReturns": 0.2,
        "odometryDstScale": 1.03,
        "odometryAngScale": 1.04,
    },
    "belief": {
        "start": {"x": 2.1, "y": 1.5, "theta": 2},
        "sigma": {"x": 0.01, "y": 0.01, "theta": 0.5},
        "noise": {key: ratio / 2 for key, ratio in NOISE.items()},
        "boundary": [[0, 0], [8.3, 0], [8.3, 6], [0, 6]],
        "obstacles": [
            {"name": "desk", "points": [[5.2, 3], [6.2, 3], [6.2, 4], [5.2, 4]]},
            {"name": "ghost", "points": [[4, 5], [4.5, 5], [4.5, 5.5], [4, 5.5]]},
        ],
    },
}
COMMANDS = [
    {"move": {"distance": 1, "angle": 20}},
    {"sense": {"angle": 0}},
    {"move": {"distance": 1, "angle": -30, "slip": 0.5}},
    {"sense": {"angle": 90}},
    {"sense": {"angle": 90}},
    {"kidnap": {"x": 3, "y": 2, "theta": 40}},
    {"sense": {"angle": -60}},
    {"move": {"distance": 0.5, "angle": 200}},
    {"sense": {"angle": 30}},
]


@pytest.fixture(scope="module")
def scene():
    return load_scene({"commands": COMMANDS, "seed": 5}, WRONG)


def every(scene):
    steps = list(play(scene))
    one_by_one = [*told.ratios(scene.world), *told.starts(scene.world)]
    one_by_one += [*maps.map_changes(scene.world), *faults.slips(scene), *faults.kidnaps(scene)]
    one_by_one += [faults.fault(scene, name) for name in faults.NAMES]
    one_by_one += singles.singles([step.entry for step in steps])
    one_by_one += [beams.AMBIGUOUS, *(suspect.change for suspect in suspects_of(scene, steps))]
    return one_by_one


def test_no_change_replays_the_run_bit_for_bit(scene):
    for one, other in zip(play(scene), replayed(scene, ()), strict=True):
        for a, b in zip(one.posterior, other.posterior, strict=True):
            assert np.array_equal(a, b, equal_nan=True)


def test_everything_that_is_wrong_can_be_put_right_by_itself(scene):
    names = {change.name for change in every(scene)}
    assert names >= {
        *(f"the told {key}" for key in NOISE),
        *("the told start", "the told sigma of the start"),
        *("edge 1 of boundary in the map", "desk in the map", "chest in the map"),
        *("ghost in the map", *faults.NAMES.values(), "the slip of step 3"),
        *("the kidnap of step 6", "all repeated beams but the first", "the ambiguous beams"),
        *("the beam of step 2", "the move of step 8"),
    }
    said = {change.name: change.told for change in every(scene)}
    assert said["edge 1 of boundary in the map"] == "0.3 m off"
    assert said["desk in the map"] == "0.2 m off"
    assert said["chest in the map"] == "missing in the map"
    assert said["ghost in the map"] == "in the map alone"


def normals(scene, entries):
    """The standard normals that each entry of a run was made of, taken out of it again."""
    noise, found, before = scene.world.noise, {}, None
    fault = scene.world.faults
    walls = scene.world.map.walls
    for entry in entries:
        match entry.given:
            case Control(_, u):
                d = entry.truth[:2] - before[:2]
                way = d @ [np.cos(before[2]), np.sin(before[2])] / (1 - entry.command.slip)
                asked = entry.command.distance
                found[entry.index] = [
                    (way - asked) / (noise.execution_distance * abs(asked)),
                    (u[0] - fault.odometry_distance_scale * way)
                    / (noise.odometry_distance * abs(way)),
                ]
            case Reading(sensor, z):
                r, _ = walls.first(*entry.truth[:2], entry.truth[2] + sensor.bearing)
                short = fault.short_returns > 0
                error = z[0] - fault.range_scale * r - fault.range_bias
                if not short or abs(error) < 5 * noise.range * r:
                    found[entry.index] = [error / (noise.range * r)]
        before = entry.truth
    return found


def test_a_change_keeps_every_draw_of_every_other_command(scene):
    base = normals(scene, entries_of(scene))
    for change in every(scene):
        now = changed(scene, (change,))
        found = normals(now, entries_of(now))
        both = base.keys() & found.keys()
        assert len(both) >= 4
        for index in both:
            assert found[index] == pytest.approx(base[index], abs=1e-6), change.name


def test_readings_and_moves_side_by_side_are_each_alone(scene):
    entries = [step.entry for step in play(scene)]
    changes = singles.singles(entries)
    for row, change in enumerate(changes):
        alone = list(change.of_entries(entries))
        for one, many in zip(alone, singles.abreast(entries, changes), strict=True):
            if isinstance(one.given, Reading):
                assert np.array_equal(one.given.z, many.given.z[row], equal_nan=True)
            elif isinstance(one.given, Control):
                assert np.array_equal(one.given.u, many.given.u[row])


def test_a_move_made_exact_leads_the_filter_to_the_truth(scene):
    certain = replace(scene, commands=scene.commands[:1])
    start = next(iter(play(certain))).entry.truth
    *_, last = replayed(certain, (singles.move(1),))
    motion, u = last.entry.given.motion, last.entry.given.u
    assert motion.f(start, u) == pytest.approx(last.entry.truth, abs=1e-12)


def test_a_kidnap_taken_out_leaves_the_robot_where_it_is(scene):
    (change,) = faults.kidnaps(scene)
    entries = list(entries_of(changed(scene, (change,))))
    assert not any(isinstance(entry.command, Kidnap) for entry in entries)
    assert np.array_equal(entries[6].truth, entries[5].truth)


def test_a_leaning_map_is_told_from_a_moved_wall(scene):
    assert not maps.leans(scene.world)
    assert maps.leans(load_scene("diverge-05b-sheared-map").world)


def test_a_beam_held_to_its_wall_is_what_it_measures_without_noise():
    """From the truth, and with the derivatives that central differences find."""
    scene = load_scene("diverge-01-wrong-wall")
    for entry in list(entries_of(scene))[:20]:
        if not isinstance(entry.given, Reading):
            continue
        held = beams.of_its_wall(entry.given.sensor, entry.truth)
        h, H, R = held.linearize(entry.truth)
        assert h == pytest.approx(entry.given.sensor.h(entry.truth), abs=1e-12)
        assert pytest.approx(entry.given.sensor.R(entry.truth), abs=1e-12) == R
        for axis, step in enumerate(np.eye(3) * 1e-6):
            slope = (held.h(entry.truth + step) - held.h(entry.truth - step)) / 2e-6
            assert H[0, axis] == pytest.approx(slope[0], abs=1e-6)
        # however far the estimate is, it is the same line
        away = np.add(entry.truth, [0.3, -0.2, 0.05])
        assert held.h(np.array([away, away])) == pytest.approx(
            np.array([held.h(away), held.h(away)])
        )
