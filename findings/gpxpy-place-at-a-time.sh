#!/usr/bin/env bash
# Guess:     "approx. location at given time" of a recorded track is one between the two fixes about it, or the nearer
#            of them: errors that have no direction.
# Behaviour: gpxpy's get_location_at hands out the next fix, however far ahead it is, with its own later time. A right
#            estimate that is compared with such a truth lags at each instant: at 10 m/s by 4.5 m on average for fixes
#            of 1 Hz, and by up to 300 m where half a minute of fixes is missing: half a period of delay that nobody
#            has. Before the first and after the last fix it hands out None. Right: interpolate
#            between the points oneself, and not over gaps.
# Version:   gpxpy 1.6.2, numpy 2.4.6 (PyPI)
# Source:    run below; GPXTrackSegment.get_location_at takes the first point whose time is not before the one asked for
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q gpxpy==1.6.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import datetime

import gpxpy.gpx
import numpy as np

BEGIN, SPEED, DEGREE = datetime.datetime(2026, 1, 1), 10.0, 111_195.0


def instant(seconds):
    return BEGIN + datetime.timedelta(seconds=seconds)


def ahead(fixes_at, asked):
    """How far (m) the place handed out is ahead of a robot that drives north at 10 m/s; nan where there is none."""
    points = [gpxpy.gpx.GPXTrackPoint(SPEED * t / DEGREE, 8.4, time=instant(t)) for t in fixes_at]
    segment = gpxpy.gpx.GPXTrackSegment(points)
    found = [segment.get_location_at(instant(t)) for t in asked]
    return np.array([place.latitude * DEGREE - SPEED * t if place else np.nan for place, t in zip(found, asked)])


TENTHS = [tenth / 10 for tenth in range(600)]
EACH_SECOND = list(range(61))
WITH_GAP = [second for second in EACH_SECOND if not 20 < second < 50]
CASES = {
    "fixes of 1 Hz": (EACH_SECOND, 4.5, 9.0),
    "fixes of 0.2 Hz": (EACH_SECOND[::5], 24.5, 49.0),
    "1 Hz, a gap of 30 s": (WITH_GAP, 77.0, 299.0),
}
agrees = []
print("asked for every 0.1 s         ahead (m): mean     least      most")
for name, (fixes_at, mean, most) in CASES.items():
    metres = np.round(ahead(fixes_at, TENTHS), 3) + 0.0
    print(f"{name:24s}{metres.mean():21.1f}{metres.min():10.1f}{metres.max():10.1f}")
    agrees.append(np.allclose([metres.mean(), metres.min(), metres.max()], [mean, 0.0, most], atol=0.1))
agrees.append(np.isnan(ahead(EACH_SECOND, [-0.1, 60.1])).all())
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
