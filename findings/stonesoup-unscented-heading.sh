#!/usr/bin/env bash
# Guess:     an unscented prediction of a state whose heading is a Bearing, by a linear model that moves nothing and adds
#            no noise, leaves mean and covariance as they were, as the Kalman predictor does.
# Behaviour: it does so in the middle of the circle only. The sigma points are Bearings, folded into a turn; the linear
#            model's matrix product makes plain numbers of them, and those are averaged as they are. Near the seam a
#            heading of 178 degrees known to 5 becomes -62 degrees known to 430; at the seam, 180, even one that is
#            known to 1. And at 0, where no point is folded until they lie half a turn away, a heading that is told to
#            be unknown (sigma 330 degrees) is known to 86 after a second of standing still.
# Version:   stonesoup 1.9.1 (PyPI), UnscentedKalmanPredictor, LinearGaussianTimeInvariantTransitionModel, Bearing
# Source:    run below; stonesoup/functions: gauss2sigma, unscented_transform, sigma2gauss
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q stonesoup==1.9.1 numpy==2.4.6 2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import datetime

import numpy as np
from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
from stonesoup.predictor.kalman import KalmanPredictor, UnscentedKalmanPredictor
from stonesoup.types.angle import Bearing
from stonesoup.types.array import CovarianceMatrix, StateVector
from stonesoup.types.state import GaussianState

NOON, SECOND = datetime.datetime(2026, 1, 1, 12), datetime.timedelta(seconds=1)
STILL = LinearGaussianTimeInvariantTransitionModel(transition_matrix=np.eye(3), covariance_matrix=np.zeros((3, 3)))


def after(predictor, heading, sigma):
    """Heading and its standard deviation, in degrees, after a second of standing still."""
    P = CovarianceMatrix(np.diag([0.01, 0.01, np.radians(sigma) ** 2]))
    before = GaussianState(StateVector([0.0, 0.0, Bearing(np.radians(heading))]), P, timestamp=NOON)
    told = predictor.predict(before, timestamp=NOON + SECOND)
    return np.degrees(float(told.state_vector[2])), np.degrees(np.sqrt(float(told.covar[2, 2])))


print("standing still, degrees      Kalman          unscented")
seen = {}
for heading, sigma in ((0, 5), (150, 5), (178, 5), (180, 1), (0, 180), (0, 330)):
    linear, unscented = (after(predictor(STILL), heading, sigma) for predictor in (KalmanPredictor, UnscentedKalmanPredictor))
    seen[heading, sigma] = unscented
    print(f"{heading:5d} ± {sigma:<5d} {linear[0]:16.1f} ± {linear[1]:<6.1f} {unscented[0]:9.1f} ± {unscented[1]:<6.1f}")
    if abs(abs(linear[0]) - heading) > 1e-6 or abs(linear[1] - sigma) > 1e-6:
        raise SystemExit("the Kalman predictor has changed")
sound = all(np.allclose(seen[case], case) for case in ((0, 5), (150, 5), (0, 180)))
wild = all(seen[case][1] > 400 for case in ((178, 5), (180, 1))) and seen[0, 330][1] < 90
raise SystemExit(0 if sound and wild else "this has changed")
PYTHON
