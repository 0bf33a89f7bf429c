#!/usr/bin/env bash
# Guess:     in a world of ir-sim an obstacle whose vertices are told stands where they are: a polygon or a line of walls
#            needs no `state`, for its vertices are places already.
# Behaviour: vertices are those of a body, and a body that tells no `state` stands at (1, 1): all corners are 1 m further
#            right and up than the file has them, by both shapes. Nothing tells. With `state: [0, 0, 0]` they are where
#            they were told. A map that was written by another program is off by 1.41 m, which no scan-matcher would be
#            told of. Right: write the state with each.
# Version:   ir-sim 2.12.0, numpy 2.4.6 (PyPI)
# Source:    run below; ObjectFactory.generate_state_list: "Default is [1, 1, 0]"
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q ir-sim==2.12.0 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
cd "$folder"
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - 2> "$folder/log" <<'PYTHON' || { tail -3 "$folder/log"; exit 1; }
import contextlib
import io

with contextlib.redirect_stdout(io.StringIO()):  # words on windows, which are not needed
    import irsim

DESK = {"shape": {"name": "polygon", "vertices": [[4, 5], [5, 5], [5, 6], [4, 6]]}}
WALL = {"shape": {"name": "linestring", "vertices": [[0, 5], [3, 5]]}}


def bounds(body, state):
    """What a world of this one obstacle holds: (x from, y from, x to, y to) in m"""
    told = f"state: {state}, " if state else ""
    with open("world.yaml", "w") as file:
        file.write("world: {width: 10, height: 10}\n")
        file.write("robot: [{kinematics: {name: diff}, shape: {name: circle, radius: 0.2}, state: [1, 1, 0]}]\n")
        file.write(f"obstacle: [{{{told}shape: {body['shape']}}}]\n")
    with contextlib.redirect_stdout(io.StringIO()):
        env = irsim.make("world.yaml", display=False, log_level="ERROR")
        found = env.obstacle_list[0].geometry.bounds
        env.end()
    return tuple(round(float(edge), 6) for edge in found)


agrees = []
for name, body in {"polygon": DESK, "linestring": WALL}.items():
    corners = body["shape"]["vertices"]
    xs, ys = zip(*corners)
    told = tuple(float(edge) for edge in (min(xs), min(ys), max(xs), max(ys)))
    without, at_zero = bounds(body, None), bounds(body, [0, 0, 0])
    print(f"{name:10s} told {told}, without state {without}, with state [0, 0, 0] {at_zero}")
    agrees += [at_zero == told, without == tuple(edge + 1 for edge in told)]
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
