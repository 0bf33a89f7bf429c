"""Files that are none of ours: what they are, and what reads them, in place of what is wrong."""

import gzip
import io
import json
import zipfile

import numpy as np
import pytest

from ekfsim.errors import UsageError
from ekfsim.files.foreign import of_bytes, of_folder, of_text
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.check_study import check as check_any
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


def test_tables_with_words_in_their_rows_are_tables_and_texts_with_numbers_are_none(tmp_path):
    rows = "".join(f"range2 {k / 10} 2.5 0.01 -1.5 2 105 80\n" for k in range(9))
    assert of_text(rows).what == "a table of numbers"
    assert of_text("% time,O_x,O_y\n" + "".join(f"{k},0.1,2e-3\n" for k in range(9))) is not None
    assert of_text("In 2010 a robot drove.\nIt came 2nd.\nIn 2011 it was 3rd.\nThen 4.\n") is None
    assert of_text("a: 1 2\nb: 3 4\nc: 5 6\nd: 7 8\n") is None
    assert (
        of_text("rosbag2_bagfile_information:\n  version: 5\n").what == "what tells of a ROS 2 bag"
    )
    (file := tmp_path / "log.txt").write_text("% time,O_x\n" + "1,2\n" * 9)
    (mistake,) = check_any(file).mistakes
    assert mistake.wrong == "this is a table of numbers"


OF_LOGS = {  # the names of the files that a log of each format has
    "gnss": ["wheelspeeds-1.csv", "gnss-1.csv"],
    "mrclam": ["ds1_Odometry.dat", "ds1_Measurement.dat", "Landmark_Groundtruth.dat"],
    "ranges": ["odometry.csv", "ranges.csv", "nodes.csv"],
    "pioneer": ["odometry.csv", "ultrasonic.csv"],
    "mower": ["marker-001-poselog.txt", "marker-001-003-angles.txt", "marker-001-map.txt"],
}


@pytest.mark.parametrize("format", OF_LOGS)
def test_a_folder_with_a_log_is_told_by_its_format(format, tmp_path):
    """In place of a scene or a map, and of a log of another format."""
    for name in OF_LOGS[format]:
        (tmp_path / name).touch()
    right = f"a log of the format {format}: `ekfsim run {format}_log --log {tmp_path}` reads it"
    with pytest.raises(UsageError, match="is a folder with ") as refused:
        check_any(tmp_path)
    assert right in str(refused.value)
    with pytest.raises(UsageError, match="here is ") as refused:
        load_scene("mower_log" if format == "gnss" else "gnss_log", log=tmp_path)
    assert right in str(refused.value)


def test_a_folder_of_a_bag_and_one_of_nothing_known():
    assert of_folder(["metadata.yaml", "a_0.db3"], "a").cure == "`ekfsim run bag --log a` reads it"
    assert of_folder(["odometry.csv", "readings.csv"], "a").what == "a log of the format log"
    assert of_folder(["letter.txt", "world.yaml"], "a") is None


def test_a_world_of_the_classroom_is_told_how_it_takes_any_log(tmp_path):
    (file := tmp_path / "c.yaml").write_text("recording: {format: log, path: .}\n")
    mistake, *_ = read_scene(file, packaged("worlds")["room"]).mistakes
    assert "the world is of the classroom" in mistake.wrong
    assert "system: landmarks" in mistake.right
    assert "sensors: [{ultrasonic: {range: 10}}]" in mistake.right


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
