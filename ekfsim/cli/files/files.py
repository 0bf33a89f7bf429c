"""The commands that look at files and make them: check, schema, list, show, new, figures."""

import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ekfsim.cli.program.asked import scene_of
from ekfsim.cli.program.kinds import Result, Seed, Source, Word
from ekfsim.cli.program.options import DOCUMENTS, FORCE, PLAIN, READING
from ekfsim.cli.program.process import say, shown, warn, width
from ekfsim.errors import MOST_TOLD, EkfsimError, Mistake, UsageError, told
from ekfsim.printable import in_a_line

if TYPE_CHECKING:
    from ekfsim.files.packaged import Folder

KINDS = ("world", "commands", "homework", "filter")  # of files to start from
# in the name of a file, and what it then is
WORDS = {"world": "world", "command": "commands", "homework": "homework"}

MORE = "ekfsim list GROUP ({}), NAME, or --all tells more"  # than is listed


@click.command(short_help="Validate FILES: every mistake with its place, or ok.")
@click.argument("files", nargs=-1, required=True)
def check(files: tuple[str, ...]) -> None:
    """Validate world and command FILES, and filters of your own: every mistake with its place,
    or `ok`.
    """
    from ekfsim.files.maps.reading import plan_in
    from ekfsim.files.packaged import packaged, resolve
    from ekfsim.files.scenes.check_study import check as mistakes_in
    from ekfsim.filters.place import is_place

    # of a world that other files name, too, told once
    status, before, warned = 0, set[Mistake](), set[str]()
    for file in files:
        if is_place(file):
            status = max(status, _check_filter(file))
            continue
        if (plan := plan_in(Path(file), file)) is not None:
            say(plan)
            status = UsageError.status
            continue
        try:
            found = mistakes_in(
                resolve(file, "worlds" if file in packaged("worlds") else "commands")
            )
        except UsageError as missing:
            say(str(missing))
            status = UsageError.status
            continue
        new = [
            mistake
            for mistake in found.mistakes
            if not before or mistake.placed_alike not in before
        ]
        odd = (warning for warning in found.warnings if warning not in warned)
        warn(odd, MOST_TOLD - len(told(new)))  # together no more than anybody reads
        warned.update(found.warnings)
        if len(files) > 1:
            before.update(mistake.placed_alike for mistake in new)
        all_told = in_a_line(
            f"{file}: {'what is wrong with it is told above' if found.mistakes else 'ok'}"
        )
        click.echo("\n".join(told(new)) or all_told)
        status = UsageError.status if found.mistakes else status
    if status:
        sys.exit(status)


def _check_filter(place: str) -> int:
    """Say what is found of a filter of one's own, or what is wrong with it; the status of that."""
    from ekfsim.filters.place import absolute
    from ekfsim.student.own.choice import quietly
    from ekfsim.student.own.forms import told as found

    try:
        form = quietly(absolute(place)).form
    except EkfsimError as wrong:
        say(str(wrong))
        return wrong.status
    click.echo(in_a_line(f"{place}: ok: {found(form)}"))
    return 0


@click.command(short_help="Print the JSON Schema by which editors check a file.")
@click.argument("kind", type=Word(["world", "commands", "study", "homework", "recording"]))
@click.option("--markdown", is_flag=True, help="Tables of all keys, for people to read.")
def schema(kind: str, markdown: bool) -> None:
    """Print the JSON Schema from which editors complete and check a world,
    commands, study or homework file; of a recording the files and columns of each format of logs.
    """
    from typing import cast

    from ekfsim.files.yaml.reference import reference
    from ekfsim.files.yaml.schema import Kind, json_schema

    if kind == "recording":
        from ekfsim.files.logs import DECLARED
        from ekfsim.files.logs.tables.telling import all_pages, as_json

        formats = DECLARED.values()
        click.echo(all_pages(formats) if markdown else _json(as_json(formats)), nl=not markdown)
        return
    asked = cast("Kind", kind)
    if markdown:
        click.echo(reference(asked), nl=False)
        return
    click.echo(_json(json_schema(asked)))


def _json(value: object) -> str:
    """As a person may read it."""
    import json

    return json.dumps(value, indent=2, ensure_ascii=False)


@click.command("list", short_help="List what comes along, or all that is said of NAME.")
@click.argument("name", required=False)
@click.option("--all", "all_told", is_flag=True, help="What each of the commands is for.")
@click.option("--worlds", is_flag=True, help="The worlds in place of the commands.")
def list_packaged(name: str | None, all_told: bool, worlds: bool) -> None:
    """List the commands that come along, or the worlds; with NAME, all that is said of that one, or
    what each of a group is for: start, proofs, divergence, systems or logs.
    """
    from ekfsim.files.packaged import described, grouped, kind_of, packaged, resolve

    groups = {group.name: group for group in grouped()}
    if name in groups and not worlds:
        return _tell_group(groups[name].title, groups[name].files)
    if name is not None:
        kind: Folder = "worlds" if worlds else kind_of(name)
        click.echo(
            shown(described(resolve(name, kind)) or in_a_line(f"{name}: has no description"))
        )
        return
    if worlds:
        return _tell_group("worlds", packaged("worlds"))
    for group in groups.values():
        if all_told or group.name == "start":
            _tell_group(group.title, group.files)
        else:
            click.echo(f"{group.title}:")
            click.echo(
                textwrap.fill(
                    "  ".join(group.files), width() or 80, initial_indent="  ",
                    subsequent_indent="  ", break_on_hyphens=False, break_long_words=False,
                )
            )  # fmt: skip
    if not all_told:
        click.echo(MORE.format(", ".join([*groups][1:])))


def _tell_group(title: str, files: "dict[str, Path]") -> None:
    """What each of some files is for."""
    from ekfsim.files.packaged import description_of

    click.echo(f"{title}:")
    for one, path in files.items():
        click.echo(f"  {one:{max(map(len, files))}}  {description_of(path)}")


@click.command(short_help="Print a file that comes along, or copy it.")
@click.argument("name")
@click.option("--world", is_flag=True, help="The world that NAME names, if it is a commands file.")
@click.option("--out", "-o", type=Result(), metavar="FILE", help="Copy it to FILE.")
@FORCE
def show(name: str, world: bool, out: Path | None, force: bool) -> None:
    """Print the file NAME, commands or a world that come along, as it stands; or copy it.

    A copy is the same to the last character. `ekfsim new FILE --from NAME` makes one of a commands
    file that plays from where it lies.
    """
    from ekfsim.files.packaged import kind_of, packaged, resolve, source_name, world_of
    from ekfsim.files.results.writing import whole_text
    from ekfsim.files.source import as_written

    kind = kind_of(name)
    path = resolve(name, kind)
    if world and kind == "commands":
        path = world_of(path)
    text = as_written(path, source_name(path))
    if out is None:
        click.echo(shown(text), nl=False)
        return
    with whole_text(out, force) as file:
        file.write(text)
    plays = f"; ekfsim new FILE --from {name} makes one that plays from where it lies"
    copied = f"{out}: a copy of {source_name(path)}"
    click.echo(in_a_line(copied + plays if path == packaged("commands").get(name) else copied))


@click.command(short_help="Write a commented file to start from, or a copy of one.")
@click.argument("file", type=Result())
@click.option("--kind", type=Word(KINDS), help="Where the name of FILE does not tell.")
@click.option(
    "--complete", is_flag=True, help="Of a filter: with its equations, in place of what is open."
)
@click.option("--from", "model", metavar="NAME", help="A copy of commands that come along.")
@FORCE
def new(file: Path, kind: str | None, complete: bool, model: str | None, force: bool) -> None:
    """Write a commented world, commands, filter or homework FILE to start from; or, with --from, a
    copy of a commands file that comes along, which plays from where it lies.
    """
    from typing import cast

    from ekfsim.files.results.writing import whole_text
    from ekfsim.files.template import Kind, starting_from, template

    if model is not None:
        if kind is not None or complete:
            other = "--complete" if complete else "--kind"
            raise UsageError(f"{other} and --from: a copy is of the kind that it is copied from")
        if file.suffix == ".py":
            raise UsageError(
                f"{file}: a copy of commands is no filter; name it e.g. {file.stem}.yaml"
            )
        text = starting_from(model, file)
        with whole_text(file, force) as out:
            out.write(text)
        click.echo(in_a_line(f"{file}: a copy of {model}; ekfsim play {file} steps through it"))
        return
    told = kind or kind_told(file)
    if complete and told != "filter":
        raise UsageError(f"{file}: --complete is of a filter; leave it out, or say --kind filter")
    with whole_text(file, force) as out:
        out.write(template(cast("Kind", f"{told}-complete" if complete else told)))
    if told != "filter":
        way = f"ekfsim check {file} validates it"
    elif file.suffix == ".py":
        way = f"ekfsim play tour --filter {file} plays it"
    else:
        way = "it is played under a name that ends in .py"
    click.echo(in_a_line(f"{file}: a {told} file to start from; {way}"))


def kind_told(file: Path) -> str:
    """What a file is to be, by its name. Raises UsageError where that does not tell."""
    if file.suffix.lower() == ".py":
        return "filter"
    told = [kind for word, kind in WORDS.items() if word in file.stem.lower()]
    if len(told) != 1:
        raise UsageError(
            f"{file}: a world, commands, a homework or a filter? say --kind world, "
            "--kind commands, --kind homework or --kind filter"
        )
    return told[0]


@click.command(epilog=DOCUMENTS, short_help="Draw the figures and tables of a document.")
@click.argument("name", type=Word(["classroom", "mower", "pioneer", "gnss", "pylon", "gallery"]))
@click.option(
    "--out",
    "-o",
    type=Result(),
    required=True,
    help="A folder for the figures, tables and captions.md.",
)
@click.option("--format", "formats", type=Word(["png", "svg", "pdf"]), multiple=True,
    default=("png",),
              show_default=True, help="May be given several times.")  # fmt: skip
@click.option(
    "--log", type=Source(), metavar="PATH", help="A recorded log in place of the simulated twin."
)
@READING
@click.option("--seed", type=Seed(), help="In place of the scene's seed.")
@PLAIN
@FORCE
def figures(
    name: str,
    out: Path,
    formats: tuple[str, ...],
    log: str | None,
    reading: str,
    seed: int | None,
    force: bool,
) -> None:
    """Draw every figure and table of one of the five documents, with captions; or, of gallery, the
    table of the scenarios that diverge, as they stand and cured. `ekfsim gallery` shows them all.
    """
    from ekfsim.views.picture.look import get_ready

    get_ready()
    from ekfsim.figures import draw_figures

    simulated = {"classroom": "tour", "gallery": "diverge-00-control"}.get(name)
    if simulated and log is not None:
        raise UsageError(f"--log: the figures of '{name}' are of simulated runs; leave this out")
    commands = simulated or (name if log is None else f"{name}_log")
    scene = scene_of(commands, log=log, reading=reading, seed=seed)
    written = draw_figures(name, scene, out, formats, force)
    click.echo(in_a_line(f"{out}: {len(written)} files, read captions.md first"))
