import shutil
import tracemalloc
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scenes import DESK, scene

from ekfsim.commands import Move, Repeat, Sense
from ekfsim.errors import RunError, UsageError
from ekfsim.localization import play
from ekfsim.provenance import metadata, told_in_a_line
from ekfsim.views.film import animation, gif, video
from ekfsim.views.film.animation import render
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views

RUN = scene(
    Move(1.0, 0.5),
    Sense(0.3),
    Move(1.0, -0.5),
    Sense(0.3),
    sigma=(0.1, 0.1, 0.1),
    obstacles=(DESK,),
)
NAMES = [f"step-000{name}.png" for name in ("0", "1", "2-beam", "2", "3", "4-beam", "4")]
VIEWS = len(NAMES)  # the start, two moves, two beams and what came of them


def rendered(target, run=RUN, **how):
    render(views(play(run)), run, scopes.of(run, play(run)), target, **how)
    return target


def test_a_folder_of_numbered_pictures(tmp_path):
    made = sorted(path.name for path in rendered(tmp_path / "out").iterdir())
    assert made == NAMES
    with Image.open(tmp_path / "out" / "step-0002-beam.png") as picture:
        assert picture.text == {**metadata(RUN), "View": "2"}
        frame = Frame(RUN, scopes.of(RUN, play(RUN)))
        assert np.array_equal(np.asarray(picture), frame.rgb(list(views(play(RUN)))[2]))


@pytest.mark.parametrize(
    ("every", "numbers"), [(1, range(7)), (3, [0, 3, 6]), (4, [0, 4, 6]), (100, [0, 6])]
)
def test_every_so_many_views_and_the_last(tmp_path, every, numbers):
    made = sorted(path.name for path in rendered(tmp_path / "out", every=every).iterdir())
    assert made == [NAMES[number] for number in numbers]


def test_a_gif_has_a_frame_for_each_view_at_its_tempo_and_says_what_made_it(tmp_path):
    told = []
    with Image.open(rendered(tmp_path / "run.gif", progress=told.append)) as picture:
        assert picture.n_frames == VIEWS
        assert picture.info["comment"].decode() == told_in_a_line(RUN)
        assert picture.info["loop"] == 0
        durations = []
        for number in range(VIEWS):
            picture.seek(number)
            durations.append(picture.info["duration"])
        assert durations == [1200, 1200, 800, 1200, 1200, 800, 3200]
    assert told == list(range(1, VIEWS + 1))


def test_a_gif_looks_like_its_pictures(tmp_path):
    frame, every = Frame(RUN, scopes.of(RUN, play(RUN))), list(views(play(RUN)))
    with Image.open(rendered(tmp_path / "run.gif")) as picture:
        for view in every:
            picture.seek(view.number)
            seen = np.asarray(picture.convert("RGB")).astype(int)
            wanted = frame.rgb(view).astype(int)
            assert (np.abs(seen - wanted).max(axis=-1) > 40).mean() < 1e-3
            assert (seen[wanted.min(axis=-1) == 255] == 255).all()  # white stays white


def test_equal_pictures_are_still_frames(tmp_path):
    pixels = np.full((6, 8, 4), 255, np.uint8)
    with (tmp_path / "still.gif").open("wb") as file:
        gif.write(file, [(pixels, 1.0)] * 3, "still")
    with Image.open(tmp_path / "still.gif") as picture:
        assert picture.n_frames == 3


def test_a_gif_holds_only_what_changed(tmp_path):
    pixels = np.full((60, 80, 4), 255, np.uint8)
    after = pixels.copy()
    after[20:30, 40:45] = (0, 0x72, 0xB2, 255)
    after[25, 42] = 255
    with (tmp_path / "moved.gif").open("wb") as file:
        gif.write(file, [(pixels, 1.0), (after, 1.0), (pixels, 1.0)], "moved")
    with Image.open(tmp_path / "moved.gif") as picture:
        for number, expected in enumerate((pixels, after, pixels)):
            picture.seek(number)
            assert picture.tile[0][1] == ((40, 20, 45, 30) if number else (0, 0, 80, 60))
            assert np.array_equal(np.asarray(picture.convert("RGB")), expected[..., :3])


def decoded(path):
    av = pytest.importorskip("av")
    with av.open(str(path)) as container:
        assert told_in_a_line(RUN) in container.metadata["comment"]
        stream = container.streams.video[0]
        assert stream.codec_context.pix_fmt == "yuv420p"
        return [
            (frame.pts * frame.time_base, frame.to_ndarray(format="rgb24"))
            for frame in container.decode(stream)
        ]


def test_an_mp4_has_a_frame_for_each_view_at_its_tempo(tmp_path):
    pytest.importorskip("av")
    shown = decoded(rendered(tmp_path / "run.mp4"))
    tenths = [0, 12, 24, 32, 44, 56, 64]
    assert [time for time, _ in shown] == [Fraction(tenth, 10) for tenth in tenths]
    frame = Frame(RUN, scopes.of(RUN, play(RUN)))
    for (_, pixels), view in zip(shown, views(play(RUN)), strict=True):
        assert np.abs(pixels.astype(int) - frame.rgb(view)).mean() < 3


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_an_mp4_by_ffmpeg(tmp_path):
    pixels = np.zeros((7, 9, 3), np.uint8)
    video.with_ffmpeg(tmp_path / "run.mp4", [(pixels, 0.8), (pixels, 1.2)], told_in_a_line(RUN))
    assert len(decoded(tmp_path / "run.mp4")) == 5


def test_what_ffmpeg_complains_of_is_told(tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho first >&2\necho unknown encoder >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    with pytest.raises(RunError, match=r"run\.mp4: ffmpeg failed: unknown encoder"):
        video.with_ffmpeg(Path("run.mp4"), [(np.zeros((700, 900, 3), np.uint8), 1.0)] * 3, "")


def test_without_a_video_encoder_a_way_out_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(
        UsageError, match=r"pip install 'ekfsim\[video\]', or choose a name that ends in \.gif"
    ):
        rendered(tmp_path / "run.mp4")
    assert list(tmp_path.iterdir()) == []


def test_other_suffixes_are_refused(tmp_path):
    with pytest.raises(
        UsageError,
        match=r"'\.avi' is no kind of picture; name a \.gif, an \.mp4, an \.html",
    ):
        rendered(tmp_path / "run.avi")
    with pytest.raises(UsageError, match="choose 1 or more"):
        rendered(tmp_path / "run.gif", every=0)


@pytest.mark.parametrize("name", ["run.gif", "run.mp4", "run"])
def test_what_exists_is_replaced_by_force_only(tmp_path, name):
    if name.endswith("mp4"):
        pytest.importorskip("av")
    rendered(tmp_path / name)
    with pytest.raises(UsageError, match="--force"):
        rendered(tmp_path / name)
    rendered(tmp_path / name, force=True)


@pytest.mark.parametrize("name", ["run.gif", "run.mp4", "run"])
def test_nothing_is_left_of_a_run_that_breaks_off(tmp_path, name):
    if name.endswith("mp4"):
        pytest.importorskip("av")

    def broken():
        yield from list(views(play(RUN)))[:3]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        render(broken(), RUN, scopes.of(RUN, play(RUN)), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_memory_does_not_grow_with_the_number_of_pictures(tmp_path, monkeypatch):
    monkeypatch.setattr(
        animation.Frame,
        "rgb",
        lambda frame, view: np.full((70, 90, 3), view.number % 256, np.uint8),
    )

    def peak(times):
        run = scene(Repeat(times, (Sense(0.3),)), obstacles=(DESK,))
        extent = scopes.of(run, play(run))
        tracemalloc.start()
        render(views(play(run)), run, extent, tmp_path / f"{times}.gif")
        highest = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return highest

    peak(5)  # what is loaded once
    # 400 pictures more, of 6 kB each with their colours as numbers
    assert peak(220) < peak(20) + 1_000_000
