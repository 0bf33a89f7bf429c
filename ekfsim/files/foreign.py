"""What a file or folder is that is none of ours, and what reads it: told in place of what is wrong
in it.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple, get_args

from ekfsim.files.keys.recorded.recording import LogFormat

ENOUGH = 4096  # bytes from the beginning, by which a file is recognised
NUMBERS = re.compile(r"[-+\d.eEnaif]+")
NO_ROW = re.compile(r"[\[\]{}|]|:\s|:$")  # what stands in texts, in no row of a table
FEWEST = 2  # numbers in a row
METADATA = re.compile(r"rosbag2_bagfile_information:\s")
BAG_FILES = ("metadata.yaml", "*.db3", "*.mcap", "*.bag")
# a format, the files without which its reader tells what is missing, and the commands that read it
LOGS = (
    ("gnss", ("wheelspeeds*.csv", "gnss*.csv"), "gnss_log"),
    ("mower", ("*poselog.txt", "*angles.txt", "*map.txt"), "mower_log"),
    ("mrclam", ("*Odometry.dat", "*Measurement.dat"), "mrclam_log"),
    ("ranges", ("odometry*.csv", "ranges*.csv", "nodes*.csv"), "ranges_log"),
    ("pioneer", ("odometry*.csv", "ultrasonic*.csv"), "pioneer_log"),
    ("classroom", ("entries.csv", "world.yaml"), "tour"),
    ("log", ("motion*.csv", "readings*.csv"), "log"),
    ("log", ("odometry*.csv", "readings*.csv"), "log"),
)
SEPARATORS = re.compile(r"[,;\t ]+")
ROWS = 3  # of numbers that make a table


class Foreign(NamedTuple):
    """A kind of file."""

    what: str  # as in "this is …"
    cure: str


PICTURE = "of a ROS map name its map.yaml: ekfsim world map.yaml -o world.yaml"
UNPACK = "unpack it first"
LOG = "a commands file names a log: recording: {format: …, path: …}; see `ekfsim schema recording`"
BAG = "recording: {format: bag, path: …, topics: {…}}"
TABLE_CURE = f"{LOG}, or `ekfsim run log --log DIR`"
SIGNS: tuple[tuple[bytes, str, str], ...] = (
    (b"#ROSBAG V", "a ROS 1 bag", "bag"),
    (b"\x89MCAP0", "an MCAP file", "bag"),
    (b"SQLite format 3\0", "an SQLite file, as bags of ROS 2 have", "bag"),
    (b"\x89PNG", "a PNG picture", PICTURE),
    (b"\xff\xd8\xff", "a JPEG picture", PICTURE),
    (b"GIF8", "a GIF picture", PICTURE),
    (b"BM", "a BMP picture", PICTURE),
    (b"II*\0", "a TIFF picture", PICTURE),
    (b"MM\0*", "a TIFF picture", PICTURE),
    (b"P5", "a PGM picture", PICTURE),
    (b"PK\x03\x04", "a zip archive or a spreadsheet", "unpack it, or save the sheet as CSV"),
    (b"\x1f\x8b", "a gzip archive", UNPACK),
    (b"7z\xbc\xaf", "a 7z archive", UNPACK),
    (b"BZh", "a bzip2 archive", UNPACK),
    (b"\xfd7zXZ", "an xz archive", UNPACK),
    (b"%PDF", "a PDF document", "save its numbers as CSV"),
    (b"MATLAB 5.0 MAT-file", "a MATLAB file", "save its arrays as CSV: writematrix(a, 'a.csv')"),
    (b"\x89HDF", "an HDF5 file", "save its arrays as CSV"),
    (b"\x93NUMPY", "a numpy array", "save it as CSV: numpy.savetxt"),
    (b"\x80\x04\x95", "a Python pickle", "save its arrays as CSV"),
    (b"\x80\x03", "a Python pickle", "save its arrays as CSV"),
    (b"\x80\x05\x95", "a Python pickle", "save its arrays as CSV"),
)


def of_bytes(raw: bytes) -> Foreign | None:
    """What a file is that begins with these bytes; None where it may be a text."""
    for sign, what, cure in SIGNS:
        if raw.startswith(sign) and (len(sign) > 2 or _is_binary(raw)):
            return Foreign(what, _bag_cure() if cure == "bag" else cure)
    return None


def of_text(text: str) -> Foreign | None:
    """What a text is that is no YAML file of ours: rows of numbers, or what lies beside a bag."""
    if METADATA.match(text):
        return Foreign("what tells of a ROS 2 bag", "name its folder: `ekfsim run bag --log DIR`")
    lines = [line for line in text[:ENOUGH].splitlines() if line.strip()[:1] not in ("", "#", "%")]
    rows = [_is_row(line) for line in lines]
    if sum(rows[:-1]) >= ROWS and all(rows[1:-1]):
        return Foreign("a table of numbers", TABLE_CURE)
    return None


def of_folder(names: Sequence[str], shown: str) -> Foreign | None:
    """What a folder with files of these names is: a bag, or a log.
    shown : how the folder was named
    """
    if _has(names, BAG_FILES, any):
        return Foreign("a bag", f"`ekfsim run bag --log {shown}` reads it")
    for format, files, commands in LOGS:
        if _has(names, files, all):
            cure = f"`ekfsim run {commands} --log {shown}` reads it"
            return Foreign(f"a log of the format {format}", cure)
    return None


def _has(
    names: Sequence[str], patterns: Sequence[str], many: Callable[[Iterable[bool]], bool]
) -> bool:
    """Whether there are names for any, or for all, of some patterns."""
    return many(any(fnmatchcase(name, pattern) for name in names) for pattern in patterns)


def _is_row(line: str) -> bool:
    """Whether a line is one of a table: numbers, among which words may stand."""
    fields = SEPARATORS.split(line.strip().strip(",;"))
    numbers = sum(NUMBERS.fullmatch(field) is not None for field in fields)
    return numbers >= FEWEST and 2 * numbers >= len(fields) and not NO_ROW.search(line)


def _is_binary(raw: bytes) -> bool:
    """Whether a file whose sign is short is more than a text that begins so."""
    return any(byte < 9 or byte > 126 for byte in raw[:ENOUGH])


def _bag_cure() -> str:
    """What reads a bag."""
    if "bag" in get_args(LogFormat):
        return f"`ekfsim run bag --log …` reads it, and a commands file: {BAG}"
    return "write its topics as CSV files: `ekfsim schema recording` tells which"
