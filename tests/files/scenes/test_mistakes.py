# ruff: noqa: E501 (each message stands whole on its line)
"""Every mistake a person can make in a file, with the whole line that it is told in."""

from pathlib import Path

import pytest

from ekfsim.errors import InputError, UsageError
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import check, load_scene, load_world

NOISE = (
    "noise: {executionDstSigmaRatio: 0.05, executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: "
    "0.02, "
    "odometryAngSigmaRatio: 0.02, rangeSigmaRatio: 0.01}\n"
)
START = "start: {x: 1, y: 1, theta: 90}\n"
HEAD = "name: room\n" + START + NOISE  # lines 1 to 3: the smallest world
SQUARE = "points: [[4, 3], [5, 3], [5, 4], [4, 4]]"
DESK = f"  - {{name: desk, {SQUARE}}}\n"


def lines_of(folder, text, name="f.yaml"):
    """What is told of a file, without the folder it lies in."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as told:
        check(path).get()
    return [line.replace(f"{folder}/", "") for line in str(told.value).splitlines()]


WORLDS = {
    "unknown key": (HEAD + "obstacle: []\n", ["4:1: unknown key 'obstacle'; did you mean "
                                              "'obstacles'?"]),
    "far key": (
        "name: a\n" + NOISE + "start: {x: 1, y: 1, theta: 0, colour: 5}\n",
        ["3:31: start: unknown key 'colour'; known keys here: x, y, theta, sigma"],
    ),
    "no space": (
        "name: a\n" + NOISE + "start: {x:1, y: 1, theta: 0}\n",
        ["3:9: start: unknown key 'x:1'; write a space after the colon: 'x: 1'"],
    ),
    "misspelt required key is told once": (
        "name: a\n" + NOISE + "start: {x: 1, y: 1, teta: 0}\n",
        ["3:21: start: unknown key 'teta'; did you mean 'theta'?"],
    ),
    "repeated key": (HEAD + "name: b\n", ["4:1: the key 'name' is given twice, first on line 1; "
                                          "delete one"]),
    "repeated inner key": (
        "name: a\n" + NOISE + "start: {x: 1, y: 1, x: 2, theta: 0}\n",
        ["3:21: start: the key 'x' is given twice, first on line 3; delete one"],
    ),
    "missing": (
        "description: d\nnoise: {executionDstSigmaRatio: 0.05}\n",
        [
            "1:1: name: the key is missing; write name: classroom",
            "1:1: start: the key is missing; write start: {x: 1.0, y: 1.0, theta: 90}",
            "2:8: noise.executionAngSigmaRatio: the key is missing; write executionAngSigmaRatio: "
            "0.05",
            "2:8: noise.odometryDstSigmaRatio: the key is missing; write odometryDstSigmaRatio: "
            "0.02",
            "2:8: noise.odometryAngSigmaRatio: the key is missing; write odometryAngSigmaRatio: "
            "0.02",
            "2:8: noise.rangeSigmaRatio: the key is missing; write rangeSigmaRatio: 0.01",
        ],
    ),
    "not numbers": (
        "name: a\n" + NOISE + "start: {x: five, y: true, theta: 90°}\n",
        [
            "3:12: start.x: 'five' is text where a number belongs; write e.g. 1.5",
            "3:21: start.y: true is a yes-or-no value where a number belongs; write e.g. 1.5",
            "3:34: start.theta: '90°' is text where a number belongs; write 90",
        ],
    ),
    "nearly numbers": (
        "name: a\n" + NOISE + "start: {x: 1_000, y: '1,5', theta: \"2\"}\n",
        [
            "3:12: start.x: '1_000' is text where a number belongs; write 1000",
            "3:22: start.y: '1,5' is text where a number belongs; write 1.5",
            "3:36: start.theta: '2' is text where a number belongs; write 2",
        ],
    ),
    "a date is text": (
        "name: a\n" + NOISE + "start: {x: 2026-13-45, y: [1], theta: {a: 1}}\n",
        [
            "3:12: start.x: '2026-13-45' is text where a number belongs; write e.g. 1.5",
            "3:27: start.y: a list stands where a number belongs; write e.g. 1.5",
            "3:39: start.theta: a mapping stands where a number belongs; write e.g. 90",
        ],
    ),
    "not finite": (
        "name: a\n" + NOISE + "start: {x: .nan, y: -.inf, theta: 1e400}\n",
        [
            "3:12: start.x: .nan is not a finite number; write e.g. 1.5",
            "3:21: start.y: -.inf is not a finite number; write e.g. 1.5",
            "3:35: start.theta: 1e400 is too large; write e.g. 90",
        ],
    ),
    "5000 digits": (
        "name: a\n" + NOISE + f"start: {{x: {'1' * 5000}, y: 1, theta: -1e7}}\n",
        [
            f"3:12: start.x: {'1' * 37}... is too large; write e.g. 1.5",
            "3:5027: start.theta: -1e7 is too small; write a number of -1 000 000 or more",
        ],
    ),
    "too far": (
        "name: a\n" + NOISE + "start: {x: 100000001, y: 1, theta: 0}\n",
        ["3:12: start.x: 100000001 is too large; write a number of at most 100 000 000"],
    ),
    "negative ratio": (
        "name: a\n" + START + NOISE.replace("rangeSigmaRatio: 0.01", "rangeSigmaRatio: -0.01"),
        ["3:144: noise.rangeSigmaRatio: -0.01 is negative; write a number of 0 or more"],
    ),
    "negative sigma": (
        HEAD + "belief: {sigma: {x: -1, theta: -5}, noise: {rangeSigmaRatio: -1}}\n",
        [
            "4:21: belief.sigma.x: -1 is negative; write a number of 0 or more",
            "4:32: belief.sigma.theta: -5 is negative; write a number of 0 or more",
            "4:62: belief.noise.rangeSigmaRatio: -1 is negative; write a number of 0 or more",
        ],
    ),
    "probability": (
        HEAD + "faults: {shortReturns: 1.5}\n",
        ["4:24: faults.shortReturns: 1.5 is too large; write a number from 0 to 1"],
    ),
    "negative probability": (
        HEAD + "faults: {shortReturns: -0.1}\n",
        ["4:24: faults.shortReturns: -0.1 is negative; write a number from 0 to 1"],
    ),
    "text": (
        HEAD.replace("room", "5") + "description: [a]\n",
        [
            "1:7: name: 5 is a number where text belongs; write it in quotes: '5'",
            "4:14: description: a list stands where text belongs; write e.g. One room, two desks.",
        ],
    ),
    "name of two lines": (
        HEAD.replace("room", '"a\\nb"') + "obstacles:\n  - {name: '', " + SQUARE + "}\n",
        [
            "1:7: name: 'a b' is no name; write one line of text, e.g. classroom",
            "5:12: obstacles[0].name: '' is no name; write one line of text, e.g. desk",
        ],
    ),
    "nothing": (
        HEAD + "description:\nobstacles:\nbelief: ~\n",
        [
            "4:13: description: nothing stands where text belongs; write e.g. One room, two desks.",
            "5:11: obstacles: nothing stands where a list belongs; write e.g. "
            "[{name: desk, points: [[4, 3], [5, 3], [5, 4], [4, 4]]}]",
            "6:9: belief: nothing stands where a mapping 'key: value' belongs; write e.g. "
            "{start: {x: 1.2, y: 1.0, theta: 80}}",
        ],
    ),
    "not indented": (
        HEAD + "belief:\nmissing: [desk]\n",
        [
            "4:8: belief: nothing stands where a mapping 'key: value' belongs; write e.g. "
            "{start: {x: 1.2, y: 1.0, theta: 80}}",
            "5:1: unknown key 'missing'; indent it further than 'belief' to put it under it",
        ],
    ),
    "two points": (
        HEAD + "boundary: [[0, 0], [5, 5]]\n",
        ["4:11: boundary: 2 points make no polygon; write at least three, e.g. [[0, 0], [10, 0], "
         "[10, 8], [0, 8]]"],
    ),
    "one point": (
        HEAD + "obstacles:\n  - {name: a, points: [[1, 1]]}\n",
        ["5:23: obstacles[0].points: 1 point makes no polygon; write at least three, e.g. [[4, "
         "3], [5, 3], [5, 4]]"],
    ),
    "no pairs": (
        HEAD + "boundary: [[0, 0, 0], [5], 5, x, [0, x]]\n",
        [
            "4:12: boundary[0]: 3 values stand where a point [x, y] belongs; write e.g. [4, 3]",
            "4:23: boundary[1]: 1 value stands where a point [x, y] belongs; write e.g. [4, 3]",
            "4:28: boundary[2]: 5 is a number where a point [x, y] belongs; write e.g. [4, 3]",
            "4:31: boundary[3]: 'x' is text where a point [x, y] belongs; write e.g. [4, 3]",
            "4:38: boundary[4][1]: 'x' is text where a number belongs; write e.g. 1.5",
        ],
    ),
    "crossing": (
        HEAD + "boundary: [[0, 0], [10, 8], [10, 0], [0, 8]]\n",
        ["4:11: boundary: the outline crosses or touches itself at [5, 4]; give the corners in "
         "order, around it"],
    ),
    "touching": (
        HEAD + "belief: {boundary: [[0, 0], [4, 0], [2, 2], [4, 4], [0, 4], [2, 2]]}\n",
        ["4:20: belief.boundary: the outline crosses or touches itself at [2, 2]; give the "
         "corners in order, around it; the rim of a hole, or a spike, may stand by itself under 'walls'"],
    ),
    "no area": (
        HEAD + "obstacles:\n  - {name: a, points: [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]}\n",
        ["5:23: obstacles[0].points: the polygon has no area: its points lie on one line; move a "
         "point off that line"],
    ),
    "closed, and nothing in it": (
        HEAD + "boundary: [[0, 0], [9, 0], [0, 0]]\n",
        ["4:11: boundary: the polygon has no area: its points lie on one line; move a point off "
         "that line"],
    ),
    "repeated point": (
        HEAD + "boundary: [[0, 0], [9, 0], [9, 0], [9, 9]]\n",
        ["4:28: boundary[2]: the point [9, 0] repeats the one before it; delete one of them"],
    ),
    "circles that are none": (
        HEAD + "obstacles:\n - {name: b, circle: {x: 1, y: 9, radius: 0}}\n - {name: c, circle: [1, 2, 3]}\n"
        " - {name: d}\n - {name: e, circle: {x: 9, y: 9, radius: 1}, points: [[5, 5], [6, 5], [6, 6]]}\n"
        " - {name: f, cirle: {x: 9, y: 9, radius: 1}}\n - {name: g, circle: {x: 9, y: 9, r: -1}}\n",
        [
            "5:43: obstacles[0].circle.radius: 0 is too small; write more than 0",
            "6:22: obstacles[1].circle: a list stands where a circle belongs; write e.g. {x: 3, y: 2, radius: 0.4}",
            "7:4: obstacles[2].points: the key is missing; write points: [[4, 3], [5, 3], [5, 4]], or circle: {x: 3, y: 2, radius: 0.4}",
            "8:22: obstacles[3].circle: a polygon and a circle stand in one obstacle; delete one of them",
            "9:14: obstacles[4]: unknown key 'cirle'; did you mean 'circle'?",
            "10:22: obstacles[5].circle.radius: the key is missing; write radius: 0.4",
            "10:35: obstacles[5].circle: unknown key 'r'; known keys here: x, y, radius",
        ],
    ),
    "start in a circle, and on its rim": (
        HEAD + "obstacles: [{name: a, circle: {x: 1, y: 2, radius: 1}}, {name: b, circle: {x: 0, y: 1, radius: 3}},"
        " {name: c, circle: {x: 1, y: 2, radius: 0.999}}]\n",
        [
            f"2:8: start: the robot starts at [1, 1], inside the obstacle '{name}' or on its wall; start it where it can move"
            for name in "ab"
        ],
    ),
    "walls that are none": (
        HEAD + "walls:\n - [[7, 0]]\n - [[7, 0], [7, 0]]\n - 7\n - [1, 2]\n - []\n"
        " - {name: panel, point: [[2, 6], [4, 6]]}\n - {name: a, points: [[2, x], [4]]}\n"
        " - {points: [[2, 3], [4, .inf]]}\n",
        [
            "5:4: walls[0]: 1 point makes no wall; write at least two, e.g. [[7, 0], [7, 5]]",
            "6:13: walls[1][1]: the point [7, 0] repeats the one before it; delete one of them",
            "7:4: walls[2]: 7 is a number where a wall belongs; write e.g. [[7, 0], [7, 5]]",
            "8:5: walls[3][0]: 1 is a number where a point [x, y] belongs; write e.g. [4, 3]",
            "8:8: walls[3][1]: 2 is a number where a point [x, y] belongs; write e.g. [4, 3]",
            "9:4: walls[4]: an empty list stands here; write e.g. [[7, 0], [7, 5]]",
            "10:18: walls[5]: unknown key 'point'; did you mean 'points'?",
            "11:27: walls[6].points[0][1]: 'x' is text where a number belongs; write e.g. 1.5",
            "11:31: walls[6].points[1]: 1 value stands where a point [x, y] belongs; write e.g. [4, 3]",
            "12:4: walls[7].name: the key is missing; write name: panel",
            "12:26: walls[7].points[1][1]: .inf is not a finite number; write e.g. 1.5",
        ],
    ),
    "walls of one name": (
        HEAD + "obstacles:\n" + DESK + "walls:\n - {name: desk, points: [[7, 0], [7, 5]]}\n"
        " - [[2, 0], [2, 5]]\n - {name: wall 2, points: [[7, 0], [7, 5]]}\n"
        " - {name: boundary, points: [[7, 0], [7, 5]]}\n",
        [
            "7:11: walls[0].name: 'desk' is already the name of the obstacle on line 5; choose another name",
            "8:4: walls[1]: 'wall 2' is already the name of the wall on line 9; choose another name",
            "10:11: walls[3].name: 'boundary' is the name of the room's own wall; choose another name",
        ],
    ),
    "a wall of the belief": (
        HEAD + "belief: {walls: [[[1, 2]], [[1, 2], [1, 2]]]}\n",
        [
            "4:18: belief.walls[0]: 1 point makes no wall; write at least two, e.g. [[7, 0], [7, 5]]",
            "4:37: belief.walls[1][1]: the point [1, 2] repeats the one before it; delete one of them",
        ],
    ),
    "start on a wall": (
        HEAD + "walls: [[[0, 1], [3, 1], [3, 0]], [[0, 2], [9, 2]]]\n",
        ["2:8: start: the robot starts at [1, 1], on the wall 'wall 1'; start it where it can move"],
    ),
    "a missing wall that is not there": (
        HEAD + "walls: [[[0, 2], [9, 2]], {name: panel, points: [[0, 3], [9, 3]]}]\n"
        "belief: {missing: [wall 1, pannel]}\n",
        ["5:28: belief.missing[1]: no obstacle or wall is named 'pannel'; did you mean 'panel'?"],
    ),
    "missing walls of two lists": (
        HEAD + "walls: [[[0, 2], [9, 2]]]\nbelief: {missing: [wall 1], walls: []}\n",
        ["5:19: belief.missing: belief.walls lists all that the filter's map holds; delete either "
         "'missing' or 'walls'"],
    ),
    "one name": (
        HEAD + "obstacles:\n" + DESK + DESK,
        ["6:12: obstacles[1].name: 'desk' is already the name of the obstacle on line 5; choose "
         "another name"],
    ),
    "the boundary's name": (
        HEAD + "belief:\n obstacles:\n  - {name: boundary, " + SQUARE + "}\n",
        ["6:12: belief.obstacles[0].name: 'boundary' is the name of the room's own wall; choose "
         "another name"],
    ),
    "landmarks": (
        HEAD + "landmarks: [{id: 3, x: 1, y: 1}, {id: 3, x: 2, y: 2}, {id: 1.5, x: 2, y: 2}, {id: "
               "4.0, x: 2, y: 2}]\n",
        [
            "4:39: landmarks[1].id: 3 is already the id of the landmark on line 4; choose another "
            "id",
            "4:60: landmarks[2].id: 1.5 is not written as a whole number; write e.g. 3",
        ],
    ),
    "start outside": (
        HEAD + "boundary: [[2, 0], [9, 0], [9, 9], [2, 9]]\n",
        ["2:8: start: the robot starts at [1, 1], outside the boundary or on its wall; start it "
         "where it can move"],
    ),
    "start on the wall": (
        HEAD + "boundary: [[1, 0], [9, 0], [9, 9], [1, 9]]\n",
        ["2:8: start: the robot starts at [1, 1], outside the boundary or on its wall; start it "
         "where it can move"],
    ),
    "start in a desk": (
        HEAD.replace("x: 1, y: 1", "x: 4.5, y: 3.5") + "obstacles:\n" + DESK,
        [
            "2:8: start: the robot starts at [4.5, 3.5], inside the obstacle 'desk' or on its "
            "wall; "
            "start it where it can move"
        ],
    ),
    "start on a desk's edge": (
        HEAD.replace("x: 1, y: 1", "x: 4, y: 3.5") + "obstacles:\n" + DESK,
        [
            "2:8: start: the robot starts at [4, 3.5], inside the obstacle 'desk' or on its wall; "
            "start it where it can move"
        ],
    ),
    "missing obstacle": (
        HEAD + "obstacles:\n" + DESK + "belief: {missing: [dek, piano]}\n",
        [
            "6:20: belief.missing[0]: no obstacle is named 'dek'; did you mean 'desk'?",
            "6:25: belief.missing[1]: no obstacle is named 'piano'; the obstacles are: desk",
        ],
    ),
    "missing of none": (
        HEAD + "belief: {missing: [desk]}\n",
        ["4:20: belief.missing[0]: no obstacle is named 'desk'; the obstacles are: none"],
    ),
    "missing and obstacles": (
        HEAD + "obstacles:\n" + DESK + "belief: {missing: [desk], obstacles: []}\n",
        [
            "6:19: belief.missing: belief.obstacles lists all that the filter's map holds; "
            "delete either 'missing' or 'obstacles'"
        ],
    ),
    "all at once, in the order of the file": (
        "boundary: [[0, 0], [10, 8], [10, 0], [0, 8]]\nobstacles:\n" + DESK
        + "belief: {missing: [dek]}\nstart: {x: 4.5, y: 3.5, theta: x}\n" + NOISE + "size: 5\nname: a\nname: b\n",
        [
            "1:11: boundary: the outline crosses or touches itself at [5, 4]; give the corners in "
            "order, around it",
            "4:20: belief.missing[0]: no obstacle is named 'dek'; did you mean 'desk'?",
            "5:8: start: the robot starts at [4.5, 3.5], inside the obstacle 'desk' or on its "
            "wall; "
            "start it where it can move",
            "5:32: start.theta: 'x' is text where a number belongs; write e.g. 90",
            "7:1: unknown key 'size'; known keys here: name, description, system, boundary, "
            "obstacles, walls, landmarks, start, "
            "noise, robot, sensors, expectedPath, belief, faults",
            "9:1: the key 'name' is given twice, first on line 8; delete one",
        ],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WORLDS)
def test_mistakes_of_a_world(tmp_path, case):
    text, lines = WORLDS[case]
    assert lines_of(tmp_path, text) == [f"f.yaml:{line}" for line in lines]


SCENES = {
    "not a command": (
        "commands:\n  - moev: {distance: 1, angle: 0}\n  - jump: 5\n  - sense\n  - {}\n",
        [
            "3:5: commands[0]: 'moev' is not a command; did you mean 'move'?",
            "4:5: commands[1]: 'jump' is not a command; known commands here: move, sense, repeat, "
            "kidnap, say",
            "5:5: commands[2]: 'sense' is text where a command belongs; write e.g. {move: "
            "{distance: 1.75, angle: 90}}",
            "6:5: commands[3]: the command is missing; write one of move, sense, repeat, kidnap, "
            "say",
        ],
    ),
    "not indented": (
        "commands:\n  - move:\n    distance: 1\n",
        [
            "3:10: commands[0].move: nothing stands where a mapping 'key: value' belongs; "
            "write e.g. {distance: 1.75, angle: 90}",
            "4:5: commands[0]: 'distance' is not a command; indent it further than 'move' to put "
            "it under it",
        ],
    ),
    "two commands in one item": (
        "commands:\n  - repeat:\n      times: 2\n      commands:\n        - {sense: {angle: 5}, "
        "say: hi}\n",
        [
            "6:11: commands[0].repeat.commands[0]: 'sense' and 'say' stand in one item; "
            "begin each command with '- ' on a line of its own"
        ],
    ),
    "missing keys": (
        "commands:\n  - move: {}\n  - kidnap: {x: 1, y: 2}\n  - repeat: {times: 2}\n",
        [
            "3:11: commands[0].move.distance: the key is missing; write distance: 1.5",
            "3:11: commands[0].move.angle: the key is missing; write angle: 90",
            "4:13: commands[1].kidnap.theta: the key is missing; write theta: 90",
            "5:13: commands[2].repeat.commands: the key is missing; write commands: [{move: "
            "{distance: 1.75, angle: 90}}]",
        ],
    ),
    "slip": (
        "commands:\n  - move: {distance: 1, angle: 0, slip: 1.1}\n  - say: 5\n",
        [
            "3:41: commands[0].move.slip: 1.1 is too large; write a number from 0 to 1",
            "4:10: commands[1].say: 5 is a number where text belongs; write it in quotes: '5'",
        ],
    ),
    "times": (
        "commands:\n  - repeat: {times: -1, commands: []}\n  - repeat: {times: 1.5, commands: 5}\n"
        "  - repeat: {times: 1000001, commands: []}\n",
        [
            "3:21: commands[0].repeat.times: -1 is negative; write a whole number of 0 or more",
            "4:21: commands[1].repeat.times: 1.5 is not written as a whole number; write e.g. 4",
            "4:36: commands[1].repeat.commands: 5 is a number where a list belongs; "
            "write e.g. [{move: {distance: 1.75, angle: 90}}]",
            "5:21: commands[2].repeat.times: 1000001 is too large; write a whole number of at "
            "most 1 000 000",
        ],
    ),
    "too many commands": (
        "commands:\n  - repeat: {times: 1000, commands: [{repeat: {times: 1000, commands: [{say: "
        "a}]}}]}\n  - say: b\n",
        [
            "3:3: commands: the commands expand to 1 000 001, more than 1 000 000; repeat fewer "
            "times"
        ],
    ),
    "far too many commands": (
        "commands:\n  - repeat: {times: 1000000, commands: [{repeat: {times: 1000000, commands: "
        "[{say: a}, {say: b}]}}]}\n",
        [
            "3:3: commands: the commands expand to about 2e+12, more than 1 000 000; repeat fewer "
            "times"
        ],
    ),
    "settings": (
        "seed: -1\nfilter: ekff\ngate: 1\nguard: loud\ncommands: []\n",
        [
            "2:7: seed: -1 is negative; write a whole number of 0 or more",
            "3:9: filter: 'ekff' is not known here; did you mean 'ekf'?",
            "4:7: gate: 1 is not strictly between 0 and 1; write e.g. 0.99",
            "5:8: guard: 'loud' is not known here; write off, warn or skip",
        ],
    ),
    "other settings": (
        "seed: 7.5\nfilter: 5\ngate: 0\nguard: false\ncommands: 5\n",
        [
            "2:7: seed: 7.5 is not written as a whole number; write e.g. 7",
            "3:9: filter: 5 is a number where a word belongs; write kf, kf-nominal, ekf, iekf, "
            "ukf, ukf-augmented, huber, pdaf, adaptive, invariant, pf, amcl, mhekf or FILE.py",
            "4:7: gate: 0 is not strictly between 0 and 1; write e.g. 0.99",
            "5:8: guard: false is a yes-or-no value where a word belongs; write off, warn or skip",
            "6:11: commands: 5 is a number where a list belongs; write e.g. [{move: {distance: "
            "1.75, angle: 90}}]",
        ],
    ),
    "a large seed": (
        f"seed: {'9' * 400}\ncommands: []\n",
        [f"2:7: seed: {'9' * 37}... is too large; write e.g. 7"],
    ),
    "a seed of two words": (
        "seed: 4294967296\ncommands: []\n",
        [
            "2:7: seed: 4294967296 is too large: beyond it NumPy's seed words would repeat the "
            "draws of other seeds; "
            "write a whole number of at most 4 294 967 295"
        ],
    ),
    "a seed of two words, written otherwise": (
        "seed: 1e10\ncommands: []\n",
        [
            "2:7: seed: 1e10 is too large: beyond it NumPy's seed words would repeat the draws of "
            "other seeds; "
            "write a whole number of at most 4 294 967 295"
        ],
    ),
    "the largest seed and a mistake": (
        "seed: 4294967295\ncommands: 5\n",
        [
            "3:11: commands: 5 is a number where a list belongs; write e.g. [{move: {distance: "
            "1.75, angle: 90}}]"
        ],
    ),
    "expect": (
        "expect: {lost: [0.5, 0.1], nis: hihg, nees: 5, coverage: [0.5], runs: 0}\ncommands: []\n",
        [
            "2:16: expect.lost: 0.5 is more than 0.1; write the lower first: [0.1, 0.5]",
            "2:33: expect.nis: 'hihg' is not known here; did you mean 'high'?",
            "2:45: expect.nees: 5 is a number where a word belongs; write silent, high or low",
            "2:58: expect.coverage: 1 value stands where a pair [low, high] belongs; write e.g. "
            "[0.5, 0.9]",
            "2:71: expect.runs: 0 is too small; write a whole number of 1 or more",
        ],
    ),
    "expect no share": (
        "expect: {lost: [0.5, 1.5], nis: [low], coverage: 1, times: 3}\ncommands: []\n",
        [
            "2:22: expect.lost[1]: 1.5 is too large; write a number from 0 to 1",
            "2:33: expect.nis: a list stands where a word belongs; write silent, high or low",
            "2:50: expect.coverage: 1 is a number where a pair [low, high] belongs; write e.g. "
            "[0.5, 0.9]",
            "2:53: expect: unknown key 'times'; known keys here: lost, nis, nees, coverage, runs",
        ],
    ),
}


@pytest.mark.parametrize("case", SCENES)
def test_mistakes_of_a_commands_file(tmp_path, case):
    (tmp_path / "room.yaml").write_text(HEAD)
    text, lines = SCENES[case]
    assert lines_of(tmp_path, "world: room.yaml\n" + text) == [f"f.yaml:{line}" for line in lines]


def test_a_scene_without_a_world(tmp_path):
    line = (
        "f.yaml:1:1: the scene has no world; write e.g. world: ../worlds/classroom.yaml, or "
        "name one with --world"
    )
    assert lines_of(tmp_path, "commands: []\n") == [line]


def test_a_world_that_is_not_there(tmp_path):
    (tmp_path / "classroom.yaml").write_text(HEAD)
    assert lines_of(tmp_path, "commands: []\nworld: clasroom.yaml\n") == [
        "f.yaml:2:8: world: clasroom.yaml: no such file; did you mean 'classroom.yaml'?"
    ]
    assert lines_of(tmp_path, "commands: []\nworld: far/away.yaml\n") == [
        "f.yaml:2:8: world: far/away.yaml: no such file; write its path relative to this file"
    ]


def test_mistakes_of_the_world_follow_those_of_the_scene(tmp_path):
    (tmp_path / "room.yaml").write_text(HEAD + "size: 5\n")
    assert lines_of(tmp_path, "seed: x\ncommands: []\nworld: ./room.yaml\n") == [
        "f.yaml:1:7: seed: 'x' is text where a whole number belongs; write e.g. 7",
        "room.yaml:4:1: unknown key 'size'; known keys here: name, description, system, boundary, "
        "obstacles, walls, landmarks, "
        "start, noise, robot, sensors, expectedPath, belief, faults",
    ]


def test_one_kind_in_place_of_the_other(tmp_path):
    world, scene = tmp_path / "world.yaml", tmp_path / "scene.yaml"
    world.write_text(HEAD)
    scene.write_text("world: scene.yaml\ncommands: []\n")
    with pytest.raises(
        InputError,
        match=r"world.yaml:1:1: this is a world file: it has no 'commands'; name a command",
    ):
        load_scene(world)
    with pytest.raises(
        InputError, match=r"scene.yaml:1:1: this is a commands file; name a world file here$"
    ):
        load_world(scene)
    with pytest.raises(
        InputError, match=r"scene.yaml:1:1: this is a commands file; name a world file here$"
    ):
        load_scene(scene)


def test_files_that_cannot_be_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.yaml").write_text(HEAD)
    for path, line in {
        "romo.yaml": "romo.yaml: no such file; did you mean 'room.yaml'?",
        "piano.yaml": "piano.yaml: no such file",
        "no/where.yaml": "no/where.yaml: no such file",
        ".": ".: is a folder; name a file in it",
        "room.yaml/x": "room.yaml/x: cannot be read: Not a directory",
        "a\0b": "a\\x00b: cannot be read: embedded null byte",
    }.items():
        for load in (load_world, load_scene, check):
            with pytest.raises(UsageError) as told:
                load(path)
            assert str(told.value) == line
            assert not isinstance(told.value, InputError)


def test_a_file_one_may_not_read(tmp_path, monkeypatch):
    path = tmp_path / "room.yaml"
    path.write_text(HEAD)

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("builtins.open", refuse)
    with pytest.raises(UsageError, match=r"room.yaml: cannot be read: Permission denied$"):
        load_world(path)


def test_a_name_that_is_nothing(monkeypatch, tmp_path):
    monkeypatch.setattr("ekfsim.files.packaged.packaged", lambda kind: {"tour": Path("tour.yaml")})
    with pytest.raises(UsageError) as told:
        resolve("tuor", "commands")
    assert (
        str(told.value)
        == "'tuor' is neither a file nor one of the packaged commands; did you mean 'tour'?"
    )
    with pytest.raises(UsageError) as told:
        resolve("piano", "worlds")
    assert (
        str(told.value)
        == "'piano' is neither a file nor one of the packaged worlds; see `ekfsim list`, or name "
        "a file"
    )
