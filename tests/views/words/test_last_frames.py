"""Of each packaged lesson the last picture alone answers: is the filter to be believed, and since
when not?
"""

import re
from pathlib import Path

import pytest
from scipy.stats import chi2

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.picture.frames import LINES
from ekfsim.views.picture.written.lettering import wrapped
from ekfsim.views.playback.playback import views
from ekfsim.views.words.captions import notes
from ekfsim.views.words.judgement import COLUMNS, judgement, warns

LESSONS = sorted(name for name in packaged("commands") if name.startswith("diverge-"))


def since(indices, condemned):
    """From which index on all are condemned, up to the last; None where the last is not."""
    first = None
    for index, one in zip(indices, condemned, strict=True):
        first = None if not one else index if first is None else first
    return first


def answer(steps):
    """Whether to believe a filter at the end, as a word, and the step since when not."""
    judged = [s for s in steps if s.nees is not None]
    beyond = [
        bool(s.nees.impossible or s.nees.value > chi2.ppf(0.999, int(s.nees.dof))) for s in judged
    ]
    lost = since([s.entry.index for s in judged], beyond)
    read = [s for s in steps if s.correction is not None and s.correction.nis == s.correction.nis]
    sums, total = [], 0.0
    for n, s in enumerate(read, 1):
        total += float(s.correction.nis)
        sums.append((total, *chi2.interval(0.99, n)))
    above = since([s.entry.index for s in read], [total > high for total, _, high in sums])
    if lost is not None:
        return "lost", lost, above
    if above is not None:
        return "over-confident", above, above
    total, low, _ = sums[-1]
    return ("over-cautious" if total < low else "consistent"), None, None


@pytest.mark.parametrize("name", LESSONS)
def test_the_last_picture_says_whether_to_believe_the_filter_and_since_when_not(name):
    scene = load_scene(name)
    steps = list(play(scene))
    last = list(views(steps))[-1]
    word, not_since, shown_since = answer(steps)
    line = judgement(last, scene, 0.954)
    said = wrapped(notes(last, scene, None), COLUMNS, LINES)
    verdict = f"Verdict: {word}" + ("" if not_since is None else f" since step {not_since}")
    assert re.match(rf"{verdict}\b(?! since)", line)
    assert len(line) <= COLUMNS
    if not_since is None:
        assert said[0].startswith("to be believed")
    elif word == "over-confident":
        assert said[0].startswith(f"not to be believed since step {not_since}: ")
    else:
        against = f"say so since step {shown_since}"
        shows = "do not say so" if shown_since is None else against
        assert said[0].startswith(f"not to be believed: lost since step {not_since}")
        assert f" its readings {shows} (ΣNIS" in said[0]
    assert warns(last, 0.954) == (not_since is not None)
    assert not said[-1].endswith("…")


def test_every_mechanism_is_among_them():
    assert {name[8:10] for name in LESSONS} == {f"{n:02}" for n in range(13)}


def test_the_page_on_pictures_quotes_what_they_say():
    scene = load_scene("diverge-01-wrong-wall")
    said = set()
    for view in views(play(scene)):
        said |= {judgement(view, scene, 0.954), *notes(view, scene, None)}
    page = (Path(__file__).parents[3] / "docs" / "pictures" / "pictures.md").read_text(
        encoding="utf-8"
    )
    quoted = [line for block in page.split("```")[1::2] for line in block.strip().splitlines()]
    assert len(quoted) == 5
    assert {line.removeprefix("⚠ ") for line in quoted} <= said
