"""DXF and SVG: the walls stand where the drawing has them, in metres."""

import math

import numpy as np
import pytest
import shapely
from test_drawings import agree

from ekfsim.errors import UsageError
from ekfsim.files.maps.making import make
from ekfsim.files.maps.plan import Asked
from ekfsim.files.maps.reading import read_plan
from ekfsim.files.scenes.load import load_world

ezdxf = pytest.importorskip("ezdxf")
pytest.importorskip("svgelements")


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def drawn(place, draw, unit=4, **asked):
    """The plan of a DXF; unit : $INSUNITS, 4 is millimetres"""
    document = ezdxf.new(setup=False)
    document.units = unit
    draw(document, document.modelspace())
    document.saveas(place / "plan.dxf")
    return read_plan(place / "plan.dxf", "plan.dxf", Asked(**asked))[0]


def hall(document, space):
    space.add_lwpolyline([(0, 0), (10000, 0), (10000, 8000), (0, 8000)], close=True)
    space.add_line((6000, 0), (6000, 3000), dxfattribs={"layer": "panel"})
    space.add_circle((2000, 6000), 500)
    space.add_text("kitchen")
    desk = document.blocks.new("desk")
    desk.add_lwpolyline([(0, 0), (1000, 0), (1000, 500), (0, 500)], close=True)
    space.add_blockref("desk", (8000, 5000), dxfattribs={"rotation": 90, "xscale": -1})


def test_what_a_dxf_holds(place):
    plan = drawn(place, hall)
    np.testing.assert_allclose(plan.boundary, [[0, 0], [10, 0], [10, 8], [0, 8]])
    assert (plan.circles[0].x, plan.circles[0].y, plan.circles[0].radius) == (2, 6, 0.5)
    np.testing.assert_allclose(plan.lines[0].points, [[6, 0], [6, 3]])
    assert plan.lines[0].name == "panel line"
    desk = shapely.Polygon(plan.outlines[0].points)
    # mirrored in x, then turned by 90 degrees: it lies to the left and below
    assert desk.symmetric_difference(shapely.box(7.5, 4, 8, 5)).area < 1e-12
    assert plan.told[:2] == (
        "one unit of the drawing is 0.001 m ($INSUNITS; otherwise: --units)",
        "1 of TEXT: left out",
    )


@pytest.mark.parametrize(("unit", "metres"), [(1, 0.0254), (2, 0.3048), (5, 0.01), (6, 1.0)])
def test_its_unit_is_its_own(place, unit, metres):
    plan = drawn(place, lambda _, space: space.add_line((1, 2), (4, 2)), unit)
    np.testing.assert_allclose(plan.lines[0].points, metres * np.array([[1, 2], [4, 2]]))


def test_a_dxf_without_a_unit_is_not_guessed(place):
    def line(_, space):
        space.add_line((1, 2), (4, 2))

    with pytest.raises(UsageError, match=r"what its unit is \(\$INSUNITS is 0\); say --units m"):
        drawn(place, line, 0)
    np.testing.assert_allclose(drawn(place, line, 0, units="cm").lines[0].points[1], [0.04, 0.02])


@pytest.mark.parametrize("tolerance", [0.001, 0.1])
def test_arcs_and_bulges_stay_within_the_tolerance(place, tolerance):
    def round_ends(_, space):
        space.add_lwpolyline([(0, 0, 0), (4, 0, 1), (4, 2, 0), (0, 2, 1)], format="xyb", close=True)
        space.add_arc((10, 0), 2, 30, 200)

    plan = drawn(place, round_ends, 6, tolerance=tolerance, boundary="none")
    (outline,) = plan.outlines
    true = shapely.LineString([(0, 1), (4, 1)]).buffer(1, quad_segs=400)
    assert true.exterior.hausdorff_distance(shapely.LinearRing(outline.points)) <= tolerance + 1e-4
    arc = plan.lines[0].points
    assert np.hypot(*(arc - (10, 0)).T) == pytest.approx(2)
    chords = (arc[:-1] + arc[1:]) / 2 - (10, 0)
    assert 2 - np.hypot(*chords.T).min() <= tolerance
    assert len(outline.points) > 4
    assert f"curves became straight lines within {tolerance:g} m (--tolerance)" in plan.told


def test_hidden_layers_are_left_out_and_told(place):
    def two(document, space):
        document.layers.add("old").off()
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": "old"})
        space.add_line((0, 0, 0), (1, 1, 3))

    plan = drawn(place, two, 6)
    assert len(plan.lines) == 1
    assert "1 of the hidden layer 'old': left out" in plan.told
    assert "heights of points: left out" in plan.told


def test_what_is_no_dxf(place):
    (place / "plan.dxf").write_text("no drawing\n")
    with pytest.raises(UsageError, match=r"plan\.dxf: this is no DXF that can be read: "):
        read_plan(place / "plan.dxf", "plan.dxf", Asked())


# SVG

PICTURE = """<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" width="210mm" height="148mm" viewBox="0 0 1000 800">
  <rect id="hall" x="0" y="0" width="1000" height="800"/>
  <g transform="translate(700 100)">
    <rect id="desk" width="100" height="50" transform="rotate(90)"/>
  </g>
  <path id="ring" d="M 100 100 H 300 V 300 H 100 Z M 150 150 v 100 h 100 v -100 z"/>
  <line x1="600" y1="800" x2="600" y2="500"/>
  <polyline id="corner" points="800,700 900,700 900,600"/>
  <text x="1" y="1">kitchen</text>
</svg>
"""


def traced(place, text, **asked):
    (place / "plan.svg").write_text(text)
    return read_plan(place / "plan.svg", "plan.svg", Asked(**asked))[0]


def test_what_an_svg_holds(place):
    plan = traced(place, PICTURE, units="cm")
    np.testing.assert_allclose(plan.boundary, [[0, 8], [10, 8], [10, 0], [0, 0]], atol=1e-12)
    found = {one.name: shapely.Polygon(one.points, one.holes) for one in plan.outlines}
    expected = {
        "desk": shapely.box(6.5, 6, 7, 7),  # y counts upwards, so the turn is clockwise
        "ring": shapely.box(1, 5, 3, 7) - shapely.box(1.5, 5.5, 2.5, 6.5),
    }
    assert set(found) == set(expected)
    for name, shape in found.items():
        assert shape.symmetric_difference(expected[name]).area < 1e-12
    np.testing.assert_allclose(plan.lines[0].points, [[6, 0], [6, 3]], atol=1e-12)
    np.testing.assert_allclose(plan.lines[1].points, [[8, 1], [9, 1], [9, 2]], atol=1e-12)
    assert plan.told[:2] == (
        "one unit of the picture is 0.01 m, its lower edge y = 0",
        "1 of text: left out",
    )


def test_an_svg_does_not_say_how_large_it_is(place):
    with pytest.raises(UsageError, match="a picture does not say how large it is; say what one"):
        traced(place, PICTURE)


def test_circles_stay_circles_and_curves_within_the_tolerance(place):
    text = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10">
      <circle id="pillar" cx="2" cy="3" r="1" transform="rotate(30)"/>
      <ellipse id="table" cx="6" cy="5" rx="2" ry="1"/>
      <path id="bow" d="M 1 9 C 3 5, 6 5, 8 9"/></svg>"""
    plan = traced(place, text, units="m", tolerance=0.002)
    ((name, x, y, radius),) = [(c.name, c.x, c.y, c.radius) for c in plan.circles]
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert (name, x, y, radius) == ("pillar", *map(pytest.approx, (
        2 * c - 3 * s, 10 - (2 * s + 3 * c), 1
    )))  # fmt: skip
    table = plan.outlines[0].points - (6, 5)
    assert np.hypot(table[:, 0] / 2, table[:, 1]) == pytest.approx(1, abs=1e-6)
    assert shapely.Polygon(table).area == pytest.approx(2 * math.pi, rel=0.002)
    t = np.linspace(0, 1, 2001)[:, None]
    bezier = sum(
        weight * np.array(point)
        for weight, point in zip(
            ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3),
            ((1, 1), (3, 5), (6, 5), (8, 1)),
            strict=True,
        )
    )
    line = shapely.LineString(plan.lines[0].points)
    assert shapely.distance(shapely.points(bezier), line).max() <= 0.002


@pytest.mark.parametrize("text", ["<svg", "<svg><rect width='a'/></svg>", "no picture"])
def test_what_is_no_svg(place, text):
    (place / "plan.svg").write_text(text)
    with pytest.raises(UsageError, match=r"plan\.svg: "):
        make(place / "plan.svg", "plan.svg", Asked(units="m"), None)


def test_beams_meet_what_shapely_meets(place):
    traced(place, PICTURE, units="cm")
    world = load_world(make(place / "plan.svg", "plan.svg", Asked(units="cm"), None).text)
    walls = shapely.union_all([
        shapely.box(0, 0, 10, 8).exterior, shapely.box(6.5, 6, 7, 7).exterior,
        shapely.box(1, 5, 3, 7).exterior, shapely.box(1.5, 5.5, 2.5, 6.5).exterior,
        shapely.LineString([(6, 0), (6, 3)]), shapely.LineString([(8, 1), (9, 1), (9, 2)]),
    ])  # fmt: skip
    ring = shapely.box(1, 5, 3, 7) - shapely.box(1.5, 5.5, 2.5, 6.5)
    agree(world, walls, np.random.default_rng(1), ring)
