"""Logs of driven robots, as they come and as they hardly ever do."""

from dataclasses import replace

import numpy as np
from numerics import covariance
from twin_inputs import axes_of, inputs

from ekfsim.commands import Move
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Entry, Reading

INPUTS = 18  # of each log


# the covariances of a stretch are sums, with an error near its end that is one of its beginning
@inputs("ekfsim.localization:localize", within=1e-9)
def logs(random, runs):
    axes = axes_of(runs)
    x = random.uniform(-5, 5, (*axes, 3)) * [1, 1, 0] + [0, 0, np.pi]
    belief = Gaussian(x, 1e-3 * covariance(random, *axes, 3))
    wheels, gyro = TwoWheels(0.5, 0.002), GyroWheels(0.5, 0.002, 1e-6 * np.eye(3), 0.01)
    beside = MoveTurn(0.01, 0.02)
    fix = Reading(Position(0.5, 0.4), x[..., :2] + 0.1)
    for motion, u in ((wheels, [0.02, 0.03]), (gyro, [0.02, 0.03, 0.5, 0.01])):
        U = random.normal(u, 0.01, (INPUTS, *axes, len(u)))
        given = [Control(motion, u) for u in U]
        truths = np.broadcast_to(x, (INPUTS, *x.shape)) + 0.05 * random.normal(size=3)
        log = tuple(
            Entry(k + 1, one, truth, t=0.01 * k)
            for k, (one, truth) in enumerate(zip(given, truths, strict=True))
        )
        between = (Entry(0, None, x, t=0.0), *log[:12], Entry(13, fix, x, t=0.2), *log[12:])
        yield between, EKF(0.9), belief
        if runs is not None and runs > 1:  # what follows is the same for all
            continue
        yield log, EKF(), belief
        yield between, EKF(), Gaussian(x, np.zeros_like(belief.covariance))
        yield [replace(entry, truth=None) for entry in log], EKF(), belief
        yield [replace(entry, command=Move(0.1, 0.1)) for entry in log], EKF(), belief
        yield (*log, Entry(INPUTS + 1, Control(beside, U[0, ..., :2]), x)), EKF(), belief
        yield log, IEKF(), belief
        yield log[:0], EKF(), belief
