"""Checking a file of any kind; of a study file also what it makes of the scene that it studies."""

from pathlib import Path

from ekfsim.errors import MOST_TOLD, InputError, Mistake
from ekfsim.files.homework import Homework, check_homework
from ekfsim.files.scenes import load
from ekfsim.files.scenes.load_study import FILTER, SWEEP, read_request
from ekfsim.files.scenes.one_file import Loaded, foreign_in, kind_of
from ekfsim.scene import Scene
from ekfsim.world import World


def check(path: str | Path) -> Loaded[World] | Loaded[Scene] | Loaded[Homework]:
    """All mistakes and warnings of a file of any kind and of the files that it names.

    Raises UsageError where there is no such file.
    """
    try:
        kind = kind_of(path)
    except InputError as error:
        return Loaded[World](mistakes=foreign_in(Path(path), str(path)) or error.mistakes)
    if kind == "homework":
        return check_homework(Path(path))
    return check_study(path) if kind == "study" else load.check(path)


def check_study(path: str | Path) -> Loaded[Scene]:
    """Mistakes of a study file, of its scene, and of each value that it sweeps or compares."""
    found = Loaded[Scene]()
    try:
        request = read_request(str(path))
    except InputError as error:
        return Loaded[Scene](mistakes=error.mistakes)
    if request.excess and (place := request.sweep[0][0].place) is not None:
        return Loaded[Scene](mistakes=[Mistake(place, SWEEP, *request.excess)])
    sides = (tuple(one for one in side if one.key != FILTER) for side in (request.a, request.b))
    for more in ((), *((one,) for values in request.sweep for one in values), *sides):
        settings = request.overruled(more, ()).settings
        try:
            loaded = load.read_scene(
                request.commands, request.world, None, request.reading, settings
            )
        except InputError as error:
            loaded = Loaded[Scene](mistakes=error.mistakes)
        found.mistakes += [mistake for mistake in loaded.mistakes if mistake not in found.mistakes]
        found.warnings += [warning for warning in loaded.warnings if warning not in found.warnings]
        found.value = loaded.value
        # each value takes a whole scene
        if more and more[0].place is not None and len(found.mistakes) >= MOST_TOLD:
            unread = Mistake(
                more[0].place,
                SWEEP,
                "what stands from here on was not looked at",
                "mend the above first",
            )
            found.mistakes[MOST_TOLD - 1 :] = [unread]
            break
    return found
