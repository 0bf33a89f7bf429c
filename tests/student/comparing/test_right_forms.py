"""Right equations, however they are written, differ nowhere."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from around import CLASS

from ekfsim import load_scene
from ekfsim.cli.program.asked import scene_of
from ekfsim.files.packaged import packaged
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import filter_of
from ekfsim.models.layout import POSE
from ekfsim.records import Reading
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.comparing.compare import compared
from ekfsim.student.comparing.difference import DIFFERENT
from ekfsim.student.comparing.sides import caller_of, runs_of
from ekfsim.student.fault import FaultError

PREDICT = """
import numpy as np
from numpy.linalg import cholesky, inv, solve

def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T + motion.Q(u)

def update(x, P, z, sensor):
    H, R, I = sensor.H(x), sensor.R(x), np.eye(len(x))
    v = sensor.residual(z, sensor.h(x))
    S = H @ P @ H.T + R
    K = P @ H.T @ inv(S)
"""
FORMS = {
    "short": "    return x + K @ v, (I - K @ H) @ P",
    "Joseph": "    return x + K @ v, (I - K @ H) @ P @ (I - K @ H).T + K @ R @ K.T",
    "by S": "    return x + K @ v, P - K @ S @ K.T",
    "Cholesky solve": """
    L = cholesky(S)
    K = solve(L.T, solve(L, H @ P)).T
    return x + K @ v, P - K @ H @ P""",
    "information": """
    P = inv(inv(P) + H.T @ inv(R) @ H)
    return x + P @ H.T @ inv(R) @ v, P""",
    "information vector": """
    Y = inv(P) + H.T @ inv(R) @ H
    return inv(Y) @ (inv(P) @ x + H.T @ inv(R) @ (v + H @ x)), inv(Y)""",
    "information without P's inverse": """
    P = solve(I + P @ H.T @ inv(R) @ H, P)
    return x + P @ H.T @ inv(R) @ v, P""",
    "one after another": """
    if (R != np.diag(np.diag(R))).any():
        return x + K @ v, (I - K @ H) @ P
    new = x
    for h, r, w in zip(H, np.diag(R), v):
        k = P @ h / (h @ P @ h + r)
        new, P = new + k * (w - h @ (new - x)), P - np.outer(k, h @ P)
    return new, P""",
    "lists": "    return list(x + K @ v), ((I - K @ H) @ P).tolist()",
    "column by column": """
    x, v = x.reshape(-1, 1), v.reshape(-1, 1)
    return (x + K @ v)[:, 0], (I - K @ H) @ P""",
    "unwrapped": "    return x + K @ v, (I - K @ H) @ P",
}
UNWRAPPED = """
_predict, _update = predict, update

def turned(x, P, by):
    x = np.array(x)
    x[HEADINGS] += by
    return x, P

def predict(*given):
    return turned(*_predict(*given), 4 * np.pi)

def update(*given):
    return turned(*_update(*given), -2 * np.pi)
"""
STEPS = 35  # of each scene; the first are those with the most singular beliefs
SCENES = {
    name: scene
    for name in packaged("commands")
    if not name.endswith(("log", "bag"))
    for scene in [replace(load_scene(name), filter="ekf", beside=())]
}


def steps_of(scene, place):
    for _, steps in runs_of(
        replace(scene, filter=place), caller_of(replace(scene, filter=place)), "ekf"
    ):
        yield from islice(steps, STEPS)


@pytest.mark.parametrize("form", [*FORMS, "class"])
def test_right_equations_differ_nowhere_in_all_that_comes_along(form, tmp_path):
    steps, faults = 0, []
    for scene in SCENES.values():
        code = PREDICT + FORMS.get(form, FORMS["short"])
        if form == "unwrapped":
            headings = list(scene.world.layout.headings)
            code += UNWRAPPED.replace("HEADINGS", str(headings))
        place = tmp_path / "mine.py"
        place.write_text(code + (CLASS if form == "class" else ""))
        told = f"{place}:Mine" if form == "class" else str(place)
        try:
            for step in steps_of(scene, told):
                assert step.differences == (), (scene.commands_source, step.asked.step)
                steps += step.asked.index > 0
        except FaultError as fault:
            faults.append(fault.wrong)
    of_inverse = form in ("information", "information vector")  # P has none at some first steps
    assert set(faults) == ({"LinAlgError: Singular matrix"} if of_inverse else set())
    assert steps > (400 if of_inverse else 900)


@pytest.mark.parametrize("form", ["short", "Joseph", "by S", "one after another"])
@pytest.mark.parametrize("sharp", ["0", "1e-7"])
@pytest.mark.parametrize("sigma", ["0", "10"])
def test_nor_where_readings_leave_nothing_but_rounding(form, sharp, sigma, tmp_path):
    place = tmp_path / "mine.py"
    place.write_text(PREDICT + FORMS[form])
    settings = (
        f"noise.rangeSigmaRatio={sharp}",
        f"belief.sigma.x={sigma}",
        f"belief.sigma.y={sigma}",
    )
    scene = scene_of("tour", settings=settings)
    steps = list(steps_of(scene, str(place)))
    assert len(steps) > 15
    assert not any(step.differences for step in steps)


def nearly_singular():
    """A reading of a robot far from the origin, whose x and y are nearly one number."""
    scene = replace(load_scene("tour"), filter="ekf")
    reading = next(e.given for e in simulate(scene) if isinstance(e.given, Reading))
    c = 1 - 1e-9
    P = 0.01 * np.array([[1, c, 0], [c, 1, 0], [0, 0, 1]])
    asked = Asked(np.array([6.5, 1.4, 1.66]), P, reading, index=1)
    right, made = filter_of(scene).update(Gaussian(asked.x, P), reading.sensor, reading.z)
    return asked, right, made


def by_information(asked, P):
    sensor, z = asked.given.sensor, asked.given.z
    H, R = sensor.H(asked.x), sensor.R(asked.x)
    Y = np.linalg.inv(P)
    new = np.linalg.inv(Y + H.T @ H / R)
    return Answer(new @ (Y @ asked.x + H.T @ (z - sensor.h(asked.x) + H @ asked.x) / R[0, 0]), new)


def test_what_an_inverse_of_a_nearly_singular_covariance_loses_is_no_mistake():
    asked, right, made = nearly_singular()
    found = compared(asked, by_information(asked, asked.P), right, made, POSE)
    assert found.size > DIFFERENT
    assert found.differences == ()
    wrong = compared(asked, by_information(asked, 1.01 * asked.P), right, made, POSE)
    assert {"P_xx", "P_θθ"} <= {one.entry for one in wrong.differences}
