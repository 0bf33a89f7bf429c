"""The command that fits noises to a log: tune."""

import sys
from pathlib import Path
from typing import Any

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result
from ekfsim.cli.program.options import FORCE, scene_options
from ekfsim.cli.program.process import heed, shown, width
from ekfsim.errors import UsageError
from ekfsim.printable import in_a_line


@click.command(short_help="Fit the noises that a filter is told of to a log.")
@scene_options
@click.option(
    "--out", "-o", type=Result(), required=True,
    help="The commands file to write, tuned.yaml: beside it tuned-world.yaml, with the numbers, "
    "and tuned.png.",
)  # fmt: skip
@click.option(
    "--fit", "keys", metavar="KEY,…",
    help="Which numbers, e.g. sensors.gnss.sigma,robot.turnDensity; all that the log depends on "
    "where left out.",
)  # fmt: skip
@FORCE
def tune(out: Path, keys: str | None, force: bool, confidence: float, **chosen: Any) -> None:
    """Fit the noises that the filter of COMMANDS is told of to its log: ratios, standard deviations
    and densities that make the log's innovations most likely.

    The first half of the readings is fitted to, the second half is held back and says how the
    filter does with the numbers, as it was told and as fitted. Where it does clearly worse, the
    files keep the numbers that were told. Without a log it is the simulated run.
    """
    from ekfsim.views.picture.look import get_ready

    get_ready()
    from ekfsim.files.packaged import resolve
    from ekfsim.files.results.outputs import refuse_the_scene_itself
    from ekfsim.files.results.writing import refuse_existing, whole_file, whole_text
    from ekfsim.files.scenes.settings import numbers_of, setting
    from ekfsim.fitting.trial import tried
    from ekfsim.fitting.written import commands_text, is_recorded, world_text
    from ekfsim.views.fitting.picture import picture, told
    from ekfsim.views.fitting.words import conclude
    from ekfsim.views.study.sheet import save

    if out.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError(f"{out}: a commands file is written; name it e.g. tuned.yaml")
    world, image = out.with_name(f"{out.stem}-world.yaml"), out.with_suffix(".png")
    for file in (out, world, image):
        refuse_existing(file, force)
    scene = scene_of(**chosen)
    for file in (out, world, image):
        refuse_the_scene_itself(file, scene)
    if scene.beside:
        raise UsageError("--filter: numbers are fitted for one filter; name one")
    numbers = numbers_of(chosen["particles"], chosen["hypotheses"])
    settings = [*map(setting, chosen["settings"]), *numbers]
    hidden = not sys.stderr.isatty()
    with click.progressbar(length=200, label="trials", file=sys.stderr, hidden=hidden) as bar:

        def heard(trials: int) -> None:
            heed()
            bar.update(trials)

        trial = tried(scene, tuple(keys.split(",")) if keys else (), heard)
    given: Any = trial.scene.log.given if trial.scene.log is not None else None
    recording = given.recording if is_recorded(trial) else None
    commands = resolve(chosen["commands"], "commands")
    as_world = world_text(trial, settings)
    as_commands = commands_text(trial, commands, world.name, out, settings, recording)
    with (
        whole_text(world, force) as of_world,
        whole_text(out, force) as of_commands,
        whole_file(image, force) as of_picture,
    ):
        of_world.write(as_world)
        of_commands.write(as_commands)
        save(picture(trial), of_picture, told(trial))
    click.echo(shown(conclude(trial, width())), nl=False)
    which = "those that were told" if trial.is_worse else "these numbers"
    click.echo(in_a_line(f"{out}: ekfsim run {out} plays it with {which}, of {world}"))
