"""study: from a command to tables and pictures, whatever ends it early."""

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from program import (
    COMMAND,
    SHORT,
    WORLD,
    ekfsim,
    ended,
    lay_out,
    left_in,
    process,
    started,
    wait_for,
)

from ekfsim.errors import RunError, UsageError
from ekfsim.files.scenes.load_study import read_request
from ekfsim.filters import FILTERS
from ekfsim.study.plan import Plan
from ekfsim.study.running import engines, journal
from ekfsim.views.study import folder as study_folder

FOLDER = ["commands.yaml", "coverage.png", "divergence.png", "nees.png", "steps.csv", "study.yaml",
    "summary.csv",
          "world.yaml"]  # fmt: skip
MANY = """\
world: world.yaml
seed: 5
commands:
  - repeat: {times: 25, commands: [{sense: {angle: 40}}, {move: {distance: 0.5, angle: 100}}]}
"""  # takes a while


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    (tmp_path / "many.yaml").write_text(MANY)
    return tmp_path


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def tables(folder):
    return {name: (Path(folder) / name).read_bytes() for name in FOLDER}


def test_a_study_leaves_a_folder_and_says_what_is_to_be_thought_of_it(place):
    told = ekfsim("study", "short.yaml", "--runs", 1500, "-o", "out")
    assert (told.status, told.err) == (0, "")
    assert left_in(place / "out") == sorted([*FOLDER, "why.txt"])  # for some runs are lost
    (row,) = rows("out/summary.csv")
    assert (row["filter"], row["runs"], row["step"], row["seed"], row["guard"]) == (
        "ekf",
        "1500",
        "3",
        "0",
        "warn",
    )
    lines = told.out.splitlines()
    assert lines[0].startswith("short.yaml: 1500 runs of seed 0, at the last step")
    assert " ".join(lines[2].split()).startswith(
        "filter position heading > 50 % > 95 % > 99.9 % ellipse cone lost NIS"
    )
    lean = "" if row["decided"] == "1" else "leans "
    assert lines[5].startswith(f"ekf: {lean}{row['verdict']} at the end")
    cells = lines[3].split()
    assert [line.partition(" %")[0].strip() for line in lines[6:9]] == [
        cells[3],
        cells[6],
        cells[8],
    ]
    played = "ekfsim play short.yaml --seed 0 --run"
    assert lines[9].startswith(f"  NIS is {float(row['nis_mean']):.3g} per number read")
    assert (
        " lie beyond the χ² 99.9 % quantile at step 2, the most of 2 steps with more than 2 %"
        in lines[11]
    )
    assert (row["on_the_way"], row["from_step"], row["to_step"], row["from_t"]) == (
        "over-confident",
        "2",
        "3",
        "",
    )
    assert lines[12].startswith(
        f"  the worst run: {played} {row['worst_run']} --filter ekf  # its last NEES is "
    )
    assert lines[13] == f"  a typical run: {played} {row['typical_run']} --filter ekf"
    why = played.replace("play", "why", 1)
    assert lines[14] == f"  why it was lost: {why} {row['worst_run']} --filter ekf"
    reason = (place / "out/why.txt").read_text().splitlines()
    assert reason[0] == f"short.yaml: seed 0, run {row['worst_run']}, ekf"
    assert reason[1].startswith("Cause: ")
    steps = rows("out/steps.csv")
    assert [step["step"] for step in steps] == ["0", "1", "2", "3"]
    assert all(steps[-1][name] == row[name] for name in steps[-1])


def test_a_first_look_needs_no_folder(place):
    arguments = ("study", "short.yaml", "--runs", 1100, "--sweep", "gate=0.9,0.99")
    before = left_in(place)
    looked = ekfsim(*arguments, "--workers", 2)
    assert (looked.status, looked.err[:33]) == (0, "ekfsim: nothing of this is kept; ")
    assert left_in(place) == before
    kept = ekfsim(*arguments, "-o", "out")
    assert (kept.status, kept.out, kept.err) == (0, looked.out, "")


def test_of_many_rows_the_table_is_enough(place):
    told = ekfsim(
        "study",
        "short.yaml",
        "--runs",
        2,
        "--sweep",
        "gate=0.5,0.6,0.7,0.8",
        "--sweep",
        "guard=off,skip",
    )
    assert sum("over-c" in line for line in told.out.splitlines()) == told.out.count("\n0.") == 8
    _, first, second = told.out.splitlines()[11:]
    assert (
        first
        == "What each verdict rests on, and the worst and a typical run of each row, stand in "
        "summary.csv (-o)."
    )
    assert second.startswith("the worst run: ekfsim play short.yaml --seed 0 --run ")


def test_the_same_study_writes_the_same_bytes_wherever_it_runs():
    for out, more in (("one", ()), ("two", ("--workers", 2)), ("three", ())):
        assert (
            ekfsim(
                "study", "short.yaml", "--runs", 2500, "--filter", "ekf,ukf", *more, "-o", out
            ).status
            == 0
        )
    assert tables("one") == tables("two") == tables("three")


def test_no_table_holds_a_date_or_a_path(place):
    (place / "sub").mkdir()
    for out in ("a", "sub/b"):
        assert ekfsim("study", place / "short.yaml", "--runs", 10, "-o", out).status == 0
    assert tables("a")["summary.csv"] == tables("sub/b")["summary.csv"]
    assert tables("a")["steps.csv"] == tables("sub/b")["steps.csv"]
    text = b"".join(
        tables("a")[name] for name in ("summary.csv", "steps.csv", "study.yaml")
    ).decode()
    assert "/" not in text.replace("`ekfsim study study.yaml -o FOLDER` makes", "")
    assert time.strftime("%Y") not in text


def test_a_studys_own_file_repeats_it(place):
    sweep = (
        "--sweep",
        "noise.rangeSigmaRatio=1e-2,0.05",
        "--sweep",
        "guard=off,skip",
        "--set",
        "belief.sigma.x=0.2",
    )
    told = ekfsim(
        "study", "short.yaml", "--runs", 300, "--seed", 9, "--filter", "ukf,kf", *sweep, "-o", "out"
    )
    assert told.status == 0
    assert yaml.safe_load((place / "out/study.yaml").read_text())["seed"] == 9
    shutil.move("world.yaml", "gone.yaml")  # the folder holds all that it needs
    assert ekfsim("check", "out/study.yaml").out == "out/study.yaml: ok\n"
    assert ekfsim("study", "out/study.yaml", "-o", "again").status == 0
    first, second = tables("out"), tables("again")
    for name in ("summary.csv", "steps.csv", "study.yaml", "commands.yaml", "world.yaml"):
        assert first[name] == second[name], name
    assert len(rows("out/summary.csv")) == 2 * 2 * 2


def test_a_sweep_is_a_grid_with_a_row_for_each_cell_and_filter():
    told = ekfsim(
        "study", "short.yaml", "--runs", 200, "--filter", "ekf,ukf",
        "--sweep", "noise.rangeSigmaRatio=0.01,0.3", "--sweep", "gate=off,0.5", "-o", "out",
    )  # fmt: skip
    assert told.status == 0
    found = rows("out/summary.csv")
    keys = [(row["noise.rangeSigmaRatio"], row["gate"], row["filter"]) for row in found]
    assert keys == [
        (r, g, f) for r in ("0.01", "0.3") for g in ("off", "0.5") for f in ("ekf", "ukf")
    ]
    assert float(found[0]["position_rmse"]) < float(found[4]["position_rmse"])
    assert "ekfsim play short.yaml --seed 0 --run " in told.out
    assert "--set noise.rangeSigmaRatio=0.01 --set gate=off" in told.out  # of the worst


def test_the_worst_run_is_the_one_that_play_shows(place):
    (place / "few.yaml").write_text(MANY.replace("25", "6"))
    ekfsim("study", "few.yaml", "--runs", 40, "--set", "noise.rangeSigmaRatio=0.003", "-o", "out")
    (row,) = rows("out/summary.csv")
    last = []
    for run in range(40):
        options = (
            "--run",
            run,
            "--set",
            "noise.rangeSigmaRatio=0.003",
            "--summary",
            f"{run}.json",
            "-q",
        )
        assert ekfsim("run", "few.yaml", *options).status == 0
        summary = json.loads((place / f"{run}.json").read_text())
        assert summary["set"] == "noise.rangeSigmaRatio=0.003"
        last.append(summary["nees"]["last"])
    assert int(row["worst_run"]) == last.index(max(last))
    assert abs(sorted(last).index(last[int(row["typical_run"])]) - 19.5) <= 1.5
    assert float(row["nees_mean"]) == pytest.approx(sum(last) / 40, rel=1e-4)


@pytest.mark.parametrize("name", ["mower", "pioneer", "gnss", "pylon"])
def test_the_other_systems_are_studied_too(place, name):
    drive = {
        "mower": "path: circle, radius: 2",
        "pioneer": "path: square, side: 1",
        "pylon": "path: square, side: 2",
    }
    world = Path(__file__).resolve().parents[2] / "worlds" / f"{name}.yaml"
    way = drive.get(name, "path: circle, radius: 1")
    (place / "drive.yaml").write_text(f"world: {world}\nseed: 3\ndrive: {{{way}}}\n")
    told = ekfsim(
        "study",
        "drive.yaml",
        "--runs",
        5,
        "--sweep",
        "robot.rate=10,20",
        "--filter",
        "ekf,ukf",
        "-o",
        "out",
    )
    assert (told.status, told.err) == (0, "")
    found = rows("out/summary.csv")
    assert len(found) == 4
    assert all(float(row["t"]) > 0 and row["nis_readings"] != "0" for row in found)


def test_a_recording_has_no_runs_to_compare():
    refused = ekfsim("compare", "gnss_log", "--b", "filter=ukf")
    assert refused.status == 2
    assert refused.err == (
        "ekfsim: gnss_log: a recording is one run only; sweep its settings with `ekfsim study`\n"
    )


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (["--sweep", "noise.rangeSigmaRato=1,2"],
         "--sweep noise.rangeSigmaRato=1: unknown key 'rangeSigmaRato'; did you mean "
         "'noise.rangeSigmaRatio'?"),
        (["--sweep", "nose.rangeSigmaRatio=1,2"],
         "--sweep nose.rangeSigmaRatio=1: unknown key 'nose'; did you mean "
         "'noise.rangeSigmaRatio'?"),
        (["--sweep", "noise=1"],
         "--sweep noise=1: 'noise' is no single value; write e.g. noise.executionDstSigmaRatio"),
        (["--sweep", "noise.rangeSigmaRatio=0.1,-1"],
         "--sweep noise.rangeSigmaRatio=-1: -1 is negative; write a number of 0 or more"),
        (["--sweep", "noise.rangeSigmaRatio=0.1,much"],
         "--sweep noise.rangeSigmaRatio=much: 'much' is text where a number belongs; write e.g. "
         "0.01"),
        (["--sweep", "start.x=0,2.5"],
         "--sweep start.x=2.5: the robot starts at [2.5, 0], inside the obstacle 'desk' or on its "
         "wall; "
         "start it where it can move"),
        (["--sweep", "guard=jump"], "--sweep guard=jump: 'jump' is not known here; write off, "
                                    "warn or skip"),
        (["--sweep", "gate=2"], "--sweep gate=2: 2 is not strictly between 0 and 1; write e.g. "
                                "0.99"),
        (["--sweep", "noise.rangeSigmaRatio=0.1,0.10"],
         "--sweep noise.rangeSigmaRatio=0.10: the value stands twice; delete one"),
        (["--sweep", "noise.rangeSigmaRatio"], "--sweep noise.rangeSigmaRatio: this is no "
                                               "KEY=VALUE,VALUE,…; "
         "write e.g. --sweep noise.rangeSigmaRatio=0.01,0.02,0.05"),
        (["--set", "gate"], "--set gate: this is no KEY=VALUE; write e.g. --set "
                            "noise.rangeSigmaRatio=0.02"),
        (["--gate", "0.9", "--sweep", "gate=0.5"],
         "--sweep gate=0.5: 'gate' is told already by --gate 0.9; "
         "keep one of them"),
        (["--set", "robot.rate=3"], "--set robot.rate=3: the classroom's robot is told by 'noise'; "
         "delete 'robot', or write e.g. system: mower"),
        (["--set", "belief.missing=desk"], "--set belief.missing=desk: 'belief.missing' is a list; "
         "only single values can be set, e.g. noise.rangeSigmaRatio"),
        (["--set", "start.x.y=3"], "--set start.x.y=3: 'start.x' is one value and holds no 'y'; "
                                   "write start.x"),
        (["--filter", "ekf,ufk"], "--filter ufk: there is no such filter; did you mean 'ukf'?"),
        (["--filter", "ekf,ekf"], "--filter ekf,ekf: 'ekf' stands twice; delete one"),
        (["--sweep", "noise.rangeSigmaRatio=" + ",".join(map(str, range(5001))), "--filter",
        "ekf,ukf"],
         "the table would have 10002 rows, more than 10000; sweep fewer values"),
        (["--workers", 2, "--cluster", "tcp://127.0.0.1:9"],
         "--workers: a cluster has its own; leave this out, or --cluster"),
        (["-o", "short.yaml/out"], "short.yaml/out: 'short.yaml' is no folder"),
    ],
)  # fmt: skip
def test_a_wrong_option_is_one_clear_line(place, options, line):
    told = ekfsim("study", "short.yaml", "-o", "out", *options)
    assert (told.status, told.out) == (2, "")
    assert told.err == f"ekfsim: {line}\n"
    assert not (place / "out").exists()
    assert not (place / "out.partial").exists()


STUDY = """\
study: short.yaml
runs: 100
filters: [ekf, ukf]
sweep:
  noise.rangeSigmaRatio: [0.01, 0.05]
set: {belief.sigma.x: 0.1}
guard: skip
"""


def test_a_study_file_is_overruled_by_options(place):
    (place / "s.yaml").write_text(STUDY)
    assert (
        ekfsim(
            "study", "s.yaml", "--runs", 20, "--filter", "ekf", "--guard", "off", "-o", "out"
        ).status
        == 0
    )
    found = rows("out/summary.csv")
    assert [(row["noise.rangeSigmaRatio"], row["runs"], row["guard"]) for row in found] == [
        ("0.01", "20", "off"),
        ("0.05", "20", "off"),
    ]
    assert found[0]["set"] == "belief.sigma.x=0.1 guard=off"


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("runs: 100", "runs: 0", "s.yaml:2:7: runs: 0 is too small; write a whole number of 1 or "
                                 "more"),
        ("runs: 100", "run: 100", "s.yaml:2:1: unknown key 'run'; did you mean 'runs'?"),
        ("[ekf, ukf]", "[ekf, ufk]", f"s.yaml:3:10: filters: 'ufk' is no filter; known: "
                                     f"{', '.join(FILTERS)}, or one of your own: FILE.py"),
        ("0.05]", "[1]]", "s.yaml:5:33: sweep.noise.rangeSigmaRatio[1]: a list stands where a "
                          "number or a word "
         "belongs; write e.g. 0.02"),
        ("[0.01, 0.05]", "0.05", "s.yaml:5:26: sweep.noise.rangeSigmaRatio: 0.05 is a number "
                                 "where a list belongs; "
         "write e.g. [0.005, 0.01, 0.02]"),
        ("0.05]", "-0.05]", "s.yaml:5:33: sweep.noise.rangeSigmaRatio[1]: -0.05 is negative; "
         "write a number of 0 or more"),
        ("noise.rangeSigmaRatio", "noise.rangeSigma",
         "s.yaml:5:3: sweep: unknown key 'rangeSigma'; "
         "did you mean 'noise.rangeSigmaRatio'?"),
        ("belief.sigma.x: 0.1", "guard: off", "s.yaml:7:1: guard: 'guard' is told already by "
                                              "'set.guard'; "
         "keep one of them"),
        ("0.05]", "0.01]", "s.yaml:5:33: sweep.noise.rangeSigmaRatio[1]: 0.01 stands twice; "
                           "delete one"),
        ("study: short.yaml", "study: shrt.yaml", "s.yaml:1:8: study: shrt.yaml: no such file; "
         "did you mean 'short.yaml'?"),
        ("guard: skip", "guard: jump", "s.yaml:7:8: guard: 'jump' is not known here; write off, "
                                       "warn or skip"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_study_file_has_its_place(place, old, new, line):
    (place / "s.yaml").write_text(STUDY.replace(old, new))
    told = ekfsim("study", "s.yaml", "-o", "out")
    assert (told.status, told.out, told.err) == (2, "", f"{line}\n")
    assert ekfsim("check", "s.yaml").out == f"{line}\n"


def test_a_folder_that_is_there_is_refused_before_anything_runs(place):
    (place / "out").mkdir()
    (place / "out/thesis.tex").write_text("mine")
    told = ekfsim("study", "many.yaml", "--runs", 10**9, "-o", "out")
    assert (told.status, told.err) == (
        2,
        "ekfsim: out: the folder is not empty; choose another, or replace what it holds with "
        "--force\n",
    )
    told = ekfsim("study", "many.yaml", "--runs", 10**9, "-o", "out", "--force")
    assert told.status == 2
    assert "thesis.tex" in told.err
    (place / "out/thesis.tex").unlink()
    assert ekfsim("study", "short.yaml", "--runs", 3, "-o", "out").status == 0
    assert ekfsim("study", "short.yaml", "--runs", 4, "-o", "out", "--force").status == 0
    assert rows("out/summary.csv")[0]["runs"] == "4"


def kill(running):
    """End a process as a power cut would."""
    running.kill()
    ended(running)


def journal_holds(place, lines):
    journal = place / "out.partial/journal.jsonl"
    return lambda: journal.exists() and journal.read_bytes().count(b"\n") > lines


BLOCKS = ("study", "many.yaml", "--runs", 20 * 1024, "-o", "out")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """What the study is that nothing ended early."""
    folder = lay_out(tmp_path_factory.mktemp("whole"))
    (folder / "many.yaml").write_text(MANY)
    assert (
        process(
            "study", folder / "many.yaml", "--runs", 20 * 1024, "--workers", 2, "-o", folder / "out"
        ).status
        == 0
    )
    return tables(folder / "out")


def check_resumed(whole, *more):
    told = process(*BLOCKS, "--resume", *more)
    assert (told.status, told.err) == (0, "")
    ours = tables("out")
    for name in ("summary.csv", "steps.csv", "study.yaml"):
        assert ours[name] == whole[name], name
    assert not Path("out.partial").exists()


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupted_study_goes_on(place, whole, workers):
    running = started(*BLOCKS, "--workers", workers, start_new_session=True)
    wait_for(journal_holds(place, 3), running)
    os.killpg(running.pid, signal.SIGINT)
    told = ended(running)
    assert told.status == 130
    (line,) = told.err.splitlines()
    assert line.startswith("ekfsim: interrupted; ")
    assert line.endswith(" of 20 blocks are kept in out.partial, --resume goes on with the rest")
    assert not (place / "out").exists()
    check_resumed(whole, "--workers", 2)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_killed_study_goes_on_and_leaves_no_worker_behind(place, whole, workers):
    running = started(*BLOCKS, "--workers", workers)
    wait_for(journal_holds(place, 3), running)
    children = children_of(running.pid)
    kill(running)
    deadline = time.monotonic() + 20
    while any(map(alive, children)):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    with (place / "out.partial/journal.jsonl").open("ab") as journal:
        journal.write(b'{"case":0,"block":19,"tal')
    refused = process(*BLOCKS)
    assert (refused.status, refused.err) == (
        2,
        "ekfsim: out.partial: holds what was done of a study that did not end; go on with "
        "--resume, "
        "or begin anew with --force\n",
    )
    check_resumed(whole, "--workers", 2)


def test_an_interrupt_while_workers_begin_is_a_line(place):
    running = started(*BLOCKS, "--workers", 2, start_new_session=True)
    wait_for(
        lambda: any(b"spawn_main" in command_of(child) for child in children_of(running.pid)),
        running,
    )
    os.killpg(running.pid, signal.SIGINT)
    told = ended(running)
    assert (told.status, told.err) == (130, "ekfsim: interrupted\n")
    assert not (place / "out.partial").exists()


@pytest.mark.parametrize("command", ["study", "compare"])
def test_a_study_that_is_ended_before_its_first_block_says_so(place, command, monkeypatch):
    monkeypatch.setattr(engines, "serial", lambda work, tasks: signal.raise_signal(signal.SIGTERM))
    more = ("-o", "out") if command == "study" else ("--b", "guard=skip")
    told = ekfsim(command, "short.yaml", "--runs", 5, *more)
    assert (told.status, told.err) == (143, "ekfsim: ended\n")
    assert not (place / "out.partial").exists()


def test_a_study_that_fails_in_its_tables_says_how_it_goes_on(place, monkeypatch):
    def full(*_):
        raise RunError("out: writing failed: No space left on device")

    monkeypatch.setattr(study_folder, "draw_study", full)
    told = ekfsim("study", "short.yaml", "--runs", 5, "-o", "out")
    why = "ekfsim: out: writing failed: No space left on device"
    kept = "all blocks are kept in out.partial, --resume goes on with the tables"
    assert (told.status, told.err) == (1, f"{why}; {kept}\n")
    monkeypatch.undo()
    monkeypatch.chdir(place)
    assert ekfsim("study", "short.yaml", "--runs", 5, "-o", "out", "--resume").status == 0
    assert left_in(place / "out") == FOLDER


def test_a_dead_worker_is_told_in_a_line(place, whole):
    running = started(*BLOCKS, "--workers", 2)
    wait_for(journal_holds(place, 3), running)
    for child in children_of(running.pid):
        if b"spawn_main" in command_of(child):
            os.kill(child, signal.SIGKILL)
            break
    told = ended(running)
    assert told.status == 1
    (line,) = told.err.splitlines()
    assert line.startswith("ekfsim: a worker process died")
    assert line.endswith("blocks are kept in out.partial, --resume goes on with the rest")
    check_resumed(whole)


def children_of(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def command_of(pid):
    return Path(f"/proc/{pid}/cmdline").read_bytes()


def alive(pid):
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False


def test_another_study_is_not_gone_on_with(place, monkeypatch):
    running = started(*BLOCKS)
    wait_for(journal_holds(place, 1), running)
    kill(running)
    begun = "ekfsim: out.partial: was begun as another study: "
    for more, what in (
        (("--seed", 6), "seed was 5, and is now 6"),
        (("--filter", "ukf"), "filters was ekf, and is now ukf"),
        (("--runs", 7), "runs was 20480, and is now 7"),
        (("--gate", 0.9), "set was not given, and is now gate=0.9"),
        (("--sweep", "guard=off,skip"), "sweep was not given, and is now guard=off,skip"),
    ):
        told = ekfsim(*BLOCKS, *more, "--resume")
        assert (told.status, told.err) == (2, f"{begun}{what}; begin anew with --force\n")
    with monkeypatch.context() as changed:
        changed.setattr(journal, "PACKAGE", place)  # another program of the same version
        told = ekfsim(*BLOCKS, "--resume")
        assert told.status == 2
        assert told.err.startswith(
            "ekfsim: out.partial: was begun by a program that was not this one to the letter, "
        )
    (place / "world.yaml").write_text(WORLD.replace("0.05", "0.06"))
    assert "the world file was another" in ekfsim(*BLOCKS, "--resume").err
    (place / "many.yaml").write_text(SHORT)
    assert "the commands file was another" in ekfsim(*BLOCKS, "--resume").err
    told = ekfsim("study", "short.yaml", "--runs", 5, "-o", "out", "--force")
    assert told.status == 0
    assert not (place / "out.partial").exists()


def test_resume_without_a_journal_starts_from_nothing(place):
    told = ekfsim("study", "short.yaml", "--runs", 5, "--resume", "-o", "out")
    assert told.status == 0
    assert (
        told.err
        == "ekfsim: out.partial: nothing is kept there to go on with; this is a study from the "
        "beginning\n"
    )
    assert left_in(place / "out") == FOLDER


@pytest.mark.skipif(os.name != "posix", reason="there is no `ulimit`")
@pytest.mark.parametrize(("kB", "left"), [(0, []), (60, ["out.partial"])])
def test_a_disk_that_takes_no_more_is_told_in_a_line(place, kB, left):
    limited = ["bash", "-c", f'ulimit -f {kB}; exec "$@"', "bash", *COMMAND]
    words = [str(word) for word in ("study", "short.yaml", "--runs", 10**6, "-o", "out")]
    told = subprocess.run([*limited, *words], capture_output=True, text=True, check=False)
    assert told.returncode == 1
    (line,) = told.stderr.splitlines()
    assert line.startswith("ekfsim: out.partial/journal.jsonl: writing failed: File too large")
    assert line.endswith("are kept in out.partial, --resume goes on with the rest") == bool(left)
    assert sorted(path.name for path in place.glob("out*")) == left


def test_two_at_one_place_are_one_too_many(place):
    running = started(*BLOCKS)
    wait_for(journal_holds(place, 1), running)
    refused = [ekfsim(*BLOCKS, *more) for more in ((), ("--resume",), ("--force",))]
    done = place / "out.partial/journal.jsonl"
    kill(running)
    for told in refused:
        assert told.status == 2
        assert (
            told.err
            == "ekfsim: out.partial: another study is at work there; wait for it, or choose "
            "another name\n"
        )
    assert done.read_bytes().startswith(b'{"journal":')  # not even --force touched it


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    """A study of two blocks, and one of very many that was killed after some."""
    folder = lay_out(tmp_path_factory.mktemp("begun"))
    with pytest.MonkeyPatch.context() as there:
        there.chdir(folder)
        assert ekfsim("study", "short.yaml", "--runs", 2000, "-o", "whole").status == 0
        running = started("study", "short.yaml", "--runs", 10**8, "-o", "out")
        wait_for(journal_holds(folder, 1), running)
        kill(running)
    return folder


@pytest.mark.parametrize("line", [b"{}\n", b"7\n", b"null\n", b'{"case":0}\n', b"\xff\n"])
def test_what_is_damaged_in_a_journal_is_done_again(place, begun, line):
    shutil.copytree(begun / "out.partial", "out.partial")
    journal = place / "out.partial/journal.jsonl"
    head, first, *_ = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(head.replace(b'"runs":100000000', b'"runs":2000') + first + line + first)
    assert ekfsim("study", "short.yaml", "--runs", 2000, "-o", "out", "--resume").status == 0
    assert tables("out") == tables(begun / "whole")


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="there are no terminals to be had")
def test_a_terminal_sees_how_far_it_is_and_how_many_are_lost_so_far():
    shown, terminal = os.openpty()
    running = started("study", "short.yaml", "--runs", 3000, "-o", "out", stderr=terminal)
    os.close(terminal)
    text = b""
    while True:
        try:
            piece = os.read(shown, 65536)
        except OSError:  # the other end is closed
            break
        if not piece:
            break
        text += piece
    os.close(shown)
    assert running.wait() == 0
    assert b"blocks" in text
    assert b"100%" in text
    assert b"% lost" in text


def test_a_fast_study_says_the_same(place):
    pytest.importorskip("numba")
    told = []
    for out, more in (("plain", ()), ("fast", ("--fast",))):
        done = ekfsim("study", "short.yaml", "--runs", 1500, *more, "-o", out)
        assert done.status == 0
        told.append(done.out.splitlines()[0])
    assert told[0].endswith("at the last step")
    assert re.fullmatch(re.escape(told[0]) + r"; [1-9]\d* runs a second", told[1])
    (plain,), (fast,) = rows("plain/summary.csv"), rows("fast/summary.csv")
    for name, value in plain.items():
        assert fast[name] == value or float(fast[name]) == pytest.approx(float(value), rel=1e-9)
    assert "fast: true" in (place / "fast" / "study.yaml").read_text()
    assert ekfsim("study", "fast/study.yaml", "-o", "again").status == 0
    assert rows("again/summary.csv") == [fast]


def test_a_plain_study_says_the_same_wherever_it_is_done(place):
    """In worker processes too: the way travels with the block."""
    for out, more in (("quick", ()), ("plain", ("--plain",)), ("two", ("--plain", "--workers", 2))):
        assert ekfsim("study", "short.yaml", "--runs", 1100, *more, "-o", out).status == 0
    (quick,), (plain,) = rows("quick/summary.csv"), rows("plain/summary.csv")
    for name, value in quick.items():
        assert plain[name] == value or float(plain[name]) == pytest.approx(float(value), rel=1e-9)
    assert (place / "two/steps.csv").read_bytes() == (place / "plain/steps.csv").read_bytes()
    told = "`ekfsim study study.yaml -o FOLDER --plain` makes this study again"
    assert told in (place / "plain" / "study.yaml").read_text()
    assert ekfsim("study", "plain/study.yaml", "-o", "again", "--plain").status == 0
    assert rows("again/summary.csv") == [plain]


def test_there_is_one_way_to_calculate():
    for command in ("study", "compare"):
        failed = ekfsim(command, "tour", "--plain", "--fast")
        assert failed.status == 2
        assert failed.err == ("ekfsim: --plain and --fast are two ways to calculate; choose one\n")


def test_a_fast_study_without_numba_says_what_to_install(monkeypatch):
    monkeypatch.setattr("ekfsim.study.plan.compiles", lambda: False)
    with pytest.raises(
        UsageError, match=r"--fast needs Numba; install it with: pip install 'ekfsim\[fast\]'"
    ):
        Plan.of(replace(read_request("tour"), fast=True))
