#!/usr/bin/env bash
# Guess:     readings of a log that lie before the filter's start count for nothing, and its Extended and its Iterated
#            Kalman Filter treat a reading that comes too late alike.
# Behaviour: navlie's run_filter leaves out what lies before the start, except where ALL readings do: then all count,
#            each as of the start. A robot known to be at 10 m, which was read at 0 to 9 m on its way there, is put to
#            4.6 m, known to 3 cm, and drives on from there. With one reading more, after the start, the same ten count
#            for nothing. It shows with the Extended Kalman Filter alone, which refuses readings of more than 1e10 s
#            before the belief, 317 years, and takes others as of now; the iterated one refuses any. Right: cut the log
#            oneself.
# Version:   navlie 0.0.1 (PyPI), filters.py; its __init__ asks for a pylie that its wheel does not name, so goes unused
# Source:    run below; run_filter, "Remove all that are before the current time"; ExtendedKalmanFilter.correct, dt <
#            -1e10
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
{ "$folder/venv/bin/pip" install -q --no-deps navlie==0.0.1 &&
  "$folder/venv/bin/pip" install -q numpy==2.4.6 scipy==1.17.1 tqdm; } \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import importlib.util
import sys
import types

import numpy as np

package = types.ModuleType("navlie")
package.__path__ = list(importlib.util.find_spec("navlie").submodule_search_locations)
sys.modules["navlie"] = package
from navlie.filters import ExtendedKalmanFilter, IteratedKalmanFilter, run_filter  # noqa: E402
from navlie.types import Measurement, MeasurementModel, ProcessModel, StampedValue, State  # noqa: E402

START, DRIVEN, BEFORE = 10.0, 9.0, np.arange(0.0, 10.0)


class Place(State):
    def __init__(self, x, stamp):
        super().__init__(x, 1, stamp)

    def plus(self, dx):
        return Place(self.value + np.ravel(dx), self.stamp)

    def minus(self, other):
        return self.value - other.value

    def copy(self):
        return Place(self.value.copy(), self.stamp)


class Driving(ProcessModel):
    def evaluate(self, x, u, dt):
        return Place(x.value + u.value * dt, x.stamp)

    def jacobian(self, x, u, dt):
        return np.eye(1)

    def covariance(self, x, u, dt):
        return 1e-6 * np.eye(1) * dt


class Reading(MeasurementModel):
    def evaluate(self, x):
        return x.value

    def jacobian(self, x):
        return np.eye(1)

    def covariance(self, x):
        return 0.01 * np.eye(1)


def end(filter, times):
    """Place and its standard deviation at 19 s; the robot is where its clock says, 1 m/s, and its readings are right."""
    speeds = [StampedValue(np.array([1.0]), START + second) for second in range(11)]
    readings = [Measurement(np.array([time]), float(time), Reading()) for time in times]
    start = Place(np.array([START]), START)
    last = run_filter(filter(Driving()), start, 0.04 * np.eye(1), speeds, readings, disable_progress_bar=True)[-1]
    assert last.stamp == START + DRIVEN
    return last.state.value.item(), last.covariance.item() ** 0.5


def refused(filter):
    try:
        end(filter, BEFORE)
    except RuntimeError as error:
        return str(error)
    return ""


LOGS = {"none": [], "ten before the start": BEFORE, "those, and one after it": [*BEFORE, 10.5]}
told = {name: end(ExtendedKalmanFilter, times) for name, times in LOGS.items()}
print("the robot is at 19 m")
for name, (place, sd) in told.items():
    print(f"readings: {name:26s} found at {place:7.3f} m ± {sd:.3f}")
iterated = refused(IteratedKalmanFilter)
print("the iterated filter on the ten:", iterated)
all_count = np.isclose(told["ten before the start"][0], (0.01 * START + 0.04 * BEFORE.sum()) / 0.41 + DRIVEN)
none_counts = all(abs(told[name][0] - 19.0) < 1e-9 for name in ("none", "those, and one after it"))
sure = told["ten before the start"][1] < 0.04
raise SystemExit(0 if all_count and none_counts and sure and "earlier" in iterated else "this has changed")
PYTHON
