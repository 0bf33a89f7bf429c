"""Files that are none of ours: what they are, and what reads them, in place of what is wrong."""

import gzip
import io
import json
import zipfile

import numpy as np
import pytest

from ekfsim.errors import UsageError
from ekfsim.files.foreign import of_bytes, of_text
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import check, load_scene, read_scene

CSV = "t,x,y\n0,1,2\n1,2,3\n2,3,4\n3,4,5\n"
ROS_MAP = "image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"


def zipped():
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("a", "b")
    return file.getvalue()


def arrays():
    file = io.BytesIO()
    np.save(file, np.zeros(3))
    return file.getvalue()


BINARY = {
    "a.bag": (b"#ROSBAG V2.0\n\x45\0\0\0\xbb", "a ROS 1 bag"),
    "a.mcap": (b"\x89MCAP0\r\n\x01", "an MCAP file"),
    "a.db3": (b"SQLite format 3\0\x10", "an SQLite file"),
    "a.png": (b"\x89PNG\r\n\x1a\n", "a PNG picture"),
    "a.pgm": (b"P5\n2 2\n255\n\xcd\xcd\xfe\0", "a PGM picture"),
    "a.xlsx": (zipped(), "a zip archive or a spreadsheet"),
    "a.gz": (gzip.compress(b"t,x,y\n"), "a gzip archive"),
    "a.npy": (arrays(), "a numpy array"),
}


@pytest.mark.parametrize("name", BINARY)
def test_a_file_of_bytes_is_told_by_what_it_is_wherever_it_is_named(tmp_path, name):
    raw, what = BINARY[name]
    (file := tmp_path / name).write_bytes(raw)
    for found in (check(file), read_scene(file)):
        (mistake,) = found.mistakes
        assert f"this is {what}" in mistake.wrong
        assert mistake.right
    with pytest.raises(UsageError, match=f"this is {what}"):
        load_scene("mrclam_log", log=file)


def test_rows_of_numbers_are_a_table_and_no_file_of_ours_is():
    assert of_text(CSV).what == "a table of numbers"
    assert of_text("# by hand\n1 2 3\n4 5 6\n7 8 9\n10 11 12\n").what == "a table of numbers"
    assert of_text("0,5;1,5\n0,6;1,5\n0,7;1,5\n0,8;1,6\n").what == "a table of numbers"
    for folder in ("worlds", "commands"):
        for path in packaged(folder).values():
            assert of_text(path.read_text(encoding="utf-8")) is None
            assert of_bytes(path.read_bytes()) is None
    assert of_bytes(b"BMX: a key\n") is None
    assert of_bytes(b"P5: a key\n") is None


@pytest.mark.parametrize("name", ["log.csv", "log.yaml"])
def test_a_table_where_a_scene_is_wanted_is_told_where_it_belongs(tmp_path, name):
    (file := tmp_path / name).write_text(CSV)
    for found in (check(file), read_scene(file)):
        (mistake,) = found.mistakes
        assert mistake.wrong == "this is a table of numbers"
        assert "recording: {format: …, path: …}" in mistake.right


def test_a_ros_map_where_a_scene_is_wanted_is_told_what_makes_a_world_of_it(tmp_path):
    (file := tmp_path / "map.yaml").write_text(ROS_MAP)
    (mistake,) = read_scene(file).mistakes
    assert mistake.wrong == "this is a ROS map"
    assert f"ekfsim world {file} -o world.yaml" in mistake.right


def test_a_world_with_mistakes_is_still_told_its_own(tmp_path):
    (file := tmp_path / "world.yaml").write_text("name: a\nstart: {x: 0, y: 0}\nnoise: {}\n")
    assert any("theta" in str(mistake) for mistake in check(file).mistakes)
    (file := tmp_path / "plan.yaml").write_text(json.dumps({"name": "a", "start": [1, 2]}))
    assert all("table" not in str(mistake) for mistake in check(file).mistakes)
