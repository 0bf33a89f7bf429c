"""render -o NAME.html: one page that plays in a browser."""

import pytest
from program import ekfsim, lay_out, left_in


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def test_a_page_of_every_view(place):
    made = ekfsim("render", "short.yaml", "-o", "new/lesson.html")
    assert (made.status, made.out, made.err) == (0, "new/lesson.html: 5 views\n", "")
    assert left_in(place / "new") == ["lesson.html"]
    first = (place / "new/lesson.html").read_bytes()
    assert ekfsim("render", "short.yaml", "-o", "new/lesson.html", "--force").status == 0
    assert (place / "new/lesson.html").read_bytes() == first


def test_a_page_of_some_says_so(place):
    made = ekfsim("render", "short.yaml", "-o", "lesson.html", "--every", "3")
    assert made.status == 0
    where = "at even distances, and wherever something happens"
    held = int(made.out.split()[1])
    assert held < 5
    assert made.err == f"ekfsim: lesson.html: {held} of the run's 5 views are held: {where}\n"


def test_a_page_that_exists_stays_unless_it_is_to_be_replaced(place):
    (place / "lesson.html").write_text("older")
    refused = ekfsim("render", "short.yaml", "-o", "lesson.html")
    assert (refused.status, refused.out) == (2, "")
    assert refused.err.startswith("ekfsim: lesson.html: exists already; ")
    assert (place / "lesson.html").read_text() == "older"


def test_a_run_that_fails_leaves_no_page(place):
    (place / "mine.py").write_text(
        "def predict(x, P, u, motion):\n    return x, P\n\n"
        "def update(x, P, z, sensor):\n    raise ValueError('no')\n"
    )
    failed = ekfsim("render", "short.yaml", "--filter", "mine.py", "-o", "lesson.html")
    assert failed.status != 0
    assert "Traceback" not in failed.err
    assert "lesson.html" not in left_in(place)


@pytest.mark.parametrize("name", ["ekf,ukf", "pf"])
def test_filters_side_by_side_and_crowds(place, name):
    made = ekfsim("render", "short.yaml", "--filter", name, "-o", "lesson.html")
    assert (made.status, made.out, made.err) == (0, "lesson.html: 5 views\n", "")


def test_a_page_tells_why_where_it_is_asked(place):
    words = ("render", "diverge-02b-laser-overtrusted", "--every", "40", "-o")
    assert ekfsim(*words, "plain.html").status == 0
    assert ekfsim(*words, "why.html", "--why").status == 0
    assert 'id="why"' not in (place / "plain.html").read_text()
    assert "Lost since step 80." in (place / "why.html").read_text()


def test_why_stands_on_a_page_alone(place):
    refused = ekfsim("render", "short.yaml", "-o", "pictures", "--why")
    assert (refused.status, refused.out) == (2, "")
    assert "--why: stands on a page" in refused.err
