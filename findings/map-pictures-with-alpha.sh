#!/usr/bin/env bash
# Guess:     a ROS map is the same map as PGM, as PNG, with an alpha channel that is opaque all over, as editors of
#            pictures save it, with a floor that was made transparent, and in 16 bits; in each reader.
# Behaviour: cartoblobpy takes the alpha channel for the map where there is one: of an opaque picture all is wall,
#            floor too. ir-sim leaves alpha out: transparent black, as editors leave what was erased, is wall,
#            transparent white is floor. And both read 16 bits by a picture library that cuts them at 255 of 65535: a
#            wall of a dark grey, 50 of 255, is floor then; ir-sim has it in the same map as PNG. Neither tells. Right:
#            grey and 8 bits, and count the wall's pixels after loading.
# Version:   ir-sim 2.12.0, cartoblobpy 0.0.10, pillow 13.0.0, matplotlib 3.11.2 (PyPI)
# Source:    run below; ImageGridGenerator._build_grid: imread, three of the channels; Graph.load_from_image
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q ir-sim==2.12.0 cartoblobpy==0.0.10 pillow==13.0.0 matplotlib==3.11.2 numpy==2.4.6 \
  2> "$folder/pip.log" || { cat "$folder/pip.log"; exit 1; }
cd "$folder"
MPLBACKEND=Agg "$folder/venv/bin/python" -W ignore - 2> "$folder/log" <<'PYTHON' || { tail -3 "$folder/log"; exit 1; }
import contextlib
import io
import os

import numpy as np
from cartoblobpy.graph import Graph
from PIL import Image

with contextlib.redirect_stdout(io.StringIO()):  # words on windows, which are not needed
    from irsim.world.map import resolve_obstacle_map

WALL, FLOOR, OPAQUE = 50, 254, 255
GREY = np.full((3, 4), FLOOR, np.uint8)
GREY[:, 0] = WALL
TRUE = GREY == WALL


def coloured(rgb_of_floor, alpha_of_floor):
    picture = np.dstack([GREY, GREY, GREY, np.full_like(GREY, OPAQUE)])
    picture[~TRUE] = (*[rgb_of_floor] * 3, alpha_of_floor)
    return picture


DEEP = GREY.astype(np.uint16) * 257
Image.fromarray(GREY).save("grey.pgm")
Image.fromarray(GREY).save("grey.png")
Image.fromarray(coloured(FLOOR, OPAQUE)).save("opaque.png")
Image.fromarray(coloured(0, 0)).save("erased-black.png")
Image.fromarray(coloured(255, 0)).save("erased-white.png")
Image.fromarray(DEEP).save("16-bits.png")
with open("16-bits.pgm", "wb") as file:
    file.write(b"P5\n4 3\n65535\n" + DEEP.astype(">u2").tobytes())


def by_irsim(name):
    """Walls, rows from the top: occupied beyond 50 of 100, columns first and from below, as its maps are."""
    return resolve_obstacle_map({"name": "image", "path": os.path.abspath(name)}).T[::-1] > 50


def by_cartoblobpy(name):
    with open("map.yaml", "w") as file:
        file.write(f"image: {name}\nresolution: 0.05\norigin: [0, 0, 0]\n")
        file.write("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")
    graph = Graph()
    graph.load_from_yaml("map.yaml")
    return graph.grid[::-1] > 0.6


EXPECTED = {  # share of the walls, share of the floor that is taken for wall
    "grey.pgm": ((1, 0), (1, 0)),
    "grey.png": ((1, 0), (1, 0)),
    "opaque.png": ((1, 0), (1, 1)),
    "erased-black.png": ((1, 1), (1, 0)),
    "erased-white.png": ((1, 0), (1, 0)),
    "16-bits.png": ((1, 0), (0, 0)),
    "16-bits.pgm": ((0, 0), (0, 0)),
}
agrees = []
print("taken for wall            ir-sim: walls   floor     cartoblobpy: walls   floor")
for name, expected in EXPECTED.items():
    walls = by_irsim(name), by_cartoblobpy(name)
    read = [(float(each[TRUE].mean()), float(each[~TRUE].mean())) for each in walls]
    print(f"{name:20s}{read[0][0]:20.0%}{read[0][1]:8.0%}{read[1][0]:23.0%}{read[1][1]:8.0%}")
    agrees.append(tuple(read) == expected)
raise SystemExit(0 if all(agrees) else "this has changed")
PYTHON
