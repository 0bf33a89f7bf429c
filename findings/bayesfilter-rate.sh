#!/usr/bin/env bash
# Guess:     the rate that a filter is run at says how finely its track is written down: a robot of 1 m/s whose readings
#            are right is found where it is at each of those instants, at 1 Hz as at 20 Hz.
# Behaviour: at 1 Hz it is found up to 1 m from there, and known to 9 mm. bayesfilter's run moves the belief by a period
#            before each entry, the first one too, and takes all readings since the last entry as of the entry's own
#            instant. A start that is known exactly is a period ahead, and stays so until readings say otherwise;
#            readings made 0.1 s after each entry are used 0.9 s late, and the belief lags by that; four readings a
#            period count as four of one instant, 0.375 m behind. Such a lag is the same at each step, so that the NIS
#            is 0 and tells nothing. Right: a period that divides all gaps between readings, and a start of one period
#            before the first.
# Version:   bayesfilter 0.2.0 (PyPI)
# Source:    run below; BayesianFilter.run: a prediction by the period at the first instant, too, then all readings up
#            to it
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q bayesfilter==0.2.0 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import os

import numpy as np
from bayesfilter.distributions import Gaussian
from bayesfilter.filtering import BayesianFilter
from bayesfilter.model import StateTransitionModel
from bayesfilter.observation import Observation

H, Q = np.array([[1.0, 0.0]]), np.diag([1e-4, 1e-4])
WHOLE = np.arange(0.0, 21.0)


def F(seconds):
    return np.array([[1.0, seconds], [0.0, 1.0]])


def at_end(times, rate, start, read_to):
    """Error and standard deviation of the place at 20 s, and the NIS of a single reading in the last period.

    The robot starts at 0 with 1 m/s and is read, exactly, at the times; start: variances of place and speed.
    """
    model = StateTransitionModel(lambda x, seconds: F(seconds) @ x, Q, lambda x, seconds: F(seconds))
    filter = BayesianFilter(model, Gaussian(np.array([0.0, 1.0]), np.diag(start)))
    R = np.array([[read_to**2]])
    readings = [Observation(np.array([time]), R, lambda x: H @ x, lambda x: H) for time in times]
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        beliefs, instants = filter.run(readings, list(times), rate, use_jacobian=True)
    end = int(np.argmin(np.abs(np.array(instants) - 20.0)))
    before = filter.predict(beliefs[end - 1], 1 / rate)
    innovation = max(time for time in times if time <= 20.0) - (H @ before.mean()).item()
    nis = innovation**2 / (H @ before.covariance() @ H.T + R).item()
    return beliefs[end].mean()[0] - instants[end], beliefs[end].covariance()[0, 0] ** 0.5, nis


def after_each_entry(seconds):
    return np.concatenate([[0.0], np.arange(0.0, 20.0) + seconds])


VAGUE, EXACT = (1.0, 0.25), (1e-12, 1e-12)
QUARTERS = np.arange(0.0, 20.1, 0.25)
CASES = {
    "exact start, at 1 Hz": (1.0, at_end(WHOLE, 1.0, EXACT, 1000.0)),
    "exact start, at 20 Hz": (0.05, at_end(WHOLE, 20.0, EXACT, 1000.0)),
    "read at each entry": (0.0, at_end(WHOLE, 1.0, VAGUE, 0.01)),
    "read 0.1 s after each entry": (-0.9, at_end(after_each_entry(0.1), 1.0, VAGUE, 0.01)),
    "read 0.5 s after each entry": (-0.5, at_end(after_each_entry(0.5), 1.0, VAGUE, 0.01)),
    "read 4 times a second, at 1 Hz": (-0.375, at_end(QUARTERS, 1.0, VAGUE, 0.01)),
    "read 4 times a second, at 4 Hz": (0.0, at_end(QUARTERS, 4.0, VAGUE, 0.01)),
}
print("after 20 s with right readings     error (m)     sd (m)")
for name, (expected, (error, sd, nis)) in CASES.items():
    print(f"{name:32s} {error:11.3f} {sd:10.4f}")
late = CASES["read 0.1 s after each entry"][1]
print(f"NIS of the last reading where they come 0.1 s after each entry: {late[2]:.1g}")
right = all(abs(error - expected) < 0.001 for expected, (error, sd, nis) in CASES.values())
raise SystemExit(0 if right and late[1] < 0.01 and late[2] < 0.01 else "this has changed")
PYTHON
