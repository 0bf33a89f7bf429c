"""The one door between records and what a notebook shows of them.

A record says what it is in one line by its `repr`. In a notebook it shows itself: words and
picture, made by `views/notebook/showing.py`, which is imported only then.
"""


class Shown:
    """What a notebook shows as words and a picture. It costs a record nothing."""

    __slots__ = ()

    def _repr_html_(self) -> str | None:
        """For whatever shows HTML: Jupyter, VS Code, marimo, Quarto."""
        from ekfsim.views.notebook.showing import html

        return html(self)

    def _repr_png_(self) -> bytes | None:
        """For whatever shows pictures alone; None where there is none."""
        from ekfsim.views.notebook.showing import picture

        return picture(self)
