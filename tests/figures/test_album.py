"""An album says in every file what made it."""

import csv

from PIL import Image

from ekfsim.figures.album import Album


def test_every_file_of_an_album_says_what_made_it(tmp_path):
    album = Album("Title", "made by seed 7", tmp_path, ("png", "svg", "pdf"))
    figure = album.figure()
    figure.subplots().plot([0, 1])
    album.add(figure, "one", "One", "See.")
    album.table("two", "Two", ["what", "how much"], [["error", "−1.5"]], "See.")
    album.close()
    assert Image.open(tmp_path / "one.png").text["Description"] == "made by seed 7"
    assert "made by seed 7" in (tmp_path / "one.svg").read_text()
    assert "<dc:date>" not in (tmp_path / "one.svg").read_text()
    assert b"made by seed 7" in (tmp_path / "one.pdf").read_bytes()
    assert b"CreationDate" not in (tmp_path / "one.pdf").read_bytes()
    with (tmp_path / "two.csv").open() as file:
        assert list(csv.reader(file)) == [
            ["what", "how much", "made by"],
            ["error", "-1.5", "made by seed 7"],
        ]
    assert "made by seed 7" in (tmp_path / "captions.md").read_text()


def test_an_album_is_the_same_to_the_byte_when_it_is_made_again(tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        album = Album("Title", "source", tmp_path / folder, ("png", "svg", "pdf"))
        figure = album.figure()
        figure.subplots().plot([0, 1])
        album.add(figure, "one", "One", "See.")
    for name in ("one.png", "one.pdf"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
