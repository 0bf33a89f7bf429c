"""What no single key can tell of a world file: polygons, names, places to stand.

The checks read the raw tree and skip whatever a model has found wrong, so that all mistakes of a
file are told at once.
"""

from collections.abc import Iterator

from ekfsim.errors import MOST_TOLD, Mistake
from ekfsim.files.keys.worlds.floor import SHAPES, ObstacleKeys
from ekfsim.files.scenes.checking import polygons
from ekfsim.files.scenes.checking.polygons import Circle, FloorPlan, Points
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.yaml.marked import Path
from ekfsim.files.yaml.telling import nearest
from ekfsim.floor import BOUNDARY, wall_name
from ekfsim.printable import quoted, some

WALLED, UNWALLED = ("obstacle or wall", "obstacles and walls"), ("obstacle", "obstacles")


def check_world(file: Sound) -> Iterator[Mistake]:
    """Mistakes of a world file that lie between its keys."""
    yield from check_polygons(file)
    for owner in ((), ("belief",)):
        yield from check_shapes(file, owner)
        yield from check_names(file, owner)
    yield from check_landmarks(file)
    yield from check_missing(file)
    yield from check_unknown_start(file)
    x, y = file.value("start", "x"), file.value("start", "y")
    if x is not None and y is not None:
        plan = FloorPlan(
            file.value("boundary"), sound_obstacles(file), sound_walls(file), sound_circles(file)
        )
        for wrong in plan.in_the_way(x, y):
            yield file.mistake(
                ("start",), f"the robot starts at {wrong}", "start it where it can move"
            )


def sound_obstacles(file: Sound) -> Iterator[tuple[str, Points]]:
    """The obstacles whose points are right, with their names."""
    for index in range(file.count("obstacles")):
        points = file.value("obstacles", index, "points")
        if points is not None:
            yield file.value("obstacles", index, "name") or f"obstacles[{index}]", points


def sound_circles(file: Sound) -> Iterator[tuple[str, Circle]]:
    """The obstacles that are round, with their names."""
    for index in range(file.count("obstacles")):
        circle = file.value("obstacles", index, "circle")
        if circle is not None:
            name = file.value("obstacles", index, "name") or f"obstacles[{index}]"
            yield name, (circle["x"], circle["y"], circle["radius"])


def sound_walls(file: Sound) -> Iterator[tuple[str, Points]]:
    """The walls that stand free and whose points are right, with their names."""
    for index in range(file.count("walls")):
        points = file.value(*wall_points(file, ("walls", index)))
        if points is not None:
            yield name_of_wall(file, ("walls", index)) or f"walls[{index}]", points


def wall_points(file: Sound, wall: Path) -> Path:
    """Where the points of a wall stand: it may be a list of them, or have a name as well."""
    node = file.root.at(wall)
    return (*wall, "points") if node is not None and node.keys else wall


def name_of_wall(file: Sound, wall: Path) -> str | None:
    """What a wall is called; None where its name is wrong."""
    node = file.root.at(wall)
    if node is not None and node.keys:
        name: str | None = file.value(*wall, "name")
        return name
    return wall_name(int(wall[-1]))


def check_polygons(file: Sound) -> Iterator[Mistake]:
    """Polygons and lines that are none. Each is known as wrong from here on."""
    faults = [(path, polygons.fault_of) for path in polygon_paths(file)]
    faults += [(path, polygons.fault_of_line) for path in line_paths(file)]
    for path, fault_of in faults:
        points = file.value(*path)
        if points is not None and (fault := fault_of(points)):
            index, wrong, right = fault
            place = path if index is None else (*path, index)
            yield file.mistake(place, wrong, right)
            file.give_up(path)


def check_shapes(file: Sound, owner: Path) -> Iterator[Mistake]:
    """Obstacles that are both a polygon and a circle, or neither."""
    for index in range(file.count(*owner, "obstacles")):
        path = (*owner, "obstacles", index)
        obstacle = file.root.at(path)
        if obstacle is None or not isinstance(obstacle.value, dict):
            continue
        held = [shape for shape in SHAPES if shape in obstacle.keys]
        unknown = obstacle.keys.keys() - ObstacleKeys.model_fields.keys()  # told of already
        if len(held) > 1:
            wrong, right = "a polygon and a circle stand in one obstacle", "delete one of them"
            yield file.mistake((*path, "circle"), wrong, right)
        elif not held and not unknown:
            right = "write points: [[4, 3], [5, 3], [5, 4]], or circle: {x: 3, y: 2, radius: 0.4}"
            yield file.mistake((*path, "points"), "the key is missing", right)


def line_paths(file: Sound) -> Iterator[Path]:
    """Where a world file holds lines of walls."""
    for owner in ((), ("belief",)):
        for index in range(file.count(*owner, "walls")):
            yield wall_points(file, (*owner, "walls", index))


def polygon_paths(file: Sound) -> Iterator[Path]:
    """Where a world file holds polygons."""
    for owner in ((), ("belief",)):
        yield (*owner, "boundary")
        for index in range(file.count(*owner, "obstacles")):
            yield (*owner, "obstacles", index, "points")


def check_names(file: Sound, owner: Path) -> Iterator[Mistake]:
    """Two obstacles or walls of one name, and one that is named like the boundary."""
    seen: dict[str, tuple[str, Path]] = {}
    for path, what, name in named(file, owner):
        if name == BOUNDARY:
            yield file.mistake(
                path, f"'{BOUNDARY}' is the name of the room's own wall", "choose another name"
            )
        elif name in seen:
            other, place = seen[name]
            line = file.root.nearest(place).mark[0]
            yield file.mistake(
                path,
                f"{quoted(name)} is already the name of the {other} on line {line}",
                "choose another name",
            )
        elif name is not None:
            seen[name] = what, path


def named(file: Sound, owner: Path) -> Iterator[tuple[Path, str, str | None]]:
    """The names of one map, each with its place and with what it is the name of: those that were
    written, then those that walls have by their places in the list.
    """
    unnamed = list[tuple[Path, str, str | None]]()
    for index in range(file.count(*owner, "obstacles")):
        path = (*owner, "obstacles", index, "name")
        yield path, "obstacle", file.value(*path)
    for index in range(file.count(*owner, "walls")):
        wall = (*owner, "walls", index)
        name = name_of_wall(file, wall)
        if wall_points(file, wall) == wall:
            unnamed.append((wall, "wall", name))
        else:
            yield (*wall, "name"), "wall", name
    yield from unnamed


def check_landmarks(file: Sound) -> Iterator[Mistake]:
    """Two landmarks that no sensor could tell apart."""
    seen: dict[int, int] = {}
    for index in range(file.count("landmarks")):
        path = ("landmarks", index, "id")
        number = file.value(*path)
        if number in seen:
            line = file.root.nearest(("landmarks", seen[number], "id")).mark[0]
            yield file.mistake(
                path,
                f"{number} is already the id of the landmark on line {line}",
                "choose another id",
            )
        elif number is not None:
            seen[number] = index


def check_missing(file: Sound) -> Iterator[Mistake]:
    """Obstacles and walls that the filter cannot lack."""
    belief = file.root.at(("belief",))
    for key in ("obstacles", "walls"):
        if belief and belief.get("missing") and belief.get(key):
            wrong = f"belief.{key} lists all that the filter's map holds"
            yield file.mistake(("belief", "missing"), wrong, f"delete either 'missing' or '{key}'")
            return
    given = [name for _, _, name in named(file, ())]
    names = [name for name in given if name is not None]
    known, told = set(names), 0
    if len(names) < len(given) or {("obstacles",), ("walls",)} & file.wrong:
        return
    for index in range(file.count("belief", "missing")):
        path = ("belief", "missing", index)
        name = file.value(*path)
        if name is not None and name not in known:
            near = nearest(name, names) if told < MOST_TOLD else ""
            one, all_of_them = WALLED if file.count("walls") else UNWALLED
            right = (
                f"did you mean {quoted(near)}?"
                if near
                else f"the {all_of_them} are: {some(names) or 'none'}"
            )
            yield file.mistake(path, f"no {one} is named {quoted(name)}", right)
            told += 1


def check_unknown_start(file: Sound) -> Iterator[Mistake]:
    """No idea of the start where it can be none."""
    if file.value("belief", "start") != "unknown":
        return
    where, belief = ("belief", "start"), file.root.at(("belief",))
    if (file.value("system") or "classroom") != "classroom":
        yield file.mistake(where, "'unknown' belongs to the classroom", "write a pose")
    elif belief and belief.at(("sigma",)):
        wrong = "nobody is sure to a sigma of a start that is unknown"
        yield file.mistake(("belief", "sigma"), wrong, "delete either")
    elif not (file.root.at(("boundary",)) or (belief and belief.at(("boundary",)))):
        right = "add a boundary, or write a pose"
        yield file.mistake(where, "no boundary says where the robot may be", right)
