"""Our own narrative with one number after the other printed as students print it."""

import math
import re

import numpy as np
import pytest

from ekfsim.errors import InputError
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.student.printed.held import held_narrative
from ekfsim.views.playback.playback import views
from ekfsim.views.words.narrative.narrating import narrate

K = math.sqrt(-2 * math.log(1 - 0.954))


@pytest.fixture(scope="module")
def scene():
    return load_scene("tour")


@pytest.fixture(scope="module")
def text(scene):
    return "".join(narrate(view, scene) for view in views(play(scene)))


@pytest.fixture(scope="module")
def posteriors(scene):
    """P after each step that is narrated, the start first, as often as its ellipse is told."""
    told = (view for view in views(play(scene)) if not view.beam)
    return [view.belief.covariance for view in told
            if view.step.entry.given is not None or view.number == 0]  # fmt: skip


def found_in(scene, tmp_path, text):
    (tmp_path / "told.txt").write_text(text)
    return held_narrative(scene, tmp_path / "told.txt", "ekf")


def replaced(text, pattern, made):
    """The text with each number of a pattern in turn as `made` makes it. made : n, number → text"""
    count = iter(range(10**6))
    return re.sub(
        pattern, lambda m: f"{m[1]}{made(next(count), float(m[2]))}", text, flags=re.MULTILINE
    )


NUMBER = r"([-+]?[\d.]+(?:e[-+]?\d+)?)"


def test_what_is_right_is_right(scene, text, tmp_path):
    found = found_in(scene, tmp_path, text)
    assert (found.wrong, found.remarks, found.steps) == ((), (), 23)
    assert found.checked > 600


@pytest.mark.parametrize("k", [2.48, 2.4816, 2.486])
def test_the_factor_of_the_ellipse_may_be_rounded(scene, text, tmp_path, k):
    rounded = replaced(
        text, rf"((?:minor|major) radius is ){NUMBER}", lambda n, v: f"{v * k / 2.48156:.6g}"
    )
    assert found_in(scene, tmp_path, rounded).wrong == ()


def test_two_decimals_raise_no_false_alarm(scene, text, tmp_path):
    def rounded(match):
        return re.sub(NUMBER, lambda number: f"{float(number[0]):.2f}", match[0])

    coarse = re.sub(r"^\[.*|radius is .*", rounded, text, flags=re.MULTILINE)
    assert "[[0.00 0.00 0.00]" in coarse
    assert found_in(scene, tmp_path, coarse).wrong == ()


def test_decimals_may_have_commas(scene, text, tmp_path):
    found = found_in(scene, tmp_path, re.sub(r"(?<=\d)\.(?=\d)", ",", text))
    assert (found.wrong, found.checked) == ((), found_in(scene, tmp_path, text).checked)


def test_what_cannot_be_read_is_told(scene, text, tmp_path):
    between = text.replace(
        "New state covariance matrix is:", "New state covariance matrix is:\nP", 3
    )
    line = between[: between.index("==>The robot moved")].count("\n") + 1
    told = f"{tmp_path / 'told.txt'}:{line}: no covariance can be read of 3 steps, this the first"
    assert told in found_in(scene, tmp_path, between).remarks
    with pytest.raises(InputError, match="no number in it follows"):
        found_in(scene, tmp_path, "==>The robot moved: far\n" * 3)


def radii(P, k, inverse=False, size=2):
    block = P[:size, :size]
    values = np.sort(np.linalg.eigvalsh(np.linalg.inv(block) if inverse else block))
    return k * np.sqrt(np.maximum(values, 0))[-2:]


@pytest.mark.parametrize(
    ("made", "guess"),
    [
        (lambda P: radii(P, 2.0), "this is the ellipse of 2 sigma, which holds 86.5 %"),
        (lambda P: radii(P, K, inverse=True), "this is the ellipse of the inverse of P"),
        (lambda P: radii(P, K, size=3), "these are eigenvalues of the whole P"),
        (lambda P: K * radii(P, 1.0) ** 2, "this is k times the eigenvalue, not its root"),
        (lambda P: radii(P, K)[::-1], "the other radius stands here"),
    ],
    ids=["2 sigma", "inverse", "3x3", "no root", "exchanged"],
)
def test_a_wrong_ellipse_is_named(scene, text, posteriors, tmp_path, made, guess):
    """In the last step alone, whose P has full rank."""
    minor, major = made(posteriors[-1])
    head, mark, tail = text.rpartition("Uncertainty ellipse is:")
    tail = replaced(tail, rf"(minor radius is ){NUMBER}", lambda n, value: f"{minor:.6g}")
    tail = replaced(tail, rf"(major radius is ){NUMBER}", lambda n, value: f"{major:.6g}")
    found = found_in(scene, tmp_path, head + mark + tail)
    assert [one.what for one in found.wrong] == ["the minor radius", "the major radius"]
    assert all(one.guess.startswith(guess) for one in found.wrong)
    right = radii(posteriors[-1], K)
    assert [one.right for one in found.wrong] == pytest.approx(right.tolist(), rel=1e-4)


@pytest.mark.parametrize(
    ("pattern", "made", "what", "guess"),
    [
        (r"(orientation is )", lambda v: (v + 90) % 180, "the orientation",
         "this is the direction of the minor axis"),
        (r"(orientation is )", math.radians, "the orientation", "it is in radians"),
        (r"(2\*sigma_theta is )", math.radians, "2*sigma_theta", "it is in radians"),
        (r"(2\*sigma_theta is )", lambda v: v / 2, "2*sigma_theta", "this is 1 sigma"),
        (r"(dh/dy = )", lambda v: -v, "dh/dy", "its sign is wrong"),
        (r"(dh/dth = )", lambda v: -v, "dh/dth", "its sign is wrong"),
        (r"(dh/dth = )", math.radians, "dh/dth", "it is per degree, and P is in radians"),
        (r"(The innovation is )", lambda v: -v, "the innovation", "its sign is wrong"),
    ],
)  # fmt: skip
def test_a_wrong_number_is_named_at_its_line(scene, text, tmp_path, pattern, made, what, guess):
    """In the last place where it stands, of a step whose P has full rank."""
    places = [found for found in re.finditer(pattern + NUMBER, text) if abs(float(found[2])) > 1e-3]
    last = places[-1]
    wrong = f"{text[: last.start(2)]}{made(float(last[2])):.6g}{text[last.end(2) :]}"
    found = found_in(scene, tmp_path, wrong)
    line = text[: last.start()].count("\n") + 1
    assert [(one.line, one.what) for one in found.wrong] == [(line, what)]
    assert found.wrong[0].guess.startswith(guess)
    assert found.wrong[0].right == pytest.approx(float(last[2]), rel=2e-4)


def test_the_command_in_place_of_the_odometry_is_named(scene, text, tmp_path):
    commands = re.findall(r"==>The robot moved: distance=(\S+), angle=(\S+)", text)
    wrong = replaced(text, rf"(odometry measured: distance=){NUMBER}", lambda n, v: commands[n][0])
    found = found_in(scene, tmp_path, wrong)
    assert len(found.wrong) >= len(commands)
    first = found.wrong[0]
    assert first.what == "the distance of the odometry"
    assert first.guess == "the command stands here in place of what the odometry measured"


def test_wrapped_and_unwrapped_headings_are_one(scene, text, tmp_path):
    wrong = replaced(
        text,
        rf"((?:New state|Revised state|Current state).*, ){NUMBER}(?=\))",
        lambda n, v: f"{v + 360 if v < 0 else v:.4f}",
    )
    assert wrong != text
    assert found_in(scene, tmp_path, wrong).wrong == ()


def test_a_variance_that_grows_and_a_matrix_that_is_not_symmetric_are_told(scene, text, tmp_path):
    """Of another run, where nothing but the print can be held against itself."""
    other = text.replace("moved: distance=2.6,", "moved: distance=2.7,")
    assert found_in(scene, tmp_path, other).wrong == ()
    rows = re.compile(r"(Revised covariance matrix is:\n\[\[)(\S+) (\S+) (\S+)\]\n\[(\S+)")
    last = list(rows.finditer(other))[-1]
    grown = f"{other[: last.start(2)]}0.9{other[last.end(2) :]}"
    found = found_in(scene, tmp_path, grown)
    assert found.remarks[0].endswith(
        "this narrative is of another run: only what hangs together in it is checked"
    )
    first = found.wrong[0]
    assert (first.what, first.bound) == ("P_xx", "at most")
    assert first.guess == "a reading never makes a variance larger than it was"
    askew = f"{other[: last.start(5)]}0.0001234{other[last.end(5) :]}"
    assert ("P_yx", 0.0001234) in [
        (one.what, one.theirs) for one in found_in(scene, tmp_path, askew).wrong
    ]


def test_a_turn_before_the_move_is_named_in_any_run(scene, text, tmp_path):
    """The odometry is printed, the world is not known."""
    told = """\
==>The robot moved: distance=2, angle=90
The odometry measured: distance=2.01, angle=88
Current state estimate is (x, y, th) = (1.00000, 2.00000, 60.0000)
New state estimate is (x, y, theta) = ({:.5f}, {:.5f}, 148.000)
"""
    θ = math.radians(148)
    wrong = told.format(1 + 2.01 * math.cos(θ), 2 + 2.01 * math.sin(θ))
    found = found_in(scene, tmp_path, wrong)
    assert {one.guess for one in found.wrong} == {"the robot turns before it moves"}
    assert [one.what for one in found.wrong] == ["x of the new state", "y of the new state"]
    θ = math.radians(60)
    assert found_in(
        scene, tmp_path, told.format(1 + 2.01 * math.cos(θ), 2 + 2.01 * math.sin(θ))
    ).wrong == ()  # fmt: skip


def test_no_number_is_told(scene, text, tmp_path):
    wrong = replaced(text, rf"(The innovation is ){NUMBER}", lambda n, v: "nan" if n == 3 else v)
    found = found_in(scene, tmp_path, wrong)
    assert [one.what for one in found.wrong if math.isnan(one.right)] == ["the innovation"]
