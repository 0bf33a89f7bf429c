"""The schema that editors read, and the files to start from."""

import ast
import pkgutil
import re

import pytest
import yaml

import ekfsim.files
from ekfsim.errors import UsageError
from ekfsim.files import packaged as packaged_files
from ekfsim.files.packaged import description_of, packaged, resolve, source_name
from ekfsim.files.scenes.check_study import check
from ekfsim.files.scenes.load import load_scene, load_world
from ekfsim.files.template import template
from ekfsim.files.yaml.schema import json_schema, schema_at, words_of
from ekfsim.filters import FILTERS

KINDS = ["world", "commands", "homework"]


def parts(schema, path=""):
    """Every part of a schema that says what a value may be."""
    yield path, schema
    for name, part in schema.get("$defs", {}).items():
        yield from parts(part, name)
    for key, part in schema.get("properties", {}).items():
        yield from parts(part, f"{path}.{key}")
    if "items" in schema:
        yield from parts(schema["items"], f"{path}[]")


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_is_told_with_its_bounds_and_an_example(kind):
    schema = json_schema(kind)
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert schema["title"] == f"ekfsim {kind}"
    for path, part in parts(schema):
        ways = part.get("anyOf", ())  # to write it; or which of its keys there must be
        assert path == ".filter" or all("required" in way for way in ways), path
        assert part.get("default", 0) is not None, path
        if part.get("type") == "object":
            # a sensor may go by a name of its own
            named = path in ("ToldSensorsKeys", "FaultySensorsKeys")
            assert (part["additionalProperties"] is False) is not named
            for key, value in part["properties"].items():
                assert (
                    value.get("description")
                    or schema["$defs"][value["$ref"].rpartition("/")[2]]["description"]
                )
                assert re.fullmatch("[a-z][A-Za-z]*", key)
        if part.get("type") in ("number", "integer"):
            assert "minimum" in part or "exclusiveMinimum" in part, path
            assert "maximum" in part or "exclusiveMaximum" in part, path
        if (
            "type" in part
            and part is not schema
            and (part["type"] != "object" or part["title"] in ("a command", "a part"))
        ):
            assert part["examples"], path


@pytest.mark.parametrize("kind", [*KINDS, "study"])
def test_no_description_is_broken_into_the_lines_of_the_code(kind):
    schema = json_schema(kind)
    for path, part in parts(schema):
        told = part.get("description", "")
        assert told.count("\n") == (2 if part is schema else 0), path  # what no schema can tell


@pytest.mark.parametrize("kind", KINDS)
def test_every_mapping_has_an_example_where_it_is_used(kind):
    for path, part in parts(json_schema(kind)):
        for key, value in part.get("properties", {}).items():
            assert "examples" in value, f"{path}.{key}"
        if "$ref" in part.get("items", {}):
            assert json_schema(kind)["$defs"][part["items"]["$ref"].rpartition("/")[2]][
                "examples"
            ], path


def test_a_command_is_one_of_five():
    command = schema_at("commands", ("commands", 0))
    assert list(command["properties"]) == ["move", "sense", "repeat", "kidnap", "say"]
    assert (command["minProperties"], command["maxProperties"]) == (1, 1)
    assert schema_at("commands", ("commands", 3, "repeat", "commands", 1)) == command
    assert words_of(schema_at("commands", ("filter",))) == [*FILTERS, "FILE.py"]


def written(kind, folder, text):
    """A template as a file, with the world that it refers to."""
    (folder / "world.yaml").write_text(template("world"))
    path = folder / f"{kind}.yaml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_loads_without_a_mistake_or_a_warning(tmp_path, kind):
    text = template(kind)
    assert text.startswith(f"# yaml-language-server: $schema={kind}.schema.json\n")
    assert f"`ekfsim schema {kind} > {kind}.schema.json`" in text
    checked = check(written(kind, tmp_path, text))
    assert checked.mistakes == []
    assert checked.warnings == []


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_names_every_key(kind):
    for path, part in parts(json_schema(kind)):
        for key in part.get("properties", {}):
            assert re.search(rf"\b{key}\b", template(kind)), f"{path}.{key}"


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_loads_with_each_of_its_examples_switched_on(tmp_path, kind):
    """A commented block begins with `# key:` of the top level and ends before a line that is no
    comment."""
    for block in re.findall(
        r"^# [a-zA-Z]+:(?! drive).*\n(?:^#  .*\n)*", template(kind), re.MULTILINE
    ):
        key = block[2:].partition(":")[0]
        if key not in json_schema(kind)["properties"]:
            continue
        switched_on = re.sub("^# ", "", block, flags=re.MULTILINE)
        rest = re.sub(rf"^{key}:.*\n", "", template(kind).replace(block, ""), flags=re.MULTILINE)
        if key in ("system", "robot", "sensors"):  # as the template says of them
            rest = re.sub(r"^noise:\n(?:  .*\n)*", "", rest, flags=re.MULTILINE)
            switched_on += "" if key == "system" else "system: mower\n"
            switched_on += "landmarks: [{id: 1, x: 2, y: 2}]\n"
        mistakes = [
            mistake.wrong for mistake in check(written(kind, tmp_path, rest + switched_on)).mistakes
        ]
        assert mistakes in ([], ["belief.obstacles lists all that the filter's map holds"]), block


def test_a_template_loads_with_what_is_believed_and_wrong_of_a_driven_robot(tmp_path):
    """Its examples of `belief` and `faults` for driven robots stand behind three spaces."""
    head = (
        "name: a\nsystem: mower\nlandmarks: [{id: 1, x: 2, y: 2}]\nstart: {x: 0, y: 0, theta: 0}\n"
    )
    apart = re.findall(r"^#   ((?:belief|faults): .*\n)", template("world"), re.MULTILINE)
    assert len(apart) == 2
    checked = check(written("world", tmp_path, head + "".join(apart)))
    assert (checked.mistakes, checked.warnings) == ([], [])


def test_a_template_loads_with_each_way_to_drive(tmp_path):
    """Its examples of `drive` and `recording` stand behind three spaces, in place of `commands`."""
    (tmp_path / "mower.yaml").write_text("name: a\nsystem: mower\nstart: {x: 0, y: 0, theta: 0}\n")
    (tmp_path / "pylon.yaml").write_text("name: a\nsystem: pylon\nstart: {x: 0, y: 0, theta: 0}\n")
    (tmp_path / "classroom.yaml").write_text(template("world"))
    text = template("commands")
    before = text[: text.index("\ncommands:")]
    ways = re.findall(r"^#   ((?:drive|recording): .*)\n", text, re.MULTILINE)
    assert len(ways) == 8
    for way in ways:
        world = next((name for name in ("pylon", "classroom") if name in way), "mower")
        scene = written(
            "commands", tmp_path, before.replace("world.yaml", f"{world}.yaml") + f"\n{way}\n"
        )
        mistakes = [str(mistake) for mistake in check(scene).mistakes]
        assert mistakes == [] or (way.startswith("recording") and ": no such f" in mistakes[0]), way


@pytest.mark.parametrize(
    "path", [*packaged("worlds").values(), *packaged("commands").values()], ids=str
)
def test_packaged_files_load_without_a_mistake_or_a_warning(path):
    checked = check(path)
    assert checked.mistakes == []
    assert checked.warnings == []
    assert description_of(path)


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A checkout with one packaged world and one packaged scene."""
    monkeypatch.setattr(packaged_files, "PACKAGE", tmp_path / "ekfsim")
    written("world", tmp_path, template("world"))
    for kind in ("worlds", "commands"):
        (tmp_path / kind).mkdir()
    (tmp_path / "worlds/room.yaml").write_text(template("world"))
    (tmp_path / "commands/tour.yaml").write_text(
        template("commands").replace("world.yaml", "../worlds/room.yaml")
    )
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    return tmp_path


def test_packaged_files_go_by_their_bare_names(home):
    assert packaged("commands") == {"tour": home / "commands/tour.yaml"}
    assert resolve("tour", "commands") == home / "commands/tour.yaml"
    assert resolve("room", "worlds") == home / "worlds/room.yaml"
    assert str(resolve("some/tour", "commands")) == "some/tour"
    assert str(resolve("none.yaml", "commands")) == "none.yaml"


def test_a_filter_is_no_commands_file():
    with pytest.raises(UsageError) as refused:
        resolve("mine.py", "commands")
    assert str(refused.value) == (
        "mine.py: commands are asked for here; a filter is named after --filter"
    )


def test_an_installed_package_holds_its_own(home):
    (home / "ekfsim/_packaged/commands").mkdir(parents=True)
    (home / "ekfsim/_packaged/commands/other.yaml").write_text("")
    assert list(packaged("commands")) == ["other"]


def test_a_file_that_exists_wins_over_a_packaged_name(home):
    (home / "elsewhere/tour").write_text("")
    assert str(resolve("tour", "commands")) == "tour"


def test_a_folder_does_not_hide_a_packaged_name(home):
    (home / "elsewhere/tour").mkdir()  # as `render tour -o tour` leaves it
    assert resolve("tour", "commands") == home / "commands/tour.yaml"


def test_outputs_name_packaged_files_alike_everywhere(home):
    scene = load_scene(resolve("tour", "commands"))
    assert (scene.commands_source, scene.world_source) == ("commands/tour.yaml", "worlds/room.yaml")
    assert load_scene("../commands/tour.yaml").commands_source == "commands/tour.yaml"
    assert source_name("../world.yaml") == "../world.yaml"


def test_descriptions(tmp_path):
    path = tmp_path / "f.yaml"
    for text, told in {
        "description: A room.\n": "A room.",
        "description: |\n  Two\n  lines.\n": "Two",
        "description: [1]\n": "",
        "name: a\n": "",
        "- a\n": "",
        "a: [\n": "",
        "": "",
    }.items():
        path.write_text(text)
        assert description_of(path) == told
    assert description_of(tmp_path / "none.yaml") == ""


def test_the_room_itself_imports_nothing_heavy():
    source = ekfsim.files.__file__
    with open(source, encoding="utf-8") as file:
        assert not [
            node
            for node in ast.walk(ast.parse(file.read()))
            if isinstance(node, ast.Import | ast.ImportFrom)
        ]
    assert {"packaged", "scenes"} <= {
        module.name for module in pkgutil.iter_modules(ekfsim.files.__path__)
    }


def test_templates_are_what_any_yaml_reader_takes_them_for(tmp_path):
    path = written("world", tmp_path, template("world"))
    assert load_world(path).name == yaml.safe_load(template("world"))["name"]
