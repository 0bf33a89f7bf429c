"""A hunt finds the same list in the same share of runs, whichever way it calculates."""

from dataclasses import replace

import pytest

from ekfsim.files.scenes.load import load_scene
from ekfsim.hunting.hunt import Asked, hunt
from ekfsim.twins import compiles

FURNISHED = load_scene({"world": "furnished-room", "commands": []})
needs_numba = pytest.mark.skipif(not compiles(), reason="the extra `fast` is not installed")


@needs_numba
@pytest.mark.parametrize("filter", ["ekf", "huber", "pdaf", "mhekf"])
def test_the_same_seed_finds_the_same_list_compiled_and_not(filter):
    asked = Asked(replace(FURNISHED, filter=filter), lists=48, moves=4, runs=100, seconds=3600)
    quick, compiled = (found(replace(asked, way=way)) for way in ("quick", "compiled"))
    assert compiled == quick
    assert quick["hits"].hits > 10, "nothing was found that could differ"


@needs_numba
def test_the_text_itself_finds_that_list():
    asked = Asked(replace(FURNISHED, filter="huber"), lists=12, moves=4, runs=100, seconds=3600)
    assert found(replace(asked, way="compiled")) == found(replace(asked, way="plain"))


def found(asked):
    made = hunt(asked, lambda *_: None, lambda: None)
    lost = made.result.tally
    return {
        "commands": made.scene.commands,
        "hits": made.count,
        "fresh": made.fresh,
        "lost from": lost.lost_from,
        "looked at": made.search.looked_at,
        "best": [(seen.variant, seen.count) for seen in made.search.best],
    }
