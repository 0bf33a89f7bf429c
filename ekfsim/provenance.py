"""Which world, commands, seed and version made an output: every output says it."""

from ekfsim.scene import Scene
from ekfsim.version import VERSION


def provenance(scene: Scene) -> dict[str, str | int | float | None]:
    """All that another needs to make the same output again, by name."""
    facts: dict[str, str | int | float | None] = {
        "ekfsim": VERSION,
        "world": scene.world_source,
        "commands": scene.commands_source,
        "filter": ",".join(scene.watching),
        "gate": scene.gate,
        "guard": scene.guard,
        "seed": scene.seed,
        "run": scene.run,
    }
    if scene.log_source is not None:
        facts["log"] = scene.log_source
    if scene.reading != "corrected":
        facts["reading"] = scene.reading
    if scene.settings:
        facts["set"] = " ".join(scene.settings)
    return facts


def told_in_a_line(scene: Scene) -> str:
    """The same for a person."""
    facts = (f"{name} {value}" for name, value in provenance(scene).items() if value is not None)
    return ", ".join(facts)


def metadata(scene: Scene) -> dict[str, str]:
    """The same for the picture formats, whose notes are pairs of texts."""
    return {"Software": f"ekfsim {VERSION}", "Description": told_in_a_line(scene)}
