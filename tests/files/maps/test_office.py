"""A plan that is known, drawn in pixels as a robot's map of it is, turned, ragged and with specks,
comes out of the import as it was within the tolerance, and is as good to localize in."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely
from ros_maps import write
from shapely.affinity import rotate

from ekfsim.files.maps.making import make
from ekfsim.files.maps.plan import Asked
from ekfsim.files.scenes.load import read_world

sys.path.append(str(Path(__file__).parents[2] / "cli"))
from program import ekfsim

SIDE, TOLERANCE, TURNED = 0.05, 0.1, 7.0  # m, m, degrees
WALLS = [  # x, y of two corners each, m: two offices and a hall, 0.15 m thick, with two doors
    (0, 0, 12, 0.15), (0, 8.85, 12, 9), (0, 0, 0.15, 9), (11.85, 0, 12, 9),
    (0, 4, 2.4, 4.15), (3.4, 4, 8.2, 4.15), (9.2, 4, 12, 4.15), (6, 4.15, 6.15, 9),
]  # fmt: skip
COLUMN = (9, 6.5, 9.4, 6.9)
NOISE = """\
noise: {executionDstSigmaRatio: 0.05, executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: 0.02,
        odometryAngSigmaRatio: 0.02, rangeSigmaRatio: 0.01}
"""
WAY = """
commands:
  - sense: {angle: 90}
  - sense: {angle: -90}
  - sense: {angle: 180}
  - move: {distance: 2.3, angle: 0}
  - sense: {angle: 90}
  - sense: {angle: -90}
  - move: {distance: 1, angle: 0}
  - sense: {angle: 90}
  - sense: {angle: -90}
  - move: {distance: 0.5, angle: 180}
  - sense: {angle: 90}
  - sense: {angle: -90}
  - sense: {angle: 0}
"""


def turned(shape):
    return rotate(shape, TURNED, origin=(0, 0))


WALLED = shapely.union_all([shapely.box(*corners) for corners in (*WALLS, COLUMN)])
SOLID, INSIDE = turned(WALLED), turned(shapely.box(0, 0, 12, 9))
FREE = turned(shapely.box(0, 0, 12, 9).difference(WALLED))
START = (*np.round(turned(shapely.Point(2, 2)).coords[0], 3).tolist(), TURNED)


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """The plan that was made of the picture, and the world of it."""
    folder = tmp_path_factory.mktemp("office")
    rng = np.random.default_rng(5)
    low, high = np.array(INSIDE.bounds[:2]) - 0.5, np.array(INSIDE.bounds[2:]) + 0.5
    columns, rows = np.ceil((high - low) / SIDE).astype(int)
    x = low[0] + (np.arange(columns) + 0.5) * SIDE
    y = low[1] + (np.arange(rows) + 0.5)[::-1] * SIDE
    centres = shapely.points(*np.meshgrid(x, y))
    free = shapely.contains(FREE, centres)
    solid = shapely.contains(SOLID, centres)
    near = shapely.distance(SOLID, centres)
    ragged = free & (near < SIDE) & (rng.random(free.shape) < 0.15)
    specks = free & (near > 0.3) & (rng.random(free.shape) < 0.0005)
    pixels = np.where(free, 254, 205)
    pixels[solid | ragged | specks] = 0
    path = write(folder, pixels, origin=[*low.tolist(), 0])
    made = make(path, str(path), Asked(start=START), None)
    (folder / "world.yaml").write_text(made.text)
    return made.plan, read_world(folder / "world.yaml").get(), folder


def test_walls_are_where_they_were(imported):
    plan, _, _ = imported
    free = shapely.Polygon(plan.boundary, [one.points for one in plan.outlines])
    assert free.is_valid
    drawn, true = free.boundary, FREE.boundary
    assert shapely.hausdorff_distance(drawn, true, densify=0.1) < TOLERANCE + SIDE
    assert shapely.hausdorff_distance(true, drawn, densify=0.1) < TOLERANCE + SIDE
    assert len(plan.outlines) == 1  # the column; specks are left out, which is told
    assert any("left out" in line for line in plan.told)


def test_a_wall_is_one_wall_and_parts_beside_a_door_lie_on_one_line(imported):
    """Of stairs there would be hundreds. The plan has 8 lines of the outer walls and of both sides
    of those between, 2 · 4 of doors' jambs, 4 of the column."""
    plan, world, _ = imported
    assert len(plan.boundary) < 40
    lengths = np.hypot(*np.diff(world.map.walls.segments, axis=1)[:, 0].T)
    long = lengths > 0.5
    assert len(set(world.map.walls.line[long].tolist())) <= 8 + 2


def test_beams_end_where_they_did(imported):
    _, world, _ = imported
    rng = np.random.default_rng(6)
    places = rng.uniform(INSIDE.bounds[:2], INSIDE.bounds[2:], (400, 2))
    places = places[shapely.contains(FREE.buffer(-0.3), shapely.points(places))]
    heading = rng.uniform(-np.pi, np.pi, len(places))
    met = world.map.walls.cast(places, heading).range
    d = np.stack([np.cos(heading), np.sin(heading)], -1)
    ends = shapely.points(places + met[:, None] * d)
    assert shapely.distance(FREE.boundary, ends).max() < TOLERANCE + SIDE
    beams = shapely.linestrings(np.stack([places, places + 30 * d], 1))
    true = shapely.distance(shapely.points(places), shapely.intersection(beams, FREE.boundary))
    away = np.abs(met - true)
    assert np.median(away) < SIDE / 2
    assert np.mean(away < 2 * (TOLERANCE + SIDE)) > 0.97  # but those that just pass a corner


def test_a_robot_is_as_seldom_lost_as_in_the_plan_drawn_by_hand(imported, monkeypatch):
    _, _, folder = imported
    monkeypatch.chdir(folder)
    rings = [np.round(ring.coords[:-1], 6).tolist() for ring in (FREE.exterior, *FREE.interiors)]
    x, y, theta = START
    start = f"start: {{x: {x}, y: {y}, theta: {theta}, sigma: {{x: 0.05, y: 0.05, theta: 2}}}}\n"
    things = "".join(f"  - {{name: column, points: {ring}}}\n" for ring in rings[1:])
    Path("hand.yaml").write_text(
        f"name: hand\nboundary: {rings[0]}\nobstacles:\n{things}{start}{NOISE}"
    )
    text = Path("world.yaml").read_text()
    before, _, after = text.partition("start: ")
    Path("pixels.yaml").write_text(before + start + after.partition("\n")[2])
    lost = {}
    for name in ("hand", "pixels"):
        Path(f"go-{name}.yaml").write_text(f"world: {name}.yaml{WAY}")
        told = ekfsim("study", f"go-{name}.yaml", "--runs", "1000")
        assert told.status == 0, told.err
        lost[name] = float(re.search(r"([\d.]+) % \[.*\] are lost", told.out)[1])
    assert lost["hand"] <= 2
    assert lost["pixels"] <= 3
