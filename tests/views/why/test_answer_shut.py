"""`why` says of a filter that shut its readings out since when it did, as its closing words do."""

from dataclasses import replace

import pytest

from ekfsim.diagnostics.summary import Summary
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.why.answer import sentence
from ekfsim.views.words.closing import conclude
from ekfsim.why.records import Explanation


@pytest.mark.parametrize("filter", ["pdaf", "huber", "ekf"])
def test_it_is_told_with_the_cause(filter):
    scene = replace(load_scene("diverge-03c-slip"), filter=filter, gate=None)
    summary = Summary.of(scene)
    steps = tuple(summary.following(play(scene)))
    found = Explanation(scene, "lost", summary.evidence.lost_from, lost_steps=steps)
    told = sentence(found)
    assert told.startswith("Lost since step 32. ")
    last = conclude(summary).splitlines()[-1]
    if filter == "ekf":
        assert "call it back" not in told
        return
    (said,) = (one for one in told.split(". ") if "call it back" in one)
    assert last.removeprefix("How it was lost: ").lower() == said.lower().rstrip(".")
