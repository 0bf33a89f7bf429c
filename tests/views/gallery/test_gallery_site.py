"""The gallery: pages, pictures and figures of the scenarios, as a site and as a page of docs."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from ekfsim.errors import RunError, UsageError
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene
from ekfsim.study.block import run_block
from ekfsim.study.results import Result
from ekfsim.study.running.engines import serial
from ekfsim.views.gallery import making
from ekfsim.views.gallery.making import chosen, write_gallery
from ekfsim.views.gallery.markdown import row, section
from ekfsim.views.gallery.site import site
from ekfsim.views.study.shares import HEAD, shares

DOCS = Path(__file__).resolve().parents[3] / "docs"
NAMES = ["theta", "proof-corner"]
FILES = ["index.html", *(f"{name}.{ending}" for name in NAMES for ending in ("html", "png"))]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder of a small gallery, and what is told of it."""
    folder = tmp_path_factory.mktemp("gallery") / "site"
    return folder, write_gallery(NAMES, folder, serial, paged=True, force=False)


def links(text):
    return set(re.findall(r'(?:href|src)="([^"]*)"', text)) - {"data:,"}


def test_every_link_leads_to_a_file_or_a_place_of_the_page(made):
    folder, wings = made
    assert sorted(path.name for path in folder.iterdir()) == sorted(FILES)
    assert [wing.name for wing in wings] == ["start", "proofs"]
    text = (folder / "index.html").read_text(encoding="utf-8")
    places = {f"#{place}" for place in re.findall(r'id="([^"]+)"', text)}
    assert links(text) == {*(f"#{name}" for name in NAMES), *FILES} - {"index.html"}
    assert {link for link in links(text) if link.startswith("#")} <= places


def test_the_figures_are_those_of_a_study(made):
    shown = made[1][0].exhibits[0]
    found = Result.alone(load_scene("theta"), run_block(load_scene("theta"), 0, 1000))
    assert shown.runs == found.tally.runs
    assert len(shown.figures) == len(HEAD)
    lost, inside = found.last.lost, found.last.ellipse
    for cell, share in ((shown.figures[0], lost), (shown.figures[3], inside)):
        value, low, high = map(float, re.findall(r"[\d.]+", cell))
        assert (value, low, high) == pytest.approx(
            [100 * number for number in (share.value, share.low, share.high)], abs=0.06
        )
    above, below = map(float, re.findall(r"[\d.]+", shown.figures[1]))
    of = found.tally.of
    assert (above, below) == pytest.approx((of.nis_above / 10, of.nis_below / 10), abs=0.06)


def test_what_cannot_be_counted_is_a_dash():
    scene = load_scene("proof-dead-reckoning")
    cells = shares(Result.alone(scene, run_block(scene, 0, 20)))
    assert (cells[1], cells[4]) == ("–", "–")
    assert "–" not in cells[0] + cells[2]


def test_texts_of_a_scenario_are_inert(made):
    (wing, *_) = made[1]
    bad = "<script>alert(1)</script> {x} \" ' &"
    shown = replace(wing.exhibits[0], title=bad, told=bad, verdict=bad, judged=bad)
    text = site([wing._replace(title=bad, exhibits=[shown])])
    assert "<script" not in text
    assert text.count("&lt;script&gt;") == 6


@pytest.mark.parametrize("failing", NAMES)
def test_a_scenario_that_fails_leaves_no_gallery(failing, tmp_path, monkeypatch):
    real = making.exhibit

    def exhibit(name, *how):
        if name == failing:
            raise RunError("the disk is full")
        return real(name, *how)

    monkeypatch.setattr(making, "exhibit", exhibit)
    with pytest.raises(RunError, match="disk"):
        write_gallery(NAMES, tmp_path / "new/site", serial, paged=False, force=False)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_replaced_when_asked_and_only_where_it_is_a_gallery(made, tmp_path):
    (tmp_path / "mower.html").write_text("older")
    with pytest.raises(UsageError, match="not empty"):
        write_gallery(NAMES[:1], tmp_path, serial, paged=False, force=False)
    write_gallery(NAMES[:1], tmp_path, serial, paged=False, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["theta.png"]
    assert (tmp_path / "theta.png").read_bytes() == (made[0] / "theta.png").read_bytes()
    (tmp_path / "mine.png").write_text("mine")
    with pytest.raises(UsageError, match=r"holds 'mine.png', which is no result"):
        write_gallery(NAMES[:1], tmp_path, serial, paged=False, force=True)


def test_it_is_of_everything_but_recorded_logs():
    names = chosen([])
    assert names[:3] == ["tour", "square", "theta"]
    assert {name for name in packaged("commands") if name not in names} == {
        name for name in packaged("commands") if name.endswith(("log", "bag")) or name == "bag"
    }
    assert chosen(["proof-corner", "tour", "tour"]) == ["tour", "proof-corner"]
    for wrong, told in (
        ("tuor", "did you mean 'tour'?"),
        ("mower_log", "mower_log: is of a recorded log"),
        ("mine.yaml", "'mine.yaml': the gallery is of what comes along"),
    ):
        with pytest.raises(UsageError, match=re.escape(told)):
            chosen([wrong])


def test_the_page_of_docs_is_what_the_program_makes(made):
    text, pictures = (DOCS / "gallery.md").read_text(encoding="utf-8"), DOCS / "pictures/gallery"
    assert re.findall(r"^### (.*)$", text, re.M) == chosen([])
    assert set(re.findall(r"\]\((pictures/[^)]*)\)", text)) == {
        path.relative_to(DOCS).as_posix() for path in pictures.iterdir()
    }
    for wing in made[1]:
        for shown in wing.exhibits:
            assert section(shown, Path("pictures/gallery")) in text
            assert row(shown.name, shown.cured) in text.splitlines()
    for path in pictures.iterdir():
        assert path.stat().st_size <= 20_000
        assert f"commands/{path.stem}.yaml" in Image.open(path).text["Description"]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_in_a_browser_it_opens_from_a_folder_and_a_picture_leads_to_its_page(made, opened, scheme):
    folder, _ = made
    files = [folder / name for name in ("theta.png", "proof-corner.png", "theta.html")]
    settings = {"viewport": {"width": 390, "height": 4000}, "color_scheme": scheme}
    with opened(folder / "index.html", "", files, **settings) as page:
        page.wait_for_function("[...document.images].every(image => image.naturalWidth > 0)")
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        paper = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
        assert (paper == "rgb(255, 255, 255)") == (scheme == "light")
        page.click("article#theta a:has(img)")
        page.wait_for_selector("#title:not(:empty)")
        assert page.url == (folder / "theta.html").as_uri()
