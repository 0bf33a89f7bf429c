"""A filter of one's own on the command line: narrated, drawn, played; and where it fails."""

import json
import re
import signal
import sys

import pytest
from program import ekfsim, ended, lay_out, left_in, started, wait_for

PUT_IN = ["long.yaml", "mine.py", "short.yaml", "world.yaml"]
GAIN = "    K = "


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """A folder with two commands files and a filter."""
    monkeypatch.chdir(lay_out(tmp_path))
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "COLUMNS", "LINES"):
        monkeypatch.delenv(name, raising=False)
    assert ekfsim("new", "mine.py", "--complete").status == 0
    return tmp_path


@pytest.fixture
def changed(place):
    """Puts something before the line of mine.py that has the gain; its number."""

    def change(line):
        code = (place / "mine.py").read_text()
        assert code.count(GAIN) == 1
        (place / "mine.py").write_text(code.replace(GAIN, f"    {line}\n{GAIN}"))
        return code[: code.index(GAIN)].count("\n") + 1

    return change


def test_it_is_narrated_as_the_ekf_is(place):
    own, ekf = (ekfsim("run", "short.yaml", "--filter", name) for name in ("mine.py", "ekf"))
    assert (own.status, own.err) == (0, "")
    remark = (
        "The filter mine.py: derivatives, innovation and gain are calculated at its own estimate, "
        "not by it; it is not handed a reading without echo or wall, nor one where nothing is "
        "uncertain\n"
    )
    assert own.out.replace(remark, "").replace("filter mine.py,", "filter ekf,") == ekf.out


def test_its_files_bear_its_name_and_tell_no_folder(place):
    files = "--trace", "t.jsonl", "--csv", "t.csv", "--summary", "s.json"
    (place / "other.py").write_text((place / "mine.py").read_text())
    told = ekfsim("run", "short.yaml", "--filter", "ekf,mine.py,other.py:", *files)
    assert (told.status, told.err) == (0, "")
    ends = ("s", "json"), ("t", "csv"), ("t", "jsonl")
    made = [f"{file}.{name}.{end}" for file, end in ends for name in ("ekf", "mine", "other")]
    assert left_in(place) == sorted([*PUT_IN, "other.py", *made])
    assert json.loads((place / "s.mine.json").read_text())["filter"] == "mine.py"
    for file in made:
        assert str(place) not in (place / file).read_text()
    assert str(place) not in told.out
    assert "\nmine.py and ekf do not differ, at no step by a millionth of σ\n" in told.out


def test_two_of_one_name_are_refused(place):
    (place / "b").mkdir()
    (place / "b/mine.py").write_text((place / "mine.py").read_text())
    told = ekfsim("run", "short.yaml", "--filter", "mine.py,b/mine.py")
    right = "give one of the files another name"
    assert told.err == (
        f"ekfsim: --filter mine.py,b/mine.py: two filters are called mine.py; {right}\n"
    )
    assert told.status == 2


def test_where_two_part_is_told_once_in_the_narrative_and_at_the_end(place, changed):
    changed("P = P * 1.01")
    told = ekfsim("run", "short.yaml", "--filter", "ekf,mine.py")
    line = r"mine\.py and ekf differ from step 2 on, there by 0\.\d+ σ\n"
    assert len(re.findall(line, told.out)) == 2
    narrative, _, closing = told.out.partition("The run is over")
    assert re.search(f"==>Commanding[^>]*{line}\n==>The end", narrative)
    assert re.search(line, closing)
    played = ekfsim("play", "short.yaml", "--show", "text", "--filter", "ekf,mine.py", keys=b"nnnq")
    assert len(re.findall(line, played.out)) == 1


def test_a_run_that_fails_is_narrated_up_to_there_and_leaves_no_file(place, changed):
    sound = ekfsim("run", "short.yaml", "--filter", "mine.py").out
    line = changed("1 / 0")
    told = ekfsim("run", "short.yaml", "--filter", "mine.py", "--trace", "t.jsonl", "--tum", "t")
    fault = f"mine.py:{line}: step 2 (sense 0°): ZeroDivisionError: division by zero\n"
    assert (told.status, told.err) == (1, fault)
    assert told.out == sound[: sound.index("==>Commanding")]
    assert left_in(place) == PUT_IN


def test_play_shows_what_came_before_a_failure(place, changed):
    line = changed("1 / 0")
    told = ekfsim("play", "short.yaml", "--show", "text", "--filter", "ekf,mine.py", keys=b"nnpnq")
    fault = f"mine.py:{line}: step 2 (sense 0°): ZeroDivisionError: division by zero"
    assert (told.status, told.err) == (1, f"{fault}\n")
    assert told.out.count("==>The robot moved") == 2  # once more after p
    assert "==>Commanding" not in told.out
    assert told.out.count(f"\nThe run failed: {fault}\n") == 2
    assert told.out.count("The run failed here: q quits, p goes back, r starts again\n") == 1


@pytest.mark.parametrize("out", ["out", "out.gif"])
def test_render_draws_nothing_of_a_run_that_fails(place, changed, out):
    changed("1 / 0")
    told = ekfsim("render", "short.yaml", "--filter", "mine.py", "-o", out)
    assert (told.status, told.out) == (1, "")
    assert told.err.startswith("mine.py:")
    assert left_in(place) == PUT_IN


def test_what_it_prints_goes_beside_the_narrative(place, changed):
    sound = ekfsim("run", "short.yaml", "--filter", "mine.py").out
    changed("print('x', x.shape); np.zeros(1) / 0")
    told = ekfsim("run", "short.yaml", "--filter", "mine.py")
    assert (told.status, told.out, told.err) == (0, sound, "x (3,)\n")
    drawn = ekfsim("render", "short.yaml", "--filter", "mine.py", "-o", "out")
    assert (drawn.status, drawn.err) == (0, "x (3,)\n")


def test_a_fault_is_told_in_a_line_of_its_own(place, changed):
    changed("print('here', end=''); return x, P * np.nan")
    told = ekfsim("run", "short.yaml", "--filter", "mine.py").err.splitlines()
    assert told[0] == "here"
    assert re.fullmatch(r"mine\.py:\d+: step 2 .*: P\[0, 0\] is nan", told[1])


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent as POSIX has them")
@pytest.mark.parametrize(
    ("number", "status", "caught"), [(signal.SIGINT, 130, False), (signal.SIGTERM, 143, True)]
)
def test_an_endless_loop_is_ended_from_without(place, changed, number, status, caught):
    """Also where the code catches whatever comes, and goes on."""
    loop = "try:\n        while True: pass\n    except: pass" if caught else "while True: pass"
    changed(f"open('reached', 'w').close()\n    {loop}")
    running = started("run", "short.yaml", "--filter", "mine.py")
    wait_for((place / "reached").exists, running)
    running.send_signal(number)
    assert ended(running).status == status


def test_check_says_what_was_found(place):
    told = ekfsim("check", "mine.py", "short.yaml")
    assert told.status == 0
    assert re.fullmatch(
        r"mine\.py: ok: predict in line \d+, update in line \d+\nshort\.yaml: ok\n", told.out
    )
    (place / "kind.py").write_text(
        "class Mine:\n    def __init__(self, x, P): pass\n    def predict(self, u, motion): pass\n"
        "    def update(self, z, sensor): pass\n"
    )
    assert ekfsim("check", "kind.py").out == "kind.py: ok: the class Mine, with x and P\n"
    (place / "wrong.py").write_text("def predict(:\n")
    wrong = ekfsim("check", "wrong.py", "mine.py")
    assert (wrong.status, wrong.err) == (1, "wrong.py:1: this is not Python: invalid syntax\n")
    none = ekfsim("check", "wrong.py", "none.py")
    assert none.status == 2
    assert none.err.endswith("\nekfsim: none.py: there is no such file; did you mean 'mine.py'?\n")


def test_numbers_of_other_filters_are_no_business_of_its(place):
    told = ekfsim("run", "short.yaml", "--filter", "mine.py", "--particles", "10")
    assert told.status == 2
    assert "no filter here (mine.py) reads it" in told.err


def test_the_long_form_says_whose_numbers_they_are(place):
    told = ekfsim("run", "short.yaml", "--filter", "mine.py", "--explain", "--plain")
    assert told.status == 0
    assert told.out.count("   (as the filter's file has it)\n") == 4
