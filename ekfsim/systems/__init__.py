"""The systems of the documents: what each robot measures of its motion, what its instruments read.

SYSTEMS names them. The classroom has no entry: its robot obeys commands one by one (see
`simulation`). "Document 000" and so on, wherever the package cites an equation, are these, and here
is where their equations stand:

    000  mower: Kiriy & Buehler, Three-state Extended Kalman Filter for Mobile Robot Localization
         8, 9 filters/ekf.py · 10 to 12, 27, 28 filters/kalman.py
         16 to 22, 26, 29 models/motions/wheels.py, midpoint.py
         23 to 25, 30 models/sensors/landmarks.py
         its listing: filters/variants/listing.py, models/sensors/frozen.py
    001  pioneer: Tamás, Lazea, Robotin, Marcu, Herle & Szekely, State Estimation Based on Kalman
         Filtering Techniques in Navigation
         7 to 11 filters/kf.py, variants/nominal.py · 12, 13 filters/ekf.py
         14 to 17 filters/arithmetic/unscented.py
         20 to 28 filters/ukf.py, variants/ukf_augmented.py (22)
         18, 19 models/sensors/polar.py · 29 to 35 models/motions/odometry.py
         36, 37 models/sensors/yaw.py, which it does not use itself
         38 models/sensors/echo.py, and its estimate systems/echo.py
         fig. 4 models/sensors/infrared.py · fig. 6 models/sensors/ultrasonic.py
    002  classroom: Localization and the extended Kalman filter, an assignment
         1, 3, 6 models/motions/move_turn.py · 8, and J_H, C_v of 11 models/sensors/laser.py
         2 filters/belief.py · 4, 5, 9 filters/ekf.py · 7, 10 to 12 filters/kalman.py
    003  gnss: Sahni, Assignment 3: Sensor fusion for lawn mower
         2 models/sensors/position.py · 3, 4 and the integrals models/motions/wheel_speeds.py
         5 to 7 filters/ekf.py
         as its authors have coded it: WheelSpeedsAsWritten, filters/variants/listing.py,
         systems/interpolation.py
    004  pylon: King & Johnson, Lab 3: Extended Kalman Filter for Localization
         1 to 4 filters/ekf.py · 5 to 7, and R_t of 10 models/motions/planar_imu.py
         8, 9, and Q_t of 10 models/sensors/offset.py
         the yaw filter of its conclusion models/sensors/lidar.py
         11 geometry/outline.py · 12 figures/track.py

Two more systems read published logs, with models that no document prints: landmarks (MRCLAM) and
ranges (Plaza).
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ekfsim.systems.system import System

if TYPE_CHECKING:
    from ekfsim.systems.instruments import INSTRUMENTS as INSTRUMENTS
    from ekfsim.systems.watched import SYSTEMS as SYSTEMS

# Where the tables stand. They are imported when first asked for: the classroom must not wait for
# the motions and instruments of all others.
_HOMES = {"INSTRUMENTS": "ekfsim.systems.instruments", "SYSTEMS": "ekfsim.systems.watched"}
CLASSROOM = System()


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ekfsim.systems' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def system_of(name: str) -> System:
    """How the system of that name is watched."""
    if name == "classroom":
        return CLASSROOM
    from ekfsim.systems.watched import SYSTEMS

    return SYSTEMS.get(name, CLASSROOM)
