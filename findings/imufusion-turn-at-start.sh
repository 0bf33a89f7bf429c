#!/usr/bin/env bash
# Guess:     a robot that turns by 90 degrees on the spot has turned by 90 degrees, whether it begins at the first sample
#            of the log or three seconds into it; without a magnetometer, by the gyroscope, which is exact here.
# Behaviour: imufusion's update_no_magnetometer holds the heading at 0 for its first three seconds, the startup. A turn
#            of two seconds that begins with the log is lost whole, one that begins at 2 s by half, and nothing at the
#            log's end tells of it; a log cut just before a turn ends in another heading than the whole one. Right:
#            three seconds of standstill first; skip_startup(), as here, for a robot that begins upright. With an
#            external heading no turn is lost.
# Version:   imufusion 1.3.3 (PyPI)
# Source:    run below; the flag "startup" is set as long
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q imufusion==1.3.3 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
"$folder/venv/bin/python" - <<'PYTHON'
import imufusion
import numpy as np

PERIOD, UPRIGHT, RATE, TURNING = 0.01, np.array([0.0, 0.0, 1.0]), 45.0, 2.0


def heading_after(begins, skips=False, told=False):
    """Heading (degrees) after a turn of 90 degrees that begins at a time (s), and the seconds of startup before it."""
    ahrs = imufusion.Ahrs()
    ahrs.set_sample_period(PERIOD)
    if skips:
        ahrs.skip_startup()
    true, startup = 0.0, 0.0
    for sample in range(round((begins + TURNING + 4.0) / PERIOD)):
        rate = RATE if begins <= sample * PERIOD < begins + TURNING else 0.0
        true += rate * PERIOD
        gyroscope = np.array([0.0, 0.0, rate])
        if told:
            ahrs.update_external_heading(gyroscope, UPRIGHT, true)
        else:
            ahrs.update_no_magnetometer(gyroscope, UPRIGHT)
        startup += PERIOD * ahrs.get_flags().startup
    return imufusion.quaternion_to_euler(ahrs.get_quaternion())[2], startup


agrees = []
print("a turn of 90 degrees in 2 s begins at     heading after it     startup skipped     heading told")
for begins, kept in ((0.0, 0.0), (1.0, 0.0), (2.0, 45.0), (3.0, 90.0), (4.0, 90.0)):
    heading, startup = heading_after(begins)
    skipped, _ = heading_after(begins, skips=True)
    told, _ = heading_after(begins, told=True)
    print(f"{begins:36.0f} s{heading:20.1f}°{skipped:19.1f}°{told:16.1f}°")
    agrees.append(np.allclose([heading, skipped, told], [kept, 90.0, 90.0], atol=1.0) and abs(startup - 3.0) < 0.05)
print(f"seconds of startup: {startup:.2f}")
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
