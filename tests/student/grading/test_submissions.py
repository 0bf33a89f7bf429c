"""What was handed in: whose it is, where the filter is, and that no two are one."""

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ekfsim.errors import UsageError
from ekfsim.student.grading.submissions import Submission, odd, safe, submissions


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_files_and_folders_go_by_their_names(place):
    (place / "zoe.py").write_text("")
    (place / "hand in/anna b").mkdir(parents=True)
    found = submissions([place / "zoe.py", place / "hand in/anna b"])
    assert [one.name for one in found] == ["anna b", "zoe"]


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (["none.py"], "none.py: no such file or folder"),
        (["notes.txt"], "notes.txt: is no .py file; name a filter, or the folder it is in"),
        (["a/filter.py", "b/filter.py"],
         "b/filter.py: is called filter, as a/filter.py is; results go by that name: rename one, "
         "or hand over the folders"),
        (["Anna.py", "anna.py"],
         "anna.py: is called anna, as Anna.py is; results go by that name: rename one, or hand "
         "over the folders"),
        (["a", "a/"], "a: is called a, as a is; results go by that name: rename one, or hand over "
         "the folders"),
    ],
)  # fmt: skip
def test_what_cannot_be_graded_is_refused(place, names, told):
    from pathlib import Path

    for name in ("notes.txt", "a/filter.py", "b/filter.py", "Anna.py", "anna.py"):
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).write_text("")
    with pytest.raises(UsageError) as refused:
        submissions(list(map(Path, names)))
    assert str(refused.value) == told


def test_a_class_that_is_named_as_one_submission_is_odd(place):
    for name in ("class/anna", "class/bob", "zoe/data"):
        (place / name).mkdir(parents=True)
    (place / "zoe/filter.py").write_text("")
    assert list(odd(submissions([place / "class", place / "zoe"]))) == [
        f"{place}/class: holds folders alone; if each is a submission, name {place}/class/*"
    ]


def test_the_filter_is_found_in_a_folder(place):
    folder = place / "anna"
    folder.mkdir()
    one = Submission(folder, "anna")
    assert one.filter(None) == ("", "there is no .py file in the folder")
    assert one.filter("filter.py") == ("", "there is no filter.py in the folder")
    (folder / "mine.py").write_text("")
    assert one.filter(None) == ("mine.py", "")
    (folder / "other.py").write_text("")
    assert one.filter(None)[1].startswith("there are several .py files: mine.py, other.py; ")
    assert one.filter("other.py") == ("other.py", "")
    os.symlink("/etc/passwd", folder / "filter.py")
    assert one.filter("filter.py")[1] == "there is no filter.py in the folder"


def test_its_digest_changes_with_any_file_and_no_other(place):
    folder = place / "anna"
    (folder / "deep").mkdir(parents=True)
    (folder / "mine.py").write_text("1")
    (folder / "deep/more.py").write_text("2")
    one = Submission(folder, "anna")
    seen = {one.digest}
    assert one.digest in seen
    (folder / "deep/more.py").write_text("3")
    seen.add(one.digest)
    (folder / "deep/more.py").rename(folder / "deep/another.py")
    seen.add(one.digest)
    seen.add(Submission(folder, "bob").digest)
    (folder / "a.yaml").write_text("")
    seen.add(one.digest)
    assert len(seen) == 5


@given(st.text(min_size=1, max_size=60), st.text(min_size=1, max_size=60))
def test_any_name_makes_a_name_of_a_file_of_its_own(name, other):
    told = safe(name)
    assert 0 < len(told.encode()) <= 120
    assert not set(told) & set("/\\\0\n:*?\"<>| '`$&;")
    assert told[0] not in ".-~"
    assert name == other or told != safe(other)
