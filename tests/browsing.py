"""One browser for all tests of pages. Elsewhere than on Debian there may be none: then they are
skipped, unless EKFSIM_NEEDS_BROWSER says that there has to be one.
"""

import os
import shutil
from contextlib import contextmanager
from dataclasses import replace

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
    """The page of a packaged scene, as some filters watch it; made once."""
    folder, made = tmp_path_factory.mktemp("pages"), {}

    def page(name, *filters):
        if (name, filters) not in made:
            path = made[name, filters] = folder / f"{name}-{'-'.join(filters)}.html"
            scene = load_scene(name)
            if filters:
                scene = replace(scene, filter=filters[0], beside=filters[1:])
            write(scene, path)
        return made[name, filters]

    return page


@pytest.fixture
def opened(browser):
    """Open a page, offline. In the end nothing may have been asked for but files that the test
    names, and no script may have failed or complained.
    """

    @contextmanager
    def _opened(path, link="", files=(), **settings):
        settings = {"viewport": {"width": 1200, "height": 800}, "offline": True} | settings
        context = browser.new_context(**settings)
        page = context.new_page()
        asked, failures = [], []
        page.on("request", lambda request: asked.append(request.url.partition("#")[0]))
        page.on("pageerror", lambda failure: failures.append(str(failure)))
        page.on("console", lambda message: failures.append(message.text))
        page.goto(path.as_uri() + link)
        yield page
        assert failures == []
        assert set(asked) == {file.as_uri() for file in (path, *files)}
        context.close()

    return _opened
