import json

import pytest
from program import ekfsim, left_in

DRIVE = "world: world.yaml\nseed: 3\ndrive: {path: circle, radius: 2, speed: 1, laps: 0.5}\n"
LOGGED = "world: world.yaml\nrecording: {format: gnss}\n"
OWN = ("--format", "own")
LAWN = "name: lawn\nsystem: gnss\nstart: {x: 0, y: 0, theta: 0}\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in {"world.yaml": LAWN, "drive.yaml": DRIVE, "logged.yaml": LOGGED}.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def posteriors(file):
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    return [number for line in lines[1:] for number in line["posterior"]["mean"]]


def test_a_drive_recorded_and_run_again_is_the_same(place):
    ended = ekfsim("record", "drive.yaml", *OWN, "-o", "log")
    assert (ended.status, ended.err) == (0, "")
    assert ended.out == "log: a gnss log; run the filter on it with --log\n"
    assert left_in(place / "log") == ["about.txt", "gnss.csv", "groundtruth.csv", "wheelspeeds.csv"]
    assert "commands drive.yaml" in (place / "log" / "about.txt").read_text()
    for args in (
        ("drive.yaml", "--trace", "run"),
        ("logged.yaml", "--log", "log", "--trace", "again"),
    ):
        assert ekfsim("run", *args, "--quiet").status == 0
    assert posteriors(place / "again") == pytest.approx(posteriors(place / "run"), abs=1e-9)


def test_a_log_says_nothing_of_the_faults_nor_of_a_truth_that_the_filter_is_not_told(place):
    (place / "world.yaml").write_text(
        LAWN + "belief: {robot: {speedDensity: 0.2}, sensors: {gnss: {sigma: 0.3}}}\n"
    )
    secret = (
        "robot.turnDensity=7",
        "sensors.gnss.sigma=0.7",
        "faults.leftScale=1.1",
        "faults.sensors.gnss.xBias=7",
    )
    set_secretly = [word for text in secret for word in ("--set", text)]
    assert (
        ekfsim(
            "record", "drive.yaml", *OWN, "-o", "log", "--set", "belief.start.x=1", *set_secretly
        ).status
        == 0
    )
    about = (place / "log" / "about.txt").read_text()
    assert "belief.start.x=1" in about
    assert not any(text in about for text in secret)
    sound = (
        "record",
        "drive.yaml",
        *OWN,
        "-o",
        "sound",
        "--set",
        "belief.start.x=1",
        *set_secretly[:4],
    )
    assert ekfsim(*sound).status == 0
    sound, faulty = table(place / "sound"), table(place / "log")
    assert faulty["wheelspeeds.csv"] != sound["wheelspeeds.csv"]
    assert faulty["gnss.csv"] != sound["gnss.csv"]
    assert faulty["groundtruth.csv"] == sound["groundtruth.csv"]
    told = "robot.speedDensity=0.2", "robot.turnDensity=7", "sensors.gnss.sigma=0.3"
    (place / "world.yaml").write_text(LAWN)
    assert (
        ekfsim("run", "logged.yaml", "--log", "log", "-q", "--trace", "one", *set_of(told)).status
        == 0
    )
    (place / "world.yaml").write_text(
        LAWN + "belief: {robot: {speedDensity: 0.2}, sensors: {gnss: {sigma: 0.3}}}\n"
    )
    assert (
        ekfsim(
            "run", "logged.yaml", "--log", "log", "-q", "--trace", "two", *set_of(told[1:2])
        ).status
        == 0
    )
    assert posteriors(place / "one") == posteriors(place / "two")


def set_of(settings):
    return [word for text in settings for word in ("--set", text)]


def table(folder):
    return {file.name: file.read_text() for file in folder.iterdir()}


def test_another_seed_and_run_make_another_log(place):
    texts = set()
    for n, args in enumerate(([], ["--seed", "4"], ["--run", "1"])):
        assert ekfsim("record", "drive.yaml", *OWN, "-o", f"log{n}", *args).status == 0
        texts.add((place / f"log{n}" / "gnss.csv").read_text())
    assert len(texts) == 3


def test_a_log_that_exists_is_refused_without_force(place):
    assert ekfsim("record", "drive.yaml", *OWN, "-o", "log").status == 0
    ended = ekfsim("record", "drive.yaml", *OWN, "-o", "log")
    assert ended.status == 2
    assert ended.err.startswith("ekfsim: log: the folder is not empty; choose another")
    assert ekfsim("record", "drive.yaml", *OWN, "-o", "log", "--force").status == 0
    (place / "log" / "mine.md").write_text("")
    assert ekfsim("record", "drive.yaml", *OWN, "-o", "log", "--force").status == 2


def test_a_log_is_not_recorded(place):
    ekfsim("record", "drive.yaml", *OWN, "-o", "log")
    ended = ekfsim("record", "logged.yaml", "--log", "log", "-o", "out")
    assert ended.status == 2
    assert ended.err.endswith("ekfsim: logged.yaml: is a recorded log already; name a simulation\n")
    assert not (place / "out").exists()


def test_the_truth_of_a_drive_is_in_its_log_in_any_case(place):
    ended = ekfsim("record", "drive.yaml", *OWN, "-o", "log", "--truth")
    assert (ended.status, ended.out) == (2, "")
    wrong = "a log of the system 'gnss' holds the truth in any case; leave this out"
    assert ended.err == f"ekfsim: --truth: {wrong}\n"
    assert not (place / "log").exists()


def test_a_log_that_is_wrong_is_told_with_its_place(place):
    ekfsim("record", "drive.yaml", *OWN, "-o", "log")
    (place / "log" / "gnss.csv").write_text("t,x,y\n0.1,1,2\n0.2,x,2\n0.3,1,2\n")
    ended = ekfsim("run", "logged.yaml", "--log", "log")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err == "log/gnss.csv:3:5: x: 'x' is not a number; write e.g. 1.5\n"
    (place / "log" / "gnss.csv").unlink()
    ended = ekfsim("run", "logged.yaml", "--log", "log")
    assert (ended.status, ended.out) == (2, "")
    assert (
        ended.err == "ekfsim: log: no file 'gnss*.csv' in it; it would hold the satellite fixes; "
        "found about.txt, groundtruth.csv, wheelspeeds.csv\n"
    )


def test_a_drive_is_recorded_as_a_log_that_brings_its_world(place):
    """What is printed is what plays it again."""
    ended = ekfsim("record", "drive.yaml", "-o", "a log", "--filter", "ukf")
    assert (ended.status, ended.err) == (0, "")
    told = "ekfsim run log --log 'a log' --filter ukf --gate off"
    assert ended.out == f"a log: a log; run the filter on it with: {told}\n"
    assert left_in(place / "a log") == [
        *("about.txt", "motion.csv", "readings.csv", "truth.csv", "world.yaml")
    ]
    again = "run", "log", "--log", "a log", "--filter", "ukf", "--gate", "off", "--trace", "again"
    for args in (("run", "drive.yaml", "--filter", "ukf", "--trace", "run"), again):
        ended = ekfsim(*args, "-q")
        assert (ended.status, ended.err) == (0, "")
    assert posteriors(place / "again") == pytest.approx(posteriors(place / "run"), abs=1e-11)
    assert ekfsim("record", "drive.yaml", "-o", "a log", "--force").status == 0


def test_a_scene_of_another_format_reads_it_and_tells_so(place):
    ekfsim("record", "drive.yaml", "-o", "log")
    ekfsim("record", "drive.yaml", *OWN, "-o", "own")
    ended = ekfsim("run", "logged.yaml", "--log", "log", "-q", "--trace", "one")
    told = "holds motion.csv and no log of the format gnss: read as format: log, in the scene's"
    own = "world; that of the log is --world log/world.yaml"
    assert (ended.status, ended.err) == (0, f"ekfsim: log: {told} {own}\n")
    ended = ekfsim("run", "logged.yaml", "--log", "own", "-q", "--trace", "two")
    assert (ended.status, ended.err) == (0, "")
    assert posteriors(place / "one") == pytest.approx(posteriors(place / "two"), abs=1e-11)
    ended = ekfsim("run", "logged.yaml", "--log", "log", "--world", "log/world.yaml", "-q")
    assert (ended.status, ended.err.count("\n")) == (0, 1)


def test_a_log_of_a_drive_tells_nothing_of_its_faults(place):
    """No file but what the faulty sensors and wheels said differs."""
    faulty = [*set_of(("faults.leftScale=1.1", "faults.sensors.gnss.xBias=7"))]
    assert ekfsim("record", "drive.yaml", "-o", "sound").status == 0
    assert ekfsim("record", "drive.yaml", "-o", "log", *faulty).status == 0
    sound, log = table(place / "sound"), table(place / "log")
    assert {name for name in log if log[name] != sound[name]} == {"motion.csv", "readings.csv"}


@pytest.mark.parametrize(
    ("commands", "format", "told"),
    [
        ("tour", "log", "log: what a classroom's robot does has no time, and every row of this "
         "format has one; leave this out"),
        ("tour", "gnss", "gnss: a run of the system 'classroom' is written as classroom; write "
         "this, or leave it out"),
        ("gnss", "mower", "mower: a run of the system 'gnss' is written as log or gnss; write one "
         "of these, or leave this out"),
        ("ranges", "own", "own: logs of the system 'ranges' have no format of their own that is "
         "written; write --format log, or leave this out"),
    ],
)  # fmt: skip
def test_a_format_that_a_robot_has_not_is_refused(place, commands, format, told):
    ended = ekfsim("record", commands, "-o", "log", "--format", format)
    assert (ended.status, ended.out, ended.err) == (2, "", f"ekfsim: --format {told}\n")
    assert not (place / "log").exists()
