import os

import pytest

from ekfsim.student.fault import FaultError
from ekfsim.student.sandbox import folder as folders
from ekfsim.student.sandbox.folder import copy_of, remove


@pytest.fixture
def submission(tmp_path):
    folder = tmp_path / "anna"
    (folder / "inner").mkdir(parents=True)
    (folder / "mine.py").write_text("mine")
    (folder / "inner" / "more.yaml").write_text("more")
    (folder / "link").symlink_to("/etc/hostname")
    os.mkfifo(folder / "pipe")
    return folder


def test_a_folder_is_copied_with_all_that_can_be(submission):
    copy = copy_of(submission)
    try:
        found = {str(path.relative_to(copy)) for path in copy.rglob("*")}
        assert found == {"mine.py", "inner", "inner/more.yaml", "link"}  # nobody waits for a pipe
        assert (copy / "inner" / "more.yaml").read_text() == "more"
        assert os.readlink(copy / "link") == "/etc/hostname"  # of no other file there is a copy
        assert copy.stat().st_mode & 0o777 == 0o700
    finally:
        remove(copy)
    assert not copy.exists()


def test_a_file_is_copied_without_those_beside_it(submission):
    copy = copy_of(submission / "mine.py", shared=True)
    try:
        assert os.listdir(copy) == ["mine.py"]
        assert copy.stat().st_mode & 0o777 == 0o755
    finally:
        remove(copy)


@pytest.mark.parametrize(("what", "most"), [("MOST_FILES", 3), ("MOST_BYTES", 6)])
def test_what_is_too_much_is_told_and_nothing_is_left(
    submission, what, most, monkeypatch, tmp_path
):
    monkeypatch.setattr(folders, what, most)
    monkeypatch.setattr(folders.tempfile, "tempdir", str(tmp_path))
    with pytest.raises(FaultError, match=r"\Aanna: holds more than .* hand in the code alone\Z"):
        copy_of(submission)
    assert os.listdir(tmp_path) == ["anna"]


def test_what_is_not_there_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(folders.tempfile, "tempdir", str(tmp_path))
    with pytest.raises(FaultError, match=r"\Amine\.py: cannot be read: No such file"):
        copy_of(tmp_path / "mine.py")
    assert os.listdir(tmp_path) == []


def test_a_deep_folder_and_one_that_may_not_be_read_are_deleted_and_nothing_else(tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "kept").write_text("kept")
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "link").symlink_to(other)
    here = os.getcwd()
    try:
        os.chdir(folder)
        for _ in range(1100):  # deeper than a path may be long, or Python may recurse
            os.mkdir("deeper")
            os.chdir("deeper")
    finally:
        os.chdir(here)
    shut = folder / "shut"
    shut.mkdir()
    (shut / "file").write_text("")
    (shut / "inner").mkdir(mode=0)
    shut.chmod(0)
    remove(folder)
    assert os.listdir(tmp_path) == ["other"]
    assert (other / "kept").read_text() == "kept"
