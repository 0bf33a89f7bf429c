"""Logs of driven robots, as they come and as they hardly ever do; how they are driven and
summed up.
"""

from dataclasses import replace

import numpy as np
from numerics import covariance
from twin_inputs import axes_of, inputs

from ekfsim.commands import Move
from ekfsim.diagnostics.summary import Summary
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.cures.huber import Huber
from ekfsim.filters.cures.pdaf import PDAF
from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.localization import localize
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Entry, Reading
from ekfsim.simulation.driven import Happened

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
        yield between, Huber(k=0.5), belief
        yield between, PDAF(clutter=0.4), belief
        yield log[:0], EKF(), belief


@inputs("ekfsim.diagnostics.summary:Summary.following", within=1e-9, filled=True)  # see above
def steps(random, runs):
    if runs is not None:
        return
    outline = np.array([[0, 0], [10, 0], [10, -10], [0, -10.0]])
    for number, (log, filter, belief) in enumerate(logs(random, None)):
        start = Entry(0, None, belief.mean, t=0.0)
        steps = tuple(localize((start, *log), filter, belief))
        yield Summary(expected_path=outline if number % 2 else None), steps
        yield Summary(), steps[1:]
        lost = [
            replace(step, nees=step.nees and replace(step.nees, value=np.array(40.0)))
            if step.entry.index in (3, 4, 15, 17)
            else step
            for step in steps
        ]
        yield Summary(), lost
        uncounted = [
            replace(step, entry=replace(step.entry, judged=step.entry.index % 3 > 0))
            for step in steps
        ]
        yield Summary(), uncounted
        still = [replace(step, entry=replace(step.entry, t=0.0)) for step in steps]
        yield Summary(), still


@inputs("ekfsim.simulation.driver:driven")
def ways(random, runs):
    axes = axes_of(runs)
    asked = random.normal(size=(50, 6)) * [1, 1, 1, 5, 5, 3]
    here = random.uniform(-np.pi, np.pi, (*axes, 5)) * [1, 1, 1, 0.01, 0.01]
    for gains in ((1.0, 1.0, 2.0), (0.0, 0.0, 0.0)):
        yield here, asked, 0.01 * random.normal(size=(50, *axes, 3)), gains, 0.01
        yield here, asked[:0], np.zeros((0, *axes, 3)), gains, 0.01


@inputs("ekfsim.simulation.driven:written")
def happened(random, runs):
    axes, n = axes_of(runs), 6
    fixes = random.normal(size=(n, *axes, 2))
    readings = [Reading(Position(0.5, 0.4), fix) for fix in fixes]
    told, u, truth = TwoWheels(0.5, 0.002), fixes, random.normal(size=(n, *axes, 3))
    t = np.arange(n) / 7
    for read in ([[]] * n, [readings[:2], [], [], readings[2:3], [], readings[3:]]):
        yield Happened(told, u, truth, t, read, fixes), 12
        yield Happened(told, u, truth, t, read, None), 0
