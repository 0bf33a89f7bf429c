"""--filter ekf,ukf: several filters watch the same run, side by side."""

import json
from pathlib import Path

import pytest
from program import ekfsim, lay_out, left_in

from ekfsim.filters import FILTERS

KNOWN = f"{', '.join(FILTERS)}, or one of your own: FILE.py"


INPUTS = ["long.yaml", "short.yaml", "world.yaml"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def told(*args):
    """What a command that succeeds without a warning prints."""
    ended = ekfsim(*args)
    assert (ended.status, ended.err) == (0, "")
    return ended.out


def test_the_first_filter_is_narrated_and_all_are_summed_up():
    alone, several = (
        told("run", "short.yaml", "--filter", "ukf"),
        told("run", "short.yaml", "--filter", "ukf, ekf"),
    )
    narrative, _, _ = alone.partition("The run is over")
    same, over, table = several.partition("The run is over")
    parted = next(line for line in table.splitlines() if line.startswith("ukf and ekf differ"))
    assert same.replace(f"{parted}\n", "") == narrative.replace("filter ukf,", "filter ukf,ekf,")
    assert same.count(parted) == 1
    assert over
    lines = table.splitlines()
    assert lines[0] == " after 3 commands; 2 filters side by side (RMSE in m, degrees):"
    assert [line.split()[0] for line in lines[1:5]] == ["filter", "ukf", "ekf", "odometry"]
    assert lines[1].split() == ["filter", "updates", "position", "heading", "ΣNIS", "99", "%",
    "band", "last", "NEES",
                                "innovations", "verdict"]  # fmt: skip
    assert lines[5:7] == [parted, ""]
    for name, line in zip(("ukf", "ekf"), lines[7:], strict=True):
        verdict = (
            told("run", "short.yaml", "-q", "--filter", name)
            .splitlines()[-1]
            .removeprefix("Verdict: ")
        )
        assert line == f"{name}: {verdict}"


def test_quiet_leaves_the_table():
    quiet = told("run", "short.yaml", "-q", "--filter", "ekf,ukf")
    assert quiet.count("\n") == 6
    assert f"{quiet}\n" in told("run", "short.yaml", "--filter", "ekf,ukf")


def test_the_table_holds_the_numbers_of_each_filters_summary(place):
    rows = told(
        "run", "diverge-01-wrong-wall", "-q", "--filter", "ekf,ukf", "--summary", "s.json"
    ).splitlines()[2:]
    for name, row in zip(("ekf", "ukf"), rows, strict=False):
        summary = json.loads((place / f"s.{name}.json").read_text())
        assert summary["filter"] == name
        cells = row.split()
        assert cells[:4] == [name, str(summary["updates"]), "of", "64"]
        assert float(cells[4]) == pytest.approx(summary["position"]["rmse"], rel=0.01)
        assert float(cells[6]) == pytest.approx(summary["nis"]["sum"], rel=0.01)
        assert cells[-1] == summary["verdict"]
    assert [row.split()[-1] for row in rows[:2]] == ["lost", "consistent"]


def test_each_filter_has_files_of_its_own_and_they_are_those_it_has_alone(place):
    files = ("--trace", "t.jsonl", "--csv", "table", "--summary", "s.json", "--tum", "tum")
    told("run", "short.yaml", "-q", "--filter", "ekf,ukf", *files)
    made = [f"{stem}.{name}{end}" for name in ("ekf", "ukf")
            for stem, end in (("s", ".json"), ("t", ".jsonl"), ("table", ""),
                              ("tum/estimate", ".tum"), ("tum/truth", ".tum"))]  # fmt: skip
    assert set(left_in(place)) == {*INPUTS, *made, "tum"}
    for name in ("ekf", "ukf"):
        told("run", "short.yaml", "-q", "--filter", name, *files, "--force")
        for stem, end in (("s", ".json"), ("t", ".jsonl"), ("table", ""), ("tum/estimate", ".tum")):
            assert (place / f"{stem}.{name}{end}").read_bytes() == (
                place / f"{stem}{end}"
            ).read_bytes()
    assert (place / "tum/truth.ekf.tum").read_text().split("\n")[1:] == (
        (place / "tum/truth.ukf.tum").read_text().split("\n")[1:]
    )


def test_files_of_several_filters_appear_together_or_not_at_all(place):
    (place / "t.ukf.jsonl").write_text("mine")
    ended = ekfsim("run", "short.yaml", "--filter", "ekf,ukf", "--trace", "t.jsonl")
    assert (ended.status, ended.out) == (2, "")
    assert (
        ended.err
        == "ekfsim: t.ukf.jsonl: exists already; choose another name, or replace it with --force\n"
    )
    assert left_in(place) == sorted([*INPUTS, "t.ukf.jsonl"])


@pytest.mark.parametrize(
    ("filters", "line"),
    [
        ("ekf,wizard", f"--filter wizard: there is no such filter; known: {KNOWN}"),
        ("ekf,", f"--filter : there is no such filter; known: {KNOWN}"),
        ("ekf,ukf,ekf", "--filter ekf,ukf,ekf: 'ekf' stands twice; delete one"),
    ],
)
@pytest.mark.parametrize("command", [["run"], ["play"], ["render", "-o", "out"]])
def test_what_is_no_list_of_filters_is_refused(place, command, filters, line):
    ended = ekfsim(*command, "short.yaml", "--filter", filters)
    assert (ended.status, ended.out, ended.err) == (2, "", f"ekfsim: {line}\n")
    assert left_in(place) == INPUTS


def test_a_result_on_standard_output_is_of_one_filter_only():
    ended = ekfsim("run", "short.yaml", "--filter", "ekf,ukf", "--trace", "/dev/stdout")
    assert (ended.status, ended.out) == (2, "")
    assert (
        ended.err
        == "ekfsim: /dev/stdout: holds the result of one filter only; name a file, or one filter\n"
    )


@pytest.mark.parametrize("show", ["text", "files"])
def test_an_interactive_run_shows_all_and_sums_all_up(place, show):
    args = ("short.yaml", "--filter", "ekf,ukf", "--show", show)
    ended = ekfsim("play", *args, keys=b"nnnnnq")
    assert (ended.status, ended.err) == (0, "")
    assert ended.out.count("u ukf") == (5 if show == "text" else 0)
    assert told("run", *args[:3]).rpartition("The run is over")[2] in ended.out
    if show == "files":
        alone = ekfsim(
            "play",
            "short.yaml",
            "--filter",
            "ekf",
            "--show",
            show,
            "--out",
            "alone",
            keys=b"nnnnnq",
        )
        assert alone.status == 0
        assert (place / "out/current.png").read_bytes() != (
            place / "alone/current.png"
        ).read_bytes()


def test_pictures_tell_which_filters_they_show(place):
    assert ekfsim("render", "short.yaml", "--filter", "ekf,ukf", "-o", "out").status == 0
    assert len(left_in(place / "out")) == 5
    assert b"filter ekf,ukf" in (place / "out/step-0003.png").read_bytes()


def test_driven_and_recorded_robots_have_several_filters_too(place):
    world = Path(__file__).resolve().parents[2] / "worlds/gnss.yaml"
    (place / "drive.yaml").write_text(f"world: {world}\ndrive: [{{v: 1, omega: 30, for: 3}}]\n")
    lines = told("run", "drive.yaml", "-q", "--filter", "ekf,ukf").splitlines()
    assert [line.split()[0] for line in lines[1:]] == ["filter", "ekf", "ukf", "odometry", "ekf"]
    assert (
        ekfsim("record", "drive.yaml", "--filter", "ekf,ukf", "--format", "own", "-o", "log").status
        == 0
    )
    assert (
        told("run", "gnss_log", "-q", "--filter", "ekf,ukf", "--log", "log").splitlines()[2:4]
        == lines[2:4]
    )
