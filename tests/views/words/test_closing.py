from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from ekfsim.diagnostics.summary import Errors, Summary
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Refused
from ekfsim.localization import play
from ekfsim.records import Nees
from ekfsim.views.playback.playback import views
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.verdict import meaning, sentence

IMPOSSIBLE = "the belief is impossible: the error has a part where the covariance claims certainty"


def nees(value, dof=3, impossible=False):
    return Nees(np.array(value), np.array(dof), np.array(impossible))


@pytest.mark.parametrize(
    ("evidence", "told"),
    [
        (Evidence(), "no evidence: not one reading could be held against a prediction"),
        (Evidence(0.5, 1, nis_readings=1),
         "consistent: the NIS of 1 reading is 0.5, within the 99 % band 3.92704e-05 to 7.87944"),
        (Evidence(10, 10, None, nees(2.5), nis_readings=10),
         "consistent: the NIS of 10 readings sums to 10 (1 per number read), within "
         "the 99 % band 2.15586 to 25.1882; at the last "
         "step NEES is 2.5, below its 99.9 % bound 16.2662 (3 degrees of freedom)"),
        (Evidence(26, 10, nis_readings=10),
         "over-confident: the NIS of 10 readings sums to 26 (2.6 per number read), above "
         "the 99 % band 2.15586 to 25.1882: "
         "the filter trusts itself more than its readings allow"),
        (Evidence(26, 10, nis_refused=2, nis_readings=10),
         "over-confident: the NIS of 10 readings (2 of them refused) sums to 26 (2.6 per number "
         "read), above the 99 % "
         "band 2.15586 to 25.1882: the filter trusts itself more than its readings allow"),
        (Evidence(2, 10, nis_readings=10),
         "over-cautious: the NIS of 10 readings sums to 2 (0.2 per number read), below "
         "the 99 % band 2.15586 to 25.1882: "
         "the filter trusts itself less than it could"),
        (Evidence(7.5, 10, nis_readings=5),
         "consistent: the NIS of 5 readings sums to 7.5 (0.75 per number read), within "
         "the 99 % band 2.15586 to 25.1882 "
         "(10 degrees of freedom)"),
        (Evidence(10, 10, 7, nees(20.0, 1)),
         "lost from step 7 on: at the last step NEES is 20, beyond its 99.9 % bound 10.8276 (1 "
         "degree of freedom)"),
        (Evidence(10, 10, 7, nees(np.nan, 1, True)),
         f"lost from step 7 on: at the last step {IMPOSSIBLE}"),
    ],
)  # fmt: skip
def test_every_verdict_has_its_evidence(evidence, told):
    assert sentence(evidence) == told


def of(*errors):
    gathered = Errors()
    for e in errors:
        gathered.add(e)
    return gathered


def test_the_closing_lines():
    summary = Summary(
        steps=5, updates=1, refused={Refused.GATE: 2, Refused.NO_ECHO: 1},
        position=of(0.3, 0.4), heading=of(-0.1), reckoned_position=of(1.0),
        reckoned_heading=of(0.2),
        evidence=Evidence(0.5, 1, nis_readings=1),
    )  # fmt: skip
    assert conclude(summary) == (
        "The run is over after 5 commands: 1 update; 3 readings not used (1 without an echo, 2 "
        "refused by the gate)\n"
        "Position error: RMSE 0.353553 m, at most 0.4 m; by odometry alone RMSE 1 m, at most 1 m\n"
        "Heading error: RMSE 5.72958 degrees, at most 5.72958 degrees; "
        "by odometry alone RMSE 11.4592 degrees, at most 11.4592 degrees\n"
        "Verdict: consistent: the NIS of 1 reading is 0.5, within the 99 % band 3.92704e-05 to "
        "7.87944\n"
    )


def test_a_run_with_a_clock_counts_its_inputs_and_readings():
    summary = Summary(
        steps=7,
        inputs=4,
        updates=2,
        refused={Refused.GATE: 1},
        path=of(0.3, -0.4),
        first_t=2.0,
        last_t=3.5,
    )
    assert conclude(summary) == (
        "The run is over after 4 motion inputs and 3 readings over 1.5 s: 2 updates; "
        "1 reading not used (1 refused by the gate)\n"
        "Distance to the expected path: RMSE 0.353553 m, at most 0.4 m\n"
        "Verdict: no evidence: not one reading could be held against a prediction\n"
    )


def test_an_estimate_that_is_no_number_has_no_error():
    summary = Summary(position=of(1.0, np.nan), heading=of(0.0, 0.0))
    assert "\nThe errors are unknown: the estimate is no number\n" in conclude(summary)


def test_a_run_of_nothing():
    assert conclude(Summary()) == (
        "The run is over after 0 commands: 0 updates\n"
        "Verdict: no evidence: not one reading could be held against a prediction\n"
    )


@pytest.mark.parametrize("guard", ["warn", "skip"])
def test_a_filter_is_not_condemned_for_what_it_refused(guard):
    """Where the guard leaves out the beam that loses the run, only what is left out speaks against
    the filter.
    """
    run = replace(load_scene("diverge-01-wrong-wall"), guard=guard)
    steps = list(play(run))
    *_, last = views(steps)
    used = [s for s in steps if s.correction is not None and not s.correction.refused]
    total = sum(float(s.correction.nis) for s in used)
    low, high = chi2.interval(0.99, len(used))
    if guard == "warn":
        assert meaning(last, run).startswith("not to be believed: lost since step 13; ")
        return
    assert len(used) < sum(s.correction is not None for s in steps)
    assert meaning(last, run) == (
        f"to be believed but for what it refused: ΣNIS of the {len(used)} readings that it used is "
        f"{total:.3g}, within {low:.3g} to {high:.3g}"
    )
