"""The page on a phone, in the dark, on paper, in a frame of a course system; and for everybody."""

from importlib.resources import files

import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.views.page.writing import write

AXE = files("axe_playwright_python") / "axe.min.js"
PHONE = {"viewport": {"width": 390, "height": 800}, "has_touch": True}
SERIOUS = """async () => (await axe.run()).violations
    .filter(one => ['serious', 'critical'].includes(one.impact))
    .map(one => [one.id, one.nodes.map(node => node.target.join(' ') + node.failureSummary)])"""

APART = """() => {
    const box = document.getElementById('map').getBoundingClientRect();
    const ticks = [...document.querySelectorAll('#map .tick')].map(
        one => one.getBoundingClientRect());
    const meet = (a, b) =>
        a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const cut = ticks.filter(one => one.left < box.left || one.right > box.right);
    const met = ticks.filter((one, i) => ticks.some((other, j) => i < j && meet(one, other)));
    return [ticks.length, cut.length, met.length];
}"""  # how many numbers the map has, and how many are cut off or lie on another


@pytest.mark.parametrize(("width", "scheme"), [(390, "light"), (1200, "dark")])
def test_nothing_serious_keeps_anybody_out(opened, pages, width, scheme):
    page = pages("diverge-01-wrong-wall")
    looks = {"viewport": {"width": width, "height": 800}, "color_scheme": scheme}
    with opened(page, "#13b", bypass_csp=True, **looks) as page:
        page.evaluate(AXE.read_text(encoding="utf-8"))
        assert page.evaluate(SERIOUS) == []


def test_filters_keep_nobody_out(opened, pages):
    with opened(pages("square", "ekf", "ukf"), "#4b", bypass_csp=True) as page:
        page.evaluate(AXE.read_text(encoding="utf-8"))
        assert page.evaluate(SERIOUS) == []


def test_a_phone_need_not_scroll_sideways(opened, pages):
    with opened(pages("tour"), "#6b", **PHONE) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        page.keyboard.press("n")
        page.locator("#more summary").tap()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_buttons_and_swipes_step_on_a_phone(opened, pages):
    with opened(pages("square"), **PHONE) as page:
        title = page.locator("#title")
        page.locator("#next").tap()
        assert title.inner_text().startswith("1 of 8")
        swipe = """x => {
            const touch = { pointerType: 'touch', clientY: 200, bubbles: true };
            const map = document.getElementById('map');
            map.dispatchEvent(new PointerEvent('pointerdown', { ...touch, clientX: 200 }));
            map.dispatchEvent(new PointerEvent('pointerup', { ...touch, clientX: 200 + x }));
        }"""
        page.evaluate(swipe, -90)
        assert title.inner_text().startswith("2 of 8")
        page.evaluate(swipe, 90)
        page.evaluate(swipe, 10)  # a tap
        assert title.inner_text().startswith("1 of 8")


def test_the_dark_is_dark(opened, pages):
    ground = "getComputedStyle(document.documentElement).backgroundColor"
    with opened(pages("square"), color_scheme="dark") as page:
        assert page.evaluate(ground) == "rgb(22, 24, 27)"
    with opened(pages("square")) as page:
        assert page.evaluate(ground) == "rgb(255, 255, 255)"


def test_paper_has_the_view_and_no_buttons(opened, pages):
    with opened(pages("square"), "#2", color_scheme="dark") as page:
        page.emulate_media(media="print")
        ground = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
        assert ground == "rgb(255, 255, 255)"
        for gone in ("#controls", "#keys"):
            assert not page.locator(gone).is_visible()
        for there in ("#map", "#close", "#narrative", "#judgement", "#strips", "#matrix"):
            assert page.locator(there).is_visible()


def test_who_wants_little_motion_gets_time(opened, pages):
    with opened(pages("square"), reduced_motion="reduce") as page:
        page.clock.install()
        page.keyboard.press(" ")
        page.clock.run_for(2000)
        assert page.locator("#title").inner_text().startswith("0 of 8")
        page.clock.run_for(600)
        assert page.locator("#title").inner_text().startswith("1 of 8")
        moving = "getComputedStyle(document.querySelector('#map .ellipse')).transitionDuration"
        assert page.evaluate(moving) == "0s"


def test_without_script_it_says_what_it_would_be(opened, pages):
    with opened(pages("square"), java_script_enabled=False) as page:
        told = page.locator(".noscript").inner_text()
        assert "needs JavaScript" in told
        assert "commands commands/square.yaml" in told


@pytest.mark.parametrize("inline", [False, True])
def test_it_plays_in_a_sandbox(opened, pages, tmp_path, inline):
    """As a course system frames it, and as a notebook does."""
    page = pages("square")
    text = page.read_text(encoding="utf-8").replace("&", "&amp;").replace('"', "&quot;")
    source = f'srcdoc="{text}"' if inline else f'src="{page.as_uri()}"'
    outer = tmp_path / "course.html"
    icon = '<link rel="icon" href="data:,">'
    frame = f'<iframe sandbox="allow-scripts" width=900 height=700 {source}></iframe>'
    outer.write_text(icon + frame)
    with opened(outer, files=() if inline else (page,)) as course:
        frame = course.frame_locator("iframe")
        frame.locator("#next").click()
        frame.locator("#next").press("n")
        assert frame.locator("#title").inner_text().startswith("2 of 8")
        frame.locator(".strip").first.click()
        frame.locator("#play").click()


def test_each_view_is_told_in_words(opened, pages):
    with opened(pages("square"), "#2") as page:
        told = page.locator("#map-told").text_content()
        assert told.startswith("step 2 of 8: sense at −90°. The estimate is at x 5.")
        assert "radii" in told
        assert "NEES" in told
        assert page.locator("#map").get_attribute("aria-describedby") == "map-told"
        assert page.locator("#narrative").get_attribute("aria-live") == "polite"


def test_text_of_files_stays_text(opened, tmp_path):
    evil = "</script><script>alert(1)</script><!-- <b>&amp; \u2028 $x^2$ \u202egnp {{lesson}}"
    (tmp_path / "world.yaml").write_text(
        f"""
name: {evil!r}
start: {{x: 1, y: 1, theta: 0}}
boundary: [[0, 0], [9, 0], [9, 9], [0, 9]]
obstacles: [{{name: {evil!r}, points: [[3, 3], [8, 3], [8, 8], [3, 8]]}}]
noise: {{executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0.1,
  odometryAngSigmaRatio: 0, rangeSigmaRatio: 0.1}}
""".replace("'", '"')
    )
    (tmp_path / "commands.yaml").write_text(
        f'world: world.yaml\ndescription: "{evil}"\n'
        f'commands:\n- say: "{evil}"\n- sense: {{angle: 45}}\n'
    )
    write(load_scene(tmp_path / "commands.yaml"), path := tmp_path / "page.html")
    with opened(path, "#1") as page:
        said = page.locator("#say").inner_text()
        assert said == evil.replace("\u2028", "\\u2028").replace("\u202e", "\\u202e")
        assert page.locator("script").count() == 2
        assert page.locator("b").count() == 0
        assert page.title().startswith("</script><script>alert(1)</script><!-- <b>&amp; ")


@pytest.mark.parametrize("width", [390, 1200])
def test_long_numbers_are_neither_cut_off_nor_on_one_another(opened, tmp_path, width):
    (tmp_path / "world.yaml").write_text("""
name: far
start: {x: 500001, y: 5000001, theta: 0}
boundary: [[500000, 5000000], [500009, 5000000], [500009, 5000009], [500000, 5000009]]
noise: {executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0.1,
  odometryAngSigmaRatio: 0, rangeSigmaRatio: 0.1}
""")
    (tmp_path / "commands.yaml").write_text("world: world.yaml\ncommands: []\n")
    write(load_scene(tmp_path / "commands.yaml"), path := tmp_path / "page.html")
    with opened(path, viewport={"width": width, "height": 800}) as page:
        count, cut, crossed = page.evaluate(APART)
        assert count > 4
        assert (cut, crossed) == (0, 0)
