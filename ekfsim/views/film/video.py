"""An MP4 (H.264), written frame by frame, by PyAV or by the program ffmpeg."""

import shutil
import subprocess
from collections.abc import Callable, Iterable
from fractions import Fraction
from itertools import chain
from pathlib import Path

from ekfsim.errors import RunError, UsageError
from ekfsim.views.film.png import Pixels

TICK = Fraction(2, 5)  # s: the tempo of the pictures in whole ticks
# a whole picture every 20, for jumping about in it
OPTIONS = {"crf": "20", "preset": "veryfast", "bf": "0", "g": "20"}

Pictures = Iterable[tuple[Pixels, float]]  # (h, w, 3) each, with the seconds that it stays
Writer = Callable[[Path, Pictures, str], None]


def writer() -> Writer:
    """What writes videos here. Raises UsageError where nothing does."""
    try:
        import av  # noqa: F401
    except ImportError:
        if shutil.which("ffmpeg"):
            return with_ffmpeg
        raise UsageError(
            "an .mp4 needs PyAV or ffmpeg: "
            "pip install 'ekfsim[video]', or choose a name that ends in .gif"
        ) from None
    return with_av


def with_av(path: Path, pictures: Pictures, comment: str) -> None:
    """One frame for each picture, shown for its time."""
    import av

    with av.open(str(path), "w", format="mp4") as container:
        container.metadata["comment"] = comment
        stream = container.add_stream("libx264", rate=1 / TICK, options=OPTIONS)
        stream.pix_fmt = "yuv420p"
        stream.codec_context.time_base = TICK
        tick, length = 0, 0
        for pixels, seconds in pictures:
            rgb = even(pixels)
            if tick == 0:
                stream.height, stream.width = rgb.shape[:2]
            frame = av.VideoFrame.from_ndarray(rgb, format="rgb24")
            length = ticks(seconds)
            frame.pts, frame.time_base, frame.duration = tick, TICK, length
            tick += length
            container.mux(stream.encode(frame))
        for packet in stream.encode(None):
            packet.duration = packet.duration or length
            container.mux(packet)


def with_ffmpeg(path: Path, pictures: Pictures, comment: str) -> None:
    """The same through a pipe, where a picture is repeated for its time."""
    coming = iter(pictures)
    first = next(coming)
    height, width = even(first[0]).shape[:2]
    given = [
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-s",
        f"{width}x{height}",
        "-framerate",
        str(1 / TICK),
        "-i",
        "-",
    ]
    wanted = [
        "-c:v",
        "libx264",
        "-pix_fmt",
        "yuv420p",
        "-metadata",
        f"comment={comment}",
        "-f",
        "mp4",
        str(path),
    ]
    options = [word for name, value in OPTIONS.items() for word in (f"-{name}", value)]
    program = ["ffmpeg", "-loglevel", "error", "-y", *given, *options, *wanted]
    with subprocess.Popen(program, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as encoder:
        assert encoder.stdin is not None
        assert encoder.stderr is not None
        try:
            for pixels, seconds in chain([first], coming):
                encoder.stdin.write(even(pixels).tobytes() * ticks(seconds))
            encoder.stdin.close()
        except BrokenPipeError:
            pass  # what it says for itself is told below
        complaint = encoder.stderr.read().decode(errors="replace").strip()
    if encoder.returncode:
        raise RunError(
            f"{path}: ffmpeg failed: "
            f"{complaint.splitlines()[-1] if complaint else encoder.returncode}"
        )


def ticks(seconds: float) -> int:
    """How many ticks a picture stays, at least one."""
    return max(1, round(seconds / TICK))


def even(pixels: Pixels) -> Pixels:
    """Without the last row or column where their number is odd:
    H.264 halves the colours' resolution.
    """
    height, width = pixels.shape[:2]
    return pixels[: height - height % 2, : width - width % 2]
