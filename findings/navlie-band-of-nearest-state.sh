#!/usr/bin/env bash
# Guess:     readings that are right lie in the band of three standard deviations about what the true states say, 997 of
#            1000 of them, whatever the rates of the two; the manual has it that states in between are interpolated.
# Behaviour: navlie's plot_meas takes the state that is nearest in time. With true states at 1 Hz, and readings to 0.1 m
#            of a robot of 1 m/s, 61 % of right readings lie in the band where they come at 20 Hz, 3 % where each comes
#            0.49 s after a state, and the plot is one of a bad sensor; 99.7 % where both come at the same instants. It
#            also puts the caller's own list of readings in the order of time. Right: interpolate the states oneself.
# Version:   navlie 0.0.1 (PyPI), utils.py; its __init__ asks for a pylie that its wheel does not name, so goes unused
# Source:    run below; plot_meas, interp1d of the states' numbers with "nearest"
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
{ "$folder/venv/bin/pip" install -q --no-deps navlie==0.0.1 &&
  "$folder/venv/bin/pip" install -q numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2 joblib seaborn tqdm; } \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import importlib.util
import sys
import types

import numpy as np

package = types.ModuleType("navlie")
package.__path__ = list(importlib.util.find_spec("navlie").submodule_search_locations)
sys.modules["navlie"] = package
from navlie.types import Measurement, MeasurementModel, State  # noqa: E402
from navlie.utils import plot_meas  # noqa: E402

READ_TO, SECONDS = 0.1, 500


class Place(State):
    def plus(self, dx):
        return Place(self.value + np.ravel(dx), 1, self.stamp)

    def minus(self, other):
        return self.value - other.value

    def copy(self):
        return Place(self.value.copy(), 1, self.stamp)


class Reading(MeasurementModel):
    def evaluate(self, x):
        return x.value

    def covariance(self, x):
        return READ_TO**2 * np.eye(1)


def share_in_band(state_times, times, draws):
    """Share of readings inside the band that is drawn; the robot is where its clock says, 1 m/s."""
    truth = [Place(np.array([time]), 1, time) for time in state_times]
    readings = [Measurement(np.array([draws.normal(time, READ_TO)]), time, Reading()) for time in times]
    figure, (axes,) = plot_meas(readings, truth)
    read, band = axes.collections
    modelled, edges = axes.lines[0].get_ydata(), band.get_paths()[0].vertices[:, 1]
    assert np.allclose([edges.min(), edges.max()], [modelled.min() - 3 * READ_TO, modelled.max() + 3 * READ_TO])
    return np.mean(np.abs(read.get_offsets()[:, 1] - modelled) < 3 * READ_TO)


def earlier_first():
    late, early = (Measurement(np.array([time]), time, Reading()) for time in (2.0, 1.0))
    readings = [late, early]
    plot_meas(readings, [Place(np.array([time]), 1, time) for time in (1.0, 2.0)])
    return readings == [early, late]


draws, seconds = np.random.default_rng(1), np.arange(0.0, SECONDS)
twentieths = np.arange(20 * SECONDS - 20) / 20
shares = {
    "states and readings of the same instants": share_in_band(seconds, seconds, draws),
    "states at 20 Hz, readings at 20 Hz": share_in_band(twentieths, twentieths, draws),
    "states at 1 Hz, readings at 20 Hz": share_in_band(seconds, twentieths, draws),
    "states at 1 Hz, readings 0.49 s later": share_in_band(seconds, seconds[:-1] + 0.49, draws),
}
print("right readings in the band of three standard deviations, in %")
for name, share in shares.items():
    print(f"{name:44s}{100 * share:6.1f}")
together, fast, slow, between = shares.values()
sound = together > 0.98 and fast > 0.99 and abs(slow - 0.61) < 0.02 and between < 0.1
raise SystemExit(0 if sound and earlier_first() else "this has changed")
PYTHON
