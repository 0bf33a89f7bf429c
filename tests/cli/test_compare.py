"""compare: two settings side by side on the same draws."""

import csv
from pathlib import Path

import pytest
from program import ekfsim, lay_out, left_in

from ekfsim.filters import FILTERS

LOUD = "belief.noise.rangeSigmaRatio=0.0005"  # a filter that trusts its laser too much
RUNS = ("--runs", 200)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def told(*args):
    """What is printed of a comparison that succeeds without a warning."""
    ended = ekfsim("compare", *args)
    assert (ended.status, ended.err) == (0, "")
    return ended.out


def table(folder):
    """The rows of its table."""
    with (Path(folder) / "compare.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_two_settings_are_told_in_a_table_and_in_sentences(place):
    lines = told("diverge-01-wrong-wall", "--b", "guard=skip", *RUNS).splitlines()
    assert (
        lines[0]
        == "diverge-01-wrong-wall: 200 runs of seed 27, each under either setting on the same draws"
    )
    assert lines[1:3] == ["  a: as the file stands", "  b: guard=skip"]
    assert " ".join(lines[3].split()) == "at the last step a b b − a 95 % interval a alone b alone"
    assert lines[9].startswith("b loses fewer runs, by 34 percentage points (27.4 to 40.8): ")
    assert lines[9].endswith("): a 35 %, b 1 %")
    assert "b ends on average" in lines[11]
    assert " nearer to the true position (" in lines[11]
    assert left_in(place) == ["long.yaml", "short.yaml", "world.yaml"]


def test_what_a_study_of_either_side_finds_is_what_is_compared():
    told("short.yaml", "--a", "filter=ukf", "--b", f"gate=0.9,{LOUD}", *RUNS, "-o", "out")
    rows = {row["measure"]: row for row in table("out")}
    assert {row["a_sets"] for row in rows.values()} == {"filter=ukf"}
    assert {row["b_sets"] for row in rows.values()} == {f"filter=ekf, gate=0.9, {LOUD}"}
    for side, options in (("a", ("--filter", "ukf")), ("b", ("--gate", 0.9, "--set", LOUD))):
        assert ekfsim("study", "short.yaml", *RUNS, *options, "-o", f"study-{side}").status == 0
        with Path(f"study-{side}/summary.csv").open(newline="") as file:
            (row,) = csv.DictReader(file)
        assert rows["lost"][side] == row["lost"]
        assert rows["ellipse"][side] == row["ellipse"]


def test_a_folder_holds_all_that_is_needed_to_repeat_it(place):
    said = told("short.yaml", "--a", "guard=off", "--b", f"filter=iekf,{LOUD}", "--set",
    "faults.rangeBias=0.05", *RUNS,
                "-o", "out")  # fmt: skip
    assert left_in(place / "out") == [
        "commands.yaml",
        "compare.csv",
        "compare.png",
        "compare.yaml",
        "world.yaml",
    ]
    again = told("out/compare.yaml", "-o", "again")
    assert again.partition("\n")[2] == said.partition("\n")[2]
    for name in ("compare.csv", "compare.yaml"):
        assert (place / "again" / name).read_bytes() == (place / "out" / name).read_bytes()
    assert (place / "out" / "compare.png").read_bytes().startswith(b"\x89PNG")


def test_workers_change_nothing():
    settings = ("short.yaml", "--b", LOUD, "--runs", 2100)
    assert told(*settings, "--workers", 2) == told(*settings)


def test_settings_that_do_the_same_are_told_to(place):
    assert told("short.yaml", "--a", "guard=warn", "--b", "guard=off", *RUNS).splitlines()[-1] == (
        "a and b end alike in every run"
    )


def test_the_options_of_either_side_win_over_those_of_both():
    lines = told("short.yaml", "--gate", "0.9", "--b", "gate=0.5", *RUNS, "--seed", 3).splitlines()
    assert lines[:3] == [
        "short.yaml: 200 runs of seed 3, each under either setting on the same draws",
        "  a: as the file stands",
        "  b: gate=0.5",
    ]


@pytest.mark.parametrize(
    ("args", "line"),
    [
        ([], "short.yaml: nothing is compared; write e.g. --a guard=off --b guard=skip,gate=0.99"),
        (
            ["--a", "gate=0.9", "--b", "gate=0.9"],
            "short.yaml: a and b are the same; let them differ",
        ),
        (
            ["--a", "gate=0.9", "--b", "gate=0.90,gate=0.5"],
            "--b gate=0.90,gate=0.5: 'gate' is set twice; keep one of",
        ),
        (
            ["--a", "guard"],
            "--a guard: this is no KEY=VALUE; write e.g. --a noise.rangeSigmaRatio=0.02",
        ),
        (["--a", ""], "--a : this is no KEY=VALUE;"),
        (["--b", "mine.py"], "--b mine.py: this is no KEY=VALUE; write e.g. --b filter=mine.py"),
        (
            ["--a", "guard=off,"],
            "--a guard=off,: '' is no KEY=VALUE; write e.g. --a guard=skip,gate=0.99",
        ),
        (
            ["--b", "filter=ekf,ukf"],
            "--b filter=ekf,ukf: 'ukf' is no KEY=VALUE; write e.g. --b guard=skip,gate=0.99",
        ),
        (["--a", "gaurd=off"], "--a gaurd=off: unknown key 'gaurd'; did you mean 'guard'?"),
        (
            ["--b", "guard=maybe"],
            "--b guard=maybe: 'maybe' is not known here; write off, warn or skip",
        ),
        (
            ["--b", "filter=wizard"],
            f"--b filter wizard: there is no such filter; known: {', '.join(FILTERS)}, or one of "
            "your own: FILE.py",
        ),
        (["--b", "gate=2"], "--b gate=2: "),
        (
            ["--filter", "ekf,ukf", "--b", "gate=0.9"],
            "short.yaml: a study of several cells; compare two: say which",
        ),
    ],
)
def test_what_cannot_be_compared_is_refused_in_a_line(place, args, line):
    ended = ekfsim("compare", "short.yaml", *args)
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith(f"ekfsim: {line}")
    assert ended.err.count("\n") == 1


def test_mistakes_in_a_file_of_a_comparison_are_told_at_their_place(place):
    (place / "compare.yaml").write_text(
        "study: short.yaml\na: {gaurd: off}\nb: {filter: wizard, gate: [1]}\n"
    )
    ended = ekfsim("compare", "compare.yaml")
    assert ended.status == 2
    assert "compare.yaml:3:" in ended.err
    (place / "compare.yaml").write_text("study: short.yaml\na: {gaurd: off}\nb: {filter: wizard}\n")
    assert ekfsim("compare", "compare.yaml").err.splitlines() == [
        "compare.yaml:2:5: a: unknown key 'gaurd'; did you mean 'guard'?",
        f"compare.yaml:3:13: b.filter: 'wizard' is no filter; known: {', '.join(FILTERS)}, or one "
        "of your own: FILE.py",
    ]


def test_check_looks_at_either_side(place):
    (place / "compare.yaml").write_text(
        "study: short.yaml\na: {gate: 2, filter: ukf}\nb: {start.x: 100}\n"
    )
    ended = ekfsim("check", "compare.yaml")
    assert ended.status == 2
    first, second = ended.out.splitlines()
    assert first.startswith("compare.yaml:2:11: a.gate: ")
    assert second.startswith("compare.yaml:3:14: b.start.x: ")
    (place / "compare.yaml").write_text("study: short.yaml\nset: {gate: 0.9}\nb: {gate: 0.99}\n")
    assert ekfsim("check", "compare.yaml").out == "compare.yaml: ok\n"


def test_a_file_of_a_comparison_is_no_study(place):
    (place / "compare.yaml").write_text("study: short.yaml\nruns: 100\nb: {guard: skip}\n")
    ended = ekfsim("study", "compare.yaml", "-o", "out")
    assert ended.status == 2
    assert ended.err.endswith("puts two settings side by side; run it with `ekfsim compare`\n")
    assert ": 100 runs of seed 0, " in told("compare.yaml").partition("\n")[0]


def test_results_that_exist_are_not_replaced_unasked(place):
    told("short.yaml", "--b", LOUD, *RUNS, "-o", "out")
    before = (place / "out" / "compare.csv").read_bytes()
    ended = ekfsim("compare", "short.yaml", "--b", "gate=0.5", *RUNS, "-o", "out")
    assert ended.status == 2
    assert (place / "out" / "compare.csv").read_bytes() == before
    told("short.yaml", "--b", "gate=0.5", *RUNS, "-o", "out", "--force")
    assert (place / "out" / "compare.csv").read_bytes() != before
