import os

import pytest
from scenes import scene

from ekfsim.commands import Move, Sense
from ekfsim.errors import UsageError
from ekfsim.localization import play
from ekfsim.views.playback.playback import Playback
from ekfsim.views.terminal.player import CHANGED
from ekfsim.views.terminal.watching import LOOK, MOMENT, SETTLED, Watch, counterpart


class Desk:
    """A file, whoever writes it, and whoever watches it; a scene is what stands in it."""

    def __init__(self, folder):
        self.file, self.now = folder / "commands.yaml", 0.0
        self.others = ()
        self.file.write_text("one")
        self.reads = 0
        self.watch = Watch("one", self.read, lambda scene: (self.file, *self.others), self.clock)

    def clock(self):
        return self.now

    def read(self):
        self.reads += 1
        if not self.file.exists() or "wrong" in (text := self.file.read_text()):
            raise UsageError("commands.yaml:1:1: wrong", "commands.yaml:2:1: too")
        return text

    def after(self, seconds):
        """What is new when so much time has passed, looked at again and again."""
        news = []
        for _ in range(round(seconds / 0.05)):
            self.now += 0.05
            if self.watch.look():
                news.append(self.watch.mistake or self.watch.scene)
        return news


MISTAKE = "commands.yaml:1:1: wrong\ncommands.yaml:2:1: too"


@pytest.fixture
def desk(tmp_path):
    return Desk(tmp_path)


def test_what_was_saved_is_read_once(desk):
    assert desk.after(3) == []
    desk.file.write_text("another")
    assert desk.after(SETTLED - 0.05) == []
    assert desk.after(3) == ["another"]
    assert desk.reads == 1


def test_a_file_put_in_the_place_of_another_is_another(desk):
    before = desk.file.stat()
    new = desk.file.with_name("new")
    new.write_text("two")  # as long
    os.utime(new, ns=(before.st_atime_ns, before.st_mtime_ns))  # and as old
    new.replace(desk.file)
    assert desk.after(1) == ["two"]


def test_a_mistake_is_told_when_it_stays(desk):
    desk.file.write_text("wrong")
    assert desk.after(MOMENT - 0.1) == []
    assert desk.after(3) == [MISTAKE]
    assert desk.watch.scene == "one"
    desk.file.write_text("right")
    assert desk.after(1) == ["right"]
    assert desk.watch.mistake == ""


@pytest.mark.parametrize("meanwhile", ["half written, wrong", None])
def test_nothing_is_told_of_what_is_half_saved(desk, meanwhile):
    if meanwhile is None:
        desk.file.unlink()
    else:
        desk.file.write_text(meanwhile)
    assert desk.after(MOMENT - 0.2) == []
    desk.file.write_text("whole")
    assert desk.after(3) == ["whole"]


def test_a_file_that_is_gone_is_told(desk):
    desk.file.unlink()
    assert desk.after(3) == [MISTAKE]


def test_a_file_that_is_named_now_is_watched_from_now_on(desk, tmp_path):
    world = tmp_path / "world.yaml"
    world.write_text("a")
    desk.others = (world,)
    desk.file.write_text("in another world")
    assert desk.after(1) == ["in another world"]
    world.write_text("other walls")
    assert desk.after(1) == ["in another world"]
    assert desk.reads == 2


def test_keys_come_before_news_and_waiting_ends_in_time(desk):
    pressed, waited = iter(["n", None, None, None, None]), []

    def next_key(timeout):
        waited.append(timeout)
        desk.now += timeout
        return next(pressed)

    keys = desk.watch.keys(next_key)
    desk.file.write_text("another")
    assert (keys(None), desk.watch.news) == ("n", False)
    assert (keys(None), desk.watch.news) == (CHANGED, True)
    assert waited == [LOOK] * 4
    assert keys(0.05) is None
    assert waited[-1] == pytest.approx(0.05)


def test_the_same_step_is_found_in_another_run():
    a = scene(Move(1.0, 0.5), Sense(0.2), Move(0.5, 0.0))
    b = scene(Sense(0.1), Sense(0.2))
    one, other = Playback(play(a)), Playback(play(b))
    views = [one.view(number) for number in range(5)]
    places = [(view.step.entry.index, view.beam) for view in map(counterpart, [other] * 5, views)]
    assert places == [(0, False), (1, False), (2, True), (2, False), (2, False)]
