"""The names of a table's columns: in its first line, in a comment above, in the commands file."""

from pathlib import Path

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.recorded.columns import COLUMNS
from ekfsim.files.logs.header import separator_of
from ekfsim.files.logs.table import is_number
from ekfsim.files.logs.tables.names import OF_A_POSE, OTHERS, named
from ekfsim.files.logs.text import first_line
from ekfsim.files.yaml.telling import quoted

ALSO = {  # how else a first line may call a column, which is not told
    "t": ("time", "timestamp", "stamp"),
    "v": ("speed",),
    "omega": ("turn_rate", "yaw_rate"),
    "left": ("vl", "v_left"),
    "right": ("vr", "v_right"),
    "turn": ("dheading", "dtheta"),
    "theta": ("heading", "phi", "orientation"),
    "latitude": ("lat", "gps_lat", "field_latitude"),
    "longitude": ("lon", "lng", "long", "gps_lon", "field_longitude"),
    **{
        f"q{one}": tuple(f"{of}orientation_{one}" for of in ("", "pose_", *OF_A_POSE))
        for one in "xyzw"
    },
    "id": ("name", "landmark", "node", "marker", "subject"),
    "target": ("landmark", "node", "marker", "id", "beam", "pair"),
    **{
        f"variance{of}": (f"var{of}", f"cov{of}", f"variance{of.replace('_', '')}")
        for of in ("", "_x", "_y", "_range", "_bearing")
    },
}
TWINS = {  # of our columns, those of the other formats that mean the same
    "v": "speed", "omega": "turn rate", "left": "vl", "right": "vr", "turn": "dheading",
    "theta": "heading", "id": "node", "target": "node",
}  # fmt: skip


def meant(name: str) -> tuple[str, ...]:
    """What one would take for a column of this name, where nothing is called so, and tells."""
    others = OTHERS.get(TWINS.get(name, name), ())
    return tuple(one for one in others if one not in COLUMNS)


def fields_of(line: str, separator: str | None) -> list[str]:
    """What stands in a line, without quotes."""
    fields = [field.strip().strip('"').strip() for field in line.strip().split(separator)]
    if fields[-1] == "":
        fields.pop()
    return fields


def names_in(path: Path, first: list[str]) -> list[str] | None:
    """The names of the columns: the first row where none of it is a number, or a comment above with
    as many words; None where there is neither.
    """
    if _are_names(first):
        return first
    line = first_line(path).lstrip("#% \t")
    names = fields_of(line, separator_of(line)) if line.strip() else []
    return names if len(names) == len(first) and _are_names(names) else None


def _are_names(fields: list[str]) -> bool:
    return not any(map(is_number, fields)) and any(field[:1].isalpha() for field in fields)


def placed(head: list[str], at: Place) -> tuple[dict[str, int], dict[str, str | float]]:
    """Where the columns stand that a first line names, and their units where it states them.
    Raises InputError where two have one name.
    """
    places, units = dict[str, int](), dict[str, str | float]()
    for place, field in enumerate(head):
        _, name, unit = named(field)
        if name in places:
            wrong = f"two columns are named {quoted(name)}"
            raise InputError([Mistake(at, "", wrong, "give one another name")])
        places[name] = place
        if unit is not None:
            units[name] = unit
    return places, units


def place_of(theirs: str | int, head: list[str], width: int) -> int | None:
    """Where a column stands that goes by a name or a number from 1, None where it does not."""
    if isinstance(theirs, int):
        return theirs - 1 if theirs <= width else None
    wanted = theirs.strip().lower()
    names = [field.lower() for field in head]
    bare = [named(name).name for name in names]
    return next((known.index(wanted) for known in (names, bare) if wanted in known), None)


def absent(at: Place, name: str, theirs: str | int, head: list[str] | None) -> InputError:
    """The mistake that a column is not where the commands file says."""
    what = f"number {theirs}" if isinstance(theirs, int) else f"named {quoted(theirs)}"
    found = (
        f"found {', '.join(map(quoted, head))}" if head else "its rows have no names: number them"
    )
    return InputError([Mistake(at, f"columns.{name}", f"no column is {what}", found)])
