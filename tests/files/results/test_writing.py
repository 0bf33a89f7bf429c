import os
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from scenes import scene

from ekfsim.commands import Move
from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import RunError, UsageError
from ekfsim.files.results.outputs import Outputs
from ekfsim.files.results.partial import HOST
from ekfsim.files.results.writing import whole_file, whole_folder, whole_text
from ekfsim.localization import play

FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="no /dev/full here")
needs_a_guarded_folder = pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")


def left_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def write(path, text="result", failure=None, **how):
    """Write a result, and fail in the middle of it where a failure is given."""
    with whole_text(path, **how) as file:
        file.write(text)
        if failure:
            raise failure


def test_a_result_appears_when_it_is_whole(tmp_path):
    path = tmp_path / "result.txt"
    with whole_text(path) as file:
        file.write("result")
        file.flush()
        assert not path.exists()
    assert path.read_text() == "result"
    assert left_in(tmp_path) == ["result.txt"]


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt, SystemExit])
def test_or_not_at_all(tmp_path, failure):
    with pytest.raises(failure):
        write(tmp_path / "result.txt", "half", failure)
    assert left_in(tmp_path) == []


def test_a_failed_run_leaves_the_older_result_alone(tmp_path):
    path = tmp_path / "result.txt"
    path.write_text("older")
    with pytest.raises(ValueError, match="half"):
        write(path, "half", ValueError("half"), force=True)
    assert path.read_text() == "older"
    assert left_in(tmp_path) == ["result.txt"]


def test_a_result_that_exists_is_refused(tmp_path):
    path = tmp_path / "result.txt"
    write(path, "first")
    with pytest.raises(UsageError) as refusal:
        write(path, "second")
    assert (
        str(refusal.value)
        == f"{path}: exists already; choose another name, or replace it with --force"
    )
    assert path.read_text() == "first"
    write(path, "second", force=True)
    assert path.read_text() == "second"


def test_a_folder_is_no_file(tmp_path):
    for force in (False, True):
        with pytest.raises(UsageError) as refusal:
            write(tmp_path, force=force)
        assert str(refusal.value) == f"{tmp_path}: this is a folder; name a file"


def test_parents_are_made(tmp_path):
    write(tmp_path / "a" / "b" / "result.txt")
    assert (tmp_path / "a" / "b" / "result.txt").read_text() == "result"


def test_a_parent_that_is_a_file(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises((UsageError, RunError), match=r"file/result\.txt"):
        write(tmp_path / "file" / "result.txt")


def test_others_may_read_it_as_any_file(tmp_path):
    before = os.umask(0o022)
    try:
        write(tmp_path / "result.txt")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "result.txt").stat().st_mode) == 0o644


def test_lines_end_alike_everywhere(tmp_path):
    write(tmp_path / "result.txt", "a\nβ\n")
    assert (tmp_path / "result.txt").read_bytes() == "a\nβ\n".encode()


@pytest.mark.parametrize("name", ["r" * 200 + ".txt", "ü – ✓.txt", " .txt", "-r"])
def test_any_name(tmp_path, name):
    write(tmp_path / name)
    assert left_in(tmp_path) == [name]


def test_a_name_too_long_is_told(tmp_path):
    with pytest.raises(UsageError, match="cannot be written: File name too long"):
        write(tmp_path / ("r" * 300))


@needs_a_guarded_folder
def test_a_folder_that_may_not_be_written_is_told(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(UsageError, match="cannot be written: Permission denied"):
        write(tmp_path / "result.txt")


@needs_full
def test_a_full_disk_is_told(tmp_path):
    with pytest.raises(RunError) as refusal:
        write(FULL)
    assert str(refusal.value) == "/dev/full: writing failed: No space left on device"


def test_what_is_no_regular_file_is_written_straight(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write(pipe)
    assert os.read(reader, 100) == b"result"
    os.close(reader)
    assert left_in(tmp_path) == ["pipe"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


WRITE = (
    "import sys; from pathlib import Path; from ekfsim.files.results.writing import whole_text\n"
)


def run(program, *arguments, **how):
    return subprocess.run(
        [sys.executable, "-c", WRITE + program, *map(str, arguments)], check=False, **how
    )


STRAIGHT = """
print("before", flush=True)
with whole_text(Path("/dev/stdout")) as file:
    file.write("result\\n")
print("after")
"""


def test_standard_output_is_written_straight(tmp_path):
    assert run(STRAIGHT, capture_output=True).stdout == b"before\nresult\nafter\n"


@pytest.mark.parametrize("force", [False, True])
def test_standard_output_may_be_a_file(tmp_path, force):
    """`--trace /dev/stdout > file`: nothing is refused, lost or put in the place of /dev/stdout."""
    with (tmp_path / "out").open("wb") as out:
        done = run(
            STRAIGHT.replace('"))', f'"), force={force})'), stdout=out, stderr=subprocess.PIPE
        )
    assert done.stderr == b""
    assert (tmp_path / "out").read_bytes() == b"before\nresult\nafter\n"
    assert Path("/dev/stdout").is_symlink()


@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_several_results_may_go_to_standard_output(name):
    done = run(
        "for text in 'ab':\n    with whole_text(Path(sys.argv[1])) as file:\n        "
        "file.write(text)",
        name,
        capture_output=True,
    )
    assert done.stdout == b"ab"


def test_killed_in_the_middle_there_is_no_result(tmp_path):
    path = tmp_path / "result.txt"
    done = run(
        "import os, signal\n"
        "with whole_text(Path(sys.argv[1])) as file:\n"
        "    file.write('half'); file.flush(); os.kill(os.getpid(), signal.SIGKILL)",
        path,
    )
    assert done.returncode == -signal.SIGKILL
    assert not path.exists()
    assert all(name.startswith(".") and name.endswith(".partial") for name in left_in(tmp_path))
    write(path)
    assert path.read_text() == "result"


def fill(path, failure=None, **how):
    with whole_folder(path, "*.png", **how) as folder:
        (folder / "1.png").write_text("picture")
        if failure:
            raise failure


def test_a_folder_appears_when_it_is_whole(tmp_path):
    path = tmp_path / "a" / "pictures"
    fill(path)
    assert left_in(path) == ["1.png"]
    with pytest.raises(ValueError, match="half"):
        fill(tmp_path / "half", ValueError("half"))
    assert left_in(tmp_path) == ["a", "a/pictures", "a/pictures/1.png"]


def test_a_folder_is_replaced_only_when_all_in_it_is_ours(tmp_path):
    path = tmp_path / "pictures"
    path.mkdir()
    fill(path)  # an empty folder stands in nobody's way
    with pytest.raises(UsageError, match="the folder is not empty"):
        fill(path)
    (path / "2.png").write_text("older")
    fill(path, force=True)
    assert left_in(path) == ["1.png"]
    (path / "letter.txt").write_text("dear")
    with pytest.raises(UsageError, match=r"holds 'letter\.txt', which is no result of ekfsim"):
        fill(path, force=True)
    assert left_in(path) == ["1.png", "letter.txt"]


def test_a_file_is_no_folder(tmp_path):
    path = tmp_path / "file"
    path.write_text("x")
    with pytest.raises(UsageError, match="this is a file; name a folder"):
        fill(path, force=True)


def outputs_of(folder, **more):
    return Outputs(folder / "t.jsonl", folder / "tum", folder / "t.csv", folder / "s.json", **more)


def put(outputs, fail=False):
    made, summary = scene(Move(1.0, 0.5)), Summary()
    with outputs.open(made, 0.954, summary) as sinks:
        for step in play(made):
            summary.add(step)
            for sink in sinks:
                sink.write(step)
        if fail:
            raise ValueError("half")


ALL = ["s.json", "t.csv", "t.jsonl", "tum", "tum/estimate.tum", "tum/truth.tum"]


def test_the_files_of_a_run_appear_together(tmp_path):
    with pytest.raises(ValueError, match="half"):
        put(outputs_of(tmp_path), fail=True)
    assert [name for name in left_in(tmp_path) if name != "tum"] == []
    put(outputs_of(tmp_path))
    assert left_in(tmp_path) == ALL


@pytest.mark.parametrize("existing", [name for name in ALL if name != "tum"])
def test_one_that_exists_stops_them_all_before_anything_is_written(tmp_path, existing):
    (tmp_path / existing).parent.mkdir(exist_ok=True)
    (tmp_path / existing).write_text("older")
    before = left_in(tmp_path)
    with pytest.raises(UsageError, match="exists already"):
        put(outputs_of(tmp_path))
    assert left_in(tmp_path) == before
    put(outputs_of(tmp_path, force=True))
    assert left_in(tmp_path) == ALL
    assert "older" not in (tmp_path / existing).read_text()


def test_two_results_cannot_be_one_file(tmp_path):
    with pytest.raises(UsageError, match="named twice"):
        put(Outputs(trace=tmp_path / "same", csv=tmp_path / "same"))
    assert left_in(tmp_path) == []


def leftover(place, host=HOST):
    """What a killed process leaves beside a place: nobody holds its lock."""
    return place.with_name(f".{place.name}.{host}.abcd_123.partial")


@pytest.mark.skipif(os.name == "nt", reason="no locks here")
def test_what_a_killed_process_left_is_removed_by_the_next_one(tmp_path):
    file, folder = tmp_path / "a.csv", tmp_path / "b"
    leftover(file).write_text("half")
    leftover(folder).mkdir()
    (leftover(folder) / "half.png").write_text("half")
    others = [
        leftover(file, "elsewhere"),
        leftover(tmp_path / "other.csv"),
        tmp_path / ".a.csv.partial",
    ]
    for other in others:
        other.write_text("not ours to judge")
    with whole_text(file) as out:
        out.write("whole")
    with whole_folder(folder):
        pass
    assert sorted(tmp_path.iterdir()) == sorted([file, folder, *others])


@pytest.mark.skipif(os.name == "nt", reason="no locks here")
def test_a_folder_that_was_making_way_for_another_comes_back(tmp_path):
    place = tmp_path / "out"
    (leftover(place) / "out").mkdir(parents=True)
    (leftover(place) / "out" / "kept.png").write_text("older")
    with pytest.raises(UsageError, match="not empty"), whole_folder(place, "*.png"):
        pass
    assert [path.name for path in place.iterdir()] == ["kept.png"]
    assert not leftover(place).exists()


@pytest.mark.skipif(os.name == "nt", reason="no locks here")
@pytest.mark.parametrize("write", [whole_text, whole_file, whole_folder])
def test_two_at_once_are_told(tmp_path, write):
    place = tmp_path / "out"
    with write(place):
        before = sorted(tmp_path.iterdir())
        with pytest.raises(UsageError) as refusal, write(place, force=True):
            pass
        assert str(refusal.value) == (
            f"{place}: cannot be written: another run is at work there; wait for it, or choose "
            f"another name"
        )
        assert sorted(tmp_path.iterdir()) == before
    assert list(tmp_path.iterdir()) == [place]


@pytest.mark.parametrize("write", [whole_text, whole_folder])
def test_what_came_meanwhile_is_not_replaced(tmp_path, write):
    place = tmp_path / "out"
    with pytest.raises(UsageError, match=r"exists already|is a file"), write(place):
        place.write_text("of another machine")
    assert place.read_text() == "of another machine"
    assert list(tmp_path.iterdir()) == [place]


def test_the_longest_name_that_a_folder_takes_can_be_written(tmp_path):
    place = tmp_path / ("ж" * 127)  # 254 bytes
    with whole_text(place) as file:
        file.write("whole")
    assert place.read_text() == "whole"
