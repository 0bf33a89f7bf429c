"""A student's words, made harmless where they stand in a page or in XML."""

import re

from ekfsim.printable import in_a_line

# signs that mean something anywhere, at the beginning, and at the edge of a word
MARKUP = re.compile(r"[\\`*\[\]<>|&~$]|^[#+\-]|(?<!\w)_|_(?!\w)")
NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def page(text: str) -> str:
    r"""A text in a line of Markdown that means nothing there.

    >>> print(page("<b> *x* | [a](b)"))
    \<b\> \*x\* \| \[a\](b)
    """
    return MARKUP.sub(lambda found: "\\" + found[0], in_a_line(text))


def xml(text: str) -> str:
    """A text without the signs that no XML may hold."""
    return NO_XML.sub("", in_a_line(text))
