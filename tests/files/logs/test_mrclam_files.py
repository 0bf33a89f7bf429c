"""A folder of the multi-robot data as it is distributed, and as people repackage it."""

import shutil

import numpy as np
import pytest
from log_worlds import SHARED, lay, read, steps_of, world
from log_worlds import rmse as rmse_of

from ekfsim.errors import UsageError
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import read_log
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.settings import setting
from ekfsim.records import Control, Reading

CASES = SHARED.parent / "cases"


def robot(number, v):
    """One robot's own files; it drives with v m/s."""
    return {
        f"Robot{number}_Odometry.dat": f"100.0 {v} 0\n100.1 {v} 0\n100.2 0 0\n",
        f"Robot{number}_Measurement.dat": "100.1 63 2.1 0.2\n100.2 5 1 0\n",
        f"Robot{number}_Groundtruth.dat": "99.9 0 0 0\n100.3 0.4 0 0\n",
    }


OF_ALL = {"Barcodes.dat": "1 5\n3 14\n7 63\n", "Landmark_Groundtruth.dat": "7 2.0 0.5 0 0\n"}


@pytest.fixture
def folder(tmp_path):
    return lay(tmp_path / "data", **OF_ALL, **robot(1, 1.0), **robot(2, 2.0), **robot(3, 3.0))


def asked(path, **keys):
    return read_log(
        RecordingKeys(format="mrclam", **keys), path, world("mrclam"), "corrected", warnings := []
    ), warnings


def speed(found):
    return next(e.given.u[0] for e in found.log.entries if isinstance(e.given, Control))


def test_one_of_several_robots_is_named_by_its_odometry_or_its_number(folder):
    for number in (1, 2, 3):
        assert speed(asked(folder / f"Robot{number}_Odometry.dat")[0]) == number
        assert speed(asked(folder, robot=number)[0]) == number
    assert speed(asked(folder / "Robot2_Odometry.dat", robot=2)[0]) == 2


def test_files_may_end_otherwise_and_landmarks_go_by_their_barcodes(folder):
    """As one repository has them: newRobot1_Odometry.txt, and barcodes in Landmark_Groundtruth."""
    for name in [path.name for path in folder.iterdir() if path.name.startswith("Robot")]:
        (folder / name).rename(folder / f"new{name.replace('.dat', '.txt')}")
    sound, told = asked(folder, robot=2)
    assert speed(sound) == speed(asked(folder / "newRobot2_Odometry.txt")[0]) == 2
    (folder / "Landmark_Groundtruth.dat").write_text("63 2.0 0.5 0 0\n")
    found, warnings = asked(folder, robot=2)
    readings = [entry.given for entry in found.log.entries if isinstance(entry.given, Reading)]
    assert [one.name for one in readings] == ["landmark 63"]
    (said,) = set(warnings) - set(told)
    assert said == (
        f"{folder}/Landmark_Groundtruth.dat: its numbers are barcodes, for those of the "
        "measurements are among them and no subjects' are: read so (otherwise: --set "
        "recording.targets=barcodes)"
    )


def test_of_several_robots_none_is_taken_unasked(folder):
    choice = (
        "name one of Robot1_Odometry.dat, Robot2_Odometry.dat, Robot3_Odometry.dat: "
        f"--log {folder}/Robot1_Odometry.dat, or --set recording.robot=1"
    )
    with pytest.raises(UsageError) as refused:
        asked(folder)
    assert str(refused.value) == f"{folder}: the odometry of 3 robots is in it; {choice}"
    with pytest.raises(UsageError) as refused:
        asked(folder, robot=5)
    assert str(refused.value) == f"{folder}: no robot 5 in it; {choice}"
    for path, wrong in (
        ("Robot3_Odometry.dat", "is not the odometry of the robot 2, which recording.robot names"),
        ("Barcodes.dat", "is a file, and no robot's odometry"),
    ):
        with pytest.raises(UsageError, match=wrong):
            asked(folder / path, robot=2)


def test_the_number_reaches_its_reader_from_the_command_line(folder):
    for number in (2, 3):
        found = read_scene(
            resolve("mrclam_log", "commands"),
            log=folder,
            settings=[setting(f"recording.robot={number}")],
        ).get()
        assert speed(found) == number
    for value, told in (
        ("7", f"{folder}: no robot 7 in it"),
        ("first", "--set recording.robot=first: 'first' is text where a whole number belongs"),
    ):
        with pytest.raises(UsageError, match=told):
            read_scene(
                resolve("mrclam_log", "commands"),
                log=folder,
                settings=[setting(f"recording.robot={value}")],
            ).get()


@pytest.mark.parametrize("prefix", ["", "ds0_", "robot-", "Lab 3 run 12 "])
@pytest.mark.parametrize("all_have_it", [True, False])
def test_whatever_stands_before_the_names(tmp_path, prefix, all_have_it):
    own = {name.replace("Robot1_", prefix): text for name, text in robot(1, 0.5).items()}
    others = {f"{prefix if all_have_it else ''}{name}": text for name, text in OF_ALL.items()}
    made = lay(tmp_path / "data", **own, **others)
    found, warnings = asked(made)
    assert speed(found) == 0.5
    assert found.log.entries[0].truth is not None
    assert [told.partition(": ")[2] for told in warnings] == [
        "this measurement is of another robot: left out"
    ]
    assert speed(asked(made / f"{prefix}Odometry.dat")[0]) == 0.5


@pytest.mark.parametrize(
    ("gone", "wrong"),
    [
        ("Robot1_Odometry.dat", r"no file '\*Odometry\.dat' in it; it would hold the odometry"),
        ("Robot1_Measurement.dat", r"no file 'Robot1_Measurement\.dat' in it; it would hold the "),
        ("Landmark_Groundtruth.dat", r"no file 'Landmark_Groundtruth\.dat' in it; it would hold "),
    ],
)
def test_a_file_that_is_missing_is_named(tmp_path, gone, wrong):
    made = lay(tmp_path / "data", **OF_ALL, **robot(1, 1.0))
    (made / gone).unlink()
    with pytest.raises(UsageError, match=wrong):
        asked(made)


def test_without_barcodes_the_numbers_are_those_of_the_landmarks(tmp_path):
    made = lay(tmp_path / "data", **OF_ALL, **robot(1, 1.0))
    (made / "Barcodes.dat").unlink()
    lay(made, **{"Robot1_Measurement.dat": "100.1 63 2 0\n100.1 63 2 0.1\n100.2 1 1 0\n"})
    with pytest.raises(UsageError) as refused:
        asked(made)
    assert str(refused.value) == (
        f"{made}/Robot1_Measurement.dat: 2 of 3 numbers are no landmark's; if they are barcodes, "
        "put Barcodes.dat beside this file"
    )
    lay(made, **{"Robot1_Measurement.dat": "100.1 7 2.1 0.2\n100.2 1 1 0\n100.2 9 1 0\n"})
    found, warnings = asked(made)
    assert names(found) == ["landmark 7"]
    assert [told.replace(str(made), "") for told in warnings] == [
        ": no Barcodes.dat in it: the numbers of the measurements are taken for those of the "
        "landmarks",
        "/Robot1_Measurement.dat:2: this measurement is of another robot: left out",
        "/Robot1_Measurement.dat:3: this measurement is of no known landmark: left out",
    ]


def names(found):
    return [e.given.name for e in found.log.entries if isinstance(e.given, Reading)]


SUBJECTS = "100.0 7 2.1 0.2\n100.1 8 2 0\n100.1 9 1 0\n100.1 2 1 0\n"


@pytest.fixture
def by_subject(tmp_path):
    """8 is the landmark 7's barcode, and a landmark itself."""
    return lay(
        tmp_path / "data",
        **{
            **robot(1, 1.0),
            "Robot1_Measurement.dat": SUBJECTS,
            "Barcodes.dat": "1 5\n2 14\n7 8\n8 70\n9 45\n",
            "Landmark_Groundtruth.dat": "7 2 0 0 0\n8 3 0 0 0\n9 4 1 0 0\n",
        },
    )


def test_subjects_in_the_place_of_barcodes_are_recognized(by_subject):
    found, warnings = asked(by_subject)
    assert names(found) == ["landmark 7", "landmark 8", "landmark 9"]
    assert warnings[0] == (
        f"{by_subject}/Robot1_Measurement.dat: 3 of 4 numbers are no barcode, but all are "
        "subjects: read as those of the landmarks themselves (otherwise: --set "
        "recording.targets=barcodes)"
    )
    assert names(asked(by_subject, targets="barcodes")[0]) == ["landmark 7"]


def test_barcodes_stay_barcodes(by_subject):
    lay(by_subject, **{"Robot1_Measurement.dat": "100.0 8 2 0\n100.1 70 2 0\n100.1 45 1 0\n"})
    found, warnings = asked(by_subject)
    assert names(found) == ["landmark 7", "landmark 8", "landmark 9"]
    assert warnings == []
    assert names(asked(by_subject, targets="subjects")[0]) == ["landmark 8"]


def case(name):
    if not (CASES / name).exists():
        pytest.skip(f"the small input {name} is not here")
    return CASES / name


def test_a_robots_subjects_find_the_landmarks_that_its_barcodes_found():
    """The independent filter keeps to 0.19 m on this log with its barcodes; 0.34 m with wrong
    landmarks."""
    steps, scene, _ = steps_of("mrclam", case("subjects-for-barcodes"), gate=0.999)
    used = [step.correction is not None for step in steps]
    assert sum(used) == 163
    assert rmse_of(steps, scene) < 0.1


def test_files_without_a_robots_number():
    found = read("mrclam", case("no-robot-prefix"))
    assert len(names(found)) == 100


def test_a_copy_of_one_robot_in_a_folder_of_its_own_is_the_same(folder, tmp_path):
    alone = tmp_path / "alone"
    alone.mkdir()
    for name in (*OF_ALL, *robot(2, 0)):
        shutil.copy(folder / name, alone)
    one, other = read("mrclam", alone), asked(folder, robot=2)[0]
    np.testing.assert_array_equal([e.t for e in one.log.entries], [e.t for e in other.log.entries])
    assert speed(one) == speed(other) == 2
