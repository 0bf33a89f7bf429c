"""Drawn plans: what is a wall, where it stands, and that beams meet it there."""

import json
import math

import numpy as np
import pytest
import shapely

from ekfsim.errors import InputError, UsageError
from ekfsim.files.maps.making import make
from ekfsim.files.maps.plan import Asked
from ekfsim.files.maps.reading import read_plan
from ekfsim.files.scenes.load import load_world

FLOOR = [[0, 0], [10, 0], [10, 8], [0, 8], [0, 0]]
PILLAR = [[4, 3], [5, 3], [5, 4], [4, 4], [4, 3]]
DESK = [[7, 6], [8, 6], [8, 7], [7, 7], [7, 6]]


def feature(kind, coordinates, id=None, **properties):
    """A Feature; its geometry is null where it has no coordinates."""
    geometry = None if coordinates is None else {"type": kind, "coordinates": coordinates}
    named = {} if id is None else {"id": id}
    return {"type": "Feature", "properties": properties, "geometry": geometry, **named}


def collection(*features):
    return {"type": "FeatureCollection", "features": list(features)}


@pytest.fixture
def made(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def make_of(what, ending="geojson", **asked):
        text = what if isinstance(what, str) else json.dumps(what)
        (tmp_path / f"plan.{ending}").write_text(text)
        return make(tmp_path / f"plan.{ending}", f"plan.{ending}", Asked(**asked), None)

    return make_of


def told(found):
    return [line.removeprefix("plan.geojson: ") for line in found.told]


def rings(plan):
    return {one.name: (len(one.points), len(one.holes)) for one in plan.outlines}


HALL = collection(
    feature("Polygon", [FLOOR, PILLAR], name="hall"),
    feature("Polygon", [DESK[::-1]], name="desk"),
    feature("MultiPolygon", [[[[1, 6], [2, 6], [2, 7], [1, 6]]]], name="desk"),
    feature("LineString", [[6, 0, 2], [6, 3, 2]], name="panel"),
    feature("MultiLineString", [[[3, 8], [3, 7]], [[2, 8], [2, 7.5]]]),
    feature("Point", [1, 1], id=7),
    feature("Point", [9, 1], radius=0.25, name="bin"),
    feature("Point", [2, 2]),
    feature("Point", None, name="gone"),
)


def test_what_a_geojson_plan_holds(tmp_path):
    (tmp_path / "plan.geojson").write_text(json.dumps(HALL))
    plan, what = read_plan(tmp_path / "plan.geojson", "plan.geojson", Asked(units="m"))
    assert what == "GeoJSON"
    np.testing.assert_array_equal(plan.boundary, FLOOR[:-1])
    assert rings(plan) == {"desk": (3, 0), "hall hole 1": (4, 0)} | {"desk": (3, 0)}
    assert [one.name for one in plan.outlines] == ["desk", "desk", "hall hole 1"]
    np.testing.assert_array_equal(plan.outlines[0].points, DESK[::-1][:-1])
    assert [(one.name, len(one.points)) for one in plan.lines] == [
        ("panel", 2), ("LineString 5", 2), ("LineString 6", 2)
    ]  # fmt: skip
    assert plan.landmarks[0][:] == (7, 1.0, 1.0)
    assert (plan.circles[0].name, plan.circles[0].radius) == ("bin", 0.25)
    assert list(plan.told) == [
        "heights of points: left out",
        "the geometry of the feature 'gone' is null: left out",
        "'Point 9' is a point without an id or a radius: left out",
        "'hall' lies about all else, and is taken for the room's boundary; --boundary none makes "
        "an obstacle of it",
    ]


def test_the_names_of_a_world_differ(made):
    text = made(HALL, units="m").text
    names = [one.name for one in load_world(text).map.obstacles]
    assert names == ["desk", "desk 2", "hall hole 1", "bin"]
    assert text.startswith(
        "# yaml-language-server: $schema=world.schema.json\n# Made of GeoJSON, plan.geojson, by "
    )


@pytest.mark.parametrize("turned", [1, -1])
def test_either_orientation_of_a_ring(made, turned):
    other = made(collection(feature("Polygon", [FLOOR[::turned], PILLAR[::-turned]])), units="m")
    assert shapely.Polygon(other.plan.boundary).equals(shapely.Polygon(FLOOR))
    assert len(other.plan.outlines) == 1


def test_degrees_become_metres_about_the_middle(made):
    """Against the radii of curvature of the WGS 84 ellipsoid."""
    lat = math.radians(50.0)
    a, e2 = 6378137.0, 0.00669437999014
    w = math.sqrt(1 - e2 * math.sin(lat) ** 2)
    north, east = a * (1 - e2) / w**3, a / w * math.cos(lat)
    corners = np.array([[-5, -4], [5, -4], [5, 4], [-5, 4], [-5, -4]])
    ring = [[9 + math.degrees(x / east), 50 + math.degrees(y / north)] for x, y in corners]
    found = made(collection(feature("Polygon", [ring])))
    np.testing.assert_allclose(found.plan.boundary, corners[:-1], atol=1e-5)
    assert told(found)[0] == (
        "longitude and latitude became metres about (9.0000000, 50.0000000): x is east, y is true "
        "north (otherwise: --units m)"
    )


@pytest.mark.parametrize(
    ("ring", "wrong"),
    [
        (FLOOR, "read as longitude and latitude the plan is 1418 km across; --units m says that"),
        ([[x + 500, y] for x, y in FLOOR], "510, 8 is no longitude and latitude; --units m says"),
    ],
)
def test_metres_are_asked_for_and_not_guessed(made, ring, wrong):
    with pytest.raises(UsageError) as refused:
        made(collection(feature("Polygon", [ring])))
    assert str(refused.value).startswith(f"plan.geojson: {wrong}")


def test_another_coordinate_system_is_not_taken_for_degrees(made):
    named = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
    with pytest.raises(InputError) as refused:
        made({**collection(feature("Polygon", [FLOOR])), "crs": named})
    assert "crs: the coordinates are of urn:ogc:def:crs:EPSG::25832; where they are metres" in str(
        refused.value
    )
    assert (
        made({**collection(feature("Polygon", [FLOOR])), "crs": named}, units="m").plan.boundary
        is not None
    )


@pytest.mark.parametrize(
    ("what", "wrong"),
    [
        (feature("Polygon", [FLOOR[:-1]]),
         "geometry.coordinates[0]: the ring is not closed: it ends at [0, 8]; repeat its first "
         "point at its end, [0, 0]"),
        (feature("Polygon", [FLOOR[:2]]), "geometry.coordinates[0]: 2 points are too few; write"),
        (feature("Polygon", [[[0, 0], [1, "x"], [1, 1], [0, 0]]]),
         "geometry.coordinates[0][1]: '[1, 'x']' is no point; write [longitude, latitude]"),
        (feature("Circle", [1, 2]), "geometry: 'Circle' is no geometry; known: Point, "),
        (collection({"type": "Polygon"}), "features[0]: this is no Feature; write"),
        ({"type": "FeatureCollection"}, "'features' is missing; it is the list of what is drawn"),
    ],
)  # fmt: skip
def test_mistakes_of_geojson_have_a_place(made, what, wrong):
    with pytest.raises(InputError) as refused:
        made(what, units="m")
    assert wrong in str(refused.value)


def test_all_mistakes_at_once_with_line_and_column(made):
    text = (
        '{"type": "FeatureCollection", "features": [\n'
        '\t{"type": "Feature", "properties": {}, "geometry":\n'
        '\t\t{"type": "LineString", "coordinates": [[0, 0]]}},\n'
        '\t{"type": "Feature", "properties": {}, "geometry":\n'
        '\t\t{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1]]]}}\n'
        "]}\n"
    )
    with pytest.raises(InputError) as refused:
        made(text, units="m")
    assert [str(one).split(": ")[0] for one in refused.value.mistakes] == [
        "plan.geojson:3:41",
        "plan.geojson:5:39",
    ]


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ('{"type": "Point", \n "coordinates": [1, 2}', "plan.geojson:2:22: this is no JSON: "),
        ('{"type": "Point", "coordinates": [1, NaN]}', "NaN is no number in JSON"),
        ("[" * 100_000, "plan.geojson:1:"),
        ('{"type": "Topology"}', "plan.geojson: this is no plan that is known here"),
    ],
)
def test_what_is_no_geojson_is_told(made, text, wrong):
    with pytest.raises(UsageError) as refused:
        made(text, units="m")
    assert wrong in str(refused.value)


def test_a_ring_of_walls_keeps_its_hole(made):
    """All else lies in the hole: what the ring encloses is no room, but wall."""
    ring = feature(
        "Polygon", [[[-1, -1], [11, -1], [11, 9], [-1, 9], [-1, -1]], FLOOR], name="ring"
    )
    plan = made(collection(ring, feature("Polygon", [DESK])), units="m").plan
    assert plan.boundary is None
    assert rings(plan)["ring"] == (4, 1)
    alone = made(collection(ring), units="m").plan
    assert rings(alone) == {"ring": (4, 1)}


def test_a_keyhole_is_a_hole(made):
    keyhole = [
        [3, 3],
        [7, 3],
        [7, 7],
        [3, 7],
        [3, 3],
        [4, 4],
        [4, 6],
        [6, 6],
        [6, 4],
        [4, 4],
        [3, 3],
    ]
    plan = made(collection(feature("Polygon", [keyhole])), units="m", boundary="none").plan
    assert [(len(one.points), len(one.holes)) for one in plan.outlines] == [(4, 1)]
    assert shapely.Polygon(plan.outlines[0].points, plan.outlines[0].holes).area == pytest.approx(
        12
    )


def test_rooms_have_walls_about_them_where_they_are_said_to(made):
    rooms = [feature("Polygon", [[[x, 0], [x + 4, 0], [x + 4, 3], [x, 3], [x, 0]]]) for x in (0, 4)]
    with pytest.raises(UsageError, match="can stand nowhere in this plan"):
        made(collection(*rooms), units="m")
    plan = made(collection(*rooms), units="m", outlines="walls").plan
    assert [len(one.points) for one in plan.lines] == [5, 5]


# WKT

TEXT = """# a plan
POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0), (4 3, 5 3,
  5 4, 4 4, 4 3))
SRID=25832;LINESTRING Z (6 0 1, 6 3 1);
GEOMETRYCOLLECTION (POLYGON ((7 6, 8 6, 8 7, 7 7, 7 6)), MULTILINESTRING ((3 8, 3 7), (2 8, 2 7)))
POLYGON EMPTY
POINT (1 1)
"""


def test_what_a_wkt_plan_holds(made):
    found = made(TEXT, "wkt")
    plan = found.plan
    np.testing.assert_array_equal(plan.boundary, FLOOR[:-1])
    assert [one.name for one in plan.outlines] == ["polygon 3", "polygon 1 hole 1"]
    assert [one.name for one in plan.lines] == ["linestring 2", "linestring 3", "linestring 3"]
    assert [line.removeprefix("plan.wkt: ") for line in found.told][:4] == [
        "one of its coordinates is taken for a metre (otherwise: --units degrees)",
        "heights of points: left out",
        "'polygon 4' is empty: left out",
        "'point 5' is a point without an id: left out",
    ]


def test_the_units_of_wkt(made):
    wide = made("POLYGON ((0 0, 1000 0, 1000 800, 0 800, 0 0))", "wkt", units="cm").plan
    np.testing.assert_allclose(wide.boundary, np.array(FLOOR[:-1]), atol=1e-12)
    small = "POLYGON ((9 50, 9.0001 50, 9.0001 50.0001, 9 50))"
    with pytest.raises(UsageError, match=r"the plan is 0\.0001 m across; --units degrees says"):
        made(small, "wkt")
    for text in (f"SRID=4326;{small}", small):
        units = {} if "SRID" in text else {"units": "degrees"}
        assert shapely.Polygon(made(text, "wkt", **units).plan.boundary).area == pytest.approx(
            39.9, abs=0.2
        )


def test_all_that_is_no_geometry_is_told(made):
    with pytest.raises(InputError) as refused:
        made(
            "POLYGON ((0 0, 1 0, 1 1, 0 1))\nLINESTRING (0 0, 1 1)\nPOLYGON ((0 0, 1 x, 1 1))\n"
            "CIRCULARSTRING (0 0, 1 1, 2 0)\nLINE (",
            "wkt",
        )
    assert [one.place.line for one in refused.value.mistakes] == [1, 3, 4, 5]


# beams


@pytest.mark.parametrize(
    ("what", "ending", "asked"),
    [
        (collection(*[f for f in HALL["features"] if f["properties"].get("name") != "bin"]),
         "geojson", {"units": "m"}),
        (TEXT, "wkt", {}),
    ],
    ids=["GeoJSON", "WKT"],
)  # fmt: skip
def test_beams_meet_what_shapely_meets(made, what, ending, asked):
    world = load_world(made(what, ending, **asked).text)
    drawn = [
        shapely.LinearRing(FLOOR), shapely.LinearRing(PILLAR), shapely.LinearRing(DESK),
        shapely.LineString([(6, 0), (6, 3)]), shapely.LineString([(3, 8), (3, 7)]),
    ]  # fmt: skip
    if ending == "geojson":
        drawn += [
            shapely.LineString([(2, 8), (2, 7.5)]),
            shapely.LinearRing([(1, 6), (2, 6), (2, 7)]),
        ]
    else:
        drawn += [shapely.LineString([(2, 8), (2, 7)])]
    walls = shapely.union_all(drawn)
    agree(world, walls, np.random.default_rng(0))


def agree(world, walls, rng, solid=None, count=200, low=(0.2, 0.2), high=(9.8, 7.8)):
    """Whether the world's beams are as long as shapely's from places in a box, not in what is
    solid: the pieces of a ring of walls have cuts inside.
    """
    places = rng.uniform(low, high, (count, 2))
    if solid is not None:
        places = places[~shapely.contains_xy(solid, places)]
    angles = rng.uniform(-np.pi, np.pi, len(places))
    expected = []
    for (x, y), φ in zip(places, angles, strict=True):
        beam = shapely.LineString([(x, y), (x + 50 * np.cos(φ), y + 50 * np.sin(φ))])
        expected.append(shapely.Point(x, y).distance(beam.intersection(walls)))
    found = world.map.walls.cast(places, angles)
    np.testing.assert_allclose(found.range, expected, atol=1e-9)
