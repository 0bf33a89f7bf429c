"""A run of the classroom handed out as files: what they hold, and that they hold no more."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from program import ekfsim, left_in

from ekfsim.files.packaged import packaged

PAGE = Path(__file__).parents[2] / "docs" / "course" / "own-filter.md"
# all that may happen to a robot, and all that it may not know
WORLD = """\
name: a secret name
boundary: [[0, 0], [10, 0], [10, 8], [0, 8]]
obstacles:
  - {name: desk, points: [[4, 3], [5, 3], [5, 4], [4, 4]]}
  - {name: 'a "chair": here', points: [[7, 1], [8, 1], [8, 2]]}
start: {x: 1, y: 1, theta: 20, sigma: {x: 0.1, y: 0.2, theta: 5}}
noise:
  executionDstSigmaRatio: 0.05
  executionAngSigmaRatio: 0.05
  odometryDstSigmaRatio: 0.02
  odometryAngSigmaRatio: 0.03
  rangeSigmaRatio: 0.01
belief:
  start: {x: 1.2, y: 1.1, theta: 17.3}
  noise: {odometryDstSigmaRatio: 0.033}
  missing: [desk]
faults: {rangeBias: 0.0625}
"""
COMMANDS = """\
world: world.yaml
seed: 31337
commands:
  - say: Go.
  - move: {distance: 1.75, angle: 33.3}
  - sense: {angle: -86}
  - kidnap: {x: 3, y: 2, theta: 0}
  - move: {distance: -0.5, angle: -181}
  - sense: {angle: 12.5}
"""
LOGGED = "recording: {format: classroom, path: log}\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in {"world": WORLD, "run": COMMANDS, "logged": LOGGED}.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    return tmp_path


def lines_of(file):
    return [json.loads(line) for line in file.read_text().splitlines()]


def rows_of(file):
    return list(csv.reader(file.read_text().splitlines()))


def given(lines):
    return [line for line in lines if line["type"] in ("move", "sense")]


def test_what_stands_in_the_files(place):
    ended = ekfsim("record", "run.yaml", "-o", "log")
    assert (ended.status, ended.err) == (0, "")
    first, second = ended.out.splitlines()
    assert first == "log: a classroom log; run the filter on it with --log"
    assert second.startswith("Only here it is told what made it: ekfsim ")
    assert "commands run.yaml" in second
    assert "seed 31337, run 0" in second
    assert left_in(place / "log") == ["entries.csv", "world.yaml"]
    rows = rows_of(place / "log" / "entries.csv")
    assert rows[0] == ["index", "kind", "distance", "angle", "bearing", "range"]
    ekfsim("run", "run.yaml", "-q", "--trace", "trace")
    told = given(lines_of(place / "trace"))
    assert [int(row[0]) for row in rows[1:]] == [line["index"] for line in told] == [2, 3, 5, 6]
    for row, line in zip(rows[1:], told, strict=True):
        assert row[1] == line["type"]
        if row[1] == "move":
            assert row[4:] == ["", ""]
            assert float(row[2]) == line["odometry"]["distance"]
            assert np.radians(float(row[3])) == pytest.approx(line["odometry"]["angle"], rel=1e-15)
        else:
            assert row[2:4] == ["", ""]
            assert float(row[5]) == line["range"]
    assert [rows[2][4], rows[4][4]] == ["-86", "12.5"]


def test_nothing_there_tells_the_truth(place):
    ekfsim("record", "run.yaml", "-o", "log")
    told = "".join(file.read_text() for file in (place / "log").iterdir())
    for secret in ("secret", "31337", "run.yaml", "desk", "0.0625", "theta: 20", "0.02\n"):
        assert secret not in told
    assert "odometryDstSigmaRatio: 0.033" in told
    assert "start: {x: 1.2, y: 1.1, theta: 17.3" in told
    assert str(place) not in told


@pytest.mark.parametrize("name", ["ekf", "ukf", "pf", "kf"])
@pytest.mark.parametrize("of", [("run.yaml",), ("logged.yaml",)], ids=["--log", "recording"])
def test_run_again_it_is_the_same_in_every_filter(place, name, of):
    ekfsim("record", "run.yaml", "-o", "log", "--truth")
    options = ("-q", "--filter", name)
    simulated = ekfsim("run", "run.yaml", *options, "--seed", "31337", "--trace", "one")
    log = ("--log", "log") if of == ("run.yaml",) else ()
    recorded = ekfsim("run", *of, *log, *options, "--seed", "31337", "--trace", "two")
    assert (simulated.status, recorded.status, recorded.err) == (0, 0, "")
    one, two = given(lines_of(place / "one")), lines_of(place / "two")
    assert [line["index"] for line in two[1:]] == [2, 3, 5, 6]
    for a, b in zip(one, two[1:], strict=True):
        for belief in ("prior", "posterior"):
            P = np.array(a[belief]["covariance"])
            σ = np.maximum(np.sqrt(np.diag(P)), 1e-6)
            x, y = (np.array(line[belief]["mean"]) for line in (a, b))
            assert np.all(np.abs(x - y) <= 1e-9 * σ)
            Q = np.array(b[belief]["covariance"])
            assert np.all(np.abs(P - Q) <= 1e-9 * np.outer(σ, σ))
        assert b["truth"] == pytest.approx(a["truth"], abs=1e-14)
        assert b["impossible"] == a["impossible"]
    assert two[1]["command"] is None
    assert two[2]["command"] == one[1]["command"]


def test_every_packaged_classroom_can_be_handed_out_and_read_again(place):
    for name in packaged("commands"):
        if name.startswith(("proof", "tour", "square")):
            assert ekfsim("record", name, "-o", name).status == 0
            one, two = (
                ekfsim("run", name, *log, "--csv", "table", "-q", "--force")
                and [row for row in rows_of(place / "table") if row[1] in ("move", "sense")]
                for log in ([], ["--log", name])
            )
            assert [row[:2] for row in one] == [row[:2] for row in two]
            for a, b in zip(one, two, strict=True):
                assert np.float64(b[2:11]) == pytest.approx(np.float64(a[2:11]), abs=1e-12)


def test_the_rows_in_the_docs_are_those_of_the_tour(place):
    told = PAGE.read_text(encoding="utf-8").partition("index,kind,distance,angle,bearing,range\n")[
        2
    ]
    ekfsim("record", "tour", "-o", "log")
    written = rows_of(place / "log" / "entries.csv")[1:6]
    shown = list(csv.reader(told.split("```")[0].splitlines()))
    assert [row[:2] for row in shown] == [row[:2] for row in written]
    for a, b in zip(shown, written, strict=True):
        for one, other in zip(a[2:], b[2:], strict=True):
            assert (float(one or "nan")) == pytest.approx(float(other or "nan"), nan_ok=True)


def test_no_echo_is_an_empty_field(place):
    (place / "world.yaml").write_text(WORLD.replace("boundary:", "# boundary:"))
    ekfsim("record", "run.yaml", "-o", "log")
    rows = (place / "log" / "entries.csv").read_text().splitlines()
    assert rows[2] == "3,sense,,,-86,"
    ended = ekfsim("run", "logged.yaml")
    assert "There is no echo: the beam met no wall\n" in ended.out


def test_the_truth_comes_along_where_it_is_asked_for(place):
    assert ekfsim("record", "run.yaml", "-o", "log", "--truth").out.count("\n") == 1
    assert left_in(place / "log") == ["about.txt", "entries.csv", "truth.csv", "world.yaml"]
    assert "seed 31337" in (place / "log" / "about.txt").read_text()
    rows = rows_of(place / "log" / "truth.csv")
    assert [row[0] for row in rows] == ["index", "0", "2", "3", "5", "6"]
    assert ekfsim("record", "run.yaml", "-o", "log", "--force").status == 0
    assert left_in(place / "log") == ["entries.csv", "world.yaml"]


def test_a_move_of_a_log_is_a_view_of_its_own_and_tells_its_odometry(place):
    (place / "run.yaml").write_text(COMMANDS.replace("  - sense: {angle: -86}\n", ""))
    ekfsim("record", "run.yaml", "-o", "log")
    told = ekfsim("run", "logged.yaml").out
    assert told.count("==>The robot moved (its log does not tell what was commanded)\n") == 2
    assert "seed" in told
    assert "a secret name" not in told
    assert ekfsim("render", "logged.yaml", "-o", "film").out == "film: 5 pictures\n"
    shown = ekfsim("play", "logged.yaml", "--show", "text", keys=b"nnq")
    assert shown.status == 0
    assert "by odometry" in shown.out


def test_a_world_that_is_named_is_told_in_place_of_the_log_s_own(place):
    ekfsim("record", "run.yaml", "-o", "log")
    (place / "logged.yaml").write_text(f"world: world.yaml\n{LOGGED}")
    assert "odometryDstSigmaRatio=0.033" in ekfsim("run", "logged.yaml").out
    (place / "world.yaml").write_text(WORLD.replace("0.033", "0.044"))
    for args in (["logged.yaml"], ["run.yaml", "--log", "log", "--world", "world.yaml"]):
        assert "odometryDstSigmaRatio=0.044" in ekfsim("run", *args).out
    assert "odometryDstSigmaRatio=0.033" in ekfsim("run", "run.yaml", "--log", "log").out
    set_so = ("--set", "noise.odometryDstSigmaRatio=0.055")
    assert "odometryDstSigmaRatio=0.055" in ekfsim("run", "run.yaml", "--log", "log", *set_so).out


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("2,mvoe,1,2,,", "3:3: kind: 'mvoe' is no kind of entry; did you mean 'move'?"),
        ("2,move,1,,,", "3:10: angle: '' stands where a number belongs; write e.g. 1.5"),
        ("2,move,1,2,3,", "3:12: bearing: '3' stands in a move; leave the field empty: a move "
         "has none"),
        ("2,sense,,, 90,-1", "3:15: range: '-1' is negative; a range is 0 or more; an empty "
         "field is no echo"),
        ("2,sense,,,x,1", "3:11: bearing: 'x' is not a number; write e.g. 1.5"),
        ("2,move,nan,2,,", "3:8: distance: 'nan' cannot be meant; write one within ±1e+06"),
        ("1,move,1,2,,", "3:1: index: '1' does not go on; write a whole number above 1, that of "
         "the row above"),
        ("2,move,1,2", "3:1: 4 columns stand in this row; it must have 6, as the first line names"),
    ],
)  # fmt: skip
def test_a_row_that_is_wrong_is_told_with_its_place(place, row, told):
    ekfsim("record", "run.yaml", "-o", "log")
    head = "index,kind,distance,angle,bearing,range\n"
    (place / "log" / "entries.csv").write_text(f"{head}1,move,1,2,,\n{row}\n")
    ended = ekfsim("run", "logged.yaml")
    assert (ended.status, ended.out, ended.err) == (2, "", f"log/entries.csv:{told}\n")


def test_what_is_missing_is_told(place):
    ended = ekfsim("run", "run.yaml", "--log", "nowhere")
    assert ended.status == 2
    assert ended.err.startswith("ekfsim: nowhere: no such folder; name the one that holds entries")
    ekfsim("record", "run.yaml", "-o", "log")
    (place / "log" / "entries.csv").unlink()
    ended = ekfsim("run", "run.yaml", "--log", "log")
    assert (ended.status, ended.out) == (2, "")
    assert "no file 'entries.csv' in it; it would hold what was measured" in ended.err
    (place / "log" / "world.yaml").unlink()
    ended = ekfsim("run", "run.yaml", "--log", "log")
    assert "no file 'world.yaml' in it; it would hold the map and the ratios" in ended.err
