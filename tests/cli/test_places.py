"""Whatever a path leads to, or may not lead to: each option that takes one tells it in a line, with
status 2."""

import ctypes
import os
import shutil
from contextlib import contextmanager

import pytest
from program import ekfsim, lay_out

LOGS = ("gnss", "mower", "mrclam", "ranges", "pioneer", "pylon")
WRITING = [  # {} is where a result is to go
    ("render short.yaml -o {}", "render short.yaml -o {}.gif"),
    ("run short.yaml -q --trace {}", "run short.yaml -q --csv {}", "run short.yaml -q --tum {}"),
    ("run short.yaml -q --summary {}", "record drive.yaml -o {}", "figures classroom -o {}"),
    (
        "study short.yaml --runs 1 -o {}",
        "compare short.yaml --runs 1 --b guard=skip -o {}",
        "new {} --kind world",
        "new {} --from tour",
        "show tour -o {}",
        "worksheet short.yaml -o {}",
        "mutants short.yaml --csv {}",
    ),
]
READING = [  # {} is what is to be read
    (
        "run {}",
        "play {}",
        "check {}",
        "study {} --runs 1 -o out",
        "compare {} --runs 1 --b guard=skip",
        "mutants {}",
        "worksheet {} -o out",
        "show {}",
    ),
    ("run short.yaml --world {}", "study short.yaml --runs 1 -o out --world {}"),
    tuple(f"run {log}_log.yaml --log {{}}" for log in LOGS),
    ("figures gnss -o out --log {}", "figures pylon -o out --log {}"),
]
IN_FILES = {  # what stands in a file that names {}
    "scene.yaml": "world: '{}'\ncommands: [{{say: a}}]\n",
    "study.yaml": "study: '{}'\n",
    "other.yaml": "study: short.yaml\nworld: '{}'\n",
    **{
        f"log_{log}.yaml": f"world: {log}.yaml\nrecording: {{{{format: {log}, path: '{{}}'}}}}\n"
        for log in LOGS
    },
}
ODD = os.fsdecode(b"b\xff\x1b\n")
PLACES = {  # where nothing can be read nor written, and why
    "locked/in/x": "Permission denied",
    "locked/x": "Permission denied",
    "n" * 300: "File name too long",
    "loop/x": "Too many levels of symbolic links",
    "loop": "Too many levels of symbolic links",
    "short.yaml/x": "",  # no folder, or no such file
}


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder with some that lead nowhere."""
    folder = lay_out(tmp_path)
    systems = {"mrclam": "landmarks"}
    for log in LOGS:
        (folder / f"{log}.yaml").write_text(
            f"name: a\nsystem: {systems.get(log, log)}\nstart: {{x: 0, y: 0, theta: 0}}\n"
        )
        (folder / f"{log}_log.yaml").write_text(
            f"world: {log}.yaml\nrecording: {{format: {log}, path: nowhere}}\n"
        )
    (folder / "drive.yaml").write_text("world: gnss.yaml\ndrive: [{v: 1, for: 0.2}]\n")
    (folder / "locked").mkdir()
    (folder / "loop").symlink_to("loop")
    monkeypatch.chdir(folder)
    (folder / "locked").chmod(0)
    with as_anybody():
        yield folder
    (folder / "locked").chmod(0o700)


@contextmanager
def as_anybody():
    """Without root's right to look everywhere, where root runs this: two capabilities of this
    thread are laid aside."""
    if not hasattr(os, "geteuid"):
        pytest.skip("no rights to files here")
    if os.geteuid() != 0:
        yield
        return
    libc = ctypes.CDLL(None, use_errno=True)
    header, held = (
        (ctypes.c_uint32 * 2)(0x20080522, 0),
        (ctypes.c_uint32 * 6)(),
    )  # of two words: in force, allowed, left
    if libc.capget(header, held) != 0:
        pytest.skip("root can lay nothing aside here")
    without = (ctypes.c_uint32 * 6)(*held)
    without[0] &= ~(1 << 1 | 1 << 2)  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH
    assert libc.capset(header, without) == 0
    try:
        yield
    finally:
        assert libc.capset(header, held) == 0


def told(*words):
    """The one line that a refusal is told in."""
    how = ekfsim(*words)
    lines = [
        line for line in (how.out + how.err).splitlines() if "and the world has none" not in line
    ]
    assert (how.status, len(lines)) == (2, 1), (words, how)
    return lines[0]


@pytest.mark.parametrize("commands", WRITING, ids=lambda commands: commands[0].split()[0])
def test_where_no_result_can_be_is_told(place, commands):
    before = sorted(os.listdir(place))
    for target, why in PLACES.items():
        for command in commands:
            if target == "loop" and "{}." in command:
                continue  # another name, which leads somewhere
            line = told(*(word.format(target) for word in command.split()))
            assert line.startswith(f"ekfsim: {target}")
            assert why in line, command
    assert sorted(os.listdir(place)) == before


@pytest.mark.parametrize("commands", READING, ids=lambda commands: commands[0])
def test_what_cannot_be_read_is_told(place, commands):
    for source, why in PLACES.items():
        for command in commands:
            line = told(*(word.format(source) for word in command.split()))
            assert f"{source}: cannot be read: {why}" in line or (not why and source in line), (
                command,
                line,
            )


@pytest.mark.parametrize("name", IN_FILES)
def test_what_a_file_names_and_cannot_be_read_is_told_at_its_place(place, name):
    for source, why in PLACES.items():
        (place / name).write_text(IN_FILES[name].format(source))
        for command in ("check", "study --runs 1 -o out" if "study" in IN_FILES[name] else "run"):
            line = told(*command.split(), name)
            assert line.removeprefix("ekfsim: ").startswith(f"{name}:"), line
            assert why in line
            assert "no such" not in line or not why, line


def test_what_is_there_and_may_not_be_read_is_told_in_a_line(place):
    (place / "mine.yaml").write_text("")
    (place / "mine.yaml").chmod(0)
    for source in ("locked", "mine.yaml"):
        for words in (
            "run gnss_log.yaml --log",
            "figures gnss -o out --log",
            "study short.yaml --runs 1 -o",
            "list",
        ):
            assert source in told(*words.split(), source)
    for option in ("--trace", "--csv", "--summary"):
        assert told("run", "short.yaml", "-q", option, "mine.yaml").startswith(
            "ekfsim: mine.yaml: "
        )


def test_list_tells_where_there_is_nothing_to_tell(place):
    assert told("list", "zzz.yaml") == "ekfsim: zzz.yaml: no such file"
    assert told("list", "loop").startswith("ekfsim: loop: cannot be read: ")
    assert ekfsim("list", "short.yaml").out == "short.yaml: has no description\n"


def test_names_of_odd_bytes_are_no_obstacle(place):
    for name in ("world.yaml", "short.yaml"):
        shutil.copy(name, f"{ODD}{name}")
    odd = f"{ODD}short.yaml"
    for words in (
        ("check", odd, f"{ODD}world.yaml"),
        (
            "run",
            odd,
            "--world",
            f"{ODD}world.yaml",
            "-q",
            "--trace",
            f"{ODD}/trace",
            "--tum",
            ODD,
            "--csv",
            f"{ODD}/c",
        ),
        ("run", odd, "-q", "--summary", f"{ODD}/summary"),
        ("render", odd, "-o", f"{ODD}/frames", "--every", "9"),
        ("render", odd, "-o", f"{ODD}/film.gif", "--every", "9"),
        ("study", odd, "--runs", "2", "-o", f"{ODD}/study"),
        ("compare", odd, "--runs", "2", "--b", "guard=skip", "-o", f"{ODD}/compared"),
        ("record", "drive.yaml", "-o", f"{ODD}/log"),
        ("run", "gnss_log.yaml", "-q", "--log", f"{ODD}/log"),
        ("new", f"{ODD}/world.yaml"),
    ):
        how = ekfsim(*words)
        assert how.status == 0, (words, how)
        assert not set("\x1b\udcff") & set(how.out + how.err)
        # no name goes on in another line
        assert how.out.count("\\xff") == how.out.count("\\xff\\x1b\\x0a")
        assert "\n\n" not in how.err


def test_a_current_folder_that_was_deleted_is_told_as_such(place, monkeypatch):
    (place / "gone").mkdir()
    os.chdir(place / "gone")
    (place / "gone").rmdir()
    for words in (
        ["check", "a.yaml"],
        ["run", str(place / "short.yaml"), "-q", "--trace", "t"],
        ["new", "world.yaml"],
    ):
        assert "the current folder was deleted; go to another" in told(*words)
    out = place / "pictures"
    # it needs no current folder
    assert ekfsim("render", place / "short.yaml", "-o", out, "--every", "9").status == 0
    assert out.is_dir()
