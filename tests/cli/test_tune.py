"""`ekfsim tune`: what it finds, what it writes, and that this can be run at once."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from program import ekfsim

from ekfsim import load_scene
from ekfsim.fitting.estimate import fit
from ekfsim.fitting.likelihood import truncation
from ekfsim.fitting.noises import Retold, noises_of
from ekfsim.fitting.trial import recorded, tried
from ekfsim.fitting.written import UNLIKE, WORSE
from ekfsim.localization import play
from ekfsim.records import Reading
from ekfsim.views.fitting.words import conclude

KEYS = [f"noise.{name}SigmaRatio" for name in ("odometryDst", "odometryAng", "range")]


def laps(seed=0, times=1):
    scene = load_scene("diverge-00-control")
    return replace(scene, commands=scene.commands * times, seed=seed)


def doubled(scene):
    """The same log, its filter told twice the noise there is; and what there is."""
    scene = recorded(scene)
    truth = noises_of(scene)
    return Retold(scene, truth).with_([2 * one.value for one in truth]), truth


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_it_finds_the_ratios_of_a_simulated_log_within_its_intervals():
    off, truth = doubled(laps(times=3))
    found = fit(Retold(off, noises_of(off)), len(off.log.entries), None)
    assert [one.number.key for one in found.found] == KEYS
    for one, right in zip(found.found, truth, strict=True):
        assert one.low <= right.value <= one.high
        assert one.low < one.value < one.high < 3 * right.value


def test_a_gate_does_not_fool_it():
    """A filter that is told far too little noise refuses nearly all, and still finds it."""
    scene = recorded(laps(3))
    beam = noises_of(scene)[2:]
    off = Retold(scene, beam).with_([beam[0].value / 5])
    refused = sum(bool(s.correction.refused) for s in play(replace(off, gate=0.99)) if s.correction)
    assert refused > 10
    found = fit(Retold(off, noises_of(off)[2:]), len(off.log.entries), 0.99)
    assert found.found[0].low <= beam[0].value <= found.found[0].high
    assert len(found.left_out) < 5


def test_an_outlier_tells_no_noise_though_the_file_has_no_gate():
    scene = recorded(laps(1))
    assert scene.gate is None
    entries = list(scene.log.entries)
    at = next(n for n, one in enumerate(entries) if n > 20 and isinstance(one.given, Reading))
    far = replace(entries[at].given, z=entries[at].given.z + 1.0)
    entries[at] = replace(entries[at], given=far)
    with_it = replace(scene, log=replace(scene.log, entries=tuple(entries)))
    trial, clean = tried(with_it, KEYS[2:]), tried(scene, KEYS[2:])
    assert trial.fit.left_out == clean.fit.left_out | {entries[at].index}
    assert trial.fit.values == pytest.approx(clean.fit.values, rel=0.1)
    assert "1 reading beyond a gate of 0.999 told nothing" in conclude(trial)


def test_what_a_gate_leaves_has_a_smaller_variance():
    w = np.random.default_rng(1).normal(size=(200_000, 2))
    nis = (w * w).sum(axis=1)
    kept = nis[nis < np.quantile(nis, 0.9)]
    assert truncation(0.9, 2) == pytest.approx(kept.mean() / 2, rel=0.01)


def test_a_half_that_was_held_back_says_how_it_does():
    off, _ = doubled(laps(1))
    trial = tried(off, KEYS[2:])
    assert trial.before.mean < 0.5
    assert trial.after.mean == pytest.approx(1.0, abs=0.45)
    assert trial.after.cost < trial.before.cost
    assert (trial.is_worse, trial.used) == (False, trial.fit.found)
    assert trial.after.evidence.nis_readings == 32
    assert conclude(trial).startswith("Fitted to the first half of ")
    worse = replace(trial, after=replace(trial.after, cost=trial.before.cost + 6))
    assert worse.is_worse
    assert conclude(worse).startswith(f"{WORSE}\n\n{UNLIKE}\n\nFitted to")


def of_columns(sigma=""):
    """A log of speeds and fixes that brings no world; the fixes tell their σ where one is named."""
    Path("named").mkdir()
    Path("named/motion.csv").write_text("t,v,omega\n" + "".join(f"{k},1,0\n" for k in range(61)))
    scatter = np.random.default_rng(3).normal(0, 0.5, (60, 2)).round(3)
    rows = [f"{k},{k + x},{y}{sigma}\n" for k, (x, y) in enumerate(scatter.tolist())]
    Path("named/readings.csv").write_text("t,x,y" + ",sigma" * bool(sigma) + "\n" + "".join(rows))


def test_a_log_without_a_world_is_fitted_and_what_is_written_plays_it():
    of_columns()
    told = ekfsim("tune", "log", "--log", "named", "-o", "t.yaml", "--fit", "sensors.gnss.sigma")
    assert told.status == 0, told.err
    fitted = float(told.out.split("sensors.gnss.sigma")[1].split()[1])
    assert fitted == pytest.approx(0.5, rel=0.4)
    ran = ekfsim("run", "t.yaml", "-q", "--summary", "s.json")
    assert ran.status == 0
    mean = json.loads(Path("s.json").read_text())["nis"]["mean"]
    assert mean == pytest.approx(1.0, abs=0.4)


def test_a_sensor_whose_readings_tell_their_own_sigma_is_not_fitted():
    """The numbers that are written would say nothing to the run that reads the log again."""
    of_columns(sigma=",0.5")
    told = ekfsim("tune", "log", "--log", "named", "-o", "t.yaml", "--fit", "sensors.gnss.sigma")
    assert told.status == 0, told.err
    why = "each reading tells by itself how sure it is, which wins"
    assert f"sensors.gnss.sigma is left at 0.15: {why}" in told.out
    swept = ekfsim("study", "log", "--log", "named", "--sweep", "sensors.gnss.sigma=0.1,9")
    assert f"sensors.gnss.sigma changes nothing: {why}" in swept.out


@pytest.fixture
def log():
    Path("mine.yaml").write_text(
        "world: room\ncommands:\n  - repeat:\n      times: 30\n      commands:\n"
        "        - move: {distance: 0.5, angle: 0}\n        - sense: {angle: 0}\n"
        "        - sense: {angle: 90}\n        - move: {distance: -0.5, angle: 37}\n"
        "        - sense: {angle: 180}\n        - sense: {angle: -90}\n"
    )
    assert ekfsim("record", "mine.yaml", "--world", "room", "-o", "log", "--truth").status == 0
    return "log"


def test_what_is_written_can_be_run(log):
    options = "tune", "mine.yaml", "--log", log, "--fit", "noise.rangeSigmaRatio", "-o"
    told = ekfsim(*options, "out/tuned.yaml")
    assert (told.status, told.err) == (0, "")
    assert sorted(path.name for path in Path("out").iterdir()) == [
        "tuned-world.yaml", "tuned.png", "tuned.yaml",
    ]  # fmt: skip
    assert "On the second half, which was held back:" in told.out
    assert "noise.rangeSigmaRatio" in told.out
    assert "odometry" not in told.out
    assert ekfsim("check", "out/tuned.yaml", "out/tuned-world.yaml").status == 0
    scene, before = load_scene("out/tuned.yaml"), load_scene("mine.yaml", log=log)
    assert scene.world.told.noise.range != before.world.told.noise.range
    assert scene.world.noise == before.world.noise
    assert len(scene.log.entries) == len(before.log.entries)
    assert ekfsim("run", "out/tuned.yaml", "-q").status == 0
    held = {path: path.read_bytes() for path in Path("out").iterdir()}
    assert ekfsim(*options, "out/tuned.yaml").status == 2  # they exist
    assert {path: path.read_bytes() for path in Path("out").iterdir()} == held


def test_numbers_that_do_worse_on_the_other_half_are_not_written(log, monkeypatch):
    monkeypatch.setattr("ekfsim.fitting.trial.CLEARLY", -1e9)  # as if they did
    options = "--log", log, "--fit", "noise.rangeSigmaRatio"
    told = ekfsim("tune", "mine.yaml", *options, "-o", "tuned.yaml")
    assert told.status == 0
    assert told.out.startswith("NOT TUNED: ")
    assert "plays it with those that were told" in told.out
    scene, before = load_scene("tuned.yaml"), load_scene("mine.yaml", log=log)
    assert scene.world.told.noise == before.world.told.noise
    for file in ("tuned.yaml", "tuned-world.yaml"):
        assert Path(file).read_text().startswith("# NOT TUNED: the half of the log that was held")


def test_nothing_is_written_among_the_files_of_the_log(log):
    refused = ekfsim("tune", "mine.yaml", "--log", log, "-o", f"{log}/tuned.yaml")
    assert (refused.status, refused.err) == (
        2, "ekfsim: log/tuned.yaml: lies in the folder of the log; choose another folder\n",
    )  # fmt: skip


@pytest.mark.parametrize(("options", "line"), [
    (["--fit", "noise.rangeSigmaratio"],
     "--fit noise.rangeSigmaratio: no noise that this filter is told of; known: "),
    (["--filter", "pf"], "pf: its own draws make every trial another; tune ekf or ukf"),
    (["--filter", "ekf,ukf"], "--filter: numbers are fitted for one filter; name one"),
])  # fmt: skip
def test_what_cannot_be_is_refused(options, line):
    refused = ekfsim("tune", "tour", "-o", "tuned.yaml", *options)
    assert refused.status == 2
    assert refused.err.startswith(f"ekfsim: {line}")


def test_too_few_readings_and_no_name_for_a_file():
    refused = ekfsim("tune", "square", "-o", "tuned.yaml")
    assert refused.status == 2
    assert refused.err == (
        "ekfsim: commands/square.yaml: 4 readings tell no noise; at least 40 are wanted\n"
    )
    assert ekfsim("tune", "tour", "-o", "tuned.txt").status == 2
    assert not list(Path().iterdir())
