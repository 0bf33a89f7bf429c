"""ROS maps as they are written to a folder, of rows of pixels from the top."""

import numpy as np

KEYS = {
    "image": "map.pgm",
    "resolution": 0.05,
    "origin": [0, 0, 0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.196,
}


def write(folder, pixels, most=255, **keys):
    """A map.yaml and its picture, a binary PGM."""
    pixels = np.asarray(pixels)
    wide = ">u2" if most > 255 else "u1"
    rows, columns = pixels.shape
    header = f"P5\n# drawn by a test\n{columns} {rows}\n{most}\n".encode()
    (folder / "map.pgm").write_bytes(header + pixels.astype(wide).tobytes())
    return text(folder, **keys)


def text(folder, **keys):
    """The map.yaml alone; a key that is None is left out."""
    lines = [f"{key}: {value}" for key, value in (KEYS | keys).items() if value is not None]
    (folder / "map.yaml").write_text("\n".join(lines) + "\n")
    return folder / "map.yaml"


def room(rows, columns, wall=0, inside=254):
    """A room with a wall around it, one pixel thick."""
    pixels = np.full((rows, columns), inside)
    pixels[[0, -1]] = wall
    pixels[:, [0, -1]] = wall
    return pixels
