"""Cures for what the EKF does not expect; the first line of each says what it assumes in return.

huber.py      a reading that lies far off pulls no harder than one that lies k σ off
pdaf.py       a reading is of what was expected, or of clutter: both, as probable as each is
adaptive.py   what surprises is the sensor's noise, which is learnt: a warning example
invariant.py  errors turn with the robot: the left-invariant EKF on SE(2)
amcl.py       who cannot explain a reading was carried away, and may be anywhere: particles
"""
