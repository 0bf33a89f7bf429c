"""No beam is called ambiguous for the sake of a place where the robot cannot be; Shapely tells
where that is."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene, load_world
from ekfsim.geometry.angles import wrap
from ekfsim.localization import play
from ekfsim.models.sensors.laser import Laser

WALLED = [
    name
    for name, path in packaged("worlds").items()
    if (told := load_world(path).told.map).boundary is not None and told.obstacles
]


def possible(floor, poses):
    """Whether a robot can stand at poses (n, 3): in the room, or on its wall, and in no
    obstacle."""
    points = shapely.points(poses[:, :2])
    inside = [shapely.Polygon(o.points).contains(points) for o in floor.obstacles]
    indoors = floor.boundary is None or shapely.Polygon(floor.boundary).intersects(points)
    return indoors & ~np.any([*inside, np.zeros(len(poses), bool)], axis=0)


@pytest.mark.parametrize("name", WALLED)
def test_no_alarm_rests_on_an_impossible_pose(name):
    floor, random = load_world(packaged("worlds")[name]).told.map, np.random.default_rng(7)
    x = random.uniform(
        (*floor.boundary.min(axis=0), -np.pi), (*floor.boundary.max(axis=0), np.pi), (300, 3)
    )
    x = x[possible(floor, x)]
    A = random.normal(size=(len(x), 3, 3)) * [[[0.2], [0.2], [0.1]]]
    seen = Laser(floor.walls, 0.5, 0.01).sight(x, A @ A.mT)
    assert possible(floor, seen.probes.reshape(-1, 3)).all()
    assert 0.1 < seen.ambiguous.mean() < 1
    λ, V = np.linalg.eigh(A @ A.mT)
    ends = x[:, None] + np.concatenate([arms := (V * 3 * np.sqrt(λ)[:, None, :]).mT, -arms], axis=1)
    kept = possible(floor, ends.reshape(-1, 3)).reshape(-1, 6)
    assert seen.probes[kept] == pytest.approx(ends[kept])  # who can stand there is asked there
    assert np.linalg.norm(seen.probes - ends, axis=-1)[~kept].min() > 0
    share = (seen.probes - x[:, None]) / np.where(ends == x[:, None], 1, ends - x[:, None])
    assert np.ptp(share, axis=-1).max() < 1e-6  # place and heading go back together


@pytest.mark.parametrize(
    "name", ["tour", "diverge-12-close-to-the-wall", "diverge-03c-slip", "diverge-01-wrong-wall"]
)
def test_whole_runs(name):
    scene, asked, alarms = replace(load_scene(name), guard="skip"), 0, 0
    for step in play(scene, np.arange(64)):
        if step.sighting is not None:
            places = step.sighting.probes[step.sighting.astray]
            assert possible(scene.world.told.map, places).all()
            asked, alarms = asked + 64, alarms + int(step.sighting.ambiguous.sum())
    assert alarms < 0.1 * asked


def test_leaving_out_ambiguous_beams_of_the_tour_costs_little():
    tour = load_scene("tour")
    error = {}
    for guard in ("warn", "skip"):
        *_, last = play(replace(tour, guard=guard), np.arange(2000))
        away = last.posterior.mean - last.entry.truth
        error[guard] = np.hypot(away[:, 0], away[:, 1]).mean()
        assert np.abs(wrap(away[:, 2])).mean() < 0.05
    assert error["skip"] - error["warn"] < 0.005
