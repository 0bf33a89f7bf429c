"""Files that a student could hand in, each broken in its own way, and what is told of each."""

import re
from typing import NamedTuple

RIGHT = """\
import numpy as np


def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)


def update(x, P, z, sensor):
    H = sensor.H(x)
    S = H @ P @ H.T + sensor.R(x)
    K = P @ H.T @ np.linalg.inv(S)
    return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(len(x)) - K @ H) @ P
"""


def doing(line: str) -> str:
    """The right file, whose predict does something first."""
    head = "def predict(x, P, u, motion):\n"
    return "import os, signal, sys, time\n" + RIGHT.replace(head, f"{head}    {line}\n")


LINE = RIGHT.count("\n", 0, RIGHT.index("F, G")) + 2  # where `doing` does it


class Broken(NamedTuple):
    """A file, and what is told of it: a pattern for the whole line."""

    text: str
    told: str


HERE = rf"mine\.py:{LINE}: "
BROKEN = {
    "endless loop": Broken(doing("while True: pass"), HERE + r"took longer than 1 s"),
    "memory": Broken(
        doing("rubbish = [np.empty(10**7) for _ in range(10**4)]"), HERE + r"MemoryError.*"
    ),
    "status 0": Broken(doing("sys.exit(0)"), HERE + r"SystemExit: 0"),
    "status 0 at once": Broken(
        doing("os._exit(0)"), r"mine\.py: ended its process with status 0 instead of answering"
    ),
}


def whole(pattern: str) -> re.Pattern[str]:
    """The whole of one line."""
    return re.compile(pattern + r"\Z")
