"""The gallery as a folder: whole, or absent."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.packaged import LOGS, grouped, packaged, resolve
from ekfsim.files.results.writing import refuse_existing_folder, whole_folder
from ekfsim.files.scenes.load import load_scene
from ekfsim.scene import Scene
from ekfsim.study.plan import Task
from ekfsim.study.running.engines import Engine
from ekfsim.views.gallery.cures import RUNS as CURED
from ekfsim.views.gallery.exhibit import Exhibit, Wing, exhibit
from ekfsim.views.gallery.site import INDEX, site

# that the figures rest on; those of a drive take long
RUNS, RUNS_OF_A_DRIVE = 1000, 200


@dataclass(frozen=True)
class Making:
    """What is done of each scenario, wherever that is: the work of an engine."""

    scenes: Mapping[str, Scene]
    folder: Path
    paged: bool  # whether each has a page, too
    cures: int  # how many runs each cure watches

    def block(self, case: int) -> Callable[[int, int], Exhibit]:
        """What becomes of a scenario: a function of the runs that its figures rest on."""
        name = list(self.scenes)[case]
        return partial(exhibit, name, self.scenes[name], self.folder, self.paged, self.cures)

    def tasks(self) -> list[Task]:
        """One for each. Those that take long come first, and nobody waits for them in the end."""
        runs = [RUNS if scene.commanded else RUNS_OF_A_DRIVE for scene in self.scenes.values()]
        return sorted((Task(case, 0, 0, n) for case, n in enumerate(runs)), key=lambda t: t.runs)


def chosen(names: Sequence[str]) -> list[str]:
    """The scenarios of these names, without any all, in the order in which they hang.

    Raises UsageError where there is no such scenario, or none that can be played without its log.
    """
    known = [name for group in grouped() if group.name != LOGS for name in group.files]
    for name in names:
        if name in packaged("commands") and name not in known:
            raise UsageError(f"{name}: is of a recorded log, which does not come along")
        if name not in known:
            resolve(name, "commands")  # which tells a name that is none
            raise UsageError(f"{name!r}: the gallery is of what comes along; see `ekfsim list`")
    return [name for name in known if not names or name in names]


def write_gallery(
    names: Sequence[str], out: Path, engine: Engine, paged: bool, force: bool, cures: int = CURED,
    done: Callable[[object, object], object] = lambda task, made: None,
) -> list[Wing]:  # fmt: skip
    """Put the pictures of scenarios into a folder, and where it is `paged` their pages and an
    index.html as well; all that is told of them, by groups.

    cures : how many runs of each scenario each cure watches; 0: there is no table of them
    done : called with each task and what was made of it
    Raises UsageError where the folder holds something (without `force`).
    """
    places = [INDEX, *(f"{name}.{ending}" for name in chosen(()) for ending in ("html", "png"))]
    refuse_existing_folder(out, *places, force=force)
    scenes = {name: load_scene(name) for name in names}
    with whole_folder(out, *places, force=force) as folder:
        making, made = Making(scenes, folder.resolve(), paged, cures), dict[str, Exhibit]()
        for task, found in engine(making, making.tasks()):
            made[found.name] = found
            done(task, found)
        groups = (
            (group, [made[name] for name in group.files if name in made]) for group in grouped()
        )
        wings = [Wing(group.name, group.title, shown) for group, shown in groups if shown]
        if paged:
            (folder / INDEX).write_text(site(wings), encoding="utf-8", newline="\n")
    return wings
