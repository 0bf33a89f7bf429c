"""A world of ir-sim: what stands where, as ir-sim itself has it."""

import math

import numpy as np
import pytest
import shapely
from PIL import Image
from shapely.affinity import rotate, translate

from ekfsim.errors import InputError
from ekfsim.files.maps.making import make
from ekfsim.files.maps.plan import Asked
from ekfsim.files.maps.reading import plan_in, read_plan
from ekfsim.files.scenes.load import load_world

HEAD = "world: {height: 8, width: 12, offset: [-1, 2]}\n"
WORLD = (
    HEAD
    + """
robot:
  - {kinematics: {name: diff}, state: [1, 5, 1.5707963267948966], shape: {name: circle}}
  - {kinematics: {name: diff}, state: [4, 5, 0]}
obstacle:
  - {shape: {name: circle, radius: 1.0, center: [0.5, 0]}, state: [5, 5, 0.7]}
  - {shape: {name: rectangle, length: 1.5, width: 1.2}, state: [8, 6, 1], name: crate}
  - {shape: {name: linestring, vertices: [[5, 5], [4, 3], [1, 6]]}, state: [0, 0, 0]}
  - shape: {name: polygon, vertices: [[0, 0], [1, 0], [1, 1]]}
  - number: 2
    distribution: {name: manual}
    shape: [{name: rectangle, length: 1, width: 0.5, wheelbase: 0.6}]
    state: [[2, 3, 0.3], [9, 8, -0.4]]
  - {shape: {name: compound, parts: [{name: rectangle, length: 1, width: 1},
     {name: circle, radius: 0.2, pose: [1, 0, 0]}]}, state: [6, 8, 0.5]}
  - {shape: {name: circle}, state: [0, 0, 0], unobstructed: true}
  - {shape: {name: circle}, distribution: {name: random}, number: 3}
  - {shape: {name: polygon, random_shape: true}}
  - {shape: {name: circle}, kinematics: {name: omni}}
"""
)


@pytest.fixture
def plan_of(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def made(text, **asked):
        (tmp_path / "place.yaml").write_text(text)
        return read_plan(tmp_path / "place.yaml", "place.yaml", Asked(**asked))[0]

    return made


def box(length, width, pose, behind=None):
    """A rectangle at a pose, its origin `behind` m from its rear, or in its middle."""
    x0 = -length / 2 if behind is None else -behind
    x, y, θ = pose
    plain = shapely.box(x0, -width / 2, x0 + length, width / 2)
    return translate(rotate(plain, θ, origin=(0, 0), use_radians=True), x, y)


def test_what_stands_where(plan_of):
    plan = plan_of(WORLD)
    np.testing.assert_allclose(plan.boundary, [[-1, 2], [11, 2], [11, 10], [-1, 10]])
    assert plan.start == pytest.approx((1, 5, 90))
    circle, knob = plan.circles
    assert (circle.x, circle.y, circle.radius) == pytest.approx(
        (5 + 0.5 * math.cos(0.7), 5 + 0.5 * math.sin(0.7), 1.0)
    )
    assert (knob.x, knob.y) == pytest.approx((6 + math.cos(0.5), 8 + math.sin(0.5)))
    expected = {
        "crate": box(1.5, 1.2, (8, 6, 1)),
        "obstacle 4": shapely.Polygon([(1, 1), (2, 1), (2, 2)]),  # no state is (1, 1, 0)
        "obstacle 5 1": box(1, 0.5, (2, 3, 0.3), behind=0.2),
        "obstacle 5 2": box(1, 0.5, (9, 8, -0.4), behind=0.2),
        "obstacle 6": box(1, 1, (6, 8, 0.5)),
    }
    assert [one.name for one in plan.outlines] == list(expected)
    for one in plan.outlines:
        assert shapely.Polygon(one.points).symmetric_difference(expected[one.name]).area < 1e-12
    np.testing.assert_allclose(plan.lines[0].points, [[5, 5], [4, 3], [1, 6]])
    assert plan.told == (
        "of 2 robots the first is the world's",
        "the edge of the ir-sim world became a wall, which its beams do not see (otherwise: "
        "--boundary none)",
        "'obstacle 7' is unobstructed, so that nothing meets it: left out",
        "'obstacle 8' is placed at random: left out",
        "'obstacle 9' has a random shape: left out",
        "'obstacle 10' moves: left out",
    )
    assert plan_of(WORLD, boundary="none").boundary is None


def test_it_is_what_irsim_makes_of_it(plan_of, tmp_path):
    irsim = pytest.importorskip("irsim")
    flat = WORLD[: WORLD.index("  - {shape: {name: circle}, distribution")]
    plan = plan_of(flat)
    env = irsim.make(str(tmp_path / "place.yaml"), display=False, disable_all_plot=True)
    theirs = [one.geometry for one in env.obstacle_list if not one.unobstructed]
    ours = [
        *(shapely.Polygon(one.points) for one in plan.outlines),
        *(shapely.Point(one.x, one.y).buffer(one.radius) for one in plan.circles),
    ]
    theirs_area = shapely.union_all([one for one in theirs if one.area])
    difference = shapely.union_all(ours).symmetric_difference(theirs_area).area
    assert difference < 0.003  # m²: their circles are turned polygons of 64 corners


def test_the_cells_of_its_picture(plan_of, tmp_path):
    """Dark is a wall, the picture's top is the world's; the file's obstacles stay."""
    pixels = np.full((80, 120), 255, np.uint8)
    pixels[0:20, 30:40] = 0
    Image.fromarray(pixels).save(tmp_path / "cave.png")
    text = HEAD.replace("}", ", obstacle_map: cave.png}") + (
        "obstacle: [{shape: {name: rectangle}, state: [0, 3, 0]}]\n"
    )
    plan = plan_of(text)
    assert len(plan.outlines) == 2
    assert (
        shapely.Polygon(plan.outlines[1].points).symmetric_difference(shapely.box(2, 8, 3, 10)).area
        < 1e-9
    )
    wide = plan_of(text.replace("width: 12", "width: 24"))
    assert len(wide.outlines) == 1
    assert wide.told[-1] == (
        "the cells of cave.png are no squares, 0.2 by 0.1 m: its walls are left out"
    )


def test_mistakes_have_their_places(plan_of):
    text = HEAD + (
        "obstacle:\n"
        "  - {shape: {name: circle, radius: big}, state: [1, x]}\n"
        "  - {shape: {name: polygon, vertices: [[1], [2, 2]]}}\n"
    )
    with pytest.raises(InputError) as refused:
        plan_of(text)
    assert [str(one) for one in refused.value.mistakes] == [
        "place.yaml:3:49: state: 2 numbers belong here; write e.g. [1, 2]",
        "place.yaml:3:36: radius: a number belongs here; write e.g. 0.2",
        "place.yaml:4:40: vertices: 2 numbers belong here; write e.g. [1, 2]",
    ]


def test_a_world_of_it_passes_its_checks_and_is_told_apart_from_ours(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = HEAD + "obstacle: [{shape: {name: rectangle}, state: [4, 5, 0.5]}]\n"
    (tmp_path / "place.yaml").write_text(text)
    made = make(tmp_path / "place.yaml", "place.yaml", Asked(), None)
    world = load_world(made.text)
    segments = shapely.LinearRing(box(1, 1, (4, 5, 0.5)).exterior)
    beam = shapely.LineString([(0, 5), (11, 5)])
    assert world.map.walls.first(0.0, 5.0, 0.0)[0] == pytest.approx(
        shapely.Point(0, 5).distance(beam.intersection(segments)), abs=1e-9
    )
    assert plan_in(tmp_path / "place.yaml", "place.yaml") == (
        "place.yaml: this is an ir-sim world; `ekfsim world place.yaml -o world.yaml` makes a "
        "world of it"
    )
    (tmp_path / "own.yaml").write_text(made.text)
    assert plan_in(tmp_path / "own.yaml", "own.yaml") is None
