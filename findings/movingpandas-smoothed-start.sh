#!/usr/bin/env bash
# Guess:     a Kalman smoother leaves a track alone that is already what it assumes: exact fixes, a straight line, a
#            constant velocity. It is at most as far off as the noise that it was told of.
# Behaviour: movingpandas' KalmanSmootherCV takes the speed at the first fix to be 0, and to be known exactly. A robot
#            that drives already, at 10 m/s, is put 7.7 m off its own exact fix at the start, with the stds as they
#            come (0.5 and 1), and 36 m off, 9 m after 12 s, where the fixes are told to be worse and the driving
#            smoother (0.1 and 3). A log that begins at a standstill is left alone. Right: Stone Soup's filter and
#            smoother by oneself, from a speed that is told to be vague; or cut the smoothed track, not the log.
# Version:   movingpandas 0.23.0, stonesoup 1.9.1, geopandas 1.2.0 (PyPI)
# Source:    run below; the initiator's prior state is 0 with a covariance of 0, of which the fix replaces the place
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q movingpandas==0.23.0 stonesoup==1.9.1 geopandas==1.2.0 pandas==3.1.1 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import datetime

import geopandas
import movingpandas
import numpy as np
import pandas as pd
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.transition.linear import CombinedLinearGaussianTransitionModel, ConstantVelocity
from stonesoup.predictor.kalman import KalmanPredictor
from stonesoup.smoother.kalman import KalmanSmoother
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.types.track import Track
from stonesoup.updater.kalman import KalmanUpdater

SECONDS, BEGIN = np.arange(30), datetime.datetime(2026, 1, 1)
INSTANTS = pd.date_range(BEGIN, periods=30, freq="s")


def by_movingpandas(x, process, reading):
    places = geopandas.points_from_xy(x, 0 * x, crs="EPSG:25832")
    track = movingpandas.Trajectory(geopandas.GeoDataFrame(geometry=places, index=INSTANTS), 1)
    return movingpandas.KalmanSmootherCV(track).smooth(process, reading).df.geometry.x.to_numpy()


def by_stonesoup(x, process, reading):
    """The same models, but a speed at the first fix that is known to 100 m/s."""
    moves = CombinedLinearGaussianTransitionModel([ConstantVelocity(process**2)] * 2)
    reads = LinearGaussian(4, [0, 2], reading**2 * np.eye(2))
    predictor, updater = KalmanPredictor(moves), KalmanUpdater(reads)
    vague = np.diag([reading**2, 1e4, reading**2, 1e4])
    track = Track([GaussianState([x[0], 0, 0, 0], vague, timestamp=BEGIN)])
    for place, second in zip(x[1:], SECONDS[1:]):
        instant = BEGIN + datetime.timedelta(seconds=int(second))
        predicted = predictor.predict(track.state, timestamp=instant)
        track.append(updater.update(SingleHypothesis(predicted, Detection([place, 0.0], timestamp=instant))))
    return np.array([float(state.state_vector[0]) for state in KalmanSmoother(moves).smooth(track)])


agrees = []
print("m off the exact fixes after                     0 s      1 s      5 s     12 s     29 s")
for speed in (0.0, 10.0):
    for process, reading in ((0.5, 1.0), (0.1, 3.0)):
        x = speed * SECONDS
        off, vague = by_movingpandas(x, process, reading) - x, by_stonesoup(x, process, reading) - x
        for name, errors in (("movingpandas", off), ("Stone Soup, vague", vague)):
            line = "".join(f"{errors[second]:9.2f}" for second in (0, 1, 5, 12, 29))
            print(f"{speed:3.0f} m/s, stds {process}, {reading:.0f}, {name:18s}{line}")
        first = {0.5: 7.66, 0.1: 36.23}[process] * speed / 10.0
        agrees.append(abs(off[0] - first) < 0.1 and np.max(np.abs(vague)) < 0.1 * reading)
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
