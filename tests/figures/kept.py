"""An album that keeps its figures, for tests to look at their artists."""

import csv
from dataclasses import dataclass, field

from matplotlib.figure import Figure

from ekfsim.figures.album import Album


@dataclass
class Kept(Album):
    """It writes no picture."""

    drawn: dict[str, Figure] = field(default_factory=dict)
    captions: dict[str, str] = field(default_factory=dict)

    def add(self, figure, name, title, caption, source=None):
        self.drawn[name], self.captions[name] = figure, caption

    def rows(self, name):
        """A table's rows by their first cell."""
        with (self.folder / f"{name}.csv").open(encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        return {row[0]: dict(zip(header[1:], row[1:], strict=True)) for row in rows}

    def line(self, name, label, panel=0):
        """The line of a figure whose label begins so."""
        return next(
            line
            for line in self.drawn[name].axes[panel].lines
            if str(line.get_label()).startswith(label)
        )
