"""The page without a browser: what it holds, and how large it is."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.version import VERSION
from ekfsim.views.page.holding import MOST, NOTED, Holding, troubles
from ekfsim.views.page.page import page
from ekfsim.views.page.writing import write
from ekfsim.views.picture.look import Look
from ekfsim.views.playback.playback import Playback


@pytest.fixture(scope="module")
def scene():
    return load_scene("square")


@pytest.fixture(scope="module")
def views():
    return list(Playback(play(load_scene("diverge-01-wrong-wall"))))


def lesson(text):
    return json.loads(text.partition('id="lesson">')[2].partition("</script>")[0])


def test_a_lesson_is_small_enough_to_be_mailed(pages):
    assert pages("tour").stat().st_size <= 120_000


def test_a_long_drive_is_thinned_and_says_so(tmp_path):
    made = write(load_scene("mower"), path := tmp_path / "mower.html")
    assert path.stat().st_size <= 2_000_000
    assert made.held < made.views == 1424
    told = re.search('<p class="thinned">(.*)</p>', made.text)[1]
    assert told.startswith(f"{made.held} of the run&#x27;s 1424 views are held")
    held = lesson(made.text)["views"]
    assert len(held) == made.held
    assert held[0]["step"] == 0
    assert "Verdict" in held[-1]["judged"]


def test_a_beam_and_its_revised_estimate_stay_together(views):
    held = list(Holding(len(views), 7).choose(views))
    numbers = [view.number for view in held]
    assert numbers == sorted(set(numbers))
    assert len(held) < len(views) / 2
    for view in held:
        if view.beam:
            assert view.number + 1 in numbers


def test_what_happens_is_held_whatever_is_left_out(views):
    held = {view.number for view in Holding(len(views), 10_000).choose(views)}
    beginnings = [
        after.number
        for before, after in zip(views[1::2], views[3::2], strict=False)
        if troubles(after) and not troubles(before)
    ]
    assert beginnings
    assert {0, views[-1].number} <= held
    first_lost = next(view.number for view in views if view.judged.lost_from is not None)
    assert first_lost - 1 in held or first_lost in held


def test_a_page_holds_no_more_than_it_may(views):
    many = [replace(view, number=n) for n, view in enumerate(views * 200)]
    many = [replace(view, judged=replace(view.judged, closing=None)) for view in many]
    held = list(Holding(len(many)).choose(many))
    assert MOST / 2 < len(held) <= MOST + 2 * NOTED + 2


def test_equal_runs_make_equal_bytes(scene):
    steps = list(play(scene))
    text = page(scene, [steps])
    assert text == page(scene, [list(play(scene))])
    assert text != page(replace(scene, run=1), [list(play(replace(scene, run=1)))])


def test_it_says_what_made_it(scene, pages):
    text = pages("square").read_text(encoding="utf-8")
    source = re.search('<p class="source">(.*)</p>', text)[1]
    assert source == (
        f"ekfsim {VERSION}, world worlds/room.yaml, commands commands/square.yaml, filter ekf, "
        "guard warn, seed 1, run 0"
    )


def test_nothing_in_it_leads_out(pages):
    text = pages("square").read_text(encoding="utf-8")
    assert set(re.findall(r"https?://[^\"' ]+", text)) == {"http://www.w3.org/2000/svg"}
    assert re.findall(r'(?:src|href)="([^"]*)"', text) == ["data:,"]
    assert "default-src &#x27;none&#x27;" in text


def test_every_line_of_the_narrative_is_held_once(pages):
    lines = lesson(pages("tour").read_text(encoding="utf-8"))["lines"]
    assert len(lines) == len(set(lines))
    assert "The derivatives are:" in lines


def test_places_far_from_the_origin_are_counted_from_near_by(scene):
    far = np.array([5e5, 4.9e6])
    moved = replace(
        scene,
        world=replace(
            scene.world, map=shifted(scene.world.map, far),
            start=np.add(scene.world.start, [*far, 0]),
            told=replace(
                scene.world.told, map=shifted(scene.world.told.map, far),
                start=np.add(scene.world.told.start, [*far, 0]),
            ),
        ),
    )  # fmt: skip
    held = lesson(page(moved, [list(play(moved))]))
    assert max(map(abs, held["limits"][0])) < 100
    near = lesson(page(scene, [list(play(scene))]))
    for there, here in zip(held["views"], near["views"], strict=True):
        x, y, _ = there["by"][0]["pose"]
        place = np.array([x, y]) + held["origin"] - far
        assert np.allclose(place, here["by"][0]["pose"][:2], atol=1e-5)


def shifted(floor, by):
    return replace(
        floor,
        boundary=None if floor.boundary is None else floor.boundary + by,
        obstacles=tuple(replace(each, points=each.points + by) for each in floor.obstacles),
    )


def test_the_ellipses_at_the_edges_of_the_cone_are_asked_for(scene):
    steps = list(play(scene))
    assert "conditional" not in lesson(page(scene, [steps]))
    held = lesson(page(scene, [steps], Look(conditional=True)))
    assert held["conditional"][0] == "ellipse if heading is at +2 σ"


def test_a_page_that_exists_stays(scene, tmp_path):
    (tmp_path / "page.html").write_text("older")
    with pytest.raises(UsageError, match="exists already"):
        write(scene, tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == "older"
    write(scene, tmp_path / "page.html", force=True)
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
