"""What is declared of each format is what its reader reads, its page shows and its schema tells."""

import json
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner
from log_worlds import CLOSET, MARKS, PYLON, lay, world

from ekfsim.cli import ekfsim
from ekfsim.files.keys.recorded.recording import RecordingKeys
from ekfsim.files.logs import DECLARED, FORMATS, read_log
from ekfsim.files.logs.tables.telling import page
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_world
from ekfsim.records import Control, Reading
from ekfsim.systems.instruments import RangeBearings

PAGES = Path(__file__).parents[3] / "docs/reference/logs"
WORLDS = {
    "log": lambda: world("mrclam", instruments=(RangeBearings(),)),
    "pylon": lambda: world("pylon", PYLON),
    "mower": lambda: world("mower", MARKS),
    "pioneer": lambda: world("pioneer", floor=CLOSET),
    "classroom": lambda: load_world("hall"),
}


def written(folder, format):
    """The example rows of a page as files."""
    names = [table.files[0].replace("*", "1") for table in format.tables]
    files = dict(zip(names, (table.example for table in format.tables), strict=True))
    if format.name == "classroom":
        files["world.yaml"] = packaged("worlds")["hall"].read_text(encoding="utf-8")
    return lay(folder, **files)


@pytest.mark.parametrize("name", [name for name in DECLARED if DECLARED[name].tables])
def test_the_rows_of_a_page_are_read_without_a_word(tmp_path, name):
    place = WORLDS.get(name, lambda: world(name))()
    folder = written(tmp_path / "log", DECLARED[name])
    found = read_log(RecordingKeys(format=name), folder, place, "corrected")
    odd = [told for told in found.warnings if "did not see the pylon" not in told]
    assert [told for told in odd if "tells where it starts" not in told] == []
    given = [entry.given for entry in found.log.entries]
    moves = sum(isinstance(one, Control) for one in given)
    readings = sum(isinstance(one, Reading) for one in given)
    assert moves >= 2
    assert readings >= 3


@pytest.mark.parametrize("name", DECLARED)
def test_the_page_of_a_format_is_what_is_declared_of_it(name):
    assert (PAGES / f"{name}.md").read_text(encoding="utf-8") == page(DECLARED[name])
    for table in DECLARED[name].tables:
        rows = table.example.splitlines()[table.named :]
        assert len(rows) == 5, table.what
        if table.named:
            assert {column.name for column in table.columns} == set(
                table.example.splitlines()[0].split(",")
            )


def test_the_maps_of_a_page_are_recordings():
    for what, text in DECLARED["log"].maps:
        keys = yaml.safe_load(text)["recording"]
        assert RecordingKeys.model_validate(keys).format == "log", what


def test_every_format_is_declared_and_told_as_json_and_as_pages():
    assert DECLARED.keys() == FORMATS.keys()
    run = CliRunner().invoke
    told = json.loads(run(ekfsim, ["schema", "recording"]).output)
    assert told.keys() == FORMATS.keys()
    columns = {one["name"]: one for one in told["gnss"]["files"][0]["columns"]}
    assert columns["vl"]["unit"] == "m/s"
    assert columns["t"]["alsoCalled"] == ["time"]
    assert told["pylon"]["oneFile"]
    pages = run(ekfsim, ["schema", "recording", "--markdown"]).output
    assert pages.count("# Logs of the format") == len(FORMATS)
