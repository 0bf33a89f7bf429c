"""What brute force finds by trying every wall, found by trying few. The first that suits answers:

    asked for                 answered by       how
    one beam, or few          single_beam.py    from cell to cell of a grid, in plain floats
    many, where Numba may     compiled.py       the same beam after beam, compiled
    many from one place       scan.py           each wall is asked which beams its ends enclose
    many close together       nearby_beams.py   runs of a study: only what is before them all is
                                                tried, often a single wall
    many, and few walls       few_walls.py      all beams × all walls, as products of matrices
    many, and many walls      many_beams.py     all beams at once from cell to cell of a grid

Round walls are tried after them: by one beam those on its line, by many what round_before.py leaves
of them, or from cell to cell of round_cells.py.

choice.py is where it is decided. How many is many, and how few is few, stands in capitals at the
top of these files. Beams from very far, where rounding is not small against a cell, are brute
force's. Where rounding could decide, `compiled`, `scan`, `nearby_beams` and `few_walls` leave a
beam in doubt, and it is followed once more, by itself or by `many_beams`.

What they share:

    grid.py          cells that list the walls which cross them, and grids within crowded cells
    flat_grid.py     all these grids laid end to end, for arrays
    candidates.py    what a few pairs of beam and wall come to, by the rules of ../rules.py
"""
