"""Students' files for the grader, and who calls them in this process."""

from pathlib import Path

from ekfsim.student.asked import one_by_one
from ekfsim.student.own.calls import InProcess
from ekfsim.student.own.derivatives import derivative
from ekfsim.student.own.loading import load

RIGHT = """\
import numpy as np


def F(x, u, motion):
    return [[1, 0, -u[0] * np.sin(x[2])], [0, 1, u[0] * np.cos(x[2])], [0, 0, 1]]


def G(x, u, motion):
    return [[np.cos(x[2]), 0], [np.sin(x[2]), 0], [0, 1]]


def H(x, sensor):
    row = []
    for step in 1e-6 * np.eye(3):
        row.append((sensor.h(x + step)[0] - sensor.h(x - step)[0]) / 2e-6)
    return [row]


def predict(x, P, u, motion):
    J_x, J_u = np.array(F(x, u, motion)), np.array(G(x, u, motion))
    return motion.f(x, u), J_x @ P @ J_x.T + J_u @ motion.M(u) @ J_u.T


def update(x, P, z, sensor):
    J = sensor.H(x)
    K = P @ J.T @ np.linalg.inv(J @ P @ J.T + sensor.R(x))
    return x + K @ (z - sensor.h(x)), (np.eye(3) - K @ J) @ P
"""
AFTER = RIGHT.replace("F(x, u, motion)), np", "F(motion.f(x, u), u, motion)), np")  # J_x, as eq. 6
SIGN = RIGHT.replace("-u[0] * np.sin", "u[0] * np.sin")  # of J_x
MINUS = RIGHT.replace("z - sensor.h(x)", "sensor.h(x) - z")  # the innovation
FAILS = RIGHT.replace("    J = sensor", "    1 / 0\n    J = sensor")
CAUTIOUS = RIGHT.replace("sensor.R(x)", "40 * sensor.R(x)")


class Pupil:
    """The code of a file, called here."""

    together = staticmethod(one_by_one)

    def __init__(self, path, provided=None):
        self.code, self.provided = load(str(path)), provided
        self.own = self.new_caller()
        self.begin, self.call, self.place_of = self.own.begin, self.own.call, self.own.place_of

    def new_caller(self):
        return InProcess(self.code, self.provided)

    def derivative(self, name, x, given):
        return derivative(self.code, name, x, given, self.provided)


def pupil(folder, text, provided=None):
    path = Path(folder) / "mine.py"
    path.write_text(text)
    return Pupil(path, provided)
