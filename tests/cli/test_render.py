"""render: files that are whole or absent, in bounded memory."""

import os
import signal

import pytest
from PIL import Image
from program import (
    LONG,
    MEASURED,
    SHORT,
    WORLD,
    ekfsim,
    ended,
    lay_out,
    left_in,
    process,
    started,
    wait_for,
)

from ekfsim.views.film.png import SIGNATURE
from ekfsim.views.picture.written import lettering

PUT_IN = ["long.yaml", "short.yaml", "world.yaml"]
FRAMES = [f"step-000{name}.png" for name in ("0", "1", "2-beam", "2", "3")]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(lay_out(tmp_path))
    return tmp_path


def pictures(folder):
    assert all(file.read_bytes().startswith(SIGNATURE) for file in folder.iterdir())
    return left_in(folder)


def test_a_picture_for_every_view_in_a_folder(place):
    drawn = ekfsim("render", "short.yaml", "-o", "new/frames")
    assert (drawn.status, drawn.out, drawn.err) == (0, "new/frames: 5 pictures\n", "")
    assert pictures(place / "new/frames") == FRAMES


def test_signs_that_no_font_has_are_told(place, monkeypatch):
    monkeypatch.setattr(lettering, "families", lambda: [lettering.FAMILY])
    lettering._has_glyph.cache_clear()
    (place / "world.yaml").write_text(WORLD.replace("name: desk", "name: 書桌"))
    (place / "short.yaml").write_text(SHORT.replace("The end.", "完 ±2 σ"))
    drawn = ekfsim("render", "short.yaml", "-o", "frames")
    assert drawn.status == 0
    right = "install one that has them, such as Noto Sans CJK or Noto Emoji"
    assert (
        drawn.err
        == f"ekfsim: no font here has 書, 桌, 完: in the picture □ stands for each; {right}\n"
    )
    lettering._has_glyph.cache_clear()


def test_every_n_th_and_the_last(place):
    assert (
        ekfsim("render", "short.yaml", "-o", "frames", "--every", "3").out == "frames: 3 pictures\n"
    )
    assert pictures(place / "frames") == [FRAMES[0], FRAMES[3], FRAMES[4]]
    assert (
        ekfsim("render", "short.yaml", "-o", "one.gif", "--every", "99").out
        == "one.gif: 2 pictures\n"
    )
    assert (place / "one.gif").read_bytes()[:6] == b"GIF89a"


def test_pictures_that_exist_stay_unless_they_are_to_be_replaced(place):
    (place / "frames").mkdir()
    (place / "frames/frame-9999.png").write_text("older")
    refused = ekfsim("render", "short.yaml", "-o", "frames")
    assert refused.status == 2
    assert refused.err.startswith("ekfsim: frames: the folder is not empty; ")
    assert left_in(place / "frames") == ["frame-9999.png"]
    assert ekfsim("render", "short.yaml", "-o", "frames", "--force").status == 0
    assert pictures(place / "frames") == FRAMES
    assert left_in(place) == ["frames", *(f"frames/{name}" for name in FRAMES), *PUT_IN]


def test_a_folder_that_a_link_leads_to_is_filled(place):
    (place / "far").mkdir()
    (place / "link").symlink_to("far")
    assert ekfsim("render", "short.yaml", "-o", "link").status == 0
    assert (place / "link").is_symlink()
    assert pictures(place / "far") == FRAMES


@pytest.mark.parametrize(
    ("out", "why"),
    [
        (
            "foreign",
            "foreign: holds 'thesis.tex', which is no result of ekfsim; choose another folder",
        ),
        ("here", "here: cannot be written: Too many levels of symbolic links"),
        (".", ".: this is the current folder; name a new one"),
        ("world.yaml", "world.yaml: '.yaml' is no kind of picture; "),
        ("world.yaml/frames", "world.yaml/frames: 'world.yaml' is no folder"),
        ("world.yaml/a.gif", "world.yaml/a.gif: 'world.yaml' is no folder"),
        ("foreign.gif", "foreign.gif: this is a folder; name a file"),
        ("frames.jpg", "frames.jpg: '.jpg' is no kind of picture; "),
        ("/dev/null", "/dev/null: this is a file; name a folder"),
        ("/proc/frames", "/proc/frames: cannot be written: "),
    ],
)
def test_where_no_picture_can_be_none_is_drawn(place, out, why):
    (place / "foreign").mkdir()
    (place / "foreign/thesis.tex").write_text("years")
    (place / "foreign.gif").mkdir()
    (place / "here").symlink_to("here")
    before = left_in(place)
    refused = ekfsim("render", "short.yaml", "-o", out, "--force")
    assert (refused.status, refused.out) == (2, "")
    assert refused.err.startswith(f"ekfsim: {why}")
    assert left_in(place) == before
    assert (place / "foreign/thesis.tex").read_text() == "years"


def test_one_step_is_one_picture_as_in_the_folder_of_all_and_alike_each_time(place):
    assert ekfsim("render", "short.yaml", "-o", "all").status == 0
    for step, name in (("2b", "step-0002-beam"), ("2", "step-0002"), ("3", "step-0003")):
        drawn = ekfsim("render", "short.yaml", "--step", step, "-o", f"{step}.png")
        assert (drawn.status, drawn.out) == (0, f"{step}.png: step {step.strip('b')}\n")
        assert (place / f"{step}.png").read_bytes() == (place / f"all/{name}.png").read_bytes()
    for ending in ("svg", "pdf"):
        for out in ("one", "two"):
            drawn = ekfsim("render", "short.yaml", "--step", "2b", "-o", f"{out}.{ending}")
            assert drawn.status == 0
        one, two = ((place / f"{out}.{ending}").read_bytes() for out in ("one", "two"))
        assert one == two
        assert b"short.yaml" in one  # what made it


def test_size_zoom_and_follow_shape_the_pictures(place):
    for more, size in (
        (["--size", "640x480"], (640, 480)),
        (["--size", "1281x900", "--dpi", "140"], (1281, 900)),
        (["--zoom", "1,1,4,1"], None),
        (["--follow"], None),
    ):
        drawn = ekfsim("render", "short.yaml", "--step", "2b", "-o", "a.png", "--force", *more)
        assert (drawn.status, drawn.err) == (0, "")
        with Image.open(place / "a.png") as picture:
            assert size in (None, picture.size)
    assert ekfsim("render", "short.yaml", "-o", "b", "--follow").status == 0
    assert pictures(place / "b") == FRAMES


@pytest.mark.parametrize(
    ("more", "why"),
    [
        (["--step", "4", "-o", "a.png"], "--step 4: the last step is 3"),
        (["--step", "1b", "-o", "a.png"], "--step 1b: step 1 is no reading; leave out the b"),
        (["--step", "1", "-o", "a.gif"], "a.gif: --step draws one picture; name a .png, an .svg"),
        (["--step", "1", "-o", "a"], "a: --step draws one picture; name a .png, an .svg or a .pdf"),
        (["--step", "x", "-o", "a.png"], "'x' is no step; write its number, or 13b for the beam"),
        (["-o", "a.svg"], "a.svg: one picture is of one step; say which, e.g. --step 1"),
        (["--step", "1", "--every", "2", "-o", "a.png"], "--step draws one picture, and --every"),
        (["--zoom", "0,0,1", "-o", "a"], "'0,0,1' is no part of the plane; write X,Y,W,H: the"),
        (["--zoom", "0,0,-1,1", "-o", "a"], "'0,0,-1,1' is no part of the plane"),
        (["--zoom", "0,0,inf,1", "-o", "a"], "'0,0,inf,1' is no part of the plane"),
        (["--zoom", "1e9,0,1e-9,1", "-o", "a"], "'1e9,0,1e-9,1' is no part of the plane"),
        (
            ["--zoom", "0,0,1,1", "--follow", "-o", "a"],
            "--follow and --zoom both say what is shown",
        ),
        (["--follow", "-o", "a.html"], "a.html: a page fits its window, and is not drawn with "),
        (["--size", "640x480", "--dpi", "300", "-o", "a"], "--size 640x480 at 300 dpi is 2.13 by"),
    ],
)
def test_options_that_do_not_fit_are_refused_in_a_line(place, more, why):
    refused = ekfsim("render", "short.yaml", *more)
    assert (refused.status, refused.out) == (2, "")
    assert why in refused.err
    assert left_in(place) == PUT_IN


@pytest.mark.parametrize(
    "more", [[], ["-o", ""], ["-o", "-"], ["-o", "a", "--every", "0"], ["-o", "a", "--every", "x"]]
)
def test_wrong_usage(place, more):
    assert ekfsim("render", "short.yaml", *more).status == 2
    assert left_in(place) == PUT_IN


@pytest.mark.parametrize(
    ("number", "status", "out"),
    [
        ("SIGINT", 130, "frames"),
        ("SIGTERM", 143, "frames.gif"),
        ("SIGKILL", -9, "frames"),
        ("SIGKILL", -9, "frames.gif"),
    ],
)
def test_pictures_that_are_interrupted_do_not_appear(place, number, status, out):
    (place / "long.yaml").write_text(LONG.replace("20000", "1000"))
    running = started("render", "long.yaml", "-o", out)
    wait_for(lambda: any(place.glob(".frames*.partial")), running)
    running.send_signal(getattr(signal, number))
    assert ended(running).status == status
    left = sorted(file.name for file in place.iterdir() if file.name not in PUT_IN)
    assert len(left) == (number == "SIGKILL")
    assert all(name.startswith(".frames") and name.endswith(".partial") for name in left)


def test_the_names_of_files_reach_the_pictures_whatever_they_hold(place):
    name = "кабинет\udcff\x1b[31m\n.yaml"
    (place / name).write_text((place / "short.yaml").read_text())
    for out in ("frames", "one.gif"):
        drawn = ekfsim("render", name, "-o", out, "--every", "99")
        assert (drawn.status, drawn.err) == (0, "")


def test_memory_does_not_grow_with_the_scenario(place):
    peaks = []
    for times in (10, 6000):
        (place / "long.yaml").write_text(
            LONG.replace("20000", str(times)).replace("{sense: {angle: 0}}, ", "say: n, ")
        )
        (place / "long.yaml").write_text(
            f"world: world.yaml\ncommands: [{{repeat: {{times: {times}, commands: [say: n]}}}}]"
        )
        drawn = process(
            "render", "long.yaml", "-o", f"{times}.gif", "--every", "1000", program=MEASURED
        )
        assert drawn.status == 0
        peaks.append(int(drawn.err))
    assert peaks[1] < peaks[0] + 6000  # kB


def test_settings_that_matplotlib_refuses_are_told(place):
    (place / "settings").mkdir()
    (place / "settings/matplotlibrc").write_bytes(b"\xff")
    refused = process("render", "short.yaml", "-o", "frames", MPLCONFIGDIR="settings")
    assert refused.status == 2
    assert "ekfsim: matplotlib does not accept its settings: " in refused.err
    assert not (place / "frames").exists()


EACH = """\
import os, sys
import ekfsim
from ekfsim import cli
from ekfsim.study import block, plan
ekfsim.load_scene("short.yaml")
assert "matplotlib" not in sys.modules
for line in sys.stdin.read().splitlines():
    if os.fork() == 0:  # matplotlib reads its settings once a process
        backend, settings, *arguments = line.split()
        os.environ.update(MPLBACKEND=backend.strip("-"), MATPLOTLIBRC=settings)
        sys.argv = ["ekfsim", *arguments]
        cli.main()
    print(os.waitstatus_to_exitcode(os.wait()[1]), flush=True)
"""
DRAWING = """\
nonsense none render short.yaml -o frames --every 9
module://matplotlib_inline.backend_inline none render short.yaml -o frames.gif --every 9
- odd render short.yaml -o again --every 9
nonsense none study short.yaml --runs 2 -o world.yaml
nonsense none compare short.yaml --b guard=skip --runs 2 -o world.yaml
nonsense none play short.yaml --show files
nonsense none figures gnss -o world.yaml
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a process cannot be doubled here")
def test_files_are_drawn_whatever_backend_of_windows_the_settings_name(place):
    for name, settings in (("none", ""), ("odd", "backend: nonsense")):
        (place / name).write_text(settings)
    drawn = process(keys=DRAWING.encode(), program=EACH)
    assert [int(line) for line in drawn.out.splitlines() if line.isdigit()] == [0, 0, 0, 2, 2, 0, 2]
    # what is asked when all can be drawn
    assert drawn.err == 3 * "ekfsim: world.yaml: this is a file; name a folder\n"
    for result in (
        "frames/step-0000.png",
        "frames.gif",
        "again/step-0000.png",
        "out/current.png",
    ):
        assert (place / result).exists()


def test_a_home_that_cannot_be_written_is_no_matter(place):
    told = process(
        "render",
        "short.yaml",
        "-o",
        "out",
        HOME="/proc/nowhere",
        XDG_CONFIG_HOME="",
        XDG_CACHE_HOME="",
    )
    assert (told.status, told.err) == (0, "")
