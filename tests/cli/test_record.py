import json

import pytest
from program import ekfsim, left_in

DRIVE = "world: world.yaml\nseed: 3\ndrive: {path: circle, radius: 2, speed: 1, laps: 0.5}\n"
LOGGED = "world: world.yaml\nrecording: {format: gnss}\n"
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
    ended = ekfsim("record", "drive.yaml", "-o", "log")
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
            "record", "drive.yaml", "-o", "log", "--set", "belief.start.x=1", *set_secretly
        ).status
        == 0
    )
    about = (place / "log" / "about.txt").read_text()
    assert "belief.start.x=1" in about
    assert not any(text in about for text in secret)
    sound = ("record", "drive.yaml", "-o", "sound", "--set", "belief.start.x=1", *set_secretly[:4])
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
        assert ekfsim("record", "drive.yaml", "-o", f"log{n}", *args).status == 0
        texts.add((place / f"log{n}" / "gnss.csv").read_text())
    assert len(texts) == 3


def test_a_log_that_exists_is_refused_without_force(place):
    assert ekfsim("record", "drive.yaml", "-o", "log").status == 0
    ended = ekfsim("record", "drive.yaml", "-o", "log")
    assert ended.status == 2
    assert ended.err.startswith("ekfsim: log: the folder is not empty; choose another")
    assert ekfsim("record", "drive.yaml", "-o", "log", "--force").status == 0
    (place / "log" / "mine.md").write_text("")
    assert ekfsim("record", "drive.yaml", "-o", "log", "--force").status == 2


def test_a_log_is_not_recorded(place):
    ekfsim("record", "drive.yaml", "-o", "log")
    ended = ekfsim("record", "logged.yaml", "--log", "log", "-o", "out")
    assert ended.status == 2
    assert ended.err.endswith("ekfsim: logged.yaml: is a recorded log already; name a simulation\n")
    assert not (place / "out").exists()


def test_the_truth_of_a_drive_is_in_its_log_in_any_case(place):
    ended = ekfsim("record", "drive.yaml", "-o", "log", "--truth")
    assert (ended.status, ended.out) == (2, "")
    wrong = "a log of the system 'gnss' holds the truth in any case; leave this out"
    assert ended.err == f"ekfsim: --truth: {wrong}\n"
    assert not (place / "log").exists()


def test_a_log_that_is_wrong_is_told_with_its_place(place):
    ekfsim("record", "drive.yaml", "-o", "log")
    (place / "log" / "gnss.csv").write_text("t,x,y\n0.1,1,2\n0.2,x,2\n0.3,1,2\n")
    ended = ekfsim("run", "logged.yaml", "--log", "log")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err == "log/gnss.csv:3:5: x: 'x' is not a number; write e.g. 1.5\n"
    (place / "log" / "gnss.csv").unlink()
    ended = ekfsim("run", "logged.yaml", "--log", "log")
    assert (ended.status, ended.out) == (2, "")
    assert (
        ended.err == "ekfsim: log: no file 'gnss*.csv' in it; it would hold the satellite fixes\n"
    )
