"""What is told of wrong numbers alike, whatever they are found in."""

import textwrap

from ekfsim.printable import in_a_line

WIDE = 80  # columns, as fit into a mail
DEEPER = 8 * " "  # before what is left of a long row


def apart(theirs: float, right: float) -> tuple[str, str]:
    """Both values, with as many digits as tell them apart.

    >>> apart(1.0, 1.25), apart(1.0, 1.00000001)
    (('1', '1.25'), ('1', '1.00000001'))
    """
    for digits in range(6, 18):
        told = f"{theirs:.{digits}g}", f"{right:.{digits}g}"
        if told[0] != told[1]:
            break
    return told


def filled(part: str) -> str:
    """Lines of at most 80 columns; what stands in columns stays as it is, but for long rows."""
    return "\n".join(
        textwrap.fill(
            in_a_line(line), WIDE, subsequent_indent=DEEPER if line.startswith("  ") else ""
        )
        for line in part.rstrip("\n").split("\n")
    )
