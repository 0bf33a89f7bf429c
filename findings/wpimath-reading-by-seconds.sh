#!/usr/bin/env bash
# Guess:     a filter of variance 1 that is told "standard deviations of measurements" of 1 has variance 1/2, 1/3, 1/4
#            after readings of one instant.
# Behaviour: only where a step takes a second. wpimath's KalmanFilter and ExtendedKalmanFilter divide the variance of a
#            reading by the seconds of the last prediction: in the 0.02 s of a robot's loop a reading of 1 weighs as one
#            of 7, the variance is 0.980 after the first and 0.943 after the third; a loop that runs twice as slowly
#            trusts the same sensor twice as much. Right is a standard deviation times the root of the loop's seconds.
# Version:   robotpy-wpimath 2026.2.2 (PyPI)
# Source:    run below; the measurement noise is taken as a continuous one and made discrete, R / dt
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q robotpy-wpimath==2026.2.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from wpimath.estimator import ExtendedKalmanFilter_1_1_1, KalmanFilter_1_1_1
from wpimath.system import LinearSystem_1_1_1

ONE, NOTHING, READINGS = np.eye(1), np.zeros((1, 1)), (6.0, 2.0, 4.0)


def linear(sigma):
    return KalmanFilter_1_1_1(LinearSystem_1_1_1(NOTHING, ONE, ONE, NOTHING), [1.0], [sigma], 0.02)


def extended(sigma):
    return ExtendedKalmanFilter_1_1_1(lambda x, u: u * 0, lambda x, u: x, [1.0], [sigma], 0.02)


def beliefs(filter, seconds):
    """Mean and variance after each reading; the belief before them is 0 with variance 1."""
    filter.predict(np.zeros(1), seconds)
    filter.setXhat(np.zeros(1))
    filter.setP(ONE)
    for reading in READINGS:
        filter.correct(np.zeros(1), np.array([reading]))
        yield np.ravel(filter.xhat()).item(), np.ravel(filter.P()).item()


def weighing(R):
    return [(sum(READINGS[:n]) / (R + n), R / (R + n)) for n in (1, 2, 3)]


print("mean and variance after readings 6, 2, 4 of one instant, told a standard deviation of 1")
agrees = []
for name, filter in (("KalmanFilter", linear), ("ExtendedKalmanFilter", extended)):
    for seconds in (1.0, 0.04, 0.02):
        told = list(beliefs(filter(1.0), seconds))
        agrees.append(np.allclose(told, weighing(1 / seconds)))
        print(f"{name:21s}{seconds:5.2f} s" + "".join(f"{mean:9.3f} {variance:6.3f}" for mean, variance in told))
    agrees.append(np.allclose(list(beliefs(filter(0.02**0.5), 0.02)), weighing(1.0)))
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
