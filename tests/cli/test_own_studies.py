"""Studies and comparisons of a filter of one's own: like any other, wherever its runs are made."""

import csv
import pickle
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from program import ekfsim, lay_out, left_in

from ekfsim.errors import RunError
from ekfsim.files.scenes.load_study import read_request
from ekfsim.files.scenes.settings import filters_in
from ekfsim.files.template import template
from ekfsim.student.fault import FaultError
from ekfsim.study.plan import Plan
from ekfsim.study.running import engines
from ekfsim.study.running.doing import unkept
from ekfsim.views.study import folder as study_folder
from ekfsim.views.study import pictures

WHOLE = template("filter-complete")
BESIDE = WHOLE.replace("import numpy as np", "import numpy as np\nfrom parts import identity")
BESIDE = BESIDE.replace("np.eye(len(x))", "identity(len(x))")
PARTS = "import numpy as np\n\n\ndef identity(n):\n    return np.eye(n)\n"
FAULTY = f"""\
{WHOLE}

class StrangeError(Exception):
    def __init__(self, a, b):
        super().__init__(a)


whole = update


def update(x, P, z, sensor):
    if abs(z[0] - 4.5) < 0.3:
        raise StrangeError("as if", 2)
    return whole(x, P, z, sensor)
"""
NUMBERS = ("position_rmse", "heading_rmse", "nees_mean", "nis_mean", "above_95", "lost")


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    (tmp_path / "code").mkdir()
    (tmp_path / "code/mine.py").write_text(BESIDE)
    (tmp_path / "code/parts.py").write_text(PARTS)
    monkeypatch.setattr(study_folder, "draw_study", lambda *drawn: None)  # pictures take a second
    return tmp_path


def rows(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def done(*args, status=0):
    ended = ekfsim(*args)
    assert (ended.status, ended.err if status == 0 else "") == (status, ""), ended
    return ended


def check_alike(one, other):
    """What two rows of a table tell of their runs."""
    for name in NUMBERS:
        np.testing.assert_allclose(float(one[name]), float(other[name]), rtol=1e-5, err_msg=name)


def test_it_stands_beside_a_built_in_one_under_its_own_name(place):
    told = done("study", "short.yaml", "--runs", 60, "--filter", "ekf,code/mine.py", "-o", "out")
    ekf, mine = rows("out/summary.csv")
    assert (ekf["filter"], mine["filter"]) == ("ekf", "mine.py")
    check_alike(ekf, mine)
    assert f"--filter {place}/code/mine.py" in told.out  # plays its worst run from any folder
    assert str(place) not in "".join(
        (place / "out" / name).read_text() for name in ("summary.csv", "steps.csv", "study.yaml")
    )


def test_pictures_call_it_by_its_own_name(place):
    plan = Plan.of(asked_of("short.yaml", "ekf,code/mine.py"))
    plan = replace(plan, request=replace(plan.request, runs=5))
    figure = pictures.picture(
        plan, unkept(plan, engines.serial, lambda *block: None), *pictures.PICTURES["divergence"]
    )
    legend = figure.axes[0].get_legend()
    assert [text.get_text() for text in legend.get_texts()][:2] == ["ekf", "mine.py"]
    assert "filter ekf,mine.py" in pictures.told(plan)


def test_the_folder_of_a_study_repeats_it_elsewhere(place, tmp_path_factory):
    done("study", "short.yaml", "--runs", 40, "--filter", "code/mine.py,ukf", "-o", "out")
    assert {"mine.py", "parts.py"} <= set(left_in(place / "out"))
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "study"
    shutil.move(place / "out", elsewhere)
    shutil.rmtree(place / "code")
    assert done("check", elsewhere / "study.yaml").out.endswith(": ok\n")
    done("study", elsewhere / "study.yaml", "-o", "again")
    for name in ("summary.csv", "steps.csv", "study.yaml", "mine.py", "parts.py"):
        assert (place / "again" / name).read_bytes() == (elsewhere / name).read_bytes()
    done("study", elsewhere / "study.yaml", "--runs", 5, "-o", "again", "--force")
    assert rows("again/summary.csv")[0]["runs"] == "5"


def test_only_what_a_study_copied_is_replaced(place):
    """A folder in which a student keeps their code is no result of ours."""
    done("study", "short.yaml", "--runs", 5, "--filter", "code/mine.py", "-o", "code", status=2)
    told = done(
        "study", "short.yaml", "--runs", 5, "--filter", "code/mine.py", "-o", "code", "--force",
        status=2,
    )  # fmt: skip
    assert "code: holds 'mine.py', which is no result of ekfsim" in told.err
    assert (place / "code/mine.py").read_text() == BESIDE


def test_one_of_two_of_a_name_is_named_where_it_lies(place):
    (place / "other").mkdir()
    (place / "other/yours.py").write_text(BESIDE)
    (place / "other/parts.py").write_text(f"{PARTS}# another\n")
    filters = "code/mine.py,other/yours.py"
    done("study", "short.yaml", "--runs", 5, "--filter", filters, "-o", "out")
    named = yaml.safe_load(Path("out/study.yaml").read_text())["filters"]
    assert named == ["mine.py", f"{place}/other/yours.py"]
    assert "yours.py" in ekfsim("study", "out/study.yaml").out
    (place / "other/mine.py").write_text(BESIDE)
    told = done("study", "short.yaml", "--filter", "code/mine.py,other/mine.py", status=2)
    assert told.err == (
        "ekfsim: --filter code/mine.py,other/mine.py: two filters are called mine.py; give one of "
        "the files another name\n"
    )


def test_a_comparison_puts_it_on_either_side(place):
    told = done(
        "compare", "short.yaml", "--runs", 50, "--a", "filter=ekf", "--b", "filter=code/mine.py",
        "-o", "out",
    )  # fmt: skip
    assert "  a: filter=ekf\n  b: filter=mine.py\n" in told.out
    measures = {row["measure"]: row for row in rows("out/compare.csv")}
    assert abs(float(measures["position"]["difference"])) < 1e-12
    assert float(measures["lost"]["difference"]) == 0
    shutil.rmtree(place / "code")
    again = done("compare", "out/compare.yaml")
    assert again.out.splitlines()[1:] == told.out.splitlines()[1:]


def test_files_name_it_relative_to_themselves(place):
    (place / "sub").mkdir()
    (place / "sub/s.yaml").write_text(
        "study: ../own.yaml\nruns: 9\nfilters: [../code/mine.py, ekf]\nsweep: {gate: [0.9, 0.99]}\n"
    )
    (place / "sub/c.yaml").write_text(
        "study: ../own.yaml\nruns: 20\nb: {filter: ../code/mine.py}\n"
    )
    (place / "own.yaml").write_text(f"filter: code/mine.py\n{(place / 'short.yaml').read_text()}")
    for file in ("own.yaml", "sub/s.yaml", "sub/c.yaml"):
        assert done("check", file).out == f"{file}: ok\n"
    done("study", "sub/s.yaml", "-o", "out")
    assert [row["filter"] for row in rows("out/summary.csv")] == ["mine.py", "ekf"] * 2
    done("study", "own.yaml", "--runs", 20, "-o", "plain", "--plain")
    (row,) = rows("plain/summary.csv")
    assert row["filter"] == "mine.py"
    told = done("compare", "sub/c.yaml", "--a", "filter=ukf")
    assert "  b: filter=mine.py\n" in told.out


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (
            "study: short.yaml\nfilters: [ekf, mine.py]\n",
            "f.yaml:2:16: filters[1]: 'mine.py': there is no such file; write its path relative to "
            "this file",
        ),
        (
            "study: short.yaml\nfilters: [code/mine.py, ./code/mine.py]\n",
            "f.yaml:2:25: filters[1]: 'mine.py' stands twice; delete one",
        ),
        (
            "study: short.yaml\nb: {filter: mine.py:EKF}\n",
            "f.yaml:2:13: b.filter: 'mine.py:EKF': there is no such file; write its path relative "
            "to this file",
        ),
        (
            "world: world.yaml\nfilter: code/mien.py\ncommands: [say: a]\n",
            "f.yaml:2:9: filter: 'code/mien.py': there is no such file; write its path relative to "
            "this file",
        ),
    ],
)
def test_check_sees_that_the_file_is_there(place, text, line):
    (place / "f.yaml").write_text(text)
    assert done("check", "f.yaml", status=2).out == f"{line}\n"


def test_check_runs_nothing_of_it(place):
    (place / "code/mine.py").write_text("raise SystemExit(7)\n")
    (place / "s.yaml").write_text("study: c.yaml\nfilters: [code/mine.py]\n")
    (place / "c.yaml").write_text(f"filter: code/mine.py\n{(place / 'short.yaml').read_text()}")
    for file in ("s.yaml", "c.yaml"):
        assert done("check", file).out == f"{file}: ok\n"
    told = done("study", "s.yaml", status=1)
    assert told.err == "code/mine.py:1: it calls exit(7); a filter returns\n"


def ended_early(monkeypatch, failure):
    """A study whose first block alone is made here, and whose next one fails."""

    def engine(work, tasks):
        task = next(iter(tasks))
        yield task, work.block(task.case)(task.first, task.runs)
        raise failure

    args = ("study", "short.yaml", "--runs", 1030, "--filter", "code/mine.py", "-o", "out")
    with monkeypatch.context() as patched:
        patched.setattr(engines, "serial", engine)
        told = done(*args, status=1).err
    return told, (*args, "--resume")


def test_an_edited_filter_goes_on_with_no_blocks_of_before(place, monkeypatch):
    _, again = ended_early(monkeypatch, RunError("the disk is full"))
    for file, text in (("code/parts.py", PARTS), ("code/mine.py", BESIDE)):
        (place / file).write_text(f"{text}# edited\n")
        assert done(*again, status=2).err == (
            "ekfsim: out.partial: was begun as another study: the code of mine.py was another; "
            "begin anew with --force\n"
        )
        (place / file).write_text(text)
    done(*again)
    assert rows("out/summary.csv")[0]["runs"] == "1030"


def test_what_is_kept_where_the_code_fails_is_of_no_use_once_it_is_mended(place, monkeypatch):
    told, _ = ended_early(monkeypatch, FaultError("mine.py:3", "nan in P", "step 2").in_run(1027))
    assert told == (
        "mine.py:3: run 1027, step 2: nan in P; 1 of 2 blocks are kept in out.partial, "
        "made by this code: once it is mended, begin anew with --force\n"
    )


def test_code_that_changes_while_its_runs_are_made_is_told(place):
    plan = Plan.of(asked_of("short.yaml", "code/mine.py"))
    block = pickle.loads(pickle.dumps(plan.block(0)))
    assert block(0, 3).runs == 3
    (place / "code/parts.py").write_text(f"{PARTS}# edited\n")
    with pytest.raises(RunError) as told:
        block(3, 3)
    assert str(told.value) == (
        "mine.py: is not what it was when the study began; begin it anew with --force"
    )


def asked_of(commands, filter):
    return replace(read_request(commands), filters=filters_in(filter))


def test_a_fault_is_told_with_its_run_and_its_step_wherever_it_comes(place):
    """What a worker sends are words: the class of the exception could not be unpacked here."""
    (place / "code/faulty.py").write_text(FAULTY)
    args = ("study", "short.yaml", "--runs", 30, "--filter", "code/faulty.py", "-o", "out")
    here = done(*args, status=1)
    line = FAULTY.partition("        raise")[0].count("\n") + 1
    told = rf"code/faulty\.py:{line}: run (\d+), step 2 \(sense 0°\): StrangeError: as if\n"
    run = re.fullmatch(told, here.err)[1]
    assert done(*args, "--workers", 2, status=1).err == here.err
    assert not (place / "out.partial").exists()
    alone = done("run", "short.yaml", "--filter", "code/faulty.py", "--run", run, "-q", status=1)
    assert alone.err == here.err.replace(f"run {run}, ", "")


def test_nothing_is_heard_of_what_many_runs_print(place):
    noisy = "import sys\nprint('loaded')\ndef noisy(*given):\n"
    noisy += "    print('moved')\n    print('moved', file=sys.stderr)\n    return predict(*given)\n"
    text = BESIDE.replace("def predict", "def moved") + noisy
    text = text.replace("predict(*given)", "moved(*given)") + "predict = noisy\n"
    (place / "code/mine.py").write_text(text)
    told = ekfsim("study", "short.yaml", "--runs", 9, "--filter", "code/mine.py")
    assert "loaded" not in told.out + told.err
    assert "moved" not in told.out + told.err
    alone = ekfsim("run", "short.yaml", "--filter", "code/mine.py", "-q")
    assert alone.err == "loaded\nmoved\nmoved\n"


def test_workers_make_the_same_tables(place):
    args = ("study", "short.yaml", "--runs", 1030, "--filter", "code/mine.py")
    done(*args, "-o", "one")
    done(*args, "--workers", 2, "-o", "two")
    for name in ("summary.csv", "steps.csv"):
        assert (place / "one" / name).read_bytes() == (place / "two" / name).read_bytes()


def test_a_promise_is_verified_of_it(place):
    (place / "e.yaml").write_text(
        f"expect: {{lost: [0, 0.2], runs: 40}}\n{(place / 'short.yaml').read_text()}"
    )
    told = done("study", "e.yaml", "--filter", "code/mine.py", "--expect")
    assert told.out.startswith("e.yaml: 40 runs of seed 0, filter mine.py\nlost: kept: ")
