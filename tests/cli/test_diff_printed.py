"""`ekfsim diff --csv` and `--narrative`: the numbers of a program in another language."""

import csv
import io
import math
from pathlib import Path

import pytest
from program import ekfsim

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import load_scene

SAMPLE = Path(__file__).parents[2] / ".." / "shared" / "documents" / "002_c97c9a2cbe37d538.txt"
# the assignment's format with numbers of our own, of which three do not follow from the others
OWN_SAMPLE = """\
==>The robot moved: distance=2, angle=90
Current state estimate is (x, y, th) = (1.00000, 2.00000, 60.0000)
New state estimate is (x, y, theta) = (2.00000, 3.73205, 150.000)
New state covariance matrix is:
[[0.0400000 0.0100000 0.00200000]
[0.0100000 0.0200000 0.00100000]
[0.00200000 0.00100000 0.0100000]]

Uncertainty ellipse is:
  minor radius is 0.251856
  major radius is 0.420201
  orientation is 22.5 degrees
  2*sigma_theta is 0.2 degrees
"""
WRONG = """\
def predict(x, P, u, motion):
    F, G = motion.F(motion.f(x, u), u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T

def update(x, P, z, sensor):
    H = sensor.H(x)
    K = P @ H.T / (H @ P @ H.T + sensor.R(x))
    return x + K @ (z - sensor.h(x)), P - K @ H @ P
"""
NAMES = "index,x,y,theta,P_xx,P_xy,P_xtheta,P_yy,P_ytheta,P_thetatheta"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def table(commands="tour", digits="{:.6g}", options=(), unit=math.degrees):
    """The reference's own results, as another program might have written them: rows of texts."""
    ekfsim("run", commands, "-q", "--csv", "table.csv", "--force", *options)
    rows = csv.DictReader(io.StringIO(Path("table.csv").read_text()))
    made = []
    for row in rows:
        if row["type"] in ("move", "sense"):
            entries = [float(row[name]) for name in list(row)[2:11]]
            entries[2] = unit(entries[2])
            made.append([row["index"], *(digits.format(value) for value in entries)])
    return made


def written(rows, names=NAMES, separator=","):
    lines = [separator.join(row) for row in [names.split(","), *rows]]
    Path("theirs.csv").write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize("digits", ["{:.17g}", "{:.6g}", "{:.6f}", "{:.4f}", "{:.3g}"])
def test_right_results_are_equal_however_few_their_digits(digits):
    written(table(digits=digits))
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert ended.status == 0
    head = "theirs.csv equals ekf at all 23 steps (8 moves, 15 readings) of 1 run."
    assert ended.out.startswith(head)
    assert "theirs.csv: headings are read as degrees" in ended.err


def test_digits_that_do_not_suffice_are_told():
    written(table(digits="{:.3g}"))
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert "cannot be judged: the printed digits leave more than 0.1 σ open" in ended.err
    written(table(digits="{:.6g}"))
    assert "cannot be judged" not in ekfsim("diff", "tour", "--csv", "theirs.csv").err


def test_a_number_that_is_wrong_by_a_digit_is_found_and_the_next_step_is_not():
    rows = table()
    rows[6][4] = f"{float(rows[6][4]) * 1.01:.6g}"
    written(rows)
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert ended.status == 1
    assert ended.out.startswith("theirs.csv differs from ekf at 2 of 23 steps")
    assert f"First at step {rows[6][0]} (" in ended.out
    assert f"P_xx  {rows[6][4]}" in " ".join(ended.out.split(" ")).replace("  P_xx", "P_xx")


def test_few_digits_hide_no_wrong_P_after_a_move():
    rows = table(digits="{:.4g}")
    rows[0][7] = rows[0][4]  # P_yy is P_xx: the noise went the same way to all sides
    written(rows)
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert ended.status == 1
    assert "First at step 2" in ended.out
    assert "P_yy" in ended.out


def test_mistakes_are_named_from_six_digits():
    """With the twist of the counter-examples that a filter of ours can be set to make."""
    options = ("--set", "filter.crossCovariances=dropped")
    written(table(options=options))
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert ended.status == 1
    assert "Guess:" in ended.out
    assert "Read again:" in ended.out


FORMS = [
    *("radians", "semicolons", "tabs", "spaces", "BOM", "nine", "order", "words", "hats"),
    "degrees",
]


@pytest.mark.parametrize("form", FORMS)
def test_a_table_may_be_written_in_many_ways(form):
    rows, names, separator = table(), NAMES, ","
    if form == "radians":
        rows = table(unit=float)
    elif form == "semicolons":
        rows, separator = [[one.replace(".", ",") for one in row] for row in rows], ";"
    elif form == "tabs":
        separator = "\t"
    elif form == "spaces":
        separator = "  "
    elif form == "degrees":  # in P, too
        powers = [0, 0, 0, 0, 0, 1, 0, 1, 2]
        rows = [
            [row[0], *(f"{float(one) * math.degrees(1) ** power:.6g}"
                       for one, power in zip(row[1:], powers, strict=True))]
            for row in table(digits="{:.17g}")
        ]  # fmt: skip
    elif form == "nine":
        names = "k,x,y,th,p11,p12,p13,p21,p22,p23,p31,p32,p33"
        rows = [[*r[:7], r[5], r[7], r[8], r[6], r[8], r[9]] for r in rows]
    elif form == "order":
        names, rows = ",".join(names.split(",")[::-1]), [row[::-1] for row in rows]
    elif form == "words":
        names = "Step,X [m],Y [m],Heading (deg),var_x,sigma_xy,sigma_xth,var_y,sigma_yth,var_theta"
    elif form == "hats":
        names = (
            "k,x_hat,mu_y,theta_est,sigma_x^2,sigma_xy,sigma_xth,σ_y²,sigma_yth,sigma_th^2 [rad^2]"
        )
    written(rows, names, separator)
    if form == "BOM":
        Path("theirs.csv").write_bytes(b"\xef\xbb\xbf" + Path("theirs.csv").read_bytes())
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert (ended.status, ended.out[:32]) == (0, "theirs.csv equals ekf at all 23 ")
    unit = "radians" if form == "radians" else "degrees"
    assert f"headings are read as {unit}" in ended.err
    assert ("P is read as of m and degrees" in ended.err) == (form == "degrees")


def test_rows_may_be_missing_or_counted_by_themselves():
    rows = table()
    written([*rows[:4], *rows[5:]])
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert (ended.status, ended.out[:28]) == (0, "theirs.csv equals ekf at all")
    assert "21 steps" in ended.out
    assert f"no row of step {rows[4][0]}: not compared, nor is what follows" in ended.err
    written([[str(n), *row[1:]] for n, row in enumerate(rows, 1)])
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert "equals ekf at all 23 steps" in ended.out
    assert "its index counts the moves and beams: row 1 is of step 2" in ended.err
    written([row[1:] for row in rows], NAMES.removeprefix("index,"))
    assert "equals ekf at all 23 steps" in ekfsim("diff", "tour", "--csv", "theirs.csv").out


def test_the_table_of_the_program_itself_is_one():
    """In radians, with a row of each text, and with columns of other things."""
    ekfsim("run", "tour", "-q", "--csv", "theirs.csv")
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert (ended.status, ended.out[:32]) == (0, "theirs.csv equals ekf at all 23 ")
    assert "headings are read as radians" in ended.err


def test_the_results_of_a_handed_out_log_are_held_against_it():
    ekfsim("record", "tour", "-o", "log", "--seed", "9")
    written(table(options=("--log", "log")))
    ended = ekfsim("diff", "tour", "--log", "log", "--csv", "theirs.csv")
    assert (ended.status, ended.out[:32]) == (0, "theirs.csv equals ekf at all 23 ")
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")  # of another seed
    assert ended.status == 1
    assert "nearly every step differs: is it of this --seed, --run, --log?" in ended.err


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "theirs.csv:1:1: the file is empty; it begins with a line like index,x,y,theta,"),
        ("1,2,3\n", "theirs.csv:1:1: '1,2,3' names no columns; the first line is e.g. index,"),
        (
            "index,x,y,theta,Pxx,Pxy,Pxt,Pyy,P_xx,Pyt,Ptt\n",
            "theirs.csv:1:1: 2 columns are named 'Pxx'; keep the one that holds the number",
        ),
        ("index,x,y\n", "theirs.csv:1:1: no column is named theta, nor P_xx, P_xy, P_xtheta, "),
        (f"{NAMES}\n2,1,2\n", "theirs.csv:2:1: 3 columns stand in this row; it must have 10, as"),
        (f"{NAMES}\n2,1,?,3,1,0,0,1,0,1\n", "theirs.csv:2:5: '?' is not a number; write e.g. 0"),
        (f"{NAMES}\n5,1,2,3,1,0,0,1,0,1\n", "theirs.csv:2:1: index: 5 is no move or beam;"),
        (f"{NAMES}\n{'2,1,2,3,1,0,0,1,0,1' + chr(10)}" * 1 + "2,1,2,3,1,0,0,1,0,1\n",
         "theirs.csv:3:1: the index 2 stands twice; each step has one row"),
    ],
)  # fmt: skip
def test_a_table_that_is_wrong_is_told_with_its_place(text, told):
    Path("theirs.csv").write_text(text)
    ended = ekfsim("diff", "tour", "--csv", "theirs.csv")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith(told)


def test_exactly_one_thing_is_compared():
    for options in ((), ("--csv", "a", "--narrative", "b"), ("--filter", "a.py", "--csv", "b")):
        ended = ekfsim("diff", "tour", *options)
        assert (ended.status, ended.out) == (2, "")
        assert "one of --filter, --csv and --narrative" in ended.err
    ended = ekfsim("diff", "tour", "--csv", "a", "--runs", "2")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith("ekfsim: --runs: a file is of one run")
    ended = ekfsim("diff", "mower", "--csv", "a")
    assert ended.status == 2
    assert "results in files are the classroom's: compare a filter with --filter" in ended.err


CLASSROOMS = [
    name for name in packaged("commands")
    if not name.endswith(("log", "bag")) and (made := load_scene(name)).commanded
    and made.filter == "ekf"
]  # fmt: skip


@pytest.mark.parametrize(
    "run", [*CLASSROOMS, "tour --explain", "diverge-01-wrong-wall --explain --seed 5"]
)
def test_our_own_narrative_is_right(run):
    name, *options = run.split()
    Path("told.txt").write_text(ekfsim("run", name, *options).out)
    seed = options[1:]
    ended = ekfsim("diff", name, *seed, "--narrative", "told.txt")
    if name == "proof-unsure-start":  # nothing happens in it
        assert ended.status == 2
        return
    assert ended.out.startswith("told.txt is right: all ")
    assert (ended.status, ended.err) == (0, "")


def test_the_narrative_of_a_log_is_right():
    ekfsim("record", "tour", "-o", "log")
    Path("told.txt").write_text(ekfsim("run", "tour", "--log", "log").out)
    assert ekfsim("diff", "tour", "--log", "log", "--narrative", "told.txt").status == 0


@pytest.mark.parametrize("name", ["ukf", "kf", "iekf"])
def test_other_filters_are_right_beside_themselves(name):
    run = ekfsim("run", "tour", "--filter", name, "--csv", "theirs.csv")
    Path("told.txt").write_text(run.out)
    against = ("diff", "tour", "--against", name)
    assert ekfsim(*against, "--narrative", "told.txt").status == 0
    assert ekfsim(*against, "--csv", "theirs.csv").status == 0
    assert ekfsim("diff", "tour", "--csv", "theirs.csv").status == 1


def test_the_narrative_of_a_wrong_filter_is_named():
    """By the equations of its own, in the assignment's lines alone."""
    Path("mine.py").write_text(WRONG)
    lines = ekfsim("run", "tour", "--filter", "mine.py").out.split("\n")
    ours = ("odometry", "innovation", "gain", "First", "It was expected", "NIS", "NEES")
    lines = [line for line in lines[lines.index("==>The robot moved: distance=2.6, angle=0") :]
             if not any(word in line for word in ours)]  # fmt: skip
    Path("told.txt").write_text("\r\n".join(lines))
    ended = ekfsim("diff", "tour", "--narrative", "told.txt")
    whole = " ".join(ended.out.split())
    assert (ended.status, ended.err) == (1, "")
    assert "Guess: your P is the one with J_x taken after the move." in whole
    assert "Line 38: " not in whole  # the first moves go straight ahead


@pytest.mark.skipif(not SAMPLE.exists(), reason="the documents are not here")
def test_the_assignment_s_own_sample_is_wrong():
    ended = ekfsim("diff", "tour", "--narrative", SAMPLE)
    assert ended.status == 1
    assert "is wrong in 12 of the 18 numbers of 2" in " ".join(ended.out.split())
    assert "First, line 50: the minor radius is 0.131259 m, right is 0.151289 m." in ended.out
    whole = " ".join(ended.out.split())
    for told in (
        "Line 52: the orientation is 169.911 degrees, right is 177.829 degrees.",
        "Line 53: 2*sigma_theta is 12.4428 degrees, right is 21.8193 degrees.",
        "Line 64: P_yy is 0.0301436, right is at most 0.00375455.",
        "Line 70: 2*sigma_theta is 10.0145 degrees, right is 15.4424 degrees.",
        "this narrative is of another run: only what hangs together in it is checked",
    ):
        assert told in whole


def test_a_sample_of_our_own_is_wrong_where_it_is():
    Path("told.txt").write_text(OWN_SAMPLE)
    ended = ekfsim("diff", "tour", "--narrative", "told.txt")
    whole = " ".join(ended.out.split())
    assert ended.status == 1
    assert "is wrong in 3 of the" in whole
    assert "line 10: the minor radius is 0.251856 m, right is 0.3125 m. Guess: this is the" in whole
    assert "Line 11: the major radius is 0.420201 m, right is 0.52138 m. (the same)" in whole
    assert "2*sigma_theta is 0.2 degrees, right is 11.4592 degrees. Guess: it is in rad" in whole
