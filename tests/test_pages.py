"""What pages of docs/ repeat of the program is what it says, and their links lead somewhere."""

import json
import re
from pathlib import Path

import click
import pytest

from ekfsim.cli import ekfsim
from ekfsim.views.terminal.driving.help import HELP as DRIVEN
from ekfsim.views.terminal.keys.help import HELP as PLAYED

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES += sorted((ROOT / "docs").rglob("*.ipynb"))
COMMANDS = (ROOT / "docs/reference/commands.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(("name", "keys"), [("play", PLAYED), ("drive", DRIVEN)])
def test_the_keys_are_those_of_the_help(name, keys):
    (shown,) = re.findall(rf"<!-- {name} -->\n```\n(.*?)```\n<!-- end -->", COMMANDS, re.DOTALL)
    assert shown.strip() == keys.strip()


def test_every_command_has_its_row_and_every_option_in_it_is_one():
    rows = dict(re.findall(r"^\| `ekfsim (\w+)[^`]*` (.*)$", COMMANDS, re.MULTILINE))
    assert sorted(rows) == sorted(ekfsim.commands)
    for name, row in rows.items():
        options = {
            option
            for parameter in ekfsim.commands[name].params
            if isinstance(parameter, click.Option)
            for option in parameter.opts
        }
        assert set(re.findall(r"`(--?[a-z]+)", row)) <= options


def test_the_summary_of_every_command_fits_eighty_columns():
    room = 80 - 2 - 6 - max(map(len, ekfsim.commands))  # as click lays them out
    for command in ekfsim.commands.values():
        assert len(command.get_short_help_str(200)) <= room


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 160


def slug(title):
    """The anchor that GitHub gives a heading."""
    return re.sub(r"[^\w -]", "", title.strip().lower()).replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_of_a_page_leads_somewhere(page):
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".ipynb":
        text = "\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"])
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"https?://", link):
            continue
        path, _, anchor = link.partition("#")
        place = page.parent / path if path else page
        assert place.exists(), link
        if anchor:
            titles = re.findall(r"^#+ (.*)$", place.read_text(encoding="utf-8"), re.MULTILINE)
            assert anchor in map(slug, titles), link


def test_no_folder_of_pages_is_crowded():
    folders = [ROOT / "docs", *(path for path in (ROOT / "docs").iterdir() if path.is_dir())]
    assert all(len([*folder.glob("*.md")]) <= 12 for folder in folders)
