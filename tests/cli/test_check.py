"""check, schema, list and new."""

import json
import os
import re
from pathlib import Path

import pytest
from program import SHORT, WORLD, ekfsim, lay_out, left_in, process

from ekfsim.files.packaged import description_of, grouped, packaged


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def test_each_sound_file_is_ok_on_a_line_of_its_own():
    told = ekfsim("check", "world.yaml", "short.yaml")
    assert (told.status, told.out, told.err) == (0, "world.yaml: ok\nshort.yaml: ok\n", "")


def test_every_mistake_of_every_file_is_told_at_its_place(place):
    (place / "wrong.yaml").write_text(
        SHORT.replace("distance: 1", "distanz: 1").replace("angle: 0", "angle: no")
    )
    (place / "odd.yaml").write_text(WORLD.replace("0.05", "-1", 1))
    told = ekfsim("check", "wrong.yaml", "world.yaml", "odd.yaml")
    assert told.status == 2
    assert told.err == ""
    assert told.out.splitlines() == [
        "wrong.yaml:3:12: commands[0].move: unknown key 'distanz'; did you mean 'distance'?",
        "wrong.yaml:4:20: commands[1].sense.angle: 'no' is text where a number belongs; write "
        "e.g. 90",
        "world.yaml: ok",
        "odd.yaml:7:27: noise.executionDstSigmaRatio: -1 is negative; write a number of 0 or more",
    ]


def test_a_missing_file_hides_no_other(place):
    (place / "empty.yaml").write_text("")
    told = ekfsim("check", "nowhere.yaml", "world.yaml", ".", "empty.yaml")
    assert told.status == 2
    assert (
        told.err
        == "ekfsim: nowhere.yaml: no such file\nekfsim: .: is a folder; name a file in it\n"
    )
    assert told.out == (
        "world.yaml: ok\nempty.yaml:1:1: the file is empty; see `ekfsim new` for one to start "
        "from\n"
    )


def test_what_is_no_text_is_told_in_a_line(place):
    (place / "bytes.yaml").write_bytes(bytes(range(255, 0, -1)))
    for file in ("bytes.yaml", "/dev/null", "", "no\x1bwhere.yaml", "a" * 300):
        told = ekfsim("check", file)
        assert told.status == 2
        assert len((told.out + told.err).splitlines()) == 1
        assert "\x1b" not in told.out + told.err


def test_a_file_named_in_escape_codes_does_not_reach_the_terminal(place):
    name = "red\x1b[31m\x07.yaml"
    (place / name).write_text(WORLD)
    assert ekfsim("check", name).out == "red\\x1b[31m\\x07.yaml: ok\n"
    (place / name).write_text("name: 7\n")
    told = ekfsim("check", name)
    assert told.out.startswith("red\\x1b[31m\\x07.yaml:1:")
    assert "\x1b" not in told.out + told.err


def test_warnings_go_to_the_other_stream(place):
    (place / "short.yaml").write_text(SHORT.replace("angle: 90", "angle: 900"))
    told = ekfsim("check", "short.yaml")
    assert told.status == 0
    assert told.out == "short.yaml: ok\n"
    assert told.err.startswith("short.yaml:3:")


def test_a_reader_who_has_seen_enough_is_no_failure():
    told = process("check", "world.yaml", "nowhere.yaml", after='| true; exit "${PIPESTATUS[0]}"')
    assert (told.status, told.out) == (0, "")


@pytest.mark.parametrize("kind", ["world", "commands"])
def test_schema_is_json(kind):
    told = ekfsim("schema", kind)
    assert (told.status, told.err) == (0, "")
    assert json.loads(told.out)["title"] == f"ekfsim {kind}"


def test_list_is_short_and_names_all_that_comes_along():
    told = ekfsim("list")
    assert (told.status, told.err) == (0, "")
    lines = told.out.splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines[4:])) <= 80
    assert lines[0] == "start here:"
    assert [line.split()[0] for line in lines[1:4]] == ["tour", "square", "theta"]
    assert lines[1].endswith(description_of(packaged("commands")["tour"]))
    named = set(told.out.split())
    assert packaged("commands").keys() <= named


def test_list_tells_what_each_of_a_group_is_for():
    def listed(*more):
        told = ekfsim("list", *more)
        assert (told.status, told.err) == (0, "")
        return dict(line.split(maxsplit=1) for line in told.out.splitlines() if line[0] == " ")

    groups = [group.name for group in grouped()]
    assert groups == ["start", "proofs", "divergence", "systems", "logs"]
    parts = [listed(group) for group in groups]
    told = {name: description_of(path) for name, path in packaged("commands").items()}
    assert listed("--all") == told == {name: line for part in parts for name, line in part.items()}
    assert sum(map(len, parts)) == len(told)
    assert all((name.endswith("log") or name == "bag") == (name in parts[-1]) for name in told)
    assert listed("--worlds").keys() == packaged("worlds").keys()
    more = ekfsim("list").out.partition("ekfsim list GROUP (")[2].partition(")")[0]
    assert more.split(", ") == groups[1:]


def test_list_tells_all_that_a_file_says_of_itself():
    (line, *more) = ekfsim("list", "tour").out.splitlines()
    assert line == description_of(packaged("commands")["tour"])
    assert len(more) > 2
    assert ekfsim("list", "furnished-room").out.strip()
    assert ekfsim("list", "--worlds", "gnss").out != ekfsim("list", "gnss").out
    assert ekfsim("list", "tuor").err.endswith("did you mean 'tour'?\n")


def test_no_summary_of_a_command_is_cut():
    assert "..." not in ekfsim("--help").out.partition("Commands:")[2]


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (("run", "tour", "--filter", "EKF"), "ekf"),
        (("run", "tour", "--filter", "ekf,uuf"), "ukf"),
        (("figures", "Classroom", "-o", "out"), "classroom"),
    ],
)
def test_a_word_that_is_nearly_one_of_ours_is_met_with_it(words, meant):
    told = ekfsim(*words)
    assert (told.status, told.out) == (2, "")
    assert told.err.endswith(f"did you mean '{meant}'?\n")


def test_a_commands_file_may_name_a_world_that_comes_along(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "c.yaml").write_text("world: furnished-room\ncommands: [{say: a}]\n")
    assert ekfsim("check", "c.yaml").out == "c.yaml: ok\n"
    assert ekfsim("run", "c.yaml", "-q").status == 0
    assert ekfsim("study", "c.yaml", "--runs", 2, "-o", "out").status == 0
    (tmp_path / "furnished-room").write_text("name: mine\n")  # a file wins
    assert "start: the key is missing" in ekfsim("check", "c.yaml").out


def test_a_shared_world_is_told_of_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "w.yaml").write_text("name: a\n")
    (tmp_path / "c.yaml").write_text("world: w.yaml\ncommands: [{say: a}]\n")
    told = ekfsim("check", "./w.yaml", "c.yaml")
    assert told.status == 2
    lines = told.out.splitlines()
    assert [line.split(": ")[1] for line in lines] == [
        "start",
        "noise",
        "what is wrong with it is told above",
    ]


@pytest.mark.skipif(os.name == "nt", reason="no pipes by name here")
def test_a_pipe_is_read_once():
    told = process("check", "/dev/stdin", keys=b"name: a\n")
    assert told.status == 2
    assert "start: the key is missing" in told.out


def test_output_that_only_ascii_can_reach_still_comes():
    for args in (
        ["--help"],
        ["run", "--help"],
        ["list"],
        ["schema", "world"],
        ["run", "tour", "-q"],
    ):
        told = ekfsim(*args, encoding="ascii")
        assert told.status == 0
        assert told.out


@pytest.mark.parametrize(
    ("name", "kind"), [("my-world.yaml", "world"), ("sub/my-commands.yaml", "commands")]
)
def test_new_writes_a_file_that_check_finds_ok(place, name, kind):
    told = ekfsim("new", name)
    assert told.status == 0
    assert told.out == f"{name}: a {kind} file to start from; ekfsim check {name} validates it\n"
    if kind == "commands":  # its world is the one to be made next
        named = next(
            line for line in Path(name).read_text().splitlines() if line.startswith("world:")
        )
        world = Path(name).parent / named.split()[1]
        if not world.exists():
            assert ekfsim("new", world, "--kind", "world").status == 0
    assert ekfsim("check", name).out == f"{name}: ok\n"


def test_new_overwrites_nothing_unasked(place):
    before = (place / "world.yaml").read_text()
    told = ekfsim("new", "world.yaml")
    assert told.status == 2
    assert (
        told.err
        == "ekfsim: world.yaml: exists already; choose another name, or replace it with --force\n"
    )
    assert (place / "world.yaml").read_text() == before
    assert ekfsim("new", "world.yaml", "--force").status == 0
    assert (place / "world.yaml").read_text() != before


def test_new_asks_which_kind():
    for name in ("file.yaml", "world-commands.yaml"):
        told = ekfsim("new", name)
        assert told.status == 2
        assert (
            told.err == f"ekfsim: {name}: a world, commands, a homework or a filter? say "
            "--kind world, --kind commands, --kind homework or --kind filter\n"
        )
        assert not Path(name).exists()
        assert ekfsim("new", name, "--kind", "world").status == 0
    assert ekfsim("new", "other.yaml", "--kind", "robot").status == 2


@pytest.mark.parametrize(
    "name",
    ["", "-", ".", "world.yaml/new-world.yaml", "world" * 60, "/proc/world", "world.yaml/a/world"],
)
def test_new_where_no_file_can_be(place, name):
    before = left_in(place)
    told = ekfsim("new", name, "--kind", "world")
    assert told.status == 2
    assert told.out == ""
    assert left_in(place) == before


@pytest.mark.parametrize(
    "args", [[], ["walk"], ["check"], ["schema"], ["schema", "robot"], ["--walk"], ["new"]]
)
def test_wrong_usage_is_told_with_the_way_out(args):
    told = ekfsim(*args)
    assert told.status == 2
    assert told.out == ""
    assert "Usage: ekfsim" in told.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read(place):
    (place / "world.yaml").chmod(0)
    told = ekfsim("check", "world.yaml")
    assert told.status == 2
    assert told.err == "ekfsim: world.yaml: cannot be read: Permission denied\n"


def test_a_recording_without_a_path_is_ok_and_cannot_be_run():
    told = ekfsim("check", "pylon_log")
    assert (told.status, told.out, told.err) == (0, "pylon_log: ok\n", "")
    told = ekfsim("run", "pylon_log")
    assert (told.status, told.out) == (2, "")
    assert re.search(
        r"pylon_log.yaml:\d+:12: recording: the recording names no path; give one with --log\n$",
        told.err,
    )


def test_a_log_where_nothing_was_recorded():
    told = ekfsim("run", "short.yaml", "--log", "log.csv")
    assert (told.status, told.out) == (2, "")
    holds = "the one that holds entries.csv, world.yaml and, where it is known, truth.csv"
    assert told.err == f"ekfsim: log.csv: no such folder; name {holds}\n"
    told = ekfsim("run", "short.yaml", "--reading", "spoken")
    assert told.status == 2
    assert "'printed', 'coded', 'corrected'" in told.err


def test_mistakes_and_warnings_of_a_file_are_together_what_anybody_reads(tmp_path):
    # in degrees a great many, and more slip than there is
    move = "  - move: {distance: 1, angle: 400, slip: 2}\n"
    for count, warnings in ((60, 0), (40, 10)):
        (tmp_path / "many.yaml").write_text("world: room\ncommands:\n" + move * count)
        told = ekfsim("check", tmp_path / "many.yaml")
        assert len(told.out.splitlines()) == min(count, 50)
        assert len(told.err.splitlines()) == warnings
