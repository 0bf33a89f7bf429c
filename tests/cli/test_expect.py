"""What a commands file promises under `expect` is verified by `ekfsim study COMMANDS --expect`."""

import pytest
from program import ekfsim, lay_out, left_in

KEPT = "expect: {lost: [0, 0.2], coverage: [0.7, 1], nis: silent, nees: silent, runs: 200}\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def promise(place, expect):
    """A file with this promise."""
    file = place / "short.yaml"
    file.write_text(expect + file.read_text())
    return "short.yaml"


def test_promises_that_are_kept_are_told_with_their_figures_and_end_in_0(place):
    ended = ekfsim("study", promise(place, KEPT), "--expect")
    assert (ended.status, ended.err) == (0, "")
    first, *lines = ended.out.splitlines()
    assert first == "short.yaml: 200 runs of seed 0, filter ekf"
    assert [line.split(": ")[:2] for line in lines] == [
        [name, "kept"] for name in ("lost", "coverage", "nis", "nees")
    ]
    assert all(" % [" in line and " of 200 runs " in line for line in lines)
    assert lines[0].endswith("are lost at the end, 0 to 20 % promised")
    assert lines[2].endswith("outside its two-sided 95 % band, fewer than 40 % promised")
    assert left_in(place) == ["long.yaml", "short.yaml", "world.yaml"]


@pytest.mark.parametrize(
    ("expect", "line"),
    [
        (
            "lost: [0.5, 1]",
            "lost: NOT kept: 3.5 % [1.7, 7.0] of 200 runs are lost at the end, 50 to 100 % "
            "promised",
        ),
        ("coverage: [0, 0.1]", "inside the 95.4 % ellipse, 0 to 10 % promised"),
        ("nis: high", "have a sum of NIS above its two-sided 95 % band, at least 40 % promised"),
        ("nis: low", "have a sum of NIS below its two-sided 95 % band, at least 40 % promised"),
        ("nees: high", "end with a NEES above its two-sided 95 % bounds, at least 20 % promised"),
        ("nees: low", "end with a NEES below its two-sided 95 % bounds, at least 20 % promised"),
    ],
)
def test_a_promise_that_is_broken_is_told_and_ends_in_1(place, expect, line):
    ended = ekfsim("study", promise(place, f"expect: {{{expect}, runs: 200}}\n"), "--expect")
    assert ended.status == 1
    assert ended.out.count("NOT kept") == 1
    assert ended.out.splitlines()[1].endswith(line)
    assert ended.err == "ekfsim: short.yaml: 1 of 1 promises not kept\n"


def test_a_promise_can_be_held_against_other_settings(place):
    name = promise(place, KEPT)
    wrong = ekfsim("study", name, "--expect", "--set", "belief.start.x=1")
    assert wrong.status == 1
    assert "nees: NOT kept" in wrong.out
    few = ekfsim("study", name, "--expect", "--runs", 50, "--seed", 4, "--filter", "ukf")
    assert few.out.startswith("short.yaml: 50 runs of seed 4, filter ukf\n")


def test_300_runs_of_the_files_seed_where_nothing_else_is_said(place):
    ended = ekfsim("study", promise(place, "seed: 7\nexpect: {lost: [0, 1]}\n"), "--expect")
    assert ended.out.startswith("short.yaml: 300 runs of seed 7,")


def test_the_study_is_written_where_a_folder_is_named(place):
    ended = ekfsim("study", promise(place, KEPT), "--expect", "-o", "out")
    assert ended.out == ekfsim("study", "short.yaml", "--expect").out
    assert (place / "out" / "summary.csv").read_text().count("\n") == 2
    assert ",200," in (place / "out" / "summary.csv").read_text()


def test_without_an_ellipse_no_coverage_can_be_kept(place):
    world = (place / "world.yaml").read_text()
    (place / "world.yaml").write_text(
        world.replace(", sigma: {x: 0.1, y: 0.1, theta: 5}", "").replace("0.05", "0")
    )
    ended = ekfsim("study", promise(place, "expect: {coverage: [0, 1]}\n"), "--expect")
    assert ended.status == 1
    assert ended.out.splitlines()[1].startswith(
        "coverage: NOT kept: no run ends with an ellipse that has an area,"
    )


@pytest.mark.parametrize(
    ("expect", "args", "line"),
    [
        (
            "",
            ["--expect"],
            "short.yaml: promises nothing; write e.g. expect: {lost: [0, 0.02], nis: silent} into "
            "it",
        ),
        ("expect: {runs: 5}\n", ["--expect"], "short.yaml: promises nothing;"),
        (
            KEPT,
            ["--expect", "--sweep", "gate=0.9,0.99"],
            "--expect verifies what one scene promises of one filter;",
        ),
        (
            KEPT,
            ["--expect", "--filter", "ekf,ukf"],
            "--expect verifies what one scene promises of one filter;",
        ),
        (KEPT, ["--resume"], "Missing option '--out' / '-o'."),
        (KEPT, ["--expect", "--resume"], "Missing option '--out' / '-o'."),
    ],
)
def test_what_cannot_be_verified_is_refused(place, expect, args, line):
    ended = ekfsim("study", promise(place, expect), *args)
    assert (ended.status, ended.out) == (2, "")
    assert line in ended.err
