"""Whatever is asked of it: a status, no traceback, a verdict, and numbers that hang together."""

import json
import math
import re
from tempfile import TemporaryDirectory

import numpy as np
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from program import SHORT, WORLD, ekfsim

few = settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
# \r and \x85 break lines in YAML
CONTROLS = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f]")


def numbers(low, high):
    return st.floats(low, high, allow_nan=False, allow_subnormal=False).map(lambda x: round(x, 6))


angles = st.one_of(st.sampled_from([0.0, 90.0, -90.0, 180.0, -180.0]), numbers(-720, 720))
ratios = st.one_of(st.sampled_from([0.0, 0.05]), numbers(0, 2))
moves = st.fixed_dictionaries(
    {"distance": st.one_of(st.just(0.0), numbers(-20, 20)), "angle": angles},
    optional={"slip": numbers(0, 1)},
)
singles = st.one_of(
    st.builds(lambda move: {"move": move}, moves),
    st.builds(lambda angle: {"sense": {"angle": angle}}, angles),
    st.builds(lambda angle: {"sense": {"angle": angle}}, angles),
    st.builds(
        lambda x, y, theta: {"kidnap": {"x": x, "y": y, "theta": theta}},
        numbers(-4, 4),
        numbers(-4, 4),
        angles,
    ),
    st.builds(lambda text: {"say": text}, st.text(max_size=20)),
)
commands = st.recursive(
    singles,
    lambda inner: st.builds(
        lambda times, held: {"repeat": {"times": times, "commands": held}},
        st.integers(0, 3), st.lists(inner, min_size=1, max_size=3),
    ),
    max_leaves=4,
)  # fmt: skip


@st.composite
def polygons(draw, x, y):
    """A star about (x, y), whose corners come in the order of their angles: it crosses itself
    nowhere."""
    corners = draw(st.integers(3, 7))
    radii = draw(st.lists(numbers(0.2, 1.2), min_size=corners, max_size=corners))
    return [
        [
            round(x + r * math.cos(2 * math.pi * k / corners), 6),
            round(y + r * math.sin(2 * math.pi * k / corners), 6),
        ]
        for k, r in enumerate(radii)
    ]


@st.composite
def worlds(draw):
    places = draw(
        st.lists(
            st.sampled_from([(2, 2), (-2, 2), (2, -2), (-2, -2), (4, 0)]), max_size=4, unique=True
        )
    )
    names = ("executionDst", "executionAng", "odometryDst", "odometryAng", "range")
    world = {
        "name": "lab",
        "obstacles": [
            {"name": f"o{n}", "points": draw(polygons(*at))} for n, at in enumerate(places)
        ],
        "start": {
            "x": draw(numbers(-0.5, 0.5)),
            "y": draw(numbers(-0.5, 0.5)),
            "theta": draw(angles),
        },
        "noise": {f"{name}SigmaRatio": draw(ratios) for name in names},
    }
    if draw(st.booleans()):
        world["boundary"] = [[-5, -5], [5, -5], [5, 5], [-5, 5]]
    if draw(st.booleans()):
        world["start"]["sigma"] = {
            "x": draw(ratios),
            "y": draw(ratios),
            "theta": draw(numbers(0, 40)),
        }
    if places and draw(st.booleans()):
        world["belief"] = {"missing": ["o0"], "noise": {"odometryDstSigmaRatio": draw(ratios)}}
    if draw(st.booleans()):
        world["faults"] = {"rangeBias": draw(numbers(-1, 1)), "shortReturns": draw(numbers(0, 1))}
    return world


@st.composite
def scenes(draw):
    scene = {
        "world": "w.yaml",
        "seed": draw(st.integers(0, 2**32 - 1)),
        "commands": draw(st.lists(commands, max_size=6)),
    }
    if draw(st.booleans()):
        scene |= {
            "gate": draw(numbers(0.01, 0.99)),
            "guard": draw(st.sampled_from(["off", "warn", "skip"])),
        }
    return scene


def files(folder, world, scene):
    """The two files, and the path of the second."""
    for name, content in (("w.yaml", world), ("c.yaml", scene)):
        with open(f"{folder}/{name}", "wb") as file:
            file.write(content)
    return f"{folder}/c.yaml"


def no_json(name):
    raise AssertionError(f"{name} is no JSON")


def covariances(line):
    for part in (line, line.get("prior"), line.get("posterior")):
        if part and "covariance" in part:
            yield np.array(part["covariance"])


def run(folder, path):
    """How a run ended, and its trace."""
    trace = f"{folder}/t.jsonl"
    ended = ekfsim("run", path, "--trace", trace, "--force")
    with open(trace, encoding="utf-8") as file:
        return ended, file.read()


@few
@given(worlds(), scenes())
def test_a_sound_scene_runs_to_its_verdict_with_numbers_that_hang_together(world, scene):
    with TemporaryDirectory() as folder:
        path = files(folder, json.dumps(world).encode(), json.dumps(scene).encode())
        checked = ekfsim("check", path)
        if checked.status == 2:  # a text that no file may hold
            assert ekfsim("run", path).status == 2
            return
        ended, trace = run(folder, path)
        assert ended.status == 0
        assert sum(line.startswith("Verdict: ") for line in ended.out.split("\n")) == 1
        assert not CONTROLS.search(ended.out)
        for text in trace.splitlines():
            line = json.loads(text, parse_constant=no_json)
            for P in covariances(line):
                np.testing.assert_array_equal(P, P.T)
                assert np.linalg.eigvalsh(P).min() >= -1e-9 * max(np.abs(P).max(), 1e-12)
        assert run(folder, path) == (ended, trace)


@few
@given(st.binary(max_size=200), st.binary(max_size=200))
@example(b"\xef\xbb\xbf", b"commands: &a [*a]")
def test_bytes_are_told_not_tripped_over(world, scene):
    with TemporaryDirectory() as folder:
        path = files(folder, world, scene)
        for args in (
            ["check", path],
            ["check", f"{folder}/w.yaml"],
            ["run", path],
            ["run", "tour", "--world", path],
        ):
            assert ekfsim(*args).status == 2


@few
@given(
    st.sampled_from([WORLD, SHORT]), st.integers(0, 300), st.binary(max_size=12), st.integers(0, 12)
)
def test_a_file_with_a_slip_of_the_keyboard_is_told_or_runs(text, at, typed, lost):
    slipped = text.encode()[:at] + typed + text.encode()[at + lost :]
    with TemporaryDirectory() as folder:
        files(folder, WORLD.encode(), SHORT.replace("world.yaml", "w.yaml").encode())
        path = f"{folder}/slip.yaml"
        with open(path, "wb") as file:
            file.write(slipped.replace(b"world.yaml", b"w.yaml"))
        checked = ekfsim("check", path)
        assert checked.status in (0, 2)
        assert (checked.status == 2) == (": ok\n" not in checked.out)
        assert ekfsim("run", path).status in (0, 2)
        assert ekfsim("run", f"{folder}/c.yaml", "--world", path).status in (0, 2)
        assert not CONTROLS.search(checked.out + checked.err)


@few
@given(st.lists(st.one_of(st.sampled_from(["run", "check", "--gate", "--world", "-q", "tour"]),
    st.text(
    st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=6)),
    max_size=5))  # fmt: skip
def test_no_line_of_arguments_trips_it(args):
    if "new" in args or any(arg.startswith(("--tr", "--cs", "--su", "--tu")) for arg in args):
        return  # they write
    ended = ekfsim(*args)
    assert ended.status in (0, 2)
    assert ended.status == 0 or ended.err or ended.out
