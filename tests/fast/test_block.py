"""A block of compiled code tallies what the readable study does."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import DESK, NOISE, ROOM, ROUND, SILENT, STEP, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import check
from ekfsim.filters.tuning import Tuning
from ekfsim.floor import Map
from ekfsim.study import block as study_block
from ekfsim.study.block import watched
from ekfsim.twins import taking
from ekfsim.world import Faults, Noise

block = pytest.importorskip("ekfsim.fast.compiled.block", exc_type=ImportError)
CLOSE = 1e-7  # relative: runs that are lost make much of what rounding leaves
UNFELT = 1e-14  # m²
LOST = 1e-4  # and of some of them alone more than of all together
LOOKS = tuple(Sense(math.radians(angle)) for angle in range(-180, 180, 45))
ROUNDS = Repeat(2, (Move(2.0, math.pi / 2), Sense(0.3), Sense(-2.0)))
SCENES = {
    "everything that can happen": rich(),
    "everything, with a wide gate": rich(seed=4, gate=0.99, guard="off"),
    "beams that meet nothing": unbounded(),
    "no walls at all": scene(Move(1.0, 0.4), *LOOKS, boundary=None, sigma=(0.1, 0.1, 0.1)),
    "no noise": scene(ROUNDS, *LOOKS, noise=SILENT),
    "no noise but a wrong start": told(
        scene(ROUNDS, *LOOKS, noise=SILENT), start=np.array([1.0, 1.1, math.radians(31)])
    ),
    "a perfect laser": scene(ROUNDS, *LOOKS, noise=replace(NOISE, range=0.0), sigma=(0.1, 0.1, 0)),
    "a sharp laser": scene(ROUNDS, noise=replace(NOISE, range=1e-4), sigma=(0.05, 0, 0.02)),
    "straight on": scene(Repeat(4, (Move(0.5, 0.0), Sense(0.0))), start=(1, 1, 0)),
    "straight on, askew": scene(*(Move(0.5, 0.0) for _ in range(4)), Sense(1.0)),
    "turns alone": scene(*(Move(0.0, 1.0) for _ in range(7)), *LOOKS, sigma=(0.1, 0, 0)),
    "headings at ±π": scene(ROUNDS, *LOOKS, start=(5, 4, math.pi), sigma=(0.1, 0.1, 0.2)),
    "a told heading": told(scene(ROUNDS, start=(2, 2, -math.pi)), sigma=np.array([0, 0, 1.0])),
    "into a wall": scene(Move(30.0, 0.2), Move(-30.0, 1.0), Move(30.0, 0.0), Sense(0.1)),
    "wheels that spin": scene(Move(1.0, 0.5, slip=1.0), ROUNDS, Move(1.0, 0.5, slip=0.5)),
    "through a corner": scene(Sense(math.atan2(7, 9)), Sense(math.atan2(-1, 9)), start=(1, 1, 0)),
    "along a wall": scene(Sense(0.0), Sense(math.pi), Move(0.5, 0.0), start=(5, 0, 0)),
    "scattered": scene(ROUNDS, *LOOKS, sigma=(1.5, 1.5, 2.0), start=(5, 2, 0), obstacles=(ROUND,)),
    "nothing happens": scene(),
    "only words": scene(Say("Nothing."), Kidnap(3.0, 3.0, 2 * math.pi), Say("Nothing more.")),
}
CLASSROOM = {
    name: made
    for name, path in packaged("commands").items()
    if (made := check(path).get()).world.system == "classroom" and made.filter == "ekf"
}


def drawn(seed):
    """A scene by chance: its walls, noise and faults, what the filter is told, what is done."""
    random = np.random.default_rng(seed)

    def some(*values):
        return values[random.integers(len(values))]

    def pillars():
        many = some(0, 3, 40)
        corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        middles = random.uniform([0, 0], [10, 8], (many, 2))
        return tuple(
            replace(DESK, name=f"{n}", points=middle + corners * random.uniform(0.05, 0.3))
            for n, middle in enumerate(middles)
        )

    def noise():
        done, measured = (
            (some(0.0, 0.0001, 0.1), some(0.0, 0.1)),
            (some(0.001, 0.1), some(0.02, 0.1)),
        )
        return Noise(*done, *measured, some(0.02, 0.1))

    def command():
        angle = math.radians(some(0, 90, 180, random.uniform(-200, 200)))
        move = Move(some(0.0, 1.0, -1.0, 6.0), angle, slip=some(0.0, 0.0, 0.3))
        kidnap = Kidnap(*random.uniform(0, 8, 2), angle)
        return some(move, move, Sense(angle), Sense(angle), Sense(angle), Say("."), kidnap)

    walls, start = pillars(), (*random.uniform(1, 7, 2), some(0.0, math.pi, random.uniform(-3, 3)))
    made = scene(
        *(command() for _ in range(25)),
        seed=seed,
        gate=some(None, 0.95),
        start=start,
        sigma=(some(0.0, 0.1, 0.5), some(0.0, 0.1), some(0.0, 0.1)),
        noise=noise(),
        boundary=some(ROOM, ROOM, None),
        obstacles=walls,
        faults=some(Faults(), Faults(0.1, 0.98, 0.3, 1.02, 0.97)),
    )
    otherwise = {"noise": some(made.world.noise, noise()), "sigma": np.array([0.2, 0.2, 0.1])}
    otherwise["map"] = Map(ROOM, some(walls, pillars(), (STEP,)))
    return some(made, told(made, **otherwise))


def verify(made, runs, first=0, tolerance=CLOSE):
    """The tally of compiled code says what that of the text does."""
    with taking("quick"):
        ends, text = (told := watched(made, first, runs)).ends, told.tally()
    with taking("compiled"):
        twin_ends, twin = (told := block.watched(made, first, runs)).ends, told.tally()
    np.testing.assert_array_equal(twin_ends.drawn, ends.drawn)
    np.testing.assert_array_equal(twin_ends.inside, ends.inside)
    np.testing.assert_array_equal(twin_ends.in_cone, ends.in_cone)
    np.testing.assert_array_equal(twin_ends.unsure, ends.unsure)
    np.testing.assert_allclose(twin_ends.position, ends.position, LOST, UNFELT)
    np.testing.assert_allclose(twin_ends.heading, ends.heading, LOST, 1e-9)
    for name, column in text.at._asdict().items():
        same = getattr(twin.at, name)
        assert same.dtype == column.dtype, name
        if column.dtype == np.int64:
            np.testing.assert_array_equal(same, column, name)
        else:
            np.testing.assert_allclose(same, column, tolerance, 1e-20, err_msg=name)
    assert twin.of._replace(nis_sum=0.0) == text.of._replace(nis_sum=0.0)
    assert twin.of.nis_sum == pytest.approx(text.of.nis_sum, rel=tolerance)
    assert twin.worst._replace(nees=0.0) == text.worst._replace(nees=0.0)
    assert twin.worst.nees == pytest.approx(text.worst.nees, rel=tolerance)
    assert (twin.runs, twin.lost_from, twin.spread) == (text.runs, text.lost_from, text.spread)
    np.testing.assert_array_equal(twin.steps, text.steps)
    np.testing.assert_array_equal(twin.times, text.times)


@pytest.mark.parametrize("runs", [1, 63, 64, 1024])
@pytest.mark.parametrize("name", SCENES)
def test_many_runs_are_tallied_as_the_text_has_it(name, runs):
    verify(SCENES[name], runs)


@pytest.mark.parametrize("name", CLASSROOM)
def test_packaged_scenes_are_tallied_as_the_text_has_it(name):
    verify(CLASSROOM[name], 100)


def test_of_a_long_run_some_steps_are_told(monkeypatch):
    monkeypatch.setattr(study_block, "MOST_STEPS", 7)
    verify(SCENES["everything that can happen"], 30)


def test_runs_of_two_blocks_draw_what_each_of_them_does():
    verify(SCENES["everything that can happen"], 40, first=1000)


@pytest.mark.parametrize(
    "otherwise",
    [
        {"filter": "ukf"},
        {"guard": "skip"},
        {"tuning": Tuning(cross_covariances="dropped")},
        {"tuning": Tuning(range_variance="reading")},
    ],
)
def test_what_it_does_not_know_is_left_to_the_text(otherwise):
    assert block.watched(replace(rich(), **otherwise), 0, 5) is None


@pytest.mark.parametrize("seed", range(40))
def test_scenes_by_chance_are_tallied_as_the_text_has_it(seed):
    verify(drawn(seed), 200)


# what a perfect laser leaves of P is rounding, and pdaf makes much of it
@pytest.mark.parametrize("tuning", [Tuning(), Tuning(huber=0.5, clutter=0.4, clutter_density=2)])
@pytest.mark.parametrize("filter", ["huber", "pdaf"])
@pytest.mark.parametrize("name", sorted(SCENES.keys() - {"a perfect laser"}))
def test_filters_that_weigh_their_readings_are_tallied_as_the_text_has_it(name, filter, tuning):
    verify(replace(SCENES[name], filter=filter, tuning=tuning), 100)


@pytest.mark.parametrize("filter", ["huber", "pdaf"])
@pytest.mark.parametrize("seed", range(10))
def test_so_are_they_in_scenes_by_chance(seed, filter):
    verify(replace(drawn(seed), filter=filter), 100)
