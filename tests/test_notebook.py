"""What README shows a notebook, and what `help(ekfsim)` tells it."""

import inspect
import pydoc
import re
from pathlib import Path

import numpy as np

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
    assert (names["world"].noise, names["world"].told.noise) == (
        told.world.noise,
        told.world.told.noise,
    )
    for ours, theirs in zip(ekfsim.play(names["scene"]), ekfsim.play(told), strict=True):
        np.testing.assert_array_equal(ours.posterior.mean, theirs.posterior.mean)


def test_help_is_a_page_and_names_all():
    told = pydoc.plain(pydoc.render_doc(ekfsim))
    assert len(told.splitlines()) < 200
    page = inspect.getdoc(ekfsim)
    listed = told.partition("FUNCTIONS")[2]
    for name in ekfsim._HOME_OF:
        assert name in dir(ekfsim)
        assert getattr(ekfsim, name).__doc__
        assert re.search(rf"\b{name}\b", page) or f"{name}(" in listed, name
