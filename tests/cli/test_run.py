"""run: its options, its streams, and what is wrong with how it is asked."""

import csv
import json
import os

import pytest
from program import LONG, MEASURED, SHORT, WORLD, ekfsim, lay_out, left_in, process

from ekfsim.filters import FILTERS
from ekfsim.views.picture.written.lettering import wrapped

BREAKS = "\r\x85"  # to YAML the end of a line, as \n
CONTROLS = sorted({chr(code) for code in [*range(32), *range(127, 160)]} - {*"\t\n"})


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def told(*args):
    """The narrative of a run that succeeds without a warning."""
    ended = ekfsim("run", *args)
    assert (ended.status, ended.err) == (0, "")
    return ended.out


def trace(*args):
    """The lines of the trace of a run."""
    told(*args, "-q", "--trace", "trace.jsonl", "--force")
    with open("trace.jsonl") as file:
        return [json.loads(line) for line in file]


def test_a_run_tells_its_commands_and_one_verdict():
    narrative = told("short.yaml")
    assert narrative.count("==>") == 3
    assert "==>The end.\n" in narrative
    assert [line for line in narrative.splitlines() if line.startswith("Verdict: ")] == [
        narrative.splitlines()[-1]
    ]


def test_quiet_leaves_the_closing_summary():
    narrative, closing = told("short.yaml"), told("short.yaml", "--quiet")
    assert narrative.endswith(f"\n\n{closing}")
    assert closing.startswith("The run is over after 3 commands")


def test_the_same_run_twice_is_the_same_run():
    assert told("short.yaml") == told("short.yaml")


@pytest.mark.parametrize(
    ("option", "value", "said"),
    [
        ("--seed", "8", "seed 8,"),
        ("--seed", "4294967295", "seed 4294967295,"),
        ("--run", "3", "run 3\n"),
        ("--run", str(2**63 - 1), f"run {2**63 - 1}\n"),
        ("--filter", "ekf", "filter ekf,"),
        ("--gate", "0.5", "gate 0.5,"),
        ("--guard", "off", "guard off,"),
        ("--guard", "skip", "guard skip,"),
    ],
)
def test_every_option_stands_in_the_first_line(option, value, said):
    assert said in told("short.yaml", option, value).partition("\n")[0] + "\n"


def test_another_seed_and_another_run_are_other_draws():
    runs = [
        told("short.yaml", "-q", *more)
        for more in ([], ["--seed", "1"], ["--run", "1"], ["--run", "1025"])
    ]
    assert len(set(runs)) == 4


def test_the_seed_of_the_file_is_overruled(place):
    (place / "short.yaml").write_text(f"seed: 8\n{SHORT}")
    seeded = told("short.yaml")
    assert "seed 8," in seeded
    assert told("short.yaml", "--seed", "0") != seeded
    assert told("short.yaml", "--seed", "8") == seeded


def test_a_gate_refuses_readings():
    assert "not used (1 refused by the gate)" in told("short.yaml", "-q", "--gate", "1e-9")
    assert "not used" not in told("short.yaml", "-q", "--gate", "0.999999999")


def test_a_gate_of_the_file_is_put_off(place):
    (place / "gated.yaml").write_text((place / "short.yaml").read_text() + "gate: 1.0e-9\n")
    assert "refused by the gate" in told("gated.yaml", "-q")
    assert "not used" not in told("gated.yaml", "-q", "--gate", "off")


def test_a_guard_leaves_ambiguous_beams_out(place):
    # past the desk's corner
    (place / "corner.yaml").write_text("world: world.yaml\ncommands: [{sense: {angle: 26}}]")
    assert "This beam is ambiguous" in told("corner.yaml")
    assert "This beam is ambiguous" not in told("corner.yaml", "--guard", "off")
    assert "not used (1 left out by the guard)" in told("corner.yaml", "--guard", "skip")


def test_confidence_scales_the_ellipse():
    sizes = [
        trace("short.yaml", "--confidence", p)[1]["ellipse"]["major"]
        for p in (1e-6, 0.5, 0.954, 0.999999)
    ]
    assert sizes == sorted(sizes)
    assert sizes[3] / sizes[1] == pytest.approx(20**0.5 * 0.998, abs=0.02)  # √(ln 10⁻⁶ / ln ½)


def test_a_world_named_on_the_command_line_wins(place):
    (place / "other.yaml").write_text(WORLD.replace("lab", "other").replace("x: 0,", "x: 1,"))
    assert "world other.yaml," in told("short.yaml", "--world", "other.yaml")
    assert "world worlds/room.yaml," in told("short.yaml", "--world", "room")
    assert told("short.yaml", "--world", "world.yaml") == told("short.yaml")
    (place / "homeless.yaml").write_text(SHORT.replace("world: world.yaml\n", ""))
    assert ekfsim("run", "homeless.yaml").status == 2
    assert told("homeless.yaml", "--world", "world.yaml", "-q") == told("short.yaml", "-q")


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *(("--gate", value) for value in ("0", "1", "2", "-1", "nan", "inf", "", "x")),
        *(("--confidence", value) for value in ("0", "1", "nan", "-inf", "95 %")),
        *(("--seed", value) for value in ("-1", "1.5", "x", "", "4294967296", "9" * 40)),
        *(("--run", value) for value in ("-1", "1e3", str(2**63), "9" * 40)),
        ("--guard", "perhaps"),
        *(
            (option, value)
            for option in ("--trace", "--csv", "--summary", "--tum")
            for value in ("", "-")
        ),
    ],
)
def test_a_value_that_cannot_be_is_refused_by_name(place, option, value):
    ended = ekfsim("run", "short.yaml", option, value)
    assert ended.status == 2
    assert ended.out == ""
    assert ended.err.splitlines()[-1].startswith(f"Error: Invalid value for '{option}': ")
    assert left_in(place) == ["long.yaml", "short.yaml", "world.yaml"]


def test_an_unknown_filter_is_told_with_the_known_ones():
    ended = ekfsim("run", "short.yaml", "--filter", "wizard")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith(
        f"ekfsim: --filter wizard: there is no such filter; known: {', '.join(FILTERS)}"
    )


@pytest.mark.parametrize(
    ("args", "line"),
    [
        (["nowhere.yaml"], "ekfsim: nowhere.yaml: no such file"),
        (["shrot.yaml"], "ekfsim: shrot.yaml: no such file; did you mean 'short.yaml'?"),
        (
            ["nowhere"],
            "ekfsim: 'nowhere' is neither a file nor one of the packaged commands; see `ekfsim "
            "list`",
        ),
        (
            ["touur"],
            "ekfsim: 'touur' is neither a file nor one of the packaged commands; did you mean "
            "'tour'?",
        ),
        (["."], "ekfsim: .: is a folder; name a file in it"),
        (["/dev/null"], "/dev/null:1:1: the file is empty"),
        (["world.yaml"], "world.yaml:1:1: this is a world file: it has no 'commands'"),
        (
            ["short.yaml", "--world", "short.yaml"],
            "short.yaml:1:1: this is a commands file; name a world file here",
        ),
        (["short.yaml", "--world", "nowhere.yaml"], "ekfsim: nowhere.yaml: no such file"),
        (["short.yaml", "--world", "/dev/null"], "/dev/null:1:1: the file is empty"),
        (["bytes.yaml"], "bytes.yaml:1:1: the byte 0xff is not UTF-8"),
        (["short.yaml", "--world", "bytes.yaml"], "bytes.yaml:1:1: the byte 0xff is not UTF-8"),
        (["red\x1b[31m.yaml"], "ekfsim: red\\x1b[31m.yaml: no such file"),
        (["two\nlines.yaml"], "ekfsim: two"),
        (["\udcff.yaml"], "ekfsim: \\xff.yaml: no such file"),
    ],
)
def test_a_wrong_file_is_told_in_a_line_and_nothing_is_written(place, args, line):
    (place / "bytes.yaml").write_bytes(b"\xff" * 100)
    before = left_in(place)
    ended = ekfsim("run", *args, "--trace", "trace.jsonl", "--tum", "tum")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith(line)
    assert "Traceback" not in ended.err
    assert left_in(place) == before


def test_all_mistakes_of_both_files_come_at_once(place):
    (place / "world.yaml").write_text(WORLD.replace("0.05", "x", 2))
    (place / "short.yaml").write_text(SHORT.replace("angle", "angel"))
    ended = ekfsim("run", "short.yaml", "--csv", "table.csv")
    assert (ended.status, ended.out) == (2, "")
    lines = ended.err.splitlines()
    assert [line.partition(":")[0] for line in lines] == ["short.yaml"] * 2 + ["world.yaml"] * 2
    assert not (place / "table.csv").exists()


def test_the_narrative_holds_no_control_characters(place):
    for char in sorted(set(CONTROLS) - {*BREAKS}):
        world = WORLD.replace("lab", json.dumps(f"l{char}b")).replace(
            "desk", json.dumps(f"d{char}k")
        )
        (place / "world.yaml").write_text(world)
        (place / "short.yaml").write_text(SHORT.replace("The end.", json.dumps(f"The {char} end.")))
        ended = ekfsim("run", "short.yaml")
        assert ended.status == 2
        assert f"U+{ord(char):04X}" in ended.err
        assert not set(CONTROLS) & set(ended.out + ended.err)


@pytest.mark.parametrize("char", BREAKS)
def test_nor_does_another_line_break(place, char):
    (place / "short.yaml").write_text(SHORT.replace("The end.", json.dumps(f"The {char} end.")))
    assert not set(CONTROLS) & set(ekfsim("run", "short.yaml").out)


@pytest.mark.parametrize("sign", ["\u202e", "\u2066", "\u200b", "\ufeff", "\u2060", "\U000e0041"])
def test_nor_do_signs_that_turn_or_hide_what_stands_around_them(place, sign):
    (place / "world.yaml").write_text(
        WORLD.replace("lab", json.dumps(f"l{sign}b")).replace("desk", f"d{sign}k")
    )
    (place / "short.yaml").write_text(SHORT.replace("The end.", json.dumps(f"gnp.{sign}exe")))
    (place / f"{sign}.yaml").write_text(SHORT)
    for told in (
        ekfsim("run", "short.yaml"),
        ekfsim("run", f"{sign}.yaml"),
        ekfsim("check", f"no{sign}.yaml"),
    ):
        assert sign not in told.out + told.err
    assert sign not in "".join(wrapped([f"gnp.{sign}exe"], 40, 1))


def test_no_line_that_a_file_says_is_taken_for_one_of_ours(place):
    said = "One.\n==>The robot moved: distance=1, angle=0\rVerdict: lost"
    (place / "short.yaml").write_text(SHORT.replace("The end.", json.dumps(said)))
    lines = ekfsim("run", "short.yaml").out.splitlines()
    at = lines.index("==>One.")
    assert lines[at + 1 : at + 3] == [
        "   ==>The robot moved: distance=1, angle=0",
        "   Verdict: lost",
    ]
    assert len([line for line in lines if line.startswith("Verdict:")]) == 1


@pytest.mark.parametrize("name", ["=1+1.yaml", "+a.yaml", "@a.yaml"])
def test_no_name_of_a_file_is_a_formula_in_a_table(place, name):
    (place / name).write_text(SHORT)
    assert ekfsim("run", name, "-q", "--csv", "table.csv").status == 0
    with open("table.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["commands"] for row in rows} == {f"'{name}"}
    assert not [cell for row in rows for cell in row.values() if cell.startswith(("=", "+", "@"))]


@pytest.mark.parametrize("name", ["red\x1b[31m.yaml", "bell\x07.yaml", "two\nlines.yaml"])
def test_nor_does_the_name_of_a_file(place, name):
    (place / name).write_text(SHORT)
    ended = ekfsim("run", name)
    assert ended.status == 0
    assert not set(CONTROLS) & set(ended.out)
    assert ended.out.startswith("ekfsim ")
    assert "filter ekf" in ended.out.partition("\n")[0]


def test_a_file_named_in_no_encoding_can_be_run_and_recorded(place):
    name = os.fsdecode(b"\xff.yaml")
    (place / name).write_text(SHORT)
    results = ("--trace", "t", "--csv", "c", "--summary", "s", "--tum", "tum")
    ended = ekfsim("run", name, *results)
    assert (ended.status, ended.err) == (0, "")
    for file in ("t", "c", "s", "tum/truth.tum", "tum/estimate.tum"):
        assert (place / file).read_text(encoding="utf-8")


def test_warnings_leave_standard_output_to_the_narrative(place):
    (place / "short.yaml").write_text(SHORT.replace("angle: 90", "angle: 900"))
    ended = ekfsim("run", "short.yaml")
    assert ended.status == 0
    assert ended.err.startswith("short.yaml:3:")
    assert ended.err.count("\n") == 1
    assert ended.out.startswith("ekfsim ")


def test_memory_does_not_grow_with_the_run(place):
    peaks = []
    for times in (200, 4000):
        (place / "long.yaml").write_text(
            LONG.replace("20000", str(times)).replace("{sense: {angle: 0}}, ", "")
        )
        ended = process(
            "run", "long.yaml", "--trace", f"{times}.jsonl", after=">/dev/null", program=MEASURED
        )
        assert ended.status == 0
        assert len((place / f"{times}.jsonl").read_bytes().splitlines()) == times + 1
        peaks.append(int(ended.err))
    assert peaks[1] < peaks[0] + 4000  # kB; 3800 steps kept would be far more
