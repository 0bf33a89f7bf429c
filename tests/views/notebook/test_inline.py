"""A run plays in a cell: the page of `render -o lesson.html`, and nothing of the notebook's."""

from html.parser import HTMLParser

import ekfsim
from ekfsim.localization import play
from ekfsim.views.page.page import page

SQUARE = ekfsim.load_scene("square")


class Frames(HTMLParser):
    """The attributes of every tag."""

    def __init__(self):
        super().__init__()
        self.tags = []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))


def test_it_is_the_page_in_a_frame_of_its_own():
    shown = ekfsim.animate(SQUARE.with_(filter="ekf,ukf"), height=500)
    parser = Frames()
    parser.feed(shown._repr_html_())
    ((tag, told),) = parser.tags
    scenes = SQUARE.with_(filter="ekf,ukf")
    assert tag == "iframe"
    assert told["srcdoc"] == page(scenes, [list(play(one)) for one in scenes.alone()])
    assert told["sandbox"] == "allow-scripts"
    assert "height: 500px" in told["style"]
    assert len(repr(shown)) < 40
