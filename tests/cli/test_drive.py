"""drive, and d in play: what keys have driven is a file, and playing it is the same run."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from program import ekfsim, ended, lay_out, left_in, started

PUT_IN = ["long.yaml", "short.yaml", "world.yaml"]
ARROWS = b"\x1b[A\x1bOA\x1b[D\x1bOC\x1b[1;5B"  # of both modes of a terminal, one with Ctrl


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "COLUMNS", "LINES", "NO_COLOR"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def drive(*args, keys=b"", status=0):
    done = ekfsim("drive", *args, "--show", "text", keys=keys)
    assert (done.status, done.err) == (status, "") if not status else done.status == status
    return done


def story(text):
    """All that is told from the first command on."""
    lines = [line for line in text.splitlines() if line]
    return lines[next(n for n, line in enumerate(lines) if line.startswith("==>")) :]


@pytest.mark.parametrize(
    "args",
    [
        ("world.yaml", "--seed", "7"),
        ("furnished-room", "--seed", "11", "--filter", "ukf", "--gate", "0.9"),
        ("room-with-desk", "--filter", "pf", "--particles", "50", "--guard", "skip"),
        ("range-bias", "--run", "3", "--set", "noise.rangeSigmaRatio=0.1"),
        ("hall", "--filter", "ekf,iekf", "--confidence", "0.5"),
        ("short.yaml", "--world", "unsure-start", "--set", "filter.rangeVariance=reading"),
    ],
)
def test_the_file_plays_what_was_driven_to_the_last_digit(args, place):
    driven = drive(*args, "--explain", keys=b"ff90b<f-30b2.5f15>bbw").out
    (saved,) = (line for line in driven.splitlines() if line.startswith("Saved "))
    command = saved.partition(": ekfsim ")[2].split()
    assert command[:2] == ["play", "drive.yaml"]
    again = ekfsim("run", *command[1:], "--explain")
    assert (again.status, again.err) == (0, "")
    played = story(again.out)
    told = [line for line in story(driven) if line in played]  # the rest is of pictures and keys
    assert len([line for line in told if line.startswith("==>")]) >= 9
    assert played[-len(told) :] == told
    checked = ekfsim("check", "drive.yaml")
    assert (checked.status, checked.out, checked.err) == (0, "drive.yaml: ok\n", "")


def test_arrows_drive_in_a_pipe(place):
    drive("world.yaml", keys=ARROWS + b"w")
    moves = [line.strip() for line in (place / "drive.yaml").read_text().splitlines()[-5:]]
    assert moves == [
        "- move: {distance: 0.25, angle: 0}",
        "- move: {distance: 0.25, angle: 0}",
        "- move: {distance: 0, angle: 15}",
        "- move: {distance: 0, angle: -15}",
        "- move: {distance: -0.25, angle: 0}",
    ]


def test_nothing_is_lost_at_the_end_of_a_pipe(place):
    assert "Saved 2 commands: ekfsim play drive.yaml\n" in drive("world.yaml", keys=b"ff").out
    assert left_in(place) == ["drive.yaml", *PUT_IN]
    drive("world.yaml", keys=b"")
    drive("world.yaml", keys=b"fqq")  # somebody who was asked
    drive("world.yaml", keys=b"fuq")
    assert left_in(place) == ["drive.yaml", *PUT_IN]


def test_what_lies_there_is_never_overwritten_without_force(place):
    (place / "drive.yaml").write_text("mine")
    drive("world.yaml", keys=b"fwfw")
    drive("world.yaml", keys=b"bw")
    assert (place / "drive.yaml").read_text() == "mine"
    assert left_in(place) == ["drive-2.yaml", "drive-3.yaml", "drive.yaml", *PUT_IN]
    drive("world.yaml", "-o", "short.yaml", "--force", keys=b"fw")
    assert "Driven by hand" in (place / "short.yaml").read_text()


def test_a_commands_file_is_driven_on_and_its_end_can_be_undone(place):
    driven = drive("short.yaml", "-o", "more.yaml", keys=b"2u<w").out
    assert "Undone: 2 commands from step 2 (sense 0°) on" in driven
    told = (place / "more.yaml").read_text()
    assert "description: Driven by hand from step 1 of short.yaml on." in told
    assert told.endswith(
        "commands:\n  - move: {distance: 1, angle: 90}\n  - move: {distance: 0, angle: 15}\n"
    )


def test_play_is_driven_on_from_the_view_that_is_shown(place):
    played = ekfsim("play", "short.yaml", "--show", "text", keys=b"nnndfw")
    assert (played.status, played.err) == (0, "")
    assert "1 more command comes here: U does them, what is driven leaves them out\n" in played.out
    told = (place / "drive.yaml").read_text()
    assert told.endswith("  - sense: {angle: 0}\n  - move: {distance: 0.25, angle: 0}\n")
    assert "The run is over after 3 commands" in played.out


@pytest.mark.parametrize("name", ["pylon", "mower"])
def test_what_obeys_no_commands_is_not_driven(name):
    system = f"the robot of the system {name} follows its way and no commands"
    refused = f"cannot be driven: {system}; drive a world of the classroom\n"
    done = drive(name, status=2)
    assert done.err.endswith(refused)
    assert done.err.count("\n") == 1
    played = ekfsim("play", name, "--show", "text", keys=b"d")
    assert (played.status, played.err) == (0, "")
    assert refused in played.out


@pytest.mark.parametrize(
    ("args", "wrong"),
    [
        (("nowhere",), "'nowhere' is neither a file nor one of the packaged worlds"),
        (("furnished-rom",), "did you mean 'furnished-room'?"),
        (("nowhere.yaml",), "nowhere.yaml: no such file"),
        (("mower_log",), "mower_log: cannot be driven: it is a recorded log"),
        (("world.yaml", "--world", "room"), "--world: world.yaml is a world itself"),
        (("world.yaml", "-o", "mine.py"), "mine.py: commands are no filter"),
        (("world.yaml", "-o", "."), "this is a folder; name a file"),
        (("world.yaml", "--set", "noise.rnge=1"), "unknown key 'rnge'"),
        (("world.yaml", "--seed", "-1"), "-1"),
    ],
)
def test_what_is_wrong_is_told_before_anything_is_driven(args, wrong, place):
    done = drive(*args, keys=b"ff", status=2)
    assert wrong in done.err
    assert "Traceback" not in done.err
    assert left_in(place) == PUT_IN


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_signal_loses_nothing(number, place):
    running = started("drive", "world.yaml", "--show", "text", stdin=subprocess.PIPE,
                      stdout=subprocess.PIPE)  # fmt: skip
    assert running.stdin is not None
    assert running.stdout is not None
    running.stdin.write(b"ff")
    running.stdin.flush()
    told = b""
    while told.count(b"==>") < 2:
        told += running.stdout.read1()
    running.send_signal(number)
    done = ended(running)
    assert done.status == 128 + number
    assert "Saved 2 commands: ekfsim play drive.yaml" in done.err
    assert left_in(place) == ["drive.yaml", *PUT_IN]


def test_the_help_tells_the_keys():
    told = ekfsim("drive", "--help").out
    assert "\n  up  f     down  x     forward" in told
    assert "d  drive the robot on from here" in ekfsim("play", "--help").out


def test_what_the_page_drives_is_lost_as_it_says():
    page = (Path(__file__).parents[2] / "docs/judging/scenarios.md").read_text(encoding="utf-8")
    block = page.partition("## Drive until it is lost")[2].partition("```sh\n")[2]
    told, said = "", 0
    for line in block.partition("```")[0].splitlines():
        if line.startswith("# > "):
            assert line.removeprefix("# > ") in told
            said += 1
            continue
        keys, _, command = line.rpartition(" | ")
        typed = keys.removeprefix("printf '").removesuffix("'").encode()
        done = ekfsim(*command.split()[1:], keys=typed)
        assert done.status == 0
        told = done.out
    assert said == 7
