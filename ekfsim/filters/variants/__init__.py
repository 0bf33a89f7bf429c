"""Filters beside those of every textbook, and counter-examples.

nominal.py        the Kalman filter, linear about a trajectory that is planned
ukf_augmented.py  the unscented one, with noise in its sigma points
listing.py        the EKF that the listings of documents 000 and 003 are
by_reading.py     a counter-example: C_v from what the laser read
shadows.py        a counter-example: P without σ_xθ and σ_yθ
"""
