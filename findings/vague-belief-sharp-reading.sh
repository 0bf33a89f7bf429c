#!/usr/bin/env bash
# Guess:     a Kalman filter that knows nothing (sigma 10 000 km) and reads a place to 8 cm believes it to 8 cm.
# Behaviour: three libraries believe it exactly, with variance 0, and Stone Soup's unscented updater believes anything:
#            P - K S K' or P - K H P is a small difference of two large numbers, and from a ratio of some 1e8 of the
#            two standard deviations on rounding leaves nothing of it. At 1 000 km the result is already off in its
#            second digit. Stone Soup's use_joseph_cov=True and SqrtKalmanUpdater are right; so is filterpy's filter.
# Version:   stonesoup 1.9.1, pykalman 0.11.2, simdkalman 1.0.4, filterpy 1.4.5 (PyPI)
# Source:    run below; KalmanUpdater._posterior_covariance, pykalman's _filter_correct, simdkalman's _update
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q stonesoup==1.9.1 pykalman==0.11.2 simdkalman==1.0.4 filterpy==1.4.5 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import datetime

import filterpy.kalman
import numpy as np
import pykalman
import simdkalman
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.prediction import GaussianStatePrediction, SqrtGaussianStatePrediction
from stonesoup.updater.kalman import KalmanUpdater, SqrtKalmanUpdater, UnscentedKalmanUpdater

NOON, READING, H, R = datetime.datetime(2026, 1, 1, 12), 8.0, np.array([[1.0, 0.0]]), np.array([[0.0064]])


def stonesoup(updater, prediction, spread):
    model = LinearGaussian(2, (0,), R)
    before = prediction(np.zeros((2, 1)), spread, timestamp=NOON)
    reading = Detection(np.array([[READING]]), timestamp=NOON, measurement_model=model)
    return updater(model).update(SingleHypothesis(before, reading)).covar[0, 0]


def joseph(model):
    return KalmanUpdater(model, use_joseph_cov=True)


def filterpys(P):
    filter = filterpy.kalman.KalmanFilter(2, 1)
    filter.x, filter.P, filter.H, filter.R = np.zeros((2, 1)), P, H, R
    filter.update(READING)
    return filter.P[0, 0]


def simdkalmans(P):
    filter = simdkalman.KalmanFilter(np.eye(2), np.zeros((2, 2)), H, R)
    return filter.update(np.zeros((2, 1)), P, np.array([[READING]]))[1][0, 0]


def pykalmans(P):
    filter = pykalman.KalmanFilter(np.eye(2), H, np.zeros((2, 2)), R, initial_state_mean=[0, 0], initial_state_covariance=P)
    return filter.filter(np.array([[READING]]))[1][0][0, 0]


KNOWN = {
    "Stone Soup": lambda P: stonesoup(KalmanUpdater, GaussianStatePrediction, P),
    "Stone Soup, unscented": lambda P: stonesoup(UnscentedKalmanUpdater, GaussianStatePrediction, P),
    "Stone Soup, Joseph": lambda P: stonesoup(joseph, GaussianStatePrediction, P),
    "Stone Soup, root": lambda P: stonesoup(SqrtKalmanUpdater, SqrtGaussianStatePrediction, np.sqrt(P)),
    "pykalman": pykalmans,
    "simdkalman": simdkalmans,
    "filterpy": filterpys,
}
print(f"variance after one reading of variance {R[0, 0]:g}, by sigma before it (m)")
print(f"{'':24s}" + "".join(f"{sigma:>14g}" for sigma in (1e3, 1e6, 1e7, 1e9)))
told = {}
for name, variance in KNOWN.items():
    told[name] = [float(variance(np.diag([sigma**2, 1.0]))) for sigma in (1e3, 1e6, 1e7, 1e9)]
    print(f"{name:24s}" + "".join(f"{each:14.6g}" for each in told[name]))
certain = all(told[name][2] == told[name][3] == 0 for name in ("Stone Soup", "pykalman", "simdkalman"))
wild = told["Stone Soup, unscented"][2] > 0.01
sound = all(abs(each - 0.0064) < 1e-6 for name in ("Stone Soup, Joseph", "filterpy") for each in told[name])
raise SystemExit(0 if certain and wild and sound else "this has changed")
PYTHON
