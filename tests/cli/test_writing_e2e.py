"""Results are whole or absent, and every way a run can end has its status."""

import json
import os
import signal
from pathlib import Path

import pytest
from program import ekfsim, ended, lay_out, left_in, process, started, wait_for

RESULTS = (
    "--trace",
    "out/trace.jsonl",
    "--csv",
    "out/table.csv",
    "--summary",
    "summary.json",
    "--tum",
    "tum/of/it",
)
PUT_IN = ["long.yaml", "short.yaml", "world.yaml"]
full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
STATUS_OF_OURS = '; exit "${PIPESTATUS[0]}"'


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def half_done(place):
    """A run in the middle of its results."""
    running = started("run", "long.yaml", "-q", *RESULTS)
    wait_for(
        lambda: any(file.stat().st_size > 0 for file in (place / "out").glob(".*.partial")), running
    )
    return running


@pytest.mark.parametrize(("number", "status"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_a_run_that_is_ended_leaves_nothing_behind(place, number, status):
    running = half_done(place)
    # the first counts; who presses Ctrl-C again does not disturb the cleaning up
    for _ in range(3):
        running.send_signal(getattr(signal, number))
    how = ended(running)
    assert how.status == status
    assert how.err.strip() == ("ekfsim: interrupted" if number == "SIGINT" else "")
    assert left_in(place) == PUT_IN


def test_a_run_that_is_killed_leaves_no_result(place):
    running = half_done(place)
    running.kill()
    assert ended(running).status == -signal.SIGKILL
    left = [
        Path(name).name
        for name in left_in(place)
        if (place / name).is_file() and name not in PUT_IN
    ]
    assert len(left) == 5
    assert all(name.startswith(".") and name.endswith(".partial") for name in left)


def test_results_come_whole_and_their_folders_are_made(place):
    assert ekfsim("run", "short.yaml", *RESULTS).status == 0
    assert left_in(place) == [
        *(
            "long.yaml",
            "out",
            "out/table.csv",
            "out/trace.jsonl",
            "short.yaml",
            "summary.json",
            "tum",
            "tum/of",
        ),
        *("tum/of/it", "tum/of/it/estimate.tum", "tum/of/it/truth.tum", "world.yaml"),
    ]


def test_a_result_that_exists_stays_unless_it_is_to_be_replaced(place):
    (place / "summary.json").write_text("older")
    refused = ekfsim("run", "short.yaml", *RESULTS)
    assert (refused.status, refused.out) == (2, "")
    assert (
        refused.err
        == "ekfsim: summary.json: exists already; choose another name, or replace it with --force\n"
    )
    assert left_in(place) == ["long.yaml", "short.yaml", "summary.json", "world.yaml"]
    assert (place / "summary.json").read_text() == "older"
    assert ekfsim("run", "short.yaml", *RESULTS, "--force").status == 0
    assert (place / "summary.json").read_text().startswith("{")


@pytest.mark.parametrize(
    ("args", "why"),
    [
        (["--trace", "a", "--csv", "a"], "a: named twice; give each result a file of its own"),
        (
            ["--trace", "a", "--csv", "./new/../a"],
            "a: named twice; give each result a file of its own",
        ),
        (
            ["--trace", "tum/truth.tum", "--tum", "tum"],
            "tum/truth.tum: named twice; give each result a file of its own",
        ),
        (
            ["--trace", "a", "--csv", "a/b"],
            "a: is to be a file and a folder; give each result a name of its own",
        ),
        (
            ["--csv", "a", "--tum", "a"],
            "a: is to be a file and a folder; give each result a name of its own",
        ),
        (["--trace", "."], ".: this is a folder; name a file"),
        (["--tum", "world.yaml"], "world.yaml/truth.tum: 'world.yaml' is no folder"),
        (["--csv", "world.yaml/a/b"], "world.yaml/a/b: 'world.yaml' is no folder"),
        (["--csv", "loop/b"], "loop/b: "),
        (["--csv", "nowhere/b"], "nowhere/b: 'nowhere' is no folder"),
        (["--csv", "a" * 300], f"{'a' * 300}: cannot be written: File name too long"),
        (["--csv", "/proc/a"], "/proc/a: cannot be written: No such file or directory"),
    ],
)
def test_where_no_result_can_be_none_is_written(place, args, why):
    (place / "loop").symlink_to("loop")
    (place / "nowhere").symlink_to("nothing")
    before = left_in(place)
    refused = ekfsim("run", "short.yaml", "-q", *args)
    assert (refused.status, refused.out) == (2, "")
    assert refused.err.startswith(f"ekfsim: {why}")
    assert left_in(place) == before


def test_the_same_place_under_two_names_is_one(place):
    (place / "link").symlink_to(place)
    refused = ekfsim("run", "short.yaml", "--trace", "link/a", "--csv", place / "a")
    assert (refused.status, refused.err) == (
        2,
        "ekfsim: link/a: named twice; give each result a file of its own\n",
    )


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_may_not_be_written(place):
    (place / "sealed").mkdir(mode=0o500)
    refused = ekfsim("run", "short.yaml", "--trace", "sealed/a")
    assert (refused.status, refused.err) == (
        2,
        "ekfsim: sealed/a: cannot be written: Permission denied\n",
    )


def test_a_result_may_go_where_the_narrative_goes():
    told = process("run", "short.yaml", "-q", "--trace", "/dev/stdout", after=">both; cat both")
    assert told.status == 0
    assert all(json.loads(line)["type"] for line in told.out.splitlines())
    assert told.err.splitlines()[-1].startswith("Verdict: ")  # where it spoils no result


def test_a_result_never_replaces_what_it_is_made_from(place):
    refused = ekfsim("run", "short.yaml", "--trace", "./short.yaml", "--force")
    assert (refused.status, refused.err) == (
        2,
        "ekfsim: short.yaml: is what the run is made from; choose another name\n",
    )
    assert (place / "short.yaml").read_text().startswith("world:")


@full
def test_a_full_disk_is_a_failed_run_and_the_right_file_is_blamed(place):
    for result in ("--trace", "--csv", "--summary"):
        failed = ekfsim("run", "short.yaml", "-q", result, "/dev/full", "--tum", "tum")
        assert (failed.status, failed.out) == (1, "")
        assert failed.err == "ekfsim: /dev/full: writing failed: No space left on device\n"
        assert left_in(place) == PUT_IN


def test_a_disk_that_fills_at_the_very_end_leaves_no_result(place):
    assert ekfsim("run", "tour", "-q", "--trace", "trace").status == 0
    size = (place / "trace").stat().st_size
    (place / "trace").unlink()
    failed = process("run", "tour", "-q", *RESULTS, before=f"ulimit -f {(size - 1) // 1024};")
    assert (failed.status, failed.out) == (1, "")
    assert failed.err == "ekfsim: out/trace.jsonl: writing failed: File too large\n"
    assert left_in(place) == PUT_IN


@full
@pytest.mark.parametrize("args", [["run", "long.yaml", *RESULTS], ["list"], ["--help"]])
def test_standard_output_on_a_full_disk_is_a_failed_run(place, args):
    failed = process(*args, after=">/dev/full")
    assert (failed.status, failed.out) == (1, "")
    assert failed.err == "ekfsim: writing to standard output failed: No space left on device\n"
    assert left_in(place) == PUT_IN


@pytest.mark.parametrize(
    "args",
    [
        ["run", "tour"],
        ["run", "long.yaml", "--trace", "trace.jsonl"],
        ["run", "long.yaml", "-q", "--trace", "/dev/stdout"],
        ["list"],
        ["--help"],
    ],
)
def test_a_reader_who_has_seen_enough_is_no_failure(place, args):
    told = process(*args, after=f"| head -1 {STATUS_OF_OURS}")
    assert (told.status, told.err) == (0, "")
    assert len(told.out.splitlines()) == 1
    assert left_in(place) == PUT_IN


@pytest.mark.parametrize(("unbuffered", "written"), [("", [4]), ("1", [])])
def test_the_trace_of_a_run_that_no_one_read_is_whole_or_absent(place, unbuffered, written):
    after = f"| true {STATUS_OF_OURS}"
    assert (
        process(
            "run", "short.yaml", "--trace", "trace.jsonl", after=after, PYTHONUNBUFFERED=unbuffered
        ).status
        == 0
    )
    assert [len(file.read_text().splitlines()) for file in place.glob("*.jsonl")] == written


def test_closed_streams_are_no_failure(place):
    closed = process("run", "short.yaml", "--trace", "trace.jsonl", before="exec <&- >&- 2>&-;")
    assert closed == process("--version", after=">&-")
    assert (closed.status, closed.out, closed.err) == (0, "", "")
    assert (place / "trace.jsonl").read_text() == traced("short.yaml")


def traced(commands):
    ekfsim("run", commands, "--trace", "again.jsonl")
    return Path("again.jsonl").read_text()


def test_a_wrong_file_has_its_status_where_no_one_hears_of_it():
    assert process("run", "nowhere", after=">&- 2>&-").status == 2
    assert process("run", "nowhere", after=">/dev/null 2>&1 | true" + STATUS_OF_OURS).status == 2
