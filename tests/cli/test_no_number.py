"""No output says nan or inf: where there is no number, there is a word for why."""

import json
import re
from dataclasses import replace
from itertools import islice

import pytest
from program import ekfsim

from ekfsim.files.packaged import resolve
from ekfsim.files.results.trace import line_of
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters import FILTERS
from ekfsim.filters.tuning import CROWDS
from ekfsim.localization import play
from ekfsim.views.picture.sights import sight
from ekfsim.views.playback.playback import views
from ekfsim.views.words.beams.beam import beam
from ekfsim.views.words.captions import notes, spread, title
from ekfsim.views.words.narrative.narrating import narrate

NO_NUMBER = re.compile(r"\b(nan|inf|infinity)\b", re.IGNORECASE)
EVERY = [(scene, filter) for scene in ("square", "tour") for filter in FILTERS]
DRIVES = {
    "gnss": "[{v: 1, omega: 20, for: 1}]",
    "pioneer": "[{v: 0.2, omega: 20, for: 2}]",
    "pylon": "[{v: 0.5, omega: 20, for: 2}]",
    "landmarks": "[{v: 0.5, omega: 20, for: 2}]",
}


def outputs(folder, *run):
    """The narrative, and every file that a run writes."""
    files = [
        *("--trace", folder / "trace"),
        *("--csv", folder / "csv"),
        *("--summary", folder / "summary"),
    ]
    done = ekfsim("run", *run, *files, "--tum", folder / "tum")
    assert done.status == 0, done.err
    yield "narrative", done.out
    for path in folder.rglob("*"):
        if path.is_file():
            yield path.name, path.read_text()


def sense_lines(text):
    return [line for line in map(json.loads, text.splitlines()) if line["type"] == "sense"]


@pytest.mark.parametrize(
    ("scene", "filter", "others"),
    [
        *((scene, filter, ()) for scene, filter in EVERY),
        ("diverge-01-wrong-wall", "kf", ()),
        ("diverge-01-wrong-wall", "kf-nominal", ()),
        ("diverge-01-wrong-wall", "pf", ("--world", "corridor")),
        ("diverge-01-wrong-wall", "kf", ("--world", "corridor")),
    ],
)
def test_a_scene_of_the_classroom(scene, filter, others, tmp_path):
    for name, text in outputs(tmp_path, scene, "--filter", filter, *others):
        assert not NO_NUMBER.search(text), (name, NO_NUMBER.search(text))
        if name == "trace":
            for line in sense_lines(text):
                assert (line["wall"] is None) == (line["incidence"] is None)
                if filter.startswith("kf"):  # a tangent meets no wall
                    assert line["wall"] is None
        if name == "narrative":
            assert "expected to meet no wall" not in text
            assert ("It was expected to meet" in text) == (not filter.startswith("kf"))


def test_the_range_of_a_tangent_may_be_negative_and_is_told_so(tmp_path):
    told = dict(outputs(tmp_path, "diverge-01-wrong-wall", "--filter", "kf", "--world", "corridor"))
    negative = sum(line["predicted_range"] is not None and line["predicted_range"] < 0
                   for line in sense_lines(told["trace"]))  # fmt: skip
    assert negative > 0
    assert told["narrative"].count("A range cannot be negative") == negative


def test_where_the_estimate_itself_sees_no_wall(tmp_path):
    told = dict(outputs(tmp_path, "diverge-01-wrong-wall", "--filter", "pf", "--world", "corridor"))
    unseen = sum(
        line["wall"] is None and line["predicted_range"] is not None
        for line in sense_lines(told["trace"])
    )
    assert unseen > 0
    assert told["narrative"].count("The beam of the estimate itself meets no wall") == unseen


@pytest.mark.parametrize("system", DRIVES)
@pytest.mark.parametrize("filter", [name for name in FILTERS if name not in CROWDS])
def test_a_drive(system, filter, tmp_path):
    path = tmp_path / "commands.yaml"
    path.write_text(f"world: {resolve(system, 'worlds')}\ndrive: {DRIVES[system]}\n")
    for name, text in outputs(tmp_path / "out", path, "--filter", filter):
        assert not NO_NUMBER.search(text), (name, NO_NUMBER.search(text))


@pytest.mark.parametrize("filter", ["kf", "pf"])
@pytest.mark.parametrize("system", ["gnss", "pioneer", "landmarks"])
def test_what_is_written_beside_pictures(system, filter):
    scene = load_scene(system if system != "landmarks" else "tour")
    scene = replace(scene, filter=filter)
    for view in islice(views(play(scene)), 25):
        seen = beam(view.step, scene) or sight(view.step)
        words = [
            narrate(view, scene),
            title(view, 9),
            *notes(view, scene, seen),
            spread(view, 0.954),
        ]
        words.append(json.dumps(line_of(view.step, scene, 0.954), allow_nan=False))
        assert not NO_NUMBER.search("\n".join(words))


def test_a_search_that_was_cut_off_is_told_in_narrative_trace_and_study(tmp_path):
    for steps, told in ((1, True), (50, False)):
        cut = ("--filter", "iekf", "--set", f"filter.iterations={steps}")
        texts = dict(outputs(tmp_path / str(steps), "tour", *cut))
        lines = [line.get("settled", True) for line in sense_lines(texts["trace"])]
        assert (texts["narrative"].count("did not settle") > 0) == told
        assert texts["narrative"].count("did not settle") == lines.count(False)
        done = ekfsim("study", "tour", *cut, "--runs", 4)
        assert (
            "readings the search for the most probable state did not settle" in done.out
        ) == told, done.err
