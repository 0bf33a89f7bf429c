"""The gallery's table of cures: a column of each, beside what ekf makes of the same runs."""

from dataclasses import replace

import pytest

from ekfsim.diagnostics.verdict import Evidence
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters import FILTERS
from ekfsim.localization import play
from ekfsim.smoothing.shares import Shares
from ekfsim.study.results import Share
from ekfsim.views.gallery.cures import (
    CURES,
    HEAD,
    PLAIN,
    AllSteps,
    Cured,
    Mark,
    assumption,
    cured,
    watched_by,
    whose,
)
from ekfsim.views.gallery.exhibit import Exhibit, Wing
from ekfsim.views.gallery.markdown import row
from ekfsim.views.gallery.site import site
from ekfsim.views.study.shares import HEAD as SHARES

RUNS = 12
ON = AllSteps(Share(20, 100), 0.5), AllSteps(Share(30, 100), 0.25)
SHOWN = Exhibit(
    "diverge-01-wrong-wall", "", "", 0, 0, "", False, "", (1, 1), 1, ("",) * len(SHARES),
    Cured(30, (Share(15, 30), Share(0, 30), Share(30, 30), *[None] * len(CURES[2:])), ON),
)  # fmt: skip


def alone(scene, name):
    """Which runs are lost, and their steps by NEES, each run played by itself."""
    lost, steps = 0, Shares()
    for run in range(RUNS):
        evidence = Evidence()
        for step in play(replace(scene, filter=name, run=run)):
            evidence.add(step)
            steps.take(step)
        lost += evidence.lost_from is not None
    return lost, steps


def test_there_is_a_column_of_every_cure_and_each_says_what_it_assumes():
    rooms = "ekfsim.filters.cures.", "ekfsim.filters.mixture."
    assert {name for name in FILTERS if FILTERS[name].__module__.startswith(rooms)} == {*CURES}
    assert HEAD[: 1 + len(CURES)] == (PLAIN, *CURES)
    for name in CURES:
        assert assumption(name).startswith("Assumes ")


def test_a_row_counts_what_each_run_alone_says():
    scene = load_scene("diverge-07-heading-spread")
    found = cured(scene, RUNS)
    assert found.runs == RUNS
    for name in (PLAIN, "huber", "pdaf", "mhekf"):
        share = found.lost[HEAD.index(name)]
        assert (share.runs, share.of) == (alone(scene, name)[0], RUNS)
    for name, all_steps in zip((PLAIN, "ekf-smoothed"), found.steps, strict=True):
        _, steps = alone(scene, name)
        assert all_steps.beyond == (steps.lost, steps.judged)
    assert found.steps[1].position_rmse < found.steps[0].position_rmse
    assert 0 < found.steps[0].beyond.runs < found.steps[1].beyond.runs
    *_, beyond, error = found.cells
    assert "→" in beyond
    assert error == f"× {found.steps[1].position_rmse / found.steps[0].position_rmse:.2g}"


@pytest.mark.parametrize(
    ("name", "marked"),
    [
        ("diverge-01-wrong-wall", {"huber": "✓", "pdaf": "✓", "mhekf": "✓"}),
        ("diverge-09-wrong-start", {"huber": "", "pdaf": "✗", "mhekf": ""}),
        ("diverge-03c-slip", {"huber": "✗", "pdaf": "✗"}),
    ],
)
def test_a_mark_says_what_a_cure_heals_and_what_it_kills(name, marked):
    scene = load_scene(name)
    share = {
        filter: Share(sum(tally.lost_from.values()), tally.runs)
        for filter in (PLAIN, *marked)
        for tally in [watched_by(filter, scene, 100)]
    }
    assert {one: Mark.of(share[one], share[PLAIN]).value for one in marked} == marked


def test_a_mark_needs_more_than_chance_and_a_quarter():
    few = Share(2, 40)
    assert Mark.of(Share(0, 40), few) is Mark.NONE  # 0 of 40, and 2: chance
    assert Mark.of(Share(900, 1000), Share(1000, 1000)) is Mark.FEWER
    assert Mark.of(Share(250, 1000), Share(1000, 1000)) is Mark.HEALS
    assert Mark.of(Share(251, 1000), Share(1000, 1000)) is Mark.FEWER
    assert Mark.of(Share(748, 1000), Share(0, 1000)) is Mark.MORE
    assert Mark.of(Share(752, 1000), Share(0, 1000)) is Mark.KILLS


def test_what_cannot_watch_a_scene_is_a_dash_and_its_runs_are_told():
    found = cured(load_scene("proof-marker-behind"), 60)  # no boundary, and a clock
    assert found.runs == 20
    assert found.cells[HEAD.index("amcl")] == "–"
    assert "–" not in found.cells[HEAD.index("mhekf")]
    assert whose([60, 50]) == "60 runs of each (50 of a drive)"


def test_where_no_start_is_known_only_particles_can_begin():
    scene = load_scene("proof-unsure-start").with_("belief.start", "unknown")
    found = cured(scene, 2)
    assert [share is None for share in found.lost] == [name != "amcl" for name in HEAD[:-2]]
    assert found.cells[-2:] == ("–", "–")
    assert set(found.marks) == {Mark.NONE}


def test_the_site_colours_what_is_healed_and_what_is_killed():
    text = site([Wing("divergence", "divergence", [SHOWN])])
    assert '<td class="heals">0 ✓</td><td class="kills">100 ✗</td><td class="none">–</td>' in text
    assert '<th scope="col" title="Assumes that the prior is right' in text
    assert text.count("<td class=") == len(HEAD)
    without = site([Wing("divergence", "divergence", [replace(SHOWN, cured=None)])])
    assert "<td class=" not in without


def test_in_markdown_a_row_has_a_cell_for_each_column():
    dashes = " | ".join("–" for _ in CURES[2:])
    name = SHOWN.name
    assert row(name, SHOWN.cured) == (
        f"| [{name}](#{name}) | 50.0 | 0 ✓ | 100 ✗ | {dashes} | 20.0 → 30.0 | × 0.5 |"
    )
