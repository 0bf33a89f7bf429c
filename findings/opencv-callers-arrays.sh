#!/usr/bin/env bash
# Guess:     who sets a filter's statePost keeps his own array as it was, and who reads the belief after each step and
#            keeps it has one belief a step.
# Behaviour: OpenCV works in the arrays that were handed to it, and hands out the same array each time: after three
#            steps the caller's start, which he keeps for comparison, and each of the three beliefs that he has kept,
#            from what correct returns or from statePost, are the last belief. Drawn as a track, it is one point.
# Version:   opencv-python-headless 5.0.0.93 (PyPI)
# Source:    run below
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q opencv-python-headless==5.0.0.93 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import cv2
import numpy as np

filter = cv2.KalmanFilter(1, 1, 0, cv2.CV_64F)
filter.transitionMatrix, filter.processNoiseCov = np.eye(1), np.eye(1)
filter.measurementMatrix, filter.measurementNoiseCov = np.eye(1), np.eye(1)
start, variance = np.zeros((1, 1)), np.eye(1)
filter.statePost, filter.errorCovPost = start, variance
printed, returned, read = [], [], []
for reading in (6.0, 2.0, 4.0):
    filter.predict()
    returned.append(filter.correct(np.array([[reading]])))
    read.append(filter.statePost)
    printed.append(filter.statePost.item())
last = printed[-1]
kept = [[belief.item() for belief in beliefs] for beliefs in (returned, read)]
print("means as they were printed at each step: ", *(f"{mean:.3f}" for mean in printed))
print("kept from correct, looked at afterwards: ", *(f"{mean:.3f}" for mean in kept[0]))
print("kept from statePost, looked at afterwards:", *(f"{mean:.3f}" for mean in kept[1]))
print(f"the caller's own start was 0 with variance 1, is {start.item():.3f} with variance {variance.item():.3f}")
moved = len(set(printed)) == 3
same = kept == [[last] * 3] * 2 and start.item() == last and variance.item() == filter.errorCovPost.item() != 1.0
raise SystemExit(0 if moved and same else "this has changed")
PYTHON
