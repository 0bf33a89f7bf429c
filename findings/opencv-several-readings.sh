#!/usr/bin/env bash
# Guess:     a filter of variance 1 that gets readings 6, 2, 4 of variance 1 at one instant has means 3, 8/3, 3 and
#            variances 1/2, 1/3, 1/4 after them; a reading that comes before the first prediction counts, too.
# Behaviour: OpenCV's correct starts from the last prediction each time, not from what the reading before has taught: of
#            several readings of an instant only the last one counts, means 3, 1, 2 and variance 1/2 three times. Before
#            the first predict that prediction is 0 with variance 0, whatever statePost and errorCovPost were set to:
#            the reading counts for nothing, the start is forgotten, and the filter is certain of 0.
# Version:   opencv-python-headless 5.0.0.93 (PyPI)
# Source:    run below; cv2.KalmanFilter.correct reads statePre and errorCovPre, writes statePost and errorCovPost
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q opencv-python-headless==5.0.0.93 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import cv2
import numpy as np

READINGS = (6.0, 2.0, 4.0)


def started(mean):
    """A filter of one number that stands still, known to variance 1 and read to variance 1."""
    filter = cv2.KalmanFilter(1, 1, 0, cv2.CV_64F)
    filter.transitionMatrix, filter.processNoiseCov = np.eye(1), np.zeros((1, 1))
    filter.measurementMatrix, filter.measurementNoiseCov = np.eye(1), np.eye(1)
    filter.statePost, filter.errorCovPost = np.array([[mean]]), np.eye(1)
    return filter


def after(filter, reading):
    filter.correct(np.array([[reading]]))
    return filter.statePost.item(), filter.errorCovPost.item()


filter = started(0.0)
filter.predict()
opencv = [after(filter, reading) for reading in READINGS]
book = [(sum(READINGS[:n]) / (1 + n), 1 / (1 + n)) for n in (1, 2, 3)]
print("mean and variance after readings 6, 2, 4 of one instant")
for name, beliefs in (("by the book", book), ("OpenCV", opencv)):
    print(f"{name:12s}" + "".join(f"{mean:10.3f} {variance:6.3f}" for mean, variance in beliefs))
early = after(started(10.0), 6.0)
print(f"a start of 10 ± 1 that reads 6 before the first predict: {early[0]}, variance {early[1]}")
last = np.allclose(opencv, [(reading / 2, 0.5) for reading in READINGS])
raise SystemExit(0 if last and early == (0.0, 0.0) else "this has changed")
PYTHON
