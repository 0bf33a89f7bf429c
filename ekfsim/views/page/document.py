"""A text for a browser that brings its style and its script with it, and allows no other."""

import base64
import hashlib
import re
from collections.abc import Mapping
from html import escape
from importlib.resources import files


def text_of(name: str, room: str = "page") -> str:
    """A file of the folder browser/ in a room of the views."""
    return (files(f"ekfsim.views.{room}") / "browser" / name).read_text(encoding="utf-8")


def filled(template: str, facts: Mapping[str, str], markup: Mapping[str, str]) -> str:
    """A template with everything in the place of its {{name}}: facts as text, markup as it is.

    >>> filled("<b>{{a}}</b>{{b}}", {"a": "1 < 2"}, {"b": "<hr>"})
    '<b>1 &lt; 2</b><hr>'
    """
    told = {name: escape(text) for name, text in facts.items()} | dict(markup)
    return re.sub(r"{{(\w+)}}", lambda name: told[name[1]], template)


def hashed(text: str) -> str:
    """By which a page's policy knows its own style and script, and allows no other."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
