"""A ROS map says what is a wall and where it stands."""

import numpy as np
import pytest
import shapely
from PIL import Image
from ros_maps import room, text, write

from ekfsim.errors import InputError, UsageError
from ekfsim.files.maps.making import make
from ekfsim.files.maps.pixels.cells import Reading
from ekfsim.files.maps.pixels.image import Grey, grey_of, pgm
from ekfsim.files.maps.plan import Asked
from ekfsim.files.maps.standing import roomiest

GREYS = [0, 10, 100, 205, 230, 254, 255]
SEEN = ["wall", "wall", "unknown", "unknown", "free", "free", "free"]


def named(reading, grey):
    occupied, free = reading.cells(grey)
    return np.where(occupied, "wall", np.where(free, "free", "unknown")).ravel().tolist()


def plan_of(path, **asked):
    return make(path, str(path), Asked(**asked), None).plan


def bounds(path, **asked):
    return shapely.Polygon(plan_of(path, **asked).boundary).bounds


def test_every_grey_is_read_by_the_thresholds():
    reading = Reading(False, 0.65, 0.196, "trinary")
    assert named(reading, Grey(np.array([GREYS]) / 255)) == SEEN
    assert named(Reading(True, 0.65, 0.196, "trinary"), Grey(1 - np.array([GREYS]) / 255)) == SEEN


@pytest.mark.parametrize("most", [15, 100, 255, 1000, 65535])
def test_pixels_are_parts_of_the_greatest_value_of_the_file(most):
    """The same shades in steps of another size; 60 % is as near as 15 steps come to each."""
    shades = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    values = np.round(np.array(shades) * most).astype(int)
    wide = ">u2" if most > 255 else "u1"
    binary = f"P5 {len(values)} 1 {most}\n".encode() + values.astype(wide).tobytes()
    plain = f"P2\n#a\n{len(values)} #b\n1\n{most}\n{' '.join(map(str, values))}\n".encode()
    for raw in (binary, plain):
        assert pgm(raw, "map.pgm").bright[0] == pytest.approx(shades, abs=1e-12)


def test_pixels_are_those_that_pillow_reads(tmp_path):
    pixels = np.random.default_rng(0).integers(0, 256, (7, 5)).astype(np.uint8)
    for ending in ("pgm", "png", "bmp"):
        Image.fromarray(pixels).save(tmp_path / f"map.{ending}")
        assert grey_of(tmp_path / f"map.{ending}", "map").bright == pytest.approx(pixels / 255)
    colours = np.random.default_rng(1).integers(0, 256, (7, 5, 4)).astype(np.uint8)
    Image.fromarray(colours).save(tmp_path / "map.png")
    assert grey_of(tmp_path / "map.png", "").bright == pytest.approx(
        colours[..., :3].mean(-1) / 255
    )


def test_transparency_is_a_channel_or_leaves_a_cell_unknown(tmp_path):
    """A black pixel that is opaque has the mean (0 + 0 + 0 + 255) / 4, by which it is a wall."""
    black, white = [0, 0, 0, 255], [255, 255, 255, 255]
    pixels = np.array([[black, white, [0, 0, 0, 0], [255, 255, 255, 0]]], np.uint8)
    Image.fromarray(pixels).save(tmp_path / "map.png")
    grey = grey_of(tmp_path / "map.png", "map.png")
    trinary = Reading(False, 0.65, 0.196, "trinary")
    assert trinary.probability(grey)[0] == pytest.approx([0.75, 0, 1, 0.25])
    assert named(Reading(False, 0.65, 0.196, "scale"), grey) == ["wall", "free", *2 * ["unknown"]]


def test_raw_pixels_are_percent():
    grey = Grey(np.array([[0, 10, 50, 65, 66, 100, 101, 255]]) / 255)
    assert named(Reading(False, 0.65, 0.196, "raw"), grey) == [
        *2 * ["free"], *2 * ["unknown"], *2 * ["wall"], *2 * ["unknown"],
    ]  # fmt: skip


def test_walls_are_the_edges_of_pixels(tmp_path):
    """A wall in pixel 7 is met at 7.0, and ends at 8.0."""
    pixels = np.full((12, 20), 254)
    pixels[:, 7] = 0
    path = write(tmp_path, pixels, resolution=1)
    assert bounds(path) == (8, 0, 20, 12)
    assert bounds(path, start=(2, 2, 0)) == (0, 0, 7, 12)
    assert bounds(write(tmp_path, pixels, resolution=0.05)) == pytest.approx((0.4, 0, 1, 0.6))


def test_the_first_row_is_the_top(tmp_path):
    pixels = room(10, 8)
    pixels[1:4, 1:-1] = 0  # the upper three rows of the room
    assert bounds(write(tmp_path, pixels, resolution=1, origin=[10, 20, 0])) == (11, 21, 17, 26)


def test_the_map_is_turned_about_its_lower_left_corner(tmp_path):
    path = write(tmp_path, room(10, 8), resolution=0.5, origin=[1, 2, np.pi / 2])
    assert bounds(path) == pytest.approx((1 - 4.5, 2 + 0.5, 1 - 0.5, 2 + 3.5))


def test_numbers_may_be_written_as_yaml_1_1_does_not_know_them(tmp_path):
    path = write(tmp_path, room(10, 8), resolution="5e-1", origin="[-1e1, '2', 0.]", negate="false")
    assert bounds(path) == pytest.approx((-9.5, 2.5, -6.5, 6.5))


def test_grey_205_is_free_by_the_threshold_that_nav2_wrote_and_that_is_told(tmp_path):
    pixels = room(10, 8)
    pixels[3:6, 2:6] = 205
    path = write(tmp_path, pixels, resolution=1, free_thresh=0.25)
    plan = plan_of(path)
    assert plan.outlines == ()
    assert any(
        "205" in line and "12 pixels" in line and "free_thresh" in line for line in plan.told
    )
    dark = plan_of(write(tmp_path, pixels, resolution=1))
    assert [shapely.Polygon(one.points).bounds for one in dark.outlines] == [(2, 4, 6, 7)]


def test_what_nobody_has_seen_is_a_wall_unless_the_user_says_otherwise(tmp_path):
    pixels = room(20, 30)
    pixels[:, 20:] = 205
    path = write(tmp_path, pixels, resolution=1)
    assert bounds(path) == (1, 1, 20, 19)
    free = plan_of(path, unknown="free", start=(5, 5, 0))
    assert free.boundary is None
    walls = shapely.unary_union([shapely.Polygon(one.points, one.holes) for one in free.outlines])
    assert walls.area == pytest.approx(20 * 2 + 18)  # two rows of 20 and a column between them
    assert walls.bounds == pytest.approx((0, 0, 20, 20))


def test_each_mistake_in_the_file_is_told_with_its_place(tmp_path):
    path = text(tmp_path, image=None, resolution="wide", origin="[1, 2]", negate=7, mode="grey",
                occupied_thresh=0.1)  # fmt: skip
    with pytest.raises(InputError) as told:
        make(path, "map.yaml", Asked(), None)
    assert str(told.value).split("\n") == [
        "map.yaml:1:1: image: the key is missing; add e.g. 'image: map.pgm'",
        "map.yaml:1:13: resolution: 'wide' does not fit here; write e.g. 0.05",
        "map.yaml:2:9: origin: these are not three numbers; write [x, y, yaw], in m, m, rad",
        "map.yaml:3:9: negate: '7' does not fit here; write 0, or 1 where white is occupied",
        "map.yaml:5:14: free_thresh: 0.196 is more than occupied_thresh, 0.1; a cell cannot be "
        "free and occupied: give the smaller number here",
        "map.yaml:6:7: mode: 'grey' is no mode; write trinary, scale or raw",
    ]


@pytest.mark.parametrize(
    ("raw", "told"),
    [
        (None, "no such file; the map's `image` names it"),
        (b"P5 8 10 255\n" + bytes(70), "the file ends after 70 of 80 pixels; copy it whole"),
        (b"P5 8\n", "this PGM file tells no width, height and greatest value"),
        (b"P2 2 1 255\n1 x", "a pixel of this PGM file is no number"),
        (b"P2 2 1 15\n1 16", "a pixel is not in 0 to 15, as the file says of them all"),
        (b"no picture", "this is no picture that can be read"),
    ],
)
def test_a_picture_that_cannot_be_read_is_told(tmp_path, raw, told):
    if raw is not None:
        (tmp_path / "map.pgm").write_bytes(raw)
    with pytest.raises(UsageError) as refused:
        make(text(tmp_path), "map.yaml", Asked(), None)
    assert str(refused.value) == f"{tmp_path / 'map.pgm'}: {told}"


def test_where_unknown_is_free_the_robot_starts_in_the_room_that_was_seen(tmp_path):
    """Most room is in the unknown beside it."""
    pixels = np.full((60, 100), 205)
    pixels[10:30, 10:40] = room(20, 30)
    path = write(tmp_path, pixels)
    made = make(path, str(path), Asked(unknown="free"), None)
    assert shapely.box(0.55, 1.55, 1.95, 2.45).contains(shapely.Point(made.start[:2]))


def test_a_map_as_small_as_a_toy_has_a_start_in_it(tmp_path):
    path = write(tmp_path, room(20, 30), resolution=0.0001)
    made = make(path, str(path), Asked(), None)
    assert shapely.Polygon(made.plan.boundary).contains(shapely.Point(made.start[:2]))


def test_every_map_of_random_cells_is_a_world(tmp_path):
    """Whatever is drawn: outlines are simple, and stay within the tolerance."""
    rng = np.random.default_rng(3)
    for size, share, unknown in ((12, 0.2, "wall"), (25, 0.35, "wall"), (25, 0.3, "free")):
        pixels = rng.choice([0, 205, 254], (size, size), p=[share / 2, share / 2, 1 - share])
        make(write(tmp_path, pixels), "map.yaml", Asked(unknown=unknown), None)


def test_slits_that_nobody_has_seen_are_free_and_keys_that_are_not_read_are_told(tmp_path):
    pixels = room(40, 60)
    pixels[20:22, 10:50] = 205
    plan = plan_of(write(tmp_path, pixels, colour="red"))
    assert plan.outlines == ()
    assert plan.told[0] == "the key 'colour' of the map is not read"
    assert "1 slit of unknown cells among free ones, beside nothing occupied, is free" in plan.told


def test_the_room_and_the_start_in_it_are_where_somebody_saw_not_where_grey_is_free(tmp_path):
    pixels = np.full((100, 100), 205)
    pixels[30:70, 20:60] = 0
    pixels[32:68, 22:58] = 254
    shut = plan_of(write(tmp_path, pixels, free_thresh=0.25))
    assert shut.boundary is not None
    assert shapely.Polygon(shut.boundary).bounds == pytest.approx((1.1, 1.6, 2.9, 3.4))
    assert any("22 m² about (" in line or "21 m² about (" in line for line in shut.told)
    pixels[45:50, 58:60] = 205  # a hole in the wall
    leaking = plan_of(write(tmp_path, pixels, free_thresh=0.25))
    assert leaking.boundary is not None
    assert shapely.Polygon(leaking.boundary).bounds == pytest.approx((0, 0, 5, 5))
    found = roomiest(leaking)
    assert found is not None
    (x, y, _), _ = found
    assert 1.1 < x < 2.9
    assert 1.6 < y < 3.4


def test_of_few_cells_each_edge_is_a_wall(tmp_path):
    pixels = room(10, 10)
    pixels[2:5, 3:5] = pixels[6:8, 5:9] = 0
    plan = plan_of(write(tmp_path, pixels, resolution=1.0))
    walls = shapely.Polygon(plan.boundary, [one.points for one in plan.outlines])
    assert walls.area == pytest.approx(64 - 6 - 8)
    assert walls.bounds == pytest.approx((1, 1, 9, 9))
