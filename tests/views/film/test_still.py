import re

import pytest
from matplotlib.figure import Figure

from ekfsim.errors import UsageError
from ekfsim.views.film.still import KINDS, save

BEGINS = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


def drawn():
    figure = Figure(figsize=(2, 1), dpi=50)
    figure.add_subplot().plot([0, 1], [1, 0])
    return figure


@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_is_of_the_kind_that_its_name_says_and_says_what_made_it(tmp_path, kind):
    first, again = tmp_path / f"a{kind}", tmp_path / f"b{kind.upper()}"
    for path in (first, again):
        save(drawn(), path, "a line", "seed 7, run 0")
    told = first.read_bytes()
    assert told.startswith(BEGINS[kind])
    assert b"seed 7, run 0" in told
    assert again.read_bytes() == told
    assert not re.search(rb"CreationDate|<dc:date>", told)


def test_a_picture_that_exists_stays_unless_it_is_to_be_replaced(tmp_path):
    path = tmp_path / "a.png"
    path.write_text("older")
    with pytest.raises(UsageError, match="exists already"):
        save(drawn(), path, "a line", "seed 7")
    assert path.read_text() == "older"
    save(drawn(), path, "a line", "seed 7", force=True)
    assert path.read_bytes().startswith(BEGINS[".png"])


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("a.gif", "'.gif' is no kind of picture; name a .png, an .svg or a .pdf"),
        ("a", "no ending tells the kind of picture; name a .png, an .svg or a .pdf"),
    ],
)
def test_other_kinds_are_refused(tmp_path, name, why):
    with pytest.raises(UsageError) as refusal:
        save(drawn(), tmp_path / name, "a line", "seed 7")
    assert str(refusal.value) == f"{tmp_path / name}: {why}"
    assert list(tmp_path.iterdir()) == []
