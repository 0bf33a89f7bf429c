"""What a command line asks for → the scenes that are played, and where a study's runs are made."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ekfsim.cli.program.process import say, warn
from ekfsim.errors import UsageError

if TYPE_CHECKING:
    from ekfsim.files.given.given import Given
    from ekfsim.scene import Scene
    from ekfsim.study.running.engines import Engine
    from ekfsim.systems.document import DocumentReading


def scene_of(
    commands: "str | Given", world: str | None = None, seed: int | None = None, run_number: int = 0,
    filter_name: str | None = None, gate: float | Literal["off"] | None = None,
    guard: str | None = None,
    log: str | None = None, reading: str = "corrected", settings: tuple[str, ...] = (),
    particles: int | None = None, hypotheses: int | None = None, smooth: bool = False,
) -> "Scene":  # fmt: skip
    """The scene of a commands file, or of what one would hold, overruled by the options that were
    given.
    filter_name : one, or several: ekf,ukf; smooth : beside each, the same smoothed
    """
    from dataclasses import replace
    from typing import cast

    from ekfsim.files.packaged import resolve
    from ekfsim.files.scenes.checking.filter_checks import refuse_unread
    from ekfsim.files.scenes.load import read_scene
    from ekfsim.files.scenes.settings import filters_in, numbers_of, setting
    from ekfsim.filters.place import with_smoothed

    names = () if filter_name is None else filters_in(filter_name)
    world_file = None if world is None else resolve(world, "worlds")
    read = resolve(commands, "commands") if isinstance(commands, str) else commands
    overruling = [*(setting(text) for text in settings), *numbers_of(particles, hypotheses)]
    found = read_scene(read, world_file, log, cast("DocumentReading", reading), overruling)
    scene = found.get()
    warn(found.warnings)
    names = names or (scene.filter,)
    names = with_smoothed(names) if smooth else names
    refuse_unread(overruling, names)
    if gate == "off":
        scene, gate = replace(scene, gate=None), None
    chosen: dict[str, Any] = {"seed": seed, "run": run_number, "gate": gate, "guard": guard}
    chosen |= {"filter": names[0], "beside": names[1:]}
    return replace(scene, **{name: value for name, value in chosen.items() if value is not None})


def scene_of_place(place: str, out: Path, world: str | None, **chosen: Any) -> "Scene":
    """The scene of a commands file, or that of a world in which nothing has been done yet.

    out : how messages name the commands that are still to be made
    """
    from ekfsim.files.given.given import Given
    from ekfsim.files.packaged import packaged, resolve
    from ekfsim.files.scenes.one_file import kind_of_tree
    from ekfsim.files.source import as_written
    from ekfsim.files.yaml.parsing import parse

    path = resolve(place, "commands" if place in packaged("commands") else "worlds")
    root, _ = parse(as_written(path, str(path)), str(path))
    if kind_of_tree(root) != "world":
        return scene_of(str(path), world, **chosen)
    if world is not None:
        raise UsageError(f"--world: {place} is a world itself; leave this out")
    nothing_yet = Given.values({"commands": []}, str(out))
    return scene_of(nothing_yet, str(path), **chosen)


def files_of(commands: str, scene: "Scene") -> "tuple[Path, ...]":
    """The files that people write of which a scene was made: commands, world, filters."""
    from ekfsim.files.packaged import resolve
    from ekfsim.filters.place import is_file, parts

    own = [Path(parts(name)[0]) for name in (scene.filter, *scene.beside) if is_file(name)]
    world = [] if scene.world_file is None else [scene.world_file]
    return resolve(commands, "commands"), *world, *own


def engine_of(workers: int, address: str | None) -> "Engine":
    """Where the blocks of a study run. Raises UsageError where two places are named."""
    from ekfsim.study.running import engines

    if address is not None:
        if workers > 1:
            raise UsageError("--workers: a cluster has its own; leave this out, or --cluster")
        from ekfsim.study.running.cluster import cluster

        return cluster(address, say)
    return engines.serial if workers == 1 else engines.pool(workers)
