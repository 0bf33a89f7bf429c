"""One browser for all tests of the page. Elsewhere than on Debian, say, there may be none: then
they are skipped, unless EKFSIM_NEEDS_BROWSER says that there has to be one."""

import os
import shutil
from contextlib import contextmanager

import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.views.page.writing import write

FLAGS = ["--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu"]  # as root, in containers


@pytest.fixture(scope="session")
def browser():
    program = shutil.which("chromium")
    if program is None:
        told = "no chromium here: the page was not tried in a browser"
        if os.environ.get("EKFSIM_NEEDS_BROWSER"):
            pytest.fail(told)
        pytest.skip(told)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield started
        started.close()


@pytest.fixture(scope="session")
def pages(tmp_path_factory):
    """The page of a packaged scene, made once."""
    folder, made = tmp_path_factory.mktemp("pages"), {}

    def page(name):
        if name not in made:
            made[name] = folder / f"{name}.html"
            write(load_scene(name), made[name])
        return made[name]

    return page


@pytest.fixture
def opened(browser):
    """Open a page, offline. When the test is over nothing may have been asked for but the page
    itself, and no script may have failed or complained."""

    @contextmanager
    def _opened(path, link="", frame=False, **settings):
        settings = {"viewport": {"width": 1200, "height": 800}, "offline": True} | settings
        context = browser.new_context(**settings)
        page = context.new_page()
        asked, failures = [], []
        page.on("request", lambda request: asked.append(request.url))
        page.on("pageerror", lambda failure: failures.append(str(failure)))
        page.on("console", lambda message: failures.append(message.text))
        page.goto(path.as_uri() + link)
        yield page
        assert {url.partition("#")[0] for url in asked} <= {path.as_uri()}
        assert failures == []
        context.close()

    return _opened
