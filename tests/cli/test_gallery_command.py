"""gallery: a site of the scenarios that come along."""

import pytest
from program import ekfsim


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_two_workers_make_the_same_gallery(place):
    asked = "--only", "theta, proof-corner", "--cures", "20"
    for folder, more in (("one", []), ("two", ["--workers", "2"])):
        made = ekfsim("gallery", "-o", folder, *asked, *more)
        told = f"{folder}: 2 scenarios; open {folder}/index.html\n"
        assert (made.status, made.out, made.err) == (0, told, "")
    for path in (place / "one").iterdir():
        assert path.read_bytes() == (place / "two" / path.name).read_bytes()
    refused = ekfsim("gallery", "-o", "one", *asked)
    assert (refused.status, refused.out) == (2, "")
    assert refused.err.startswith("ekfsim: one: the folder is not empty; ")


def test_in_markdown_it_is_printed_and_the_pictures_lie_in_the_folder(place):
    made = ekfsim("gallery", "-o", "pictures/all", "--only", "theta", "--markdown")
    assert (made.status, made.err) == (0, "")
    assert "](pictures/all/theta.png)\n" in made.out
    assert [path.name for path in (place / "pictures/all").iterdir()] == ["theta.png"]


@pytest.mark.parametrize("only", ["tuor", ""])
def test_a_name_that_is_none_is_refused(only):
    refused = ekfsim("gallery", "-o", "site", "--only", only)
    assert (refused.status, refused.out) == (2, "")
    assert refused.err.startswith("ekfsim: ")
    assert refused.err.count("\n") == 1
