"""The page in a browser: its keys, its slider, its links, its curves."""


def title(page):
    return page.locator("#title").inner_text()


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
        assert "Verdict: " in page.locator("#judgement").inner_text()
        page.keyboard.press("Home")
        assert title(page) == "0 of 8: the start"
