"""explain on the packaged scenes."""

from ekfsim.files.scenes.load import load_scene
from ekfsim.why import explain


def test_a_told_ratio_that_is_wrong_is_what_cures():
    found = explain(load_scene("diverge-02b-laser-overtrusted"))
    assert (found.outcome, [one.name for one in found.cure]) == (
        "lost",
        ["the told rangeSigmaRatio"],
    )
    assert found.cure[0].told == "0.005 told, 0.02 true"
