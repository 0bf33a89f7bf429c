"""`ekfsim diff`: the first wrong number of a filter of one's own."""

import re
from pathlib import Path

import pytest
from program import ekfsim, lay_out

from ekfsim.version import VERSION

RIGHT = """\
import numpy as np

def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T

def update(x, P, z, sensor):
    H = sensor.H(x)
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + sensor.R(x))
    return x + K @ (z - sensor.h(x)), (np.eye(3) - K @ H) @ P
"""
WRONG = RIGHT.replace("motion.F(x, u)", "motion.F(motion.f(x, u), u)").replace("x + K", "x - K")
CLASS = """\
import numpy as np

class Mine:
    def __init__(self, x, P):
        self.x, self.P = x, np.eye(3)

    def predict(self, u, motion):
        F, G = motion.F(self.x, u), motion.G(self.x, u)
        self.P = F @ self.P @ F.T + G @ motion.M(u) @ G.T
        self.x = motion.f(self.x, u)

    def update(self, z, sensor):
        H = sensor.H(self.x)
        K = self.P @ H.T / (H @ self.P @ H.T + sensor.R(self.x))
        self.x = self.x + K @ (z - sensor.h(self.x))
        self.P = self.P - K @ H @ self.P
"""
MADE = f"""
ekfsim {VERSION}, world world.yaml, commands short.yaml, filter mine.py, guard warn,
seed 0, run 0, runs 1, against ekf
"""


TOLD = """\
mine.py differs from ekf at 2 of 2 steps (1 move, 1 reading) of 1 run.

First at step 1 (move 1 m, 90°). Each step begins with what mine.py believed
before it; here, in m and rad:
  x = [0, 0, 0]
  P = [[0.01, 0, 0],
       [0, 0.01, 0],
       [0, 0, 0.00761544]]
  u = [0.964064, 1.41701]
            mine.py         ekf  difference
  P_xx    0.0192354   0.0123235     0.56 σ²
  P_xy  -0.00107138           0    0.074 σ²
  P_xθ  -0.00725513           0     0.58 σ²
  P_yy    0.0101661   0.0170779      0.4 σ²
  P_yθ   0.00112459  0.00734177     0.42 σ²

Guess: your P is the one with J_x taken after the move. Read again: eq 6: J_x is
taken at the estimate before the move.

J_x-after-move shows at step 1 (move 1 m, 90°).

innovation-sign shows at step 2 (sense 0°): your x is the one with the other
sign of the innovation, h − z, or of all of J_H. Read again: eqs 9, 10: r = z −
h, and x + K r.
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def diff(*more, code=RIGHT, commands="short.yaml"):
    Path("mine.py").write_text(code, encoding="utf-8")
    return ekfsim("diff", commands, "--filter", "mine.py", *more)


def test_equal_filters_are_told_with_the_evidence_and_status_0():
    ended = diff()
    assert (ended.status, ended.err) == (0, "")
    size = re.search(r"is ([\de.-]+) σ", ended.out)[1]
    assert float(size) < 1e-9
    assert ended.out == (
        "mine.py equals ekf at all 2 steps (1 move, 1 reading) of 1 run. The largest\n"
        f"difference is {size} σ; one of 1e-06 σ would be told.\n{MADE}"
    )


def test_a_wrong_filter_is_told_whole_with_status_1():
    ended = diff(code=WRONG)
    assert (ended.status, ended.err) == (1, "")
    assert ended.out == TOLD + MADE


@pytest.mark.parametrize("commands", ["tour", "pylon"])
def test_every_line_fits_into_a_mail(commands):
    """A state of seven entries, too."""
    code = WRONG.replace("np.eye(3)", "np.eye(len(x))").replace("M(u) @ G.T", "M(u) @ G.T * 1.1")
    ended = diff(code=code, commands=commands)
    assert (ended.status, ended.err) == (1, "")
    assert 70 < max(map(len, ended.out.splitlines())) <= 80
    assert "\x1b" not in ended.out


def test_what_a_class_begins_with_is_seen_at_the_start():
    ended = diff(code=CLASS)
    assert ended.status == 1
    assert ended.out.startswith("""\
mine.py differs from ekf at 1 of 2 steps (1 move, 1 reading) of 1 run.

First at the start: it begins with another belief than it is given.
        mine.py       given  difference
  P_xx        1        0.01       99 σ²
  P_yy        1        0.01       99 σ²
  P_θθ        1  0.00761544  1.3e+02 σ²

Guess: your run begins with a P of its own, not with the one that it is given.
Read again: eq 2: at the start P is what is given: 0 where the start is known
exactly.
Take x and P as they are given to the class: the run begins with them.

own-first-P shows at the start.
""")


def test_code_that_fails_ends_it_behind_what_was_found():
    ended = diff(code=RIGHT.replace("H = sensor.H(x)", "H = sensor.J(x)"))
    assert ended.status == 1
    assert ended.out.startswith("""\
Before its code fails, mine.py equals ekf at 1 step (1 move, 0 readings) of 1
run. The largest difference is 0 σ; one of 1e-06 σ would be told. No reading was
compared.
""")
    assert ended.err == (
        "mine.py:8: step 2 (sense 0°): sensor has no 'J'; "
        "it has H, R, bearing, circles, h, range_ratio, residual, walls\n"
    )


def test_a_wrong_call_is_told_as_it_was_written():
    ended = diff(code=RIGHT.replace("motion.F(x, u)", "motion.F(x)"))
    assert ended.out.startswith("No step was compared: its code fails.\n")
    assert ended.err == (
        "mine.py:4: step 1 (move 1 m, 90°): TypeError: motion.F() missing 1 required positional "
        "argument: 'u'\n"
    )


def test_what_the_filter_may_not_ask_for_it_is_to_write_itself():
    ended = diff("--provided", "f,h")
    assert (ended.status, ended.err) == (
        1,
        "mine.py:4: step 1 (move 1 m, 90°): motion.F is not provided; write this one yourself\n",
    )


def test_a_belief_that_can_be_none_is_told_as_what_it_is():
    ended = diff(code=RIGHT.replace("(np.eye(3) - K @ H) @ P", "-P"))
    assert ended.status == 1
    assert re.search(
        r"After step 2 \(sense 0°\) no belief is left to go on from: its variance of x is\n"
        r"-0\.0123235, and no variance is negative\.\n",
        ended.out,
    )


@pytest.mark.parametrize(
    ("coarse", "told"),
    [
        ("np.round(x, 3), P", "All numbers of x are rounded to 3 decimals."),
        ("x.astype('f'), P", "All numbers of x are float32: they have 7 digits."),
    ],
)
def test_digits_that_are_missing_are_told(coarse, told):
    code = RIGHT.replace("return x + K", "x, P = x + K") + f"    return {coarse}\n"
    ended = diff(code=code, commands="tour")
    assert ended.status == 1
    assert told in ended.out.replace("\n", " ")


def test_another_file_may_be_the_reference():
    Path("other.py").write_text(WRONG, encoding="utf-8")
    ended = diff("--against", "other.py")
    assert ended.status == 1
    assert ended.out.startswith("mine.py differs from other.py at 2 of 2 steps")
    assert "Guess" not in ended.out  # it is right
    assert diff("--against", "other.py", code=WRONG).status == 0


def test_a_filter_of_another_nature_is_no_mistake():
    ended = diff("--against", "ukf")
    assert ended.status == 1
    assert (
        """
These are an EKF's numbers, with the equations of motion and sensor as they are
handed out; ukf is another filter here. Nothing is guessed.
"""
        in ended.out
    )
    assert "Guess" not in ended.out


def test_nor_one_beside_a_reference_that_is_set_otherwise():
    ended = diff("--set", "filter.rangeVariance=reading", commands="tour")
    assert ended.status == 1
    assert "handed out; ekf is another filter here. Nothing is guessed.\n" in ended.out


def test_a_log_is_compared_too(folder):
    assert ekfsim("record", "short.yaml", "-o", "log").status == 0
    Path("log.yaml").write_text(
        "world: log/world.yaml\nrecording: {format: classroom, path: log}\n", encoding="utf-8"
    )
    ended = diff(code=WRONG, commands="log.yaml")
    assert ended.status == 1
    assert "Guess: your P is the one with J_x taken after the move." in ended.out


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (
            (),
            "ekfsim: diff: there is nothing to compare; "
            "name one of --filter, --csv and --narrative\n",
        ),
        (
            ("--filter", "min.py"),
            "ekfsim: min.py: there is no such file; did you mean 'mine.py'?\n",
        ),
        (
            ("--filter", "mine.py", "--against", "pf"),
            "ekfsim: --against pf: does not go on from a mean and a covariance alone; "
            "known: kf, ekf, iekf, ukf, ukf-augmented, huber, pdaf, invariant, or one of your own: "
            "FILE.py\n",
        ),
        (
            ("--filter", "mine.py", "--provided", "f,k"),
            "ekfsim: --provided f,k: there is no equation 'k'; "
            "known: f, F, G, M, Q, h, H, R, residual\n",
        ),
        (
            ("--filter", "mine.py", "--runs", "0"),
            "Error: Invalid value for '--runs': 0 is not in the range 1<=x<=1000000000.\n",
        ),
    ],
)
def test_wrong_usage_is_told_with_status_2(options, told):
    Path("mine.py").write_text(RIGHT, encoding="utf-8")
    ended = ekfsim("diff", "short.yaml", *options)
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.endswith(told)


def test_nothing_to_compare_is_no_agreement():
    Path("still.yaml").write_text("world: world.yaml\ncommands: [say: Hm.]\n", encoding="utf-8")
    ended = diff(commands="still.yaml")
    assert (ended.status, ended.out, ended.err) == (
        2, "", "ekfsim: still.yaml: has no move and no reading to be compared\n"
    )  # fmt: skip


def test_the_example_of_the_docs_is_what_is_said():
    page = (Path(__file__).parents[2] / "docs/course/own-filter.md").read_text(encoding="utf-8")
    code = page.partition("```python\n")[2].partition("```")[0]
    told = page.partition("<!-- diff -->\n```\n")[2].partition("```")[0]
    assert "Guess: " in told
    wrong = code.replace("motion.F(x, u)", "motion.F(motion.f(x, u), u)")
    assert wrong != code
    ended = diff(code=wrong, commands="tour")
    assert (ended.status, ended.err) == (1, "")
    assert ended.out.startswith(f"{told}\nekfsim {VERSION}, world ")
    assert diff(code=code, commands="tour").status == 0
