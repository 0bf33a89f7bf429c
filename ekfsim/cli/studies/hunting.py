"""The command that looks for an input which brings a filter down: hunt."""

import shlex
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ekfsim.cli.program.asked import scene_of_place
from ekfsim.cli.program.kinds import Metres, Pace, Result, Share, Whole, Word
from ekfsim.cli.program.options import (
    FAST,
    FORCE,
    GATE,
    GUARD,
    HYPOTHESES,
    MOST_RUNS,
    PARTICLES,
    PLAIN,
    SEED,
    SET,
    WORLD,
    with_options,
)  # fmt: skip
from ekfsim.cli.program.process import heed, part_with, shown, warn, width
from ekfsim.errors import RunError, UsageError
from ekfsim.filters.place import forward, label

if TYPE_CHECKING:
    from ekfsim.hunting.hunt import Asked
    from ekfsim.hunting.search import Search
    from ekfsim.scene import Scene

GOALS = ("lost", "silent", "apart", "numbers")  # told here again, so that --help need not load them
MOST_LISTS, MOST_MOVES = 10**8, 100
OPTIONS = (
    click.argument("place", metavar="WORLD|COMMANDS"),
    WORLD,
    SEED,
    click.option(
        "--for", "--filter", "hunted", metavar="NAME[,NAME]",
        help="The filter that is hunted, in place of the file's: see play. Of one of your own the "
        "first wrong number is found; of two, where the first is lost and the second is not.",
    ),
    click.option(
        "--goal", type=Word(GOALS),
        help="lost: as many runs as may be; silent: lost, and no NIS that tells it; apart: lost "
        "under the first of two filters and not under the second; numbers: the shortest input at "
        "which it has other numbers than a second filter, or ekf, on the same belief.",
    ),
    click.option(
        "--change", type=Word(("commands", "start", "told")), default="commands",
        show_default=True,
        help="What is looked for: a list of commands; a start for those of COMMANDS; or the "
        "smallest change of one told number at which enough of their runs are lost.",
    ),
    click.option(
        "--off", type=Metres(), default=0.1, show_default=True, metavar="METRES",
        help="A run counts as lost where its estimate is farther from the truth, too.",
    ),
    click.option(
        "--moves", type=Whole(1, MOST_MOVES), default=8, show_default=True, metavar="N",
        help="How many commands at most, moves and senses.",
    ),
    click.option(
        "--lists", type=Whole(1, MOST_LISTS), default=4000, show_default=True, metavar="N",
        help="How many lists of commands are looked at: the same seed and as many lists find the "
        "same on any machine.",
    ),
    click.option(
        "--budget", "seconds", type=Pace(), default=60.0, show_default=True, metavar="SECONDS",
        help="Where the search ends, whatever is left; what was found until then is told.",
    ),
    click.option(
        "--enough", type=Share(), metavar="SHARE",
        help="Be content with that share of runs, and shrink as far as it holds: 0.5.",
    ),
    click.option(
        "--runs", type=Whole(1, MOST_RUNS), default=1000, show_default=True, metavar="N",
        help="Runs behind what is told, of a seed that the search has not seen.",
    ),
    SET,
    PARTICLES,
    HYPOTHESES,
    GATE,
    GUARD,
    click.option(
        "--workers", type=Whole(1, 1024), default=1, show_default=True, metavar="N",
        help="Processes on this machine.",
    ),
    FAST,
    PLAIN,
    click.option(
        "--out", "-o", type=Result(), default=Path("hunt.yaml"), show_default=True,
        help="The commands file to write; where the world is another than any file holds, beside "
        "it hunt-world.yaml.",
    ),
    FORCE,
)  # fmt: skip


def hunt_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a hunt: where, for whom, for what, how long."""
    return with_options(command, OPTIONS)


@click.command(short_help="Look for a short list of commands that brings a filter down.")
@hunt_options
def hunt(place: str, out: Path, force: bool, fast: bool, **asked: Any) -> None:
    """Look for a short list of moves and senses in WORLD, or by changing those of COMMANDS, at
    which a filter is lost most often, though all that it is told is true; shrink it, measure it
    with draws that the search has not seen, and write it with what it promises. Or look for a
    start, or for the smallest change of one told number, by which COMMANDS do it (--change).

    Ctrl-C ends the search, and what was found until then is written.
    """
    from ekfsim.hunting.hunt import hunt as hunted_by
    from ekfsim.hunting.written import Told, refuse_place, write
    from ekfsim.views.hunting.words import conclude, description, interrupted

    part_with()
    refuse_place(out, force)
    task = _asked(place, out, fast, **asked)
    if task.goal == "numbers":
        return _expose(task, out, force)
    with _rounds_bar(task.lists, task.seconds) as heard:
        found = hunted_by(task, heard, heed)
    repeated = _repeating(found.search.looked_at or None, task.scene.seed)
    told = Told(description(found), repeated, f"`ekfsim study {out.name} --expect` confirms it")
    files = write(found.scene, told, task.scene.world, out, force)
    if found.end == "interrupted":
        part_with(interrupted(found, out))
        heed()
    click.echo(shown(conclude(found, files, repeated, width())), nl=False)


def _expose(task: "Asked", out: Path, force: bool) -> None:
    """The shortest input at which a filter has other numbers than the one that is right."""
    from ekfsim.hunting.exposing import exposure
    from ekfsim.hunting.hunt import begun_with, promised
    from ekfsim.hunting.written import Told, write
    from ekfsim.views.hunting.exposing import conclude, headline, held

    against = task.against or "ekf"
    end = time.monotonic() + task.seconds
    found = exposure(
        task.scene, against, task.moves, begun_with(task), heed, lambda: time.monotonic() < end
    )
    if found is None:
        within = "" if time.monotonic() < end else f" in the {task.seconds:g} s of --budget"
        raise RunError(
            f"{label(task.scene.filter)}: has the numbers of {label(against)} in every list that "
            f"was tried{within}; --goal apart looks where it is lost more often"
        )
    repeated = _repeating(None, task.scene.seed)
    told = Told(headline(found, against), repeated, held(found, against, Path(out.name)))
    scene = replace(found.scene, expect=promised(found.scene, task.runs))
    files = write(scene, told, task.scene.world, out, force)
    click.echo(shown(conclude(found, against, files, width())), nl=False)


def _asked(
    place: str, out: Path, fast: bool, world: str | None, hunted: str | None, goal: str | None,
    settings: tuple[str, ...], seed: int | None, particles: int | None,
    hypotheses: int | None, gate: Any, guard: str | None, **numbers: Any,
) -> "Asked":  # fmt: skip
    """What is hunted for. Raises UsageError or InputError where that is nothing."""
    from ekfsim.hunting.hunt import Asked
    from ekfsim.student.comparing.sides import comparable
    from ekfsim.study.running.whole_runs import by_parts
    from ekfsim.twins import compiles, taken

    if fast and not compiles():
        raise UsageError("--fast needs Numba; install it with: pip install 'ekfsim[fast]'")
    scene = scene_of_place(
        place, out, world, seed=seed, filter_name=hunted, settings=settings,
        particles=particles, hypotheses=hypotheses, gate=gate, guard=guard,
    )  # fmt: skip
    if not scene.commanded or scene.log is not None:
        raise UsageError(f"{place}: only the classroom's robot obeys commands; hunt in a room")
    if len(scene.beside) > 1 or (scene.beside and goal in ("lost", "silent")):
        raise UsageError(f"--for {hunted}: --goal apart and numbers take two filters, no other")
    against = scene.beside[0] if scene.beside else None
    chosen: Any = goal or _usual(scene, numbers["change"])
    if chosen == "apart" and against is None:
        against = "ekf" if scene.filter != "ekf" else None
    if chosen == "apart" and against is None:
        raise UsageError(f"--goal apart: name two filters, e.g. --for {scene.filter},iekf")
    if chosen == "apart" and forward(str(against)) == forward(scene.filter):
        raise UsageError(f"--for {hunted}: both believe the same at the end; name two filters")
    if chosen == "numbers":
        for name in (scene.filter, against or "ekf"):
            comparable(name, "--for")
    way = "compiled" if fast else taken()
    if numbers["change"] != "commands" and (not scene.commands or chosen == "numbers"):
        what = f"--change {numbers['change']}"
        raise UsageError(f"{what}: name COMMANDS that are to be lost, and no --goal numbers")
    plain = replace(scene, beside=())
    if fast:
        watching = {scene.filter, *([against] if against else [])}
        warn(by_parts(replace(plain, filter=name) for name in sorted(watching)))
    return Asked(plain, goal=chosen, against=against, way=way, **numbers)


def _usual(scene: "Scene", change: str) -> str:
    """What is looked for where nobody says: of a filter of one's own the first wrong number, unless
    something else than commands is looked for.
    """
    from ekfsim.filters.place import is_place

    if is_place(scene.filter) and change == "commands":
        return "numbers"
    return "apart" if scene.beside else "lost"


def _repeating(lists: int | None, seed: int) -> str:
    """The command line that finds the same again: a count of lists, and no clock."""
    ctx = click.get_current_context()
    words, elsewhere = list[str](), ("lists", "seed", "seconds", "workers", "out", "force", "fast")
    for one in ctx.command.params:
        value = ctx.params.get(str(one.name))
        if one.name in elsewhere or value in (None, (), False) or not one.opts[0].startswith("-"):
            continue
        if value != one.get_default(ctx):
            for each in value if isinstance(value, tuple) else (value,):
                words += [one.opts[0], str(each)]
    found = ["ekfsim", "hunt", ctx.params["place"], "--seed", str(seed)]
    found += [] if lists is None else ["--lists", str(lists)]
    return shlex.join([*found, *words])


@contextmanager
def _rounds_bar(lists: int, seconds: float) -> "Iterator[Callable[[Search], None]]":
    """A bar of the lists that were looked at or of the time that is over, whichever ends first,
    with the share of runs of the best so far; no wider than 80 columns.
    """
    begin = time.monotonic()
    with click.progressbar(
        length=1000, label="search", file=sys.stderr, hidden=not sys.stderr.isatty(), width=20,
        item_show_func=lambda told: told,
    ) as bar:  # fmt: skip

        def heard(search: "Search") -> None:
            best = search.best[0]
            told = f"best {100 * best.count.share:.3g} % by {best.variant.size} commands"
            over = max(search.looked_at / lists, (time.monotonic() - begin) / seconds)
            bar.update(round(1000 * min(over, 1)) - bar.pos, told)
            heed()

        yield heard
