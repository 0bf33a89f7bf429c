"""Shapes tell the matrix that they come from, to the mouse and to the keyboard; and they are the
shapes of that matrix.
"""

import json
import re

import numpy as np
import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.geometry.ellipse import outline
from ekfsim.localization import play
from ekfsim.views.playback.playback import Playback


def captions(page):
    return [text.split()[0] for text in page.locator("#matrix caption").all_inner_texts()]


def numbers(page, symbol):
    """The cells of a matrix that is shown."""
    caption = page.locator("caption", has_text=re.compile(rf"^{symbol}\s"))
    table = page.locator("table", has=caption)
    rows = table.locator("tbody tr").all()
    return [
        [float(cell.replace("−", "-")) for cell in row.locator("td").all_inner_texts()]
        for row in rows
    ]


@pytest.fixture(scope="module")
def views():
    return list(Playback(play(load_scene("square"))))


def test_the_mouse_asks_the_shapes(opened, pages, views):
    correction = views[2].step.correction
    with opened(pages("square"), "#2b") as page:
        assert captions(page) == ["P"]
        assert np.allclose(numbers(page, "P"), views[2].belief.covariance, rtol=1e-5)
        page.locator("#map .hit[data-symbol=H]").dispatch_event("mouseenter")
        assert captions(page) == ["H", "S", "ν"]
        assert np.allclose(numbers(page, "H"), correction.H, rtol=1e-5)
        assert np.allclose(numbers(page, "S"), correction.S, rtol=1e-5)
        page.keyboard.press("n")
        page.locator("#map .hit[data-symbol=K]").dispatch_event("mouseenter")
        assert captions(page) == ["K"]
        assert np.allclose(numbers(page, "K"), correction.K, rtol=1e-5)
        page.keyboard.press("End")
        page.locator("#map .ellipse").hover()
        assert captions(page) == ["P"]
        assert np.allclose(numbers(page, "P"), views[-1].belief.covariance, rtol=1e-5)
        page.keyboard.press("Home")
        page.keyboard.press("n")
        page.get_by_role("button", name="F G", exact=True).click()
        assert captions(page) == ["F", "G"]
        assert np.allclose(numbers(page, "F"), views[1].step.prediction.F, rtol=1e-5)


def test_the_keyboard_reaches_every_shape(opened, pages):
    with opened(pages("square"), "#2b") as page:
        reached = set()
        for _ in range(30):
            page.keyboard.press("Tab")
            focus = "document.activeElement"
            reached.add(page.evaluate(f"{focus}.getAttribute('aria-label') ?? {focus}.textContent"))
            if page.evaluate(f"{focus}.dataset.symbol") == "H":
                assert captions(page) == ["H", "S", "ν"]
        assert {told.partition(" = ")[0] for told in reached} >= {"P", "H", "K", "R", "H S ν"}


def test_an_ellipse_is_a_polygon_of_the_points_that_a_picture_draws(opened, pages, views):
    x, P = views[4].pose
    with opened(pages("square"), "#3") as page:
        drawn = page.locator("#map .ellipse").get_attribute("d")
        points = np.array(re.findall(r"[-\d.e]+", drawn), float).reshape(-1, 2)
        assert np.allclose(points, outline(x, P[:2, :2], 0.954)[:-1], atol=1e-5)
        matrix = page.locator("#map > g > g").first.get_attribute("transform")
        a, b, c, d, *_ = map(float, re.findall(r"[-\d.e]+", matrix))
        assert a > 0 == b == c
        assert d == -a


def test_the_page_holds_what_the_steps_say(pages, views):
    text = pages("square").read_text(encoding="utf-8")
    lesson = json.loads(text.partition('id="lesson">')[2].partition("</script>")[0])
    assert len(lesson["views"]) == len(views)
    for held, view in zip(lesson["views"], views, strict=True):
        belief = held["by"][0]
        assert np.allclose(belief["pose"], view.pose.mean, atol=1e-6)
        lower = view.belief.covariance[np.tril_indices(3)]
        assert np.allclose(belief["P"], lower, rtol=1e-5, atol=1e-15)
        way = lesson["ways"]["paths"][0][: 2 * belief["path"]]
        assert np.allclose(way, view.settled.points().ravel(), atol=1e-6)
        assert held["step"] == view.step.entry.index
