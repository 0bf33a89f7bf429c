"""show, and new --from: the files that come along, printed and copied."""

from pathlib import Path

import pytest
from program import ekfsim

from ekfsim.files.packaged import packaged, world_of
from ekfsim.files.scenes.load import check


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("kind", ["commands", "worlds"])
def test_a_file_is_printed_as_it_stands(kind):
    for name in packaged(kind).keys() - ({} if kind == "commands" else packaged("commands")):
        told = ekfsim("show", name)
        assert (told.status, told.err) == (0, "")
        assert told.out == packaged(kind)[name].read_text(encoding="utf-8")


def test_the_world_is_that_which_the_commands_name():
    for name, world in (("tour", "furnished-room"), ("gnss", "gnss"), ("room", "room")):
        told = ekfsim("show", name, "--world")
        assert (told.status, told.err) == (0, "")
        assert told.out == packaged("worlds")[world].read_text(encoding="utf-8")


def test_a_copy_is_the_same_whole_or_absent(place):
    tour = packaged("commands")["tour"].read_bytes()
    told = ekfsim("show", "tour", "-o", "lesson/tour.yaml")
    assert (told.status, told.out) == (
        0,
        "lesson/tour.yaml: a copy of commands/tour.yaml; ekfsim new FILE --from tour makes one "
        "that plays from where it lies\n",
    )
    assert Path("lesson/tour.yaml").read_bytes() == tour
    again = ekfsim("show", "tour", "--world", "-o", "lesson/tour.yaml")
    assert again.status == 2
    assert again.err == (
        "ekfsim: lesson/tour.yaml: exists already; choose another name, or replace it with "
        "--force\n"
    )
    assert Path("lesson/tour.yaml").read_bytes() == tour
    assert ekfsim("show", "tour", "--world", "-o", "lesson/tour.yaml", "--force").status == 0
    assert Path("lesson/tour.yaml").read_bytes() != tour


def test_what_there_is_not_is_told_with_what_is_meant(place):
    told = ekfsim("show", "tuor")
    assert (told.status, told.out) == (2, "")
    assert told.err == (
        "ekfsim: 'tuor' is neither a file nor one of the packaged commands; did you mean 'tour'?\n"
    )
    assert ekfsim("new", "mine.yaml", "--from", "tuor").err == told.err
    Path("bare.yaml").write_text("commands: []\n")
    assert ekfsim("show", "bare.yaml", "--world").err == (
        "ekfsim: bare.yaml: names no world; see `ekfsim new` for a file that does\n"
    )


@pytest.mark.parametrize("name", packaged("commands"))
def test_a_copy_to_start_from_is_right_and_names_the_same_world(place, name):
    told = ekfsim("new", "deep/mine.yaml", "--from", name)
    assert (told.status, told.err) == (0, "")
    assert told.out == (
        f"deep/mine.yaml: a copy of {name}; ekfsim play deep/mine.yaml steps through it\n"
    )
    copy, original = Path("deep/mine.yaml"), packaged("commands")[name]
    assert check(copy).mistakes == []
    if name in ("log", "bag"):  # it brings its world
        assert copy.read_text("utf-8") == original.read_text("utf-8")
        return
    assert world_of(copy).samefile(world_of(original))
    assert [
        line for line in copy.read_text("utf-8").splitlines() if not line.startswith("world:")
    ] == [
        line for line in original.read_text("utf-8").splitlines() if not line.startswith("world:")
    ]


def test_a_run_of_the_copy_is_that_of_the_original(place):
    ekfsim("new", "mine.yaml", "--from", "tour")
    (head, *mine), (known, *its) = (
        ekfsim("run", name).out.splitlines() for name in ("mine.yaml", "tour")
    )
    assert mine == its
    assert head == known.replace("commands/tour.yaml", "mine.yaml")


@pytest.mark.parametrize(
    ("args", "line"),
    [
        (["--from", "room"], "'room' is a world; `ekfsim show room -o mine.yaml` copies it"),
        (["--from", "mine.yaml"], "'mine.yaml' is no packaged commands file; see `ekfsim list`"),
        (
            ["--from", "tour", "--kind", "world"],
            "--kind and --from: a copy is of the kind that it is copied from",
        ),
        (
            ["--from", "tour"],
            "mine.yaml: beside it lies 'furnished-room', which would be taken for the world that "
            "the copy names; choose another folder",
        ),
    ],
)
def test_what_cannot_be_started_from(place, args, line):
    Path("furnished-room").write_text("")
    told = ekfsim("new", "mine.yaml", *args)
    assert (told.status, told.out, told.err) == (2, "", f"ekfsim: {line}\n")
    assert not Path("mine.yaml").exists()


def test_a_copy_of_commands_is_no_filter(place):
    ended = ekfsim("new", "mine.py", "--from", "tour")
    assert (ended.status, ended.err) == (
        2,
        "ekfsim: mine.py: a copy of commands is no filter; name it e.g. mine.yaml\n",
    )
    assert not Path("mine.py").exists()
