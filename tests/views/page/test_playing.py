"""The page in a browser: its keys, its slider, its links, its curves, its filters."""

import json
import re

import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.views.page.writing import write


def title(page):
    return page.locator("#title").inner_text()


def nis_of(path):
    """NIS of each view of a page that has one, and its bound."""
    text = path.read_text(encoding="utf-8").partition('id="lesson">')[2]
    held = json.loads(text.partition("</script>")[0])["views"]
    return [view["by"][0]["nis"] for view in held if "nis" in view["by"][0]]


def path_of(page, part):
    """The corners of a line of the map, in m."""
    drawn = page.locator(f"#map .{part}").first.get_attribute("d")
    return [tuple(map(float, pair.split())) for pair in re.findall(r"[-\d.e]+ [-\d.e]+", drawn)]


def test_a_press_of_n_is_a_step_and_p_takes_it_back(opened, pages):
    with opened(pages("square")) as page:
        assert title(page) == "0 of 8: the start"
        page.keyboard.press("n")
        assert title(page) == "1 of 8: move 3 m, turn 90°"
        page.keyboard.press("n")
        beam = page.locator("#map .beam")
        assert title(page) == "2 of 8: sense at −90°"
        assert beam.is_visible()
        page.keyboard.press("ArrowRight")  # the revised estimate, without the beam
        assert title(page) == "2 of 8: sense at −90°"
        assert not beam.is_visible()
        page.keyboard.press("p")
        assert beam.is_visible()
        page.keyboard.press("End")
        page.keyboard.press("n")
        assert title(page).startswith("8 of 8")
        assert page.locator("#next").is_disabled()
        assert "Verdict: " in page.locator("#judgement").inner_text()
        page.keyboard.press("Home")
        assert title(page) == "0 of 8: the start"


def test_keys_that_mean_something_else_are_left_alone(opened, pages):
    with opened(pages("square")) as page:
        for key in ("Control+n", "Alt+n", "Meta+p", "Control+End", "x"):
            page.keyboard.press(key)
        assert title(page) == "0 of 8: the start"


def test_space_plays_and_stops(opened, pages):
    with opened(pages("square")) as page:
        page.clock.install(time=0)
        page.clock.pause_at(1000)  # else a slow machine plays on while keys are pressed
        page.keyboard.press(" ")
        page.clock.run_for(1000)
        assert title(page).startswith("1 of 8")
        page.keyboard.press(" ")
        page.clock.run_for(60_000)
        assert title(page).startswith("1 of 8")
        page.keyboard.press(" ")
        page.clock.run_for(60_000)
        assert title(page).startswith("8 of 8")
        assert page.locator("#play").inner_text() == "▶ play"


def test_the_slider_is_spoken_and_goes_to_any_view(opened, pages):
    with opened(pages("square")) as page:
        slider = page.locator("#slider")
        assert slider.get_attribute("aria-valuetext") == "step 0 of 8: the start"
        slider.focus()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowRight")
        assert slider.get_attribute("aria-valuetext") == "step 2 of 8: sense at −90°"
        page.keyboard.press("End")
        assert title(page).startswith("8 of 8")
        page.keyboard.press("p")  # no key of a slider's own
        assert page.locator("#map .beam").is_visible()


def until(true, page):
    """Wait for what comes soon, but not at once."""
    for _ in range(500):
        if true():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it never came")


def test_a_link_leads_to_a_step_and_follows(opened, pages):
    with opened(pages("square"), "#4b") as page:
        assert title(page).startswith("4 of 8: sense")
        assert page.locator("#map .beam").is_visible()
        page.keyboard.press("n")
        until(lambda: page.url.endswith("#4"), page)
        page.evaluate("location.hash = '#6'")
        page.locator("#title", has_text="6 of 8").wait_for()
        assert not page.locator("#map .beam").is_visible()
        assert page.evaluate("history.length") == 3  # what was stepped through is not in it


@pytest.mark.parametrize(("link", "told"), [("#999", "8 of 8"), ("#%00", "0 of 8"), ("#b", "0")])
def test_a_link_to_no_step_harms_nothing(opened, pages, link, told):
    with opened(pages("square"), link) as page:
        assert title(page).startswith(told)


def test_a_click_on_a_curve_goes_there_and_its_cursor_follows(opened, pages):
    with opened(pages("diverge-01-wrong-wall")) as page:
        nis, nees = page.locator(".strip").all()
        cursor = nees.locator(".cursor")
        before = cursor.get_attribute("d")
        nis.click(position={"x": nis.bounding_box()["width"] - 8, "y": 30})
        assert title(page).startswith("80 of 80")
        assert cursor.get_attribute("d") != before
        over = [told for told in nis_of(pages("diverge-01-wrong-wall")) if told[0] > told[1]]
        assert nis.locator(".dot.over").count() == len(over) > 5
        assert nees.locator(".bound").get_attribute("d")


def test_the_map_grows_where_the_estimate_leaves_it_and_shrinks_on_the_way_back(opened, pages):
    with opened(pages("diverge-01-wrong-wall"), "#32") as page:
        room = "e => e.getBoundingClientRect().width"
        before = page.locator("#map .boundary").evaluate(room)
        page.keyboard.press("End")
        at_last = page.locator("#map .boundary").evaluate(room)
        assert at_last < 0.8 * before
        page.keyboard.press("Home")
        assert page.locator("#map .boundary").evaluate(room) == before


def test_the_truth_outside_is_shown_in_a_style_of_its_own(opened, pages):
    with opened(pages("diverge-01-wrong-wall"), "#13") as page:
        judged = page.locator("#judgement")
        assert "lost since step 13" in judged.inner_text()
        assert judged.get_attribute("class") == "warns"
        style = "e => [getComputedStyle(e).strokeDasharray, getComputedStyle(e).stroke]"
        wrong = page.locator("#map .ellipse").evaluate(style)
        page.keyboard.press("Home")
        assert judged.get_attribute("class") == ""
        usual = page.locator("#map .ellipse").evaluate(style)
        assert usual[0] == "none" != wrong[0]
        assert usual[1] != wrong[1] == "rgb(213, 94, 0)"  # vermillion


def test_an_ambiguous_beam_shows_the_other_wall(opened, pages):
    with opened(pages("diverge-01-wrong-wall"), "#13b") as page:
        assert path_of(page, "other-wall") == [(0, 6), (0, 0)]
        assert "of the room's wall, not edge 3 of desk" in page.locator("#notes").inner_text()


def test_what_a_lecture_says_is_there_until_it_says_something_else(opened, pages):
    with opened(pages("tour"), "#1") as page:
        said = page.locator("#say")
        assert said.inner_text().startswith("The robot knows exactly where it starts")
        assert said.get_attribute("class") == ""
        page.keyboard.press("n")
        assert said.inner_text().startswith("The robot knows exactly where it starts")
        assert said.get_attribute("class") == "past"
        page.keyboard.press("n")
        assert said.inner_text().startswith("A straight move leaves only the distance uncertain")
        page.keyboard.press("Home")
        assert not said.is_visible()


def test_filters_are_toggled_and_each_tells_its_numbers(opened, pages):
    with opened(pages("square", "ekf", "ukf"), "#2") as page:
        other = page.locator("#map .second.reference")
        assert other.count() == 1
        page.get_by_role("checkbox", name="ukf").uncheck()
        assert other.count() == 0
        assert "Kalman gain" in page.locator("#narrative").inner_text()
        told = page.locator("#narrative").inner_text()
        page.get_by_role("radio", name="ukf").check()
        assert page.locator("#narrative").inner_text() != told
        page.get_by_role("checkbox", name="ekf").uncheck()
        assert not page.locator("#map .ellipse").is_visible()
        page.keyboard.press("n")
        assert title(page).startswith("3 of 8")


def test_a_hidden_filter_leaves_no_curve(opened, pages):
    with opened(pages("square", "ekf", "ukf")) as page:
        assert page.locator(".strip .value").count() == 2
        page.get_by_role("checkbox", name="ekf").uncheck()
        assert page.locator(".strip .value").count() == 0
        assert page.locator(".strip .second").count() == 2


def test_w_opens_why_it_was_lost_where_the_page_tells_it(opened, pages, tmp_path):
    write(load_scene("square"), tmp_path / "why.html", reason="Cause: a < b.\n")
    with opened(tmp_path / "why.html") as page:
        told = page.locator("#why pre")
        assert not told.is_visible()
        page.keyboard.press("w")
        assert told.inner_text() == "Cause: a < b."
        assert "w why" in page.locator("#keys").inner_text()
        page.keyboard.press("w")
        assert not told.is_visible()
    with opened(pages("square")) as page:
        page.keyboard.press("w")
        assert page.locator("#why").count() == 0
        assert "w why" not in page.locator("#keys").inner_text()
