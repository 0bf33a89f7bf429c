"""What the files of each format hold, for people and programs: JSON, and a page of the docs."""

from collections.abc import Iterable
from typing import Any

from ekfsim.files.logs.tables.declared import Column, Format, Table


def as_json(formats: Iterable[Format]) -> dict[str, Any]:
    """The formats by their names: files, columns, units, examples."""
    return {
        format.name: {
            "description": format.told,
            "oneFile": format.alone,
            "notes": list(format.notes),
            "files": [_file(table) for table in format.tables],
        }
        for format in formats
    }


def _file(table: Table) -> dict[str, Any]:
    return {
        "holds": table.what,
        "name": list(table.files),
        "needed": table.needed,
        "firstLineOfNames": table.named,
        "columns": [
            {
                "name": column.name,
                "unit": column.unit,
                "holds": column.told,
                "alsoCalled": list(column.also),
                "column": place + 1,
                "mayBeNan": column.maybe,
            }
            for place, column in _placed(table)
        ],
        "note": table.told,
        "example": table.example,
    }


def _placed(table: Table) -> list[tuple[int, Column]]:
    """The columns in the order in which they stand in a file without names."""
    return sorted(zip(table.places, table.columns, strict=True), key=lambda one: one[0])


def page(format: Format) -> str:
    """The page of a format, in Markdown."""
    where = "one CSV file, named itself or by its folder" if format.alone else "a folder of files"
    parts = [
        f"# Logs of the format `{format.name}`",
        f"{format.told} The log is {where}:" if format.tables else format.told,
        f"```yaml\n{format.example or _named(format)}```",
        *format.notes,
        *(_section(table) for table in format.tables),
        *_maps(format),
        READ_AS if any(table.columns[0].unit == "s" for table in format.tables) else AS_JSON,
    ]
    return "\n\n".join(parts) + "\n"


def _named(format: Format) -> str:
    return f"recording: {{format: {format.name}, path: ../logs/mine}}\n"


AS_JSON = "`ekfsim schema recording` prints all formats as JSON."
READ_AS = (
    "Commas, semicolons, tabs or blanks may stand between the columns; decimal commas, quotes, a "
    "byte order mark, CRLF, comments after `#` or `%`, other usual names of a column and units in "
    "a name (`t_ns`, `bearing [deg]`) are understood. Stamps in ms, µs or ns and angles in degrees "
    "are found where the numbers leave no doubt, or said: `--set recording.timeUnit=ms`, "
    "`--set recording.angleUnit=degrees`. Whatever is taken for granted is told in a line. "
    f"{AS_JSON}"
)


def _section(table: Table) -> str:
    """One file: its columns, and what it looks like."""
    names = " or ".join(f"`{name}`" for name in table.files)
    needed = "" if table.needed else " (may be absent)"
    rows = [
        "| column | name | in | what it holds |",
        "|---|---|---|---|",
        *(
            f"| {place + 1} | {_names(column)} | {column.unit} | {column.told} |"
            for place, column in _placed(table)
        ),
    ]
    told = f"{table.told}\n\n" if table.told else ""
    order = (
        "The first line names the columns, in any order; others may stand between them."
        if table.named
        else "No line of names is needed; the columns go by their places."
    )
    return (
        f"## {names}: {table.what}{needed}\n\n{told}{order}\n\n"
        + "\n".join(rows)
        + f"\n\n```\n{table.example}```"
    )


def _maps(format: Format) -> list[str]:
    """How files of other make are told of."""
    if not format.maps:
        return []
    told = "## Files of other make\n\nA commands file tells how they are to be read:"
    return [told, *(f"{what}:\n\n```yaml\n{text}```" for what, text in format.maps)]


def _names(column: Column) -> str:
    return " or ".join(f"`{name}`" for name in (column.name, *column.also))


def all_pages(formats: Iterable[Format]) -> str:
    """All pages, one after another."""
    return "\n".join(map(page, formats))
