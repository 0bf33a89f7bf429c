"""What a command line asks for → the scenes that are played, and where a study's runs are made."""

from typing import TYPE_CHECKING, Any

from ekfsim.errors import UsageError
from ekfsim.process import say, shown

if TYPE_CHECKING:
    from ekfsim.scene import Scene
    from ekfsim.study.engines import Engine
    from ekfsim.systems.document import DocumentReading


def scenes_of(filter_name: str | None = None, **chosen: Any) -> "tuple[Scene, ...]":
    """The same scene for each of the filters that watch it: --filter ekf,ukf. The first is the one that is told of."""
    from dataclasses import replace

    from ekfsim.files.settings import filters_in

    names = (None,) if filter_name is None else filters_in(filter_name)
    first = scene_of(filter_name=names[0], **chosen)
    return (first, *(replace(first, filter=name) for name in names[1:] if name is not None))


def scene_of(
    commands: str, world: str | None = None, seed: int | None = None, run_number: int = 0,
    filter_name: str | None = None, gate: float | None = None, guard: str | None = None, log: str | None = None,
    reading: str = "corrected", settings: tuple[str, ...] = (),
) -> "Scene":  # fmt: skip
    """The scene of a commands file, overruled by the options that were given."""
    from dataclasses import replace
    from typing import cast

    from ekfsim.files.load import read_scene
    from ekfsim.files.packaged import resolve
    from ekfsim.files.settings import setting
    from ekfsim.filters import FILTERS

    if filter_name is not None and filter_name not in FILTERS:
        raise UsageError(f"--filter {filter_name}: there is no such filter; known: {', '.join(FILTERS)}")
    world_file = None if world is None else resolve(world, "worlds")
    overruling = [setting(text) for text in settings]
    found = read_scene(resolve(commands, "commands"), world_file, log, cast("DocumentReading", reading), overruling)
    for warning in found.warnings:
        say(warning)
    scene = found.get()
    chosen: dict[str, Any] = {"seed": seed, "run": run_number, "filter": filter_name, "gate": gate, "guard": guard}
    for name in ("world_source", "commands_source", "log_source"):  # every output holds them, in a line
        source = getattr(scene, name)
        chosen[name] = None if source is None else shown(source).replace("\n", "\\x0a")
    return replace(scene, **{name: value for name, value in chosen.items() if value is not None})


def engine_of(workers: int, address: str | None) -> "Engine":
    """Where the blocks of a study run."""
    from ekfsim.study import engines

    if address is not None:
        from ekfsim.study.cluster import cluster

        return cluster(address, say)
    return engines.serial if workers == 1 else engines.pool(workers)
