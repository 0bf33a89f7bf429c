"""Numbers of a filter's own: in a commands file, by --set filter.NAME=VALUE, by
--particles and --hypotheses.
"""

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from ekfsim.cli.program.asked import scene_of
from ekfsim.errors import UsageError
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import check, read_scene
from ekfsim.files.scenes.load_study import asked
from ekfsim.filters import FILTERS
from ekfsim.filters.tuning import CROWDS, UNTUNED
from ekfsim.filters.variants.shadows import ShadowsAlone
from ekfsim.localization import filter_of, play
from ekfsim.records import Reading
from ekfsim.study.comparison import Comparison, with_sides
from ekfsim.study.plan import Plan
from ekfsim.study.results import Result
from ekfsim.views.study.words import played

PYLON = (
    Path(__file__).resolve().parents[3] / "../shared/data/pylon/2020_2_26__17_21_59_filtered.csv"
)
OWN = [  # what is written, the filter, its field and the number there
    ("particles: 70", "pf", "count", 70),
    ("alpha: 0.5", "ukf", "alpha", 0.5),
    ("beta: 2", "ukf", "beta", 2.0),
    ("kappa: -1", "ukf", "kappa", -1.0),
    ("iterations: 3", "iekf", "iterations", 3),
]


@pytest.mark.parametrize(("told", "name", "field", "number"), OWN)
def test_a_number_reaches_its_filter_from_a_file_and_from_the_command_line(
    told, name, field, number, tmp_path
):
    text = (
        resolve("tour", "commands")
        .read_text()
        .replace("world: ../worlds", f"world: {resolve('room', 'worlds').parent}")
        .replace("filter: ekf\n", "")
    )
    (tmp_path / "mine.yaml").write_text(f"{text}\nfilter: {name}\nfilterSettings: {{{told}}}\n")
    in_file = read_scene(tmp_path / "mine.yaml").get()
    by_option = scene_of("tour", filter_name=name, settings=(f"filter.{told.replace(': ', '=')}",))
    for scene in (in_file, by_option):
        assert getattr(filter_of(scene), field) == number
    key = told.partition(":")[0]
    overruled = read_scene(
        tmp_path / "mine.yaml", settings=by_option_settings(f"filter.{key}=1")
    ).get()
    assert getattr(filter_of(overruled), field) == 1


def by_option_settings(*texts):
    from ekfsim.files.scenes.settings import setting

    return [setting(text) for text in texts]


def test_the_short_form_of_particles_is_the_setting():
    assert scene_of("tour", filter_name="pf", particles=50).tuning.particles == 50
    assert scene_of("tour", filter_name="pf", particles=50).settings == ("filter.particles=50",)


def test_as_it_comes_every_filter_is_its_own_default():
    for name in CROWDS:
        assert filter_of(scene_of("tour", filter_name=name)).count == CROWDS[name]
    assert (CROWDS["pf"], CROWDS["amcl"]) == (FILTERS["pf"].count, 5000)
    for name, field, key in (("ukf", "alpha", "alpha"), ("ukf", "beta", "beta"),
                             ("ukf", "kappa", "kappa"), ("iekf", "iterations",
                             "iterations")):  # fmt: skip
        made = filter_of(scene_of("tour", filter_name=name))
        assert getattr(made, field) == asdict(UNTUNED)[key]
        assert getattr(FILTERS[name], field) == asdict(UNTUNED)[key]


@pytest.mark.parametrize(
    ("filters", "settings", "message"),
    [
        ("pf", "filter.particels=5",
         "--set filter.particels=5: unknown key 'particels'; did you mean 'filter.particles'?"),
        ("pf", "particles=5", "--set particles=5: unknown key 'particles'; did you mean "
                              "'filter.particles'?"),
        ("pf", "filter.particles=0",
         "--set filter.particles=0: 0 is too small; write a whole number of 1 or more"),
        ("pf", "filter.particles=1000001",
         "--set filter.particles=1000001: 1000001 is too large; write a whole number of at most 1 "
         "000 000"),
        ("adaptive", "filter.adaptive=0",
         "--set filter.adaptive=0: 0 is too small; write more than 0"),
        ("adaptive", "filter.adaptive=1.5",
         "--set filter.adaptive=1.5: 1.5 is too large; write a number of at most 1"),
        ("pdaf", "filter.clutter=1",
         "--set filter.clutter=1: 1 is too large; write a number of less than 1"),
        ("pdaf", "filter.clutter=-0.1",
         "--set filter.clutter=-0.1: -0.1 is negative; write a number of 0 or more"),
        ("huber", "filter.huber=-1",
         "--set filter.huber=-1: -1 is negative; write more than 0"),
        ("mhekf", "filter.hypotheses=100000",
         "--set filter.hypotheses=100000: 100000 is too large; write a whole number of at most 64"),
        ("pf", "filter=ukf", "--set filter=ukf: 'filter' is no single value; write e.g. "
                             "filter.particles, and name the "
         "filter itself by --filter"),
        ("ekf,ukf", "filter.particles=5",
         "--set filter.particles=5: no filter here (ekf, ukf) reads it; name one that does: "
         "--filter pf or amcl"),
        ("ukf", "filter.kappa=-3",
         "--set filter.kappa=-3: -3 leaves no sigma points, for the state has 3 numbers; write "
         "more than -3"),
        ("ekf", "filter.rangeVariance=raeding",
         "--set filter.rangeVariance=raeding: 'raeding' is not known here; did you mean "
         "'reading'?"),
        ("pf", "filter.crossCovariances=dropped",
         "--set filter.crossCovariances=dropped: no filter here (pf) reads it; name one that "
         "does: --filter "
         + " or ".join(name for name in FILTERS if name not in CROWDS)),
    ],
)  # fmt: skip
def test_a_wrong_setting_is_told_in_a_line(filters, settings, message):
    with pytest.raises(UsageError) as error:
        scene_of("tour", filter_name=filters, settings=(settings,))
    assert str(error.value) == message


def test_the_classrooms_switches_are_no_others():
    with pytest.raises(
        UsageError,
        match=r"rangeVariance=reading: 'rangeVariance' belongs to the classroom's filter; ",
    ):
        scene_of("gnss", settings=("filter.rangeVariance=reading",))


def test_settings_that_the_files_own_filter_does_not_read_are_told_by_check_alone(tmp_path):
    (tmp_path / "c.yaml").write_text(
        f"world: {resolve('room', 'worlds')}\nfilterSettings: {{particles: 9, iterations: "
        f"2}}\ncommands: [say: hello]\n"
    )
    told = [warning.partition("c.yaml:")[2] for warning in check(tmp_path / "c.yaml").warnings]
    assert told == [
        "2:29: filterSettings.particles: the filter 'ekf' has no particles; pf or amcl would read "
        "it",
        "2:44: filterSettings.iterations: the filter 'ekf' has no iterations; iekf would read it",
    ]
    assert read_scene(tmp_path / "c.yaml").warnings == []  # --filter may name another


def request(filters="pf", sweeps=(), particles=None, hypotheses=None, settings=()):
    numbers = particles, hypotheses
    return asked("tour", None, 3, 1, filters, sweeps, settings, None, None, None, False, *numbers)


def test_a_study_sweeps_a_number_of_the_filter_and_its_runs_can_be_played():
    plan = Plan.of(request("ekf,pf", ["filter.particles=30,60"]))
    assert [case.scene.tuning.particles for case in plan.cases] == [30, 30, 60, 60]
    lines = []
    for number in (0, 1):
        tally = plan.block(number)(0, 3)
        lines.append(played(plan, Result(plan.cases[number], tally), 2))
    assert lines == [
        "ekfsim play tour --seed 1 --run 2 --filter ekf",  # which would refuse particles
        "ekfsim play tour --seed 1 --run 2 --filter pf --set filter.particles=30",
    ]


def test_a_comparison_may_set_what_one_of_its_sides_reads():
    both = with_sides(request("ekf", particles=40), "filter=ekf", "filter=pf")
    assert Comparison.of(both).b.cases[0].scene.tuning.particles == 40
    with pytest.raises(
        UsageError, match=r"^--a filter.particles=4: no filter here \(ekf\) reads it"
    ):
        Comparison.of(with_sides(request("ekf"), "filter=ekf,filter.particles=4", "filter=pf"))
    with pytest.raises(UsageError, match=r"^--particles 40: no filter here \(ekf, ukf\) reads it"):
        Comparison.of(with_sides(request("ekf", particles=40), "filter=ekf", "filter=ukf"))


def test_more_particles_than_fit_are_watched_in_portions(monkeypatch):
    plan = Plan.of(request(particles=20))
    whole = plan.block(0)(0, 7).plain()
    monkeypatch.setattr("ekfsim.study.block.MOST_PARTICLES", 50)  # two runs at once
    portions = plan.block(0)(0, 7).plain()
    np.testing.assert_allclose(flat(portions), flat(whole), rtol=1e-12)


def test_a_comparison_is_watched_in_portions_too(monkeypatch):
    comparison = Comparison.of(
        with_sides(request("pf"), "filter.particles=20", "filter.particles=30")
    )
    whole = comparison.block(0)(0, 5)
    monkeypatch.setattr("ekfsim.study.block.MOST_PARTICLES", 61)
    portions = comparison.block(0)(0, 5)
    assert portions.lost == whole.lost
    np.testing.assert_allclose(flat(portions.b.plain()), flat(whole.b.plain()), rtol=1e-12)


def flat(held):
    """All numbers of nested lists and dicts, in their order."""
    if not isinstance(held, list | tuple | dict):
        return [held]
    parts = held.values() if isinstance(held, dict) else held
    return [number for part in parts for number in flat(part)]


def test_the_beliefs_of_many_particles_are_of_so_many():
    scene = scene_of("tour", filter_name="pf", particles=7)
    steps = play(scene)
    next(steps)
    assert next(step for step in steps if step.prediction is not None).posterior.states.shape == (
        7,
        3,
    )


@pytest.mark.skipif(not PYLON.is_file(), reason="the recorded logs are not here")
def test_a_recorded_log_is_told_another_sigma_and_other_particles():
    told = ("sensors.pylon.sigma=0.022", "filter.particles=2000")
    scene = scene_of("pylon_log", filter_name="pf", log=str(PYLON), settings=told)
    sensors = {
        entry.given.sensor for entry in scene.log.entries if isinstance(entry.given, Reading)
    }
    assert [(sensor.sigma_x, sensor.sigma_y) for sensor in sensors] == [(0.022, 0.022)]
    assert filter_of(scene).count == 2000


def test_dropping_is_around_whatever_filter_there_is():
    scene = scene_of(
        "tour", filter_name="ukf", settings=("filter.crossCovariances=dropped", "filter.alpha=0.7")
    )
    made = filter_of(scene)
    assert isinstance(made, ShadowsAlone)
    assert made.filter.alpha == 0.7


def test_hypotheses_are_set_by_an_option_of_their_own():
    scene = scene_of("tour", filter_name="mhekf", hypotheses=3)
    assert filter_of(scene).hypotheses == 3
    most = max(np.count_nonzero(step.posterior.weights) for step in play(scene) if step.correction)
    assert 1 < most <= 3
    assert Plan.of(request("mhekf,ekf", hypotheses=3)).cases[0].scene.tuning.hypotheses == 3
    with pytest.raises(UsageError) as told:
        scene_of("tour", hypotheses=3)
    refusal = "--hypotheses 3: no filter here (ekf) reads it; name one that does: --filter mhekf"
    assert str(told.value) == refusal
    with pytest.raises(UsageError, match=r"^--hypotheses 3: no filter here \(ekf, ukf\) reads it"):
        Comparison.of(with_sides(request("ekf", hypotheses=3), "filter=ekf", "filter=ukf"))
    with pytest.raises(UsageError, match=r"'filter.hypotheses' is told already by --set"):
        request("mhekf", hypotheses=3, settings=("filter.hypotheses=4",))
