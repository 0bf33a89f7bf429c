"""What README shows a notebook, and what `help(ekfsim)` tells it."""

import inspect
import pydoc
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ekfsim
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.settings import setting

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_cells_of_the_readme_do_what_they_say(capsys):
    cells = re.findall(r"```python\n(.*?)```", README.partition("## In a notebook")[2], re.DOTALL)
    names = {}
    for cell in cells:
        exec(cell.replace("plt.gca()", "plt.Figure().subplots()"), names)
    assert capsys.readouterr().out.startswith("==>Commanding the robot to sense")
    assert names["views"][6].beam
    assert not any(view.beam for view in names["views"][:6])
    told = read_scene(
        resolve("tour", "commands"), settings=[setting("noise.rangeSigmaRatio=0.1")]
    ).get()
    world = names["scene"].world
    assert (world.noise, world.told.noise) == (told.world.noise, told.world.told.noise)
    for ours, theirs in zip(ekfsim.play(names["scene"]), ekfsim.play(told), strict=True):
        np.testing.assert_array_equal(ours.posterior.mean, theirs.posterior.mean)


ROOMS = {
    "scene": "ekfsim.scene('square').seed",
    "study": "ekfsim.study('square', runs=5).plan.request.runs",
    "why": "ekfsim.why('square', runs=5).outcome",
}


@pytest.mark.parametrize(
    "first",
    [
        "import ekfsim",
        "import ekfsim; ekfsim.load_scene('square')",
        "import ekfsim.{0}",
        "import ekfsim.{0} as room; import ekfsim; assert room is ekfsim.{0}",
        "from ekfsim import {0}; import ekfsim; assert {0} is ekfsim.{0}",
    ],
)
@pytest.mark.parametrize("room", ROOMS)
def test_a_room_that_is_called_means_one_thing_whatever_is_imported_first(room, first):
    program = f"{first.format(room)}\nprint({ROOMS[room]})"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) == 1


def test_help_is_a_page_and_names_all():
    told = pydoc.plain(pydoc.render_doc(ekfsim))
    assert len(told.splitlines()) < 260
    page = inspect.getdoc(ekfsim)
    listed = told.partition("FUNCTIONS")[2]
    for name in ekfsim._HOME_OF:
        assert name in dir(ekfsim)
        assert getattr(ekfsim, name).__doc__
        assert re.search(rf"\b{name}\b", page) or f"{name}(" in listed, name
