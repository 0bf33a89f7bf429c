"""`ekfsim grade` from files to files: every kind of student, order, interruptions, the autograder.

Students' code runs in processes of its own here, as it does for who grades.
"""

import csv
import json
import os
import signal
import stat
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest
from program import COMMAND, PATIENCE, ekfsim

sys.path.insert(0, str(Path(__file__).parents[1] / "student/grading"))
from pupils import MINUS, RIGHT

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="students' code needs a POSIX")

HOMEWORK = """\
homework: EKF
total: 30
limits: {seconds: 15}
parts:
  - {name: Steps, points: 20, steps: {scenes: [square], runs: 2}}
  - {name: Honest, points: 10, honesty: {scenes: [square], runs: 20}}
"""
STEPS = HOMEWORK.replace("total: 30", "total: 20").rpartition("  - {name: Honest")[0]


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hw.yaml").write_text(HOMEWORK)
    (tmp_path / "steps.yaml").write_text(STEPS)
    for name, text in {"anna": RIGHT, "bob": MINUS, "cleo": "def predict(:\n"}.items():
        (tmp_path / f"{name}.py").write_text(text)
    return tmp_path


def held(folder):
    return {path.name: path.read_bytes() for path in sorted(Path(folder).iterdir())}


def table(folder):
    with open(Path(folder, "grades.csv"), encoding="utf-8", newline="") as file:
        return {row["submission"]: row for row in csv.DictReader(file)}


def test_a_class_is_graded_and_order_and_neighbours_do_not_matter(place):
    told = ekfsim("grade", "hw.yaml", "anna.py", "bob.py", "cleo.py", "-o", "one",
                  "--format", "csv,gradescope,junit,markdown")  # fmt: skip
    assert told.status == 0, told.err
    assert told.out == "one: 3 submissions; of 30 points the mean is 13.33, the median 10\n"
    grades = table("one")
    assert grades["anna"]["points"] == "30"
    assert grades["bob"]["points"] == "10"
    assert (grades["bob"]["first wrong step"], grades["bob"]["mistakes"]) == (
        "square run 0: step 2 (sense -90°)", "innovation-sign",
    )  # fmt: skip
    assert grades["cleo"]["points"] == "0"
    assert grades["cleo"]["faults"] == "cleo.py:1: this is not Python: invalid syntax"
    assert set(held("one")) == {
        *("grades.csv", "class.md", "junit.xml"),
        *(f"{kind}-{name}.{end}" for name in grades for kind, end in
          (("report", "md"), ("report", "json"), ("gradescope", "json"))),
    }  # fmt: skip
    alone = ekfsim("grade", "hw.yaml", "bob.py", "-o", "two", "--workers", "1",
                   "--format", "gradescope,markdown")  # fmt: skip
    assert alone.status == 0
    one, two = held("one"), held("two")
    for name in two.keys() - {"class.md"}:
        assert two[name] == one[name]
    assert not list(place.glob("*.partial"))
    # what changed is graded anew, and no other: a grade that was tampered with shows it
    for name in ("anna", "bob"):
        path = place / f"one/report-{name}.json"
        path.write_text(path.read_text().replace("all 16 steps are", "all 16 steps were"))
    (place / "bob.py").write_text(RIGHT)
    assert ekfsim("grade", "hw.yaml", "anna.py", "bob.py", "-o", "one").status == 2
    told = ekfsim("grade", "hw.yaml", "anna.py", "bob.py", "-o", "one", "--force",
                  "--workers", "1")  # fmt: skip
    assert told.out == "one: 2 submissions; of 30 points the mean is 30, the median 30\n"
    assert "steps were right" in (place / "one/report-anna.md").read_text()
    assert "steps are right" in (place / "one/report-bob.md").read_text()


def test_a_grader_that_is_killed_goes_on_with_what_is_missing(place):
    (place / "dan.py").write_text("import time\ntime.sleep(600)\n")
    (place / "steps.yaml").write_text(STEPS.replace("seconds: 15", "seconds: 100"))
    asked = [*COMMAND, "grade", "steps.yaml", "anna.py", "dan.py", "-o", "out", "--workers", "1"]
    begun = subprocess.Popen(asked, stderr=subprocess.PIPE)
    kept = place / "out.partial/report-anna.json"
    until = time.monotonic() + PATIENCE
    while not kept.exists() and time.monotonic() < until:
        time.sleep(0.05)
    begun.send_signal(signal.SIGKILL)
    begun.communicate()
    assert not (place / "out").exists()
    before = kept.read_text().replace("steps are right", "steps were right")
    kept.write_text(before)
    (place / "dan.py").write_text(RIGHT)
    told = ekfsim("grade", "steps.yaml", "anna.py", "dan.py", "-o", "out", "--workers", "1")
    assert told.status == 0, told.err
    assert (place / "out/report-anna.json").read_text() == before
    assert table("out")["dan"]["points"] == "20"
    assert not (place / "out.partial").exists()


def test_ctrl_c_says_what_is_kept_and_leaves_no_process(place):
    (place / "dan.py").write_text("import time\ntime.sleep(600)\n")
    asked = [*COMMAND, "grade", "steps.yaml", "anna.py", "dan.py", "-o", "out", "--workers", "1"]
    begun = subprocess.Popen(asked, stderr=subprocess.PIPE, text=True, start_new_session=True)
    until = time.monotonic() + PATIENCE
    while not (place / "out.partial/report-anna.json").exists() and time.monotonic() < until:
        time.sleep(0.05)
    os.killpg(begun.pid, signal.SIGINT)
    _, err = begun.communicate(timeout=PATIENCE)
    assert begun.returncode == 130
    assert "Traceback" not in err
    assert err.endswith(  # after what this machine cannot keep students' code from
        "ekfsim: interrupted; 1 of 2 submissions are graded and kept in out.partial; the same "
        "command goes on with the rest\n"
    )
    while is_there(begun.pid) and time.monotonic() < until:
        time.sleep(0.05)
    assert not is_there(begun.pid)


def is_there(group):
    """Whether any process of a group is left."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (["hw.yaml", "none.py"], "none.py: no such file or folder"),
        (["none.yaml", "anna.py"], "none.yaml: no such file; did you mean 'hw.yaml'?"),
        (["anna.py", "anna.py"], None),
        (["hw.yaml", "anna.py", "--format", "cvs"],
         "--format: 'cvs' is no format; did you mean 'csv'?"),
        (["hw.yaml"], None),
    ],
)  # fmt: skip
def test_wrong_usage_is_told_and_leaves_nothing(place, args, told):
    ended = ekfsim("grade", *args, "-o", "out")
    assert ended.status == 2
    if told:
        assert ended.err == f"ekfsim: {told}\n" or ended.err.startswith(
            "ekfsim: none.yaml: no such"
        )
    assert not list(place.glob("out*"))


@pytest.mark.parametrize("fenced", [0, 6])
def test_what_this_machine_cannot_keep_from_is_told_once(place, monkeypatch, fenced):
    monkeypatch.setattr("ekfsim.student.sandbox.kernel.landlock", lambda: fenced)
    told = ekfsim("grade", "steps.yaml", "cleo.py", "-o", "out", "--workers", "1")
    ways = "read and write", "connections", "signals"
    assert [way in told.err for way in ways] == [fenced == 0, fenced < 4, fenced < 6]
    assert told.err.count("see docs/course/safety.md") == (fenced < 6)
    through = ekfsim(
        "grade", "steps.yaml", "cleo.py", "-o", "out", "--force", "--through", "env A=B"
    )
    assert (through.status, through.err) == (0, "")


# the autograder


@pytest.fixture
def autograder(place):
    """Where Gradescope unpacks it; a stand-in for the Python that setup.sh would bring."""
    told = ekfsim("autograder", "steps.yaml", "-o", "autograder.zip")
    assert told.status == 0, told.err
    root = place / "autograder"
    with zipfile.ZipFile("autograder.zip") as made:
        made.extractall(root / "source")
        modes = {one.filename: one.external_attr >> 16 for one in made.infolist()}
    for name in ("setup.sh", "run_autograder"):
        assert modes[name] & stat.S_IXUSR
    (root / "venv/bin").mkdir(parents=True)
    python = root / "venv/bin/python"
    program = root / "source/program"
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{program}" exec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    (root / "submission").mkdir()
    return root


def run(root):
    ended = subprocess.run(
        ["bash", root / "source/run_autograder"], env={**os.environ, "AUTOGRADER_ROOT": str(root)},
        capture_output=True, text=True, timeout=PATIENCE, check=False,
    )  # fmt: skip
    return ended, json.loads((root / "results/results.json").read_text())


def test_the_autograder_leaves_results_whatever_becomes_of_the_grader(autograder):
    (autograder / "submission/mine.py").write_text(MINUS)
    ended, results = run(autograder)
    assert ended.returncode == 0, ended.stderr
    assert (results["score"], results["tests"][0]["max_score"]) == (10.0, 20.0)
    assert results["execution_time"] >= 0
    assert "innovation-sign" in results["tests"][0]["output"]
    python = autograder / "venv/bin/python"
    python.write_text("#!/bin/sh\nkill -9 $$\n")
    ended, results = run(autograder)
    assert ended.returncode == 0
    assert (results["score"], results["tests"]) == (0.0, [])
    assert results["output"].startswith("The grader itself failed.")


def test_the_zip_holds_all_that_the_program_needs(autograder, place):
    source = autograder / "source"
    told = "import sys; sys.path.insert(0, sys.argv[1]); from ekfsim.cli import main; " \
        "sys.argv[:] = ['ekfsim', *sys.argv[2:]]; main()"  # fmt: skip
    asked = [sys.executable, "-I", "-c", told, str(source / "program")]
    for args in (["list"], ["check", str(source / "homework/steps.yaml"), "tour"]):
        done = subprocess.run([*asked, *args], capture_output=True, text=True, check=True)
        assert done.stderr == ""
    needed = (source / "requirements.txt").read_text().split()
    assert {one.partition("==")[0].lower() for one in needed} == {
        *("numpy", "shapely", "matplotlib", "pyyaml", "pydantic", "click", "scipy")
    }
    assert all("==" in one for one in needed)
    for script in ("setup.sh", "run_autograder"):
        subprocess.run(["bash", "-n", source / script], check=True)
        assert "@" not in (source / script).read_text().replace('"$@"', "").replace("[@]", "")
    # tried as the students' code is begun: setpriv itself may still begin a Python that nobody may
    assert '$nobody env -i "$root/venv/bin/python" -I -c' in (source / "run_autograder").read_text()
    first = Path("autograder.zip").read_bytes()
    ekfsim("autograder", "steps.yaml", "-o", "autograder.zip", "--force")
    assert Path("autograder.zip").read_bytes() == first


def test_the_zip_brings_scenes_along_as_they_lie(place):
    for name in ("scenes", "worlds", "course"):
        (place / name).mkdir()
    ekfsim("new", "worlds/lab.yaml", "--kind", "world")
    ekfsim("new", "scenes/one.yaml", "--kind", "commands")
    scene = place / "scenes/one.yaml"
    scene.write_text(scene.read_text().replace("world: world.yaml", "world: ../worlds/lab.yaml"))
    homework = place / "course/hw.yaml"
    homework.write_text(STEPS.replace("[square]", "[../scenes/one.yaml]"))
    assert ekfsim("autograder", "course/hw.yaml", "-o", "a.zip").status == 0
    with zipfile.ZipFile("a.zip") as made:
        own = {name for name in made.namelist() if name.startswith("homework/")}
    assert own == {f"homework/{name}" for name in
                   ("course/hw.yaml", "scenes/one.yaml", "worlds/lab.yaml")}  # fmt: skip
    homework.write_text(STEPS.replace("[square]", f"[{scene}]"))
    told = ekfsim("autograder", "course/hw.yaml", "-o", "b.zip")
    assert told.status == 2
    assert told.err.endswith("is named by its absolute path; name it relative to its file\n")
    assert not Path("b.zip").exists()
