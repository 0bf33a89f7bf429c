"""Each fault of a student's code in a line: its file and line, the step, what is wrong."""

import re
from dataclasses import replace

import pytest
from files import CLASS, FUNCTIONS

from ekfsim.errors import EkfsimError, UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.files.scenes.settings import filters_in
from ekfsim.localization import play
from ekfsim.student.fault import FaultError

TOUR = load_scene("tour")
MOVE, SENSE = "step 2 (move 2.6 m, 0°)", "step 6 (sense -86°)"
PREDICTED = "    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)\n"
REVISED = "    return x + K @ sensor.residual(z, sensor.h(x)), (np.eye(len(x)) - K @ H) @ P\n"
assert PREDICTED in FUNCTIONS
assert REVISED in FUNCTIONS


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fault(place, code, name="mine.py"):
    """What a run under this code fails with."""
    (place / "mine.py").write_text(code)
    with pytest.raises(EkfsimError) as raised:
        list(play(replace(TOUR, filter=filters_in(name)[0])))
    return raised.value


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("    pass", "3: {step}: predict returns nothing; write `return x, P`"),
        ("    return x", "5: {step}: predict returns one array of shape (3,); write `return x, P`"),
        ("    return None, P", "5: {step}: x is None, not an array of numbers"),
        ("    return x, P, F", "5: {step}: predict returns 3 values; write `return x, P`"),
        ("    return P, x", "5: {step}: P comes first and x second; write `return x, P`"),
        (
            "    return x[:, None], P",
            "5: {step}: x has the shape (3, 1), not (3,), a column vector; write x.ravel()",
        ),
        (
            "    return [x], P",
            "5: {step}: x has the shape (1, 3), not (3,), a row vector; write x.ravel()",
        ),
        ("    return x[:2], P", "5: {step}: x has the shape (2,), not (3,)"),
        ("    return x, np.diag(P)", "5: {step}: P has the shape (3,), not (3, 3)"),
        ("    return x * np.nan, P", "5: {step}: x[0] is nan"),
        ("    P[1, 2] = -np.inf\n    return x, P", "6: {step}: P[1, 2] is -inf"),
        ("    return list('abc'), P", "5: {step}: x holds text where numbers should be"),
        (
            "    return x * 1j, P",
            "5: {step}: x holds complex numbers; write x.real where they should be",
        ),
        (
            "    return np.ma.array(x, mask=[0, 0, 1]), P",
            "5: {step}: x holds masked values; it is to hold numbers",
        ),
        (
            "    return [x[0], x[1], x[2:]], P",
            "5: {step}: x is no array of numbers: x[0] has the shape (), x[2] the shape (1,)",
        ),
        (
            "    return [x[0], x[1], motion], P",
            "5: {step}: x holds a HandedMotion where a number should be",
        ),
        (
            "    return x, P + [[0, 0.5, 0], [0] * 3, [0] * 3]",
            "5: {step}: P is not symmetric: P[0, 1] is 0.5 and P[1, 0] is 0",
        ),
        ("    return x, P - np.eye(3)", "5: {step}: P[0, 0] is -1: no variance is negative"),
        (
            "    return x, P + np.eye(3) + 2 * np.eye(3)[::-1]",
            "5: {step}: P has the negative eigenvalue -1: it is no covariance",
        ),
        (
            "    return x + [0, 0, 90], P",
            "5: {step}: x[2] goes from 0 to 90 in one step: headings are in radians; "
            "this looks like degrees",
        ),
        ("    return x + 1 / 0, P", "5: {step}: ZeroDivisionError: division by zero"),
        (
            "    return motion.F, motion.J",
            "5: {step}: motion has no 'J'; it has F, G, M, Q, angle_ratio, distance_ratio, f",
        ),
        (
            "    return x, motion.distance_rato",
            "5: {step}: motion has no 'distance_rato'; did you mean 'distance_ratio'?",
        ),
        (
            "    return motion.f(x[:, None], u), P",
            "5: {step}: motion was given x of shape (3, 1), not (3,)",
        ),
        (
            "    return motion.f(x, 'u'), P",
            "5: {step}: motion was given u that is no array of numbers",
        ),
        ("    raise MemoryError", "5: {step}: MemoryError"),
        ("    raise BaseException('told\\nin two')", "5: {step}: BaseException: told in two"),
        ("    import sys; sys.exit(0)", "5: {step}: it calls exit(0); a filter returns"),
        ("    input()", "5: {step}: EOFError: EOF when reading a line"),
        (
            "    if len(u):\n        return x\n    return x, P",
            "3: {step}: predict returns one array of shape (3,); write `return x, P`",
        ),
    ],
)
def test_a_wrong_prediction_is_told_at_its_line(place, line, told):
    error = fault(place, FUNCTIONS.replace(PREDICTED, f"{line}\n"))
    assert (type(error), error.status) == (FaultError, 1)
    assert str(error) == f"mine.py:{told.format(step=MOVE)}"


def test_endless_recursion_is_told(place):
    again = FUNCTIONS.replace(PREDICTED, "    return predict(x, P, u, motion)\n")
    told = re.escape(f"{MOVE}: RecursionError: maximum recursion depth exceeded")
    assert re.match(f"mine.py:[45]: {told}", str(fault(place, again)))


def test_a_wrong_revision_is_told_at_its_line(place):
    error = fault(place, FUNCTIONS.replace(REVISED, "    return x, sensor.range_ratoi\n"))
    assert str(error) == (
        f"mine.py:11: {SENSE}: sensor has no 'range_ratoi'; did you mean 'range_ratio'?"
    )


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("self.x = motion.f(self.x, u)", "self.x = None", "7: {}: x is None, not an array of"),
        ("self.x, self.P = x, P", "self.state = x", "8: {}: AttributeError: 'Mine' object has no"),
        ("self.x, self.P = x, P", "raise ValueError('no')", "5: {}: ValueError: no"),
        ("self.x = motion.f(self.x, u)", "del self.x", "7: {}: Mine has no attribute 'x' after"),
        ("self.x = motion.f(self.x, u)", "self.mu = self.x; del self.x",
         "7: {}: Mine has no attribute 'x' after the call; it has P, mu, and a belief is x and P"),
        ("self.x = motion.f(self.x, u)", "return motion.f(self.x, u), self.P",
         "9: {}: predict returns what it does not keep; write `self.x, self.P = …` in it"),
    ],
)  # fmt: skip
def test_a_class_is_told_at_its_line(place, old, new, told):
    assert str(fault(place, CLASS.replace(old, new, 1))).startswith(f"mine.py:{told.format(MOVE)}")


WHOLE = """\
import ekfsim
from ekfsim.filters.belief import Correction, Gaussian, Prediction

class Mine(ekfsim.EKF):
    def predict(self, belief, motion, u):
        (x, P), told = super().predict(belief, motion, u)
        return Gaussian(x, P), told
"""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("return x, P",
         "predict returns no belief and Prediction; write `return Gaussian(x, P), "
         "Prediction(F, G)`"),
        ("return x, told", "ndarray is no belief; write Gaussian(x, P)"),
        ("return Gaussian(x[:2], P), told",
         "x and P have the shapes (2,) and (3, 3), not (3,) and (3, 3)"),
        ("return Gaussian(x, -P), told", "P[0, 0] is -0.0187059: no variance is negative"),
        ("return Gaussian(x, P), Prediction(told.F, told.F)",
         "Prediction.G has the shape (3, 3), not (3, 2)"),
        ("return Gaussian(x, P), Prediction(None, told.G)",
         "Prediction.F has the shape (), not (3, 3)"),
        ("raise ValueError(u.shape)", "ValueError: (2,)"),
    ],
)  # fmt: skip
def test_a_class_of_the_full_protocol_is_told_at_its_line(place, line, told):
    wrong = WHOLE.replace("return Gaussian(x, P), told", line)
    assert str(fault(place, wrong)) == f"mine.py:7: {MOVE}: {told}"


def test_a_helper_of_the_students_own_is_told_as_theirs(place):
    (place / "helper.py").write_text("def half(S):\n    return S / 'two'\n")
    error = fault(
        place, FUNCTIONS.replace("import numpy as np", "import numpy as np, helper").replace(
            "    K = ", "    helper.half(S)\n    K = "
        )
    )  # fmt: skip
    assert str(error).startswith(f"helper.py:2: {SENSE}: ")


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("def predict(x, P, u, motion):\n    retrun x, P\n", "mine.py:2: this is not Python: inv"),
        ("import numpyy\n", "mine.py:1: ModuleNotFoundError: No module named 'numpyy'"),
        ("\nimport sys\nsys.exit(0)\n", "mine.py:3: it calls exit(0); a filter returns"),
        ("x = 1\ny = x.y\n", "mine.py:2: AttributeError: 'int' object has no attribute 'y'"),
        ("x = '\udcff'", "mine.py:1: this is not Python: "),
    ],
)
def test_code_that_fails_as_it_is_loaded(place, code, told):
    (place / "mine.py").write_bytes(code.encode(errors="surrogateescape"))
    with pytest.raises(FaultError) as raised:
        filters_in("mine.py")
    assert str(raised.value).startswith(told)
    assert raised.value.status == 1


RIGHT = (
    "write predict(x, P, u, motion) and update(x, P, z, sensor), "
    "or a class with predict(u, motion) and update(z, sensor)"
)
TWO = CLASS + CLASS.replace("class Mine", "class Other")


@pytest.mark.parametrize(
    ("code", "name", "told"),
    [
        (None, "mine.py", "mine.py: there is no such file"),
        ("", "min.py", "min.py: there is no such file; did you mean 'mine.py'?"),
        ("", "mine", "--filter mine: there is no such filter; did you mean 'mine.py'?"),
        ("", ".", "--filter .: is a folder; name a file in it: FILE.py"),
        (
            "",
            "mine.py",
            "mine.py: has no predict(x, P, u, motion) and no update(x, P, z, sensor); " + RIGHT,
        ),
        (
            "def predict(x, P, u, motion):\n    return x, P\n",
            "mine.py",
            f"mine.py: has no update(x, P, z, sensor); {RIGHT}",
        ),
        (
            FUNCTIONS.replace("def update", "def kf_update"),
            "mine.py",
            f"mine.py: has no update(x, P, z, sensor); it has kf_update; {RIGHT}",
        ),
        (
            FUNCTIONS.replace("(x, P, z, sensor)", "(z, sensor, x, P)"),
            "mine.py",
            "mine.py:7: update takes z, sensor, x, P, but is given x, P, z, sensor; "
            "write them in this order",
        ),
        (
            FUNCTIONS.replace("(x, P, z, sensor)", "(x, P, z)"),
            "mine.py",
            "mine.py:7: update(x, P, z) does not take what it is given; "
            "write update(x, P, z, sensor)",
        ),
        (
            CLASS.replace("(self, z, sensor)", "(self, z)"),
            "mine.py",
            "mine.py:12: update(self, z) does not take what it is given; "
            "write update(self, z, sensor)",
        ),
        (
            CLASS.replace("(self, x, P)", "(self)"),
            "mine.py",
            "mine.py:4: Mine() is not begun with x and P; write __init__(self, x, P)",
        ),
        (TWO, "mine.py",
         "mine.py: holds 2 filters; name one of them: mine.py:Mine or mine.py:Other"),
        (TWO, "mine.py:Min", "mine.py:Min: there is no 'Min' in it; it has Mine, Other"),
        ("A = 1\n", "mine.py:A", f"mine.py:A: is no class; {RIGHT}"),
        ("class A:\n    pass\n", "mine.py:A",
         f"mine.py:A: the class has no predict and no update; {RIGHT}"),
        (
            "",
            "no_such_module:X",
            "no_such_module:X: there is no such module; it must be installed; "
            "a file is named FILE.py or FILE.py:Name",
        ),
    ],
)  # fmt: skip
def test_what_is_no_filter_is_wrong_usage(place, code, name, told):
    if code is not None:
        (place / "mine.py").write_text(code)
    with pytest.raises(UsageError) as raised:
        filters_in(name)
    assert (str(raised.value), raised.value.status) == (told, 2)
