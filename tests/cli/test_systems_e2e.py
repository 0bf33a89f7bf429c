"""The other documents' systems as a user of the program meets them: drives and hand-written logs,
from end to end."""

import json
import math
import re
from itertools import pairwise

import pytest
from program import ekfsim, left_in
from small_logs import LOGS, UNIX

from ekfsim.filters import FILTERS
from ekfsim.systems.document import READINGS

WALLS = "boundary: [[-1, -1], [3, -1], [3, 3], [-1, 3]]\n"
MARKS = "landmarks: [{id: 0, x: 4, y: 1}, {id: 1, x: 4, y: -1.5}, {id: 2, x: -4, y: 2}]\n"
DRIVE = "seed: 4\ndrive: [{v: 0.5, omega: 0, for: 1}, {v: 0.5, omega: 45, for: 1}]\n"
WORLDS = {
    "mower": MARKS + "sensors: [markers: {rate: 2}]\n",
    "pioneer": WALLS + "expectedPath: [[0, 0], [1, 0]]\n",
    "gnss": "robot: {rate: 20}\n",
    "pylon": "landmarks: [{id: 1, x: 5, y: -5}]\nexpectedPath: [[0, 0], [1, 0]]\n",
    "landmarks": MARKS + "robot: {rate: 20}\n",
    "ranges": MARKS,
}
STATES = {
    "gnss": ["v", "phi", "x", "y"],
    "pylon": ["xdot", "x", "ydot", "y", "thetadot", "theta", "theta_prev"],
}
STEP = {
    "type",
    "t",
    "sensor",
    "z",
    "predicted",
    "innovation",
    "S",
    "H",
    "gain",
    "nis",
    "updated",
    "state",
    "prior",
}
STEP |= {"posterior", "truth", "nees"}
SYSTEM_OF = {name: "landmarks" if name == "mrclam" else name for name in LOGS}


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """A world and a drive of each system, and a log of each format with the scene that reads it."""
    monkeypatch.chdir(tmp_path)
    for name, more in WORLDS.items():
        head = f"name: {name}\nsystem: {name}\nstart: {{x: 0, y: 0, theta: 0}}\n"
        (tmp_path / f"{name}-world.yaml").write_text(head + more)
        (tmp_path / f"{name}.yaml").write_text(f"world: {name}-world.yaml\n{DRIVE}")
    for name, files in LOGS.items():
        (tmp_path / f"{name}-log").mkdir()
        (tmp_path / f"{name}_log.yaml").write_text(
            f"world: {SYSTEM_OF[name]}-world.yaml\nrecording: {{format: {name}, path: "
            f"{name}-log}}\n"
        )
        for file, text in files.items():
            (tmp_path / f"{name}-log" / file).write_text(text)
    return tmp_path


SCENES = [*WORLDS, *(f"{name}_log" for name in LOGS)]


def said(*args, keys=b""):
    """What the program tells of something that succeeds."""
    ended = ekfsim(*args, keys=keys)
    assert ended.status == 0, ended.err
    return ended.out


def lines(path):
    """The lines of a trace, none of which holds a number that JSON does not know."""

    def refuse(constant):
        raise AssertionError(constant)

    return [json.loads(line, parse_constant=refuse) for line in path.read_text().splitlines()]


@pytest.mark.parametrize("name", SCENES)
def test_every_output_of_a_run(place, name):
    out = said(
        "run",
        f"{name}.yaml",
        "--trace",
        "a.jsonl",
        "--csv",
        "a.csv",
        "--tum",
        "tum",
        "--summary",
        "a.json",
    )
    start, *steps = lines(place / "a.jsonl")
    state = STATES.get(name.removesuffix("_log"), ["x", "y", "theta"])
    assert (start["type"], start["state"], len(start["mean"])) == ("start", state, len(state))
    assert {step["type"] for step in steps} == {"predict", "update"}
    for step in steps:
        assert set(step) >= STEP
        assert step["state"] == state
        assert (step["nees"] is None) == (step["truth"] is None) == (name == "pylon_log")
    assert [step["t"] for step in steps] == sorted(step["t"] for step in steps)
    readings = [step for step in steps if step["type"] == "update"]
    assert len(readings) > 1
    for step in readings:
        assert len(step["z"]) == len(step["predicted"]) == len(step["H"]) == len(step["gain"][0])
    assert len((place / "a.csv").read_text().splitlines()) == len(steps) + 2
    poses = [
        [*map(float, row.split())]
        for row in (place / "tum/estimate.tum").read_text().splitlines()[2:]
    ]
    assert all(math.hypot(*pose[6:]) == pytest.approx(1) for pose in poses)
    assert all(before[0] < after[0] for before, after in pairwise(poses))
    assert (place / "tum/truth.tum").exists() == (name != "pylon_log")
    summary = json.loads((place / "a.json").read_text())
    assert summary["steps"] == len(steps)
    assert summary["updates"] == sum(step["updated"] for step in readings)
    assert (
        (summary["position"]["rmse"] is None)
        == (summary["nees"]["last"] is None)
        == (name == "pylon_log")
    )
    assert re.search(
        r"^The run is over after \d+ motion inputs and \d+ readings over [12]", out, re.M
    )
    assert "nan" not in out
    assert "odometry alone" not in out


@pytest.mark.parametrize("filter", FILTERS)
@pytest.mark.parametrize("name", ["mower", "pioneer_log", "pylon_log"])
def test_every_filter_and_a_gate(name, filter):
    if filter == "kf-nominal" and name.endswith(("log", "bag")):
        told = ekfsim("run", f"{name}.yaml", "--filter", filter)
        assert (told.status, told.out) == (2, "")
        wrong = (
            "kf-nominal: a recording does not tell the way that was planned, which it is "
            "linearised about"
        )
        assert told.err.endswith(f"ekfsim: {name}.yaml: {wrong}; take kf or ekf\n")
        return
    if filter == "amcl" and name != "pioneer_log":  # there is a room in the pioneer's world alone
        told = ekfsim("run", f"{name}.yaml", "--filter", filter)
        assert (told.status, told.out) == (2, "")
        assert told.err.endswith("of a map with a boundary, and there is none; take pf\n")
        return
    out = said("run", f"{name}.yaml", "--filter", filter, "--gate", "0.999")
    assert f"filter {filter}, gate 0.999" in out.partition("\n")[0]
    assert out.splitlines()[-1].startswith("Verdict: ")


OTHERWISE = {(name, reading) for name in ("mower", "pylon") for reading in ("printed", "coded")} | {
    ("gnss", "coded")
}


@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize("name", ["mower", "pioneer", "gnss", "pylon"])
def test_every_reading_of_a_document(name, reading):
    out = said("run", f"{name}.yaml", "--reading", reading)
    follows = (name, reading) in OTHERWISE
    assert (f"as {reading}, not the corrected ones" in out) == follows
    assert (f"none is {reading} otherwise" in out) == (not follows and reading != "corrected")


@pytest.mark.parametrize("name", ["mower", "gnss", "pylon", "pioneer"])
def test_a_drive_that_was_recorded_gives_its_numbers_again(place, name):
    said("record", f"{name}.yaml", "-o", "again")
    for args in ([f"{name}.yaml"], [f"{name}_log.yaml", "--log", "again"]):
        said("run", *args, "-q", "--trace", f"{len(args)}.jsonl")
    run, again = lines(place / "1.jsonl"), lines(place / "3.jsonl")
    assert len(run) == len(again)
    for a, b in zip(run[1:], again[1:], strict=True):
        assert a["posterior"]["mean"] == pytest.approx(b["posterior"]["mean"], abs=1e-8)


@pytest.mark.parametrize("name", SCENES)
def test_a_play_goes_forth_and_back(name):
    out = said("play", f"{name}.yaml", "--show", "text", keys=b"nnnp2prq")
    assert out.count("==>") >= 2
    assert out.count("<==Back at step") == 2  # r finds the start on show
    assert " s: the start in " in out
    assert (
        ekfsim("play", f"{name}.yaml", "--show", "text", keys=b"999n").out.count("\nVerdict: ") == 1
    )


def test_times_are_told_since_the_start_and_traced_as_stamped(place):
    out = said("play", "mrclam_log.yaml", "--show", "text", keys=b"nnn")
    assert "Times are told in s since the start, which the log stamps 1248444187.156\n" in out
    assert "==>From t = 0.1 s to 0.45 s: 5 motion inputs; " in out
    assert "==>At t = 0.45 s landmark 6 was read: range = 3.8 m, " in out
    assert "t = 0.45 s: landmark 6, " in out
    said("run", "mrclam_log.yaml", "-q", "--trace", "a.jsonl")
    stamps = [step["t"] for step in lines(place / "a.jsonl")]
    assert stamps[0] == UNIX
    assert UNIX + 0.45 in [pytest.approx(stamp, abs=1e-3) for stamp in stamps]
    assert "Times are told" not in said("run", "gnss.yaml")


@pytest.mark.parametrize("name", ["mower", "pioneer_log", "pylon_log", "ranges"])
def test_pictures_of_a_run(place, name):
    assert said("render", f"{name}.yaml", "-o", "pictures", "--every", "20").startswith(
        "pictures: "
    )
    pictures = sorted((place / "pictures").iterdir())
    assert len({picture.read_bytes() for picture in pictures}) == len(pictures) > 1
    said("play", f"{name}.yaml", "--show", "files", "-o", "shown", keys=b"nns")
    current, saved = left_in(place / "shown")
    assert current == "current.png"
    assert re.fullmatch(r"step-\d{4}(-beam)?\.png", saved)


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (
            ["gnss_log.yaml", "--log", "pylon-log"],
            "ekfsim: pylon-log: no file 'wheelspeeds*.csv' in it; ",
        ),
        (
            ["gnss_log.yaml", "--log", "nowhere"],
            "ekfsim: nowhere: no such folder; name the one that holds ",
        ),
        (
            ["gnss_log.yaml", "--log", "gnss.yaml"],
            "ekfsim: gnss.yaml: is a file; name the folder that holds ",
        ),
        (
            ["pylon_log.yaml", "--log", "gnss-log"],
            "ekfsim: gnss-log: several files '*.csv' in it: ",
        ),
        (
            ["pylon_log.yaml", "--log", "gnss-log/gnss.csv"],
            "gnss-log/gnss.csv:2:1: 3 columns stand in this row; ",
        ),
        (
            ["gnss.yaml", "--log", "gnss-log"],
            "gnss.yaml:3:8: drive: the file has 'drive', not a recording; ",
        ),
        (
            ["gnss_log.yaml", "--world", "mower-world.yaml"],
            "gnss_log.yaml:2:21: recording.format: a 'gnss' log is of ",
        ),
        (
            ["gnss.yaml", "--filter", "lkf"],
            "ekfsim: --filter lkf: there is no such filter; did you mean 'kf'?",
        ),
    ],
)
def test_a_log_of_another_kind_is_refused_in_a_line(place, args, told):
    ended = ekfsim("run", *args, "--trace", "a.jsonl", "--summary", "a.json")
    assert (ended.status, ended.out) == (2, "")
    *remarks, refused = ended.err.splitlines()  # what was made of a file before it was refused
    assert refused.startswith(told)
    assert len(remarks) == ("gnss.csv" in args[-1])
    assert not {"a.jsonl", "a.json"} & set(left_in(place))


def test_an_empty_log_is_no_name():
    ended = ekfsim("run", "gnss_log.yaml", "--log", "")
    assert ended.status == 2
    assert ended.err.endswith("Invalid value for '--log': the name is empty.\n")


def test_a_log_without_readings_says_so(place):
    (place / "gnss-log" / "gnss.csv").write_text("t,x,y\n")
    ended = ekfsim("run", "gnss_log.yaml", "-q")
    assert ended.status == 0
    assert (
        ended.err == "ekfsim: gnss-log: no reading is left: the filter follows the motion alone\n"
    )
    assert "Verdict: no evidence" in ended.out


def test_two_robots_in_a_folder_are_not_guessed_between(place):
    (place / "mrclam-log" / "Robot2_Odometry.dat").write_text("")
    ended = ekfsim("run", "mrclam_log.yaml")
    assert (ended.status, ended.out) == (2, "")
    assert (
        "mrclam_log.yaml:2:35: recording.path: mrclam-log: the odometry of 2 robots is in it; name "
        "one of " in ended.err
    )


def test_a_refused_reading_is_told_with_its_reason(place):
    lawn = place / "gnss-log" / "gnss.csv"
    lawn.write_text(lawn.read_text() + "1.6,50,50\n")
    out = said("run", "gnss_log.yaml", "--gate", "0.999")
    assert "Gate: this reading is refused, its NIS is too large to be believed\n" in out
    assert ": 3 updates; 1 reading not used (1 refused by the gate)\n" in out
