"""A PNG file as kitty and iTerm2 read it, at the cursor, over so many cells."""

from base64 import standard_b64encode
from collections.abc import Iterator

CHUNK = 4096  # bytes of kitty's payload at once


def kitty(png: bytes, number: int, columns: int, rows: int) -> Iterator[str]:
    """Show an image of some number; the cursor stays, and nothing is answered."""
    payload = standard_b64encode(png).decode()
    head = f"a=T,f=100,t=d,i={number},c={columns},r={rows},C=1,q=2,"
    for first in range(0, len(payload), CHUNK):
        chunk = payload[first : first + CHUNK]
        more = int(first + CHUNK < len(payload))
        yield f"\x1b_G{head}m={more};{chunk}\x1b\\"
        head = ""


def kitty_removed(number: int) -> str:
    """Take the image away, and forget it."""
    return f"\x1b_Ga=d,d=I,i={number},q=2\x1b\\"


def iterm2(png: bytes, columns: int, rows: int) -> str:
    """Show an image."""
    size = f"width={columns};height={rows};preserveAspectRatio=0"
    payload = standard_b64encode(png).decode()
    return f"\x1b]1337;File=inline=1;size={len(png)};{size};doNotMoveCursor=1:{payload}\x07"
