"""How long it takes to grade a class, and how much memory: python benchmarks/grade.py [SUBMISSIONS]

Each submission is another file: right ones in several forms, ones with one or two mistakes, some
that fail. Three scenes of 20 runs each, every step held against the reference. Of 20 submissions
the time for 200 is told, too.
"""

import os
import subprocess
import sys
import tempfile
import time
from itertools import cycle, islice
from pathlib import Path

HERE = Path(__file__).parent.parent
HOMEWORK = """\
homework: a class
total: 60
parts:
  - {name: Each step, points: 60, steps: {scenes: [tour, square, theta], runs: 20}}
"""
RIGHT = """\
import numpy as np


def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T


def update(x, P, z, sensor):
    H = sensor.H(x)
    S = H @ P @ H.T + sensor.R(x)
    K = P @ H.T @ np.linalg.inv(S)
    return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(3) - K @ H) @ P
"""
STATEFUL = """\
import numpy as np


class Mine:
    def __init__(self, x, P):
        self.x, self.P = x, P

    def predict(self, u, motion):
        F, G = motion.F(self.x, u), motion.G(self.x, u)
        self.x, self.P = motion.f(self.x, u), F @ self.P @ F.T + G @ motion.M(u) @ G.T

    def update(self, z, sensor):
        H, R = sensor.H(self.x), sensor.R(self.x)
        K = self.P @ H.T / (H @ self.P @ H.T + R)
        self.x = self.x + K @ (z - sensor.h(self.x))
        I_KH = np.eye(3) - K @ H
        self.P = I_KH @ self.P @ I_KH.T + K @ R @ K.T
"""
MISTAKES = (
    ("sensor.residual(z, sensor.h(x))", "(sensor.h(x) - z)"),
    ("F, G = motion.F(x, u)", "F, G = motion.F(motion.f(x, u), u)"),
    ("motion.G(x, u)\n", "motion.G(motion.f(x, u), u)\n"),
    ("motion.M(u)", "np.sqrt(motion.M(u))"),
    ("G @ motion.M(u) @ G.T", "0 * P"),
    ("sensor.R(x)", "np.sqrt(sensor.R(x))"),
    ("(np.eye(3) - K @ H) @ P", "P"),
    ("(np.eye(3) - K @ H) @ P", "P - K @ S"),
    ("np.linalg.inv(S)", "S"),
    ("F @ P @ F.T", "F.T @ P @ F"),
    ("F @ P @ F.T +", "P +"),
    ("sensor.R(x)", "0.01 * np.eye(1)"),
    ("return motion.f(x, u),", "return np.array([x[0], x[1], x[2] + u[1]]),"),
)
FAILING = ("1 / 0", "return x, P * np.nan", "import os; os._exit(0)", "return x")


def texts() -> list[str]:
    """The files of a class, each another."""
    wrong = [RIGHT.replace(*one) for one in MISTAKES]
    twice = [RIGHT.replace(*a).replace(*b) for a, b in zip(MISTAKES, MISTAKES[3:], strict=False)]
    failing = [RIGHT.replace("    H = ", f"    {line}\n    H = ", 1) for line in FAILING]
    return [RIGHT, STATEFUL, *wrong, *twice, *failing]


def memory(process: int) -> tuple[float, float]:
    """The most that a process has held, and what it holds now with all below it, in MB."""
    most, held, waiting = 0.0, 0.0, [process]
    while waiting:
        one = waiting.pop()
        try:
            told = Path(f"/proc/{one}/status").read_text().split("\n")
            waiting += map(int, Path(f"/proc/{one}/task/{one}/children").read_text().split())
        except (OSError, ValueError):
            continue
        sizes = {line.partition(":")[0]: line.split()[1:2] for line in told}
        held += int(sizes.get("VmRSS", ["0"])[0]) / 1000
        if one == process:
            most = int(sizes.get("VmHWM", ["0"])[0]) / 1000
    return most, held


def main(submissions: int) -> None:
    """Grade so many, and tell what it took."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / "homework.yaml").write_text(HOMEWORK)
        for n, text in enumerate(islice(cycle(texts()), submissions)):
            (folder / f"student{n:03}.py").write_text(f"# {n}\n{text}")
        names = sorted(path.name for path in folder.glob("*.py"))
        program = "from ekfsim.cli import main; main()"
        asked = [sys.executable, "-c", program, "grade", "homework.yaml", *names, "-o", "grades"]
        began, most, together = time.perf_counter(), 0.0, 0.0
        environment = {**os.environ, "PYTHONPATH": str(HERE)}
        process = subprocess.Popen(asked, cwd=folder, env=environment)
        while process.poll() is None:
            one, all_of_them = memory(process.pid)
            most, together = max(most, one), max(together, all_of_them)
            time.sleep(0.1)
        wall = time.perf_counter() - began
        spent = os.times()
        busy = spent.children_user + spent.children_system
        print(f"{submissions} submissions, 3 scenes of 20 runs each, two workers: {wall:.0f} s on")
        print(f"the wall, {busy:.0f} s of CPU, {busy / submissions:.2f} s for each submission;")
        print(f"so 200 take {busy / submissions * 200 / 2 / 60:.1f} min of two free cores")
        print(f"the process that asks held {most:.0f} MB, all together at most {together:.0f} MB")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
