"""Document 002, the teaching assignment:
the display, inputs that prove the program, a divergence, and σ_xθ.
"""

from ekfsim.commands import Move
from ekfsim.figures.album import (
    Album,
)
from ekfsim.figures.classroom.divergence import divergence
from ekfsim.figures.classroom.ellipses import ellipse_size, theta_question
from ekfsim.figures.classroom.proofs import proof_rows
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.views.picture.extent import scope
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View


def draw_classroom(scene: Scene, album: Album) -> None:
    """Draw them into an album. scene : the tour"""
    contact_sheet(scene, album)
    album.table(
        "proofs", "Inputs that show the program is right", ["input", "what is looked at",
        "expected", "measured"],
        list(proof_rows()),
        "Each is a commands file that comes along (`ekfsim run proof-corner`), and says in its "
        "description what to expect and why. Expected values are worked out by hand from the "
        "assignment's equations, not by the program.",
    )  # fmt: skip
    divergence(scene, album)
    theta_question(album)
    ellipse_size(album)
    album.note(
        "The sample output",
        "The numbers of the assignment's sample output are made up, as its text says: they do not "
        "hang together, and no program can reproduce them. Its layout is kept; `ekfsim run tour` "
        "shows it with numbers that fit.",
    )


def contact_sheet(scene: Scene, album: Album) -> None:
    """The display after some of the commands."""
    shown, extent = list(views(play(scene))), scope.of(scene, play(scene))
    frame = Frame(scene, extent)
    figure = album.figure(15.0, 17.7)
    for axes, view in zip(figure.subplots(3, 2).flat, _chosen(shown), strict=True):
        axes.imshow(frame.rgb(view), interpolation="antialiased")
        axes.set_axis_off()
    album.add(
        figure, "display", "The display after every command",
        f"Six of the {len(shown)} views (a beam has two) of `ekfsim play {_name(scene)}`; `ekfsim "
        f"render {_name(scene)} -o DIR` makes them all. The start; the ellipse after a straight "
        "move, a line; the ellipse after the turn and more of the way; a beam, drawn from the "
        "estimate as long as it was measured; the revised estimate, thinner along the beam; and "
        "the end. The assignment asks for walls, path, ellipse, cone and beam; beyond it the "
        "picture shows the truth, where the filter expected the beam to end, and a close-up.",
    )  # fmt: skip


def _chosen(shown: list[View]) -> list[View]:
    """Start, first move, before the first beam, the first beam, its update, end."""
    moves = [view for view in shown if isinstance(view.step.entry.command, Move)]
    beams = [view for view in shown if view.beam]
    beam = beams[0].number
    before = [view for view in moves if view.number < beam][-1]
    return [shown[0], moves[0], before, shown[beam], shown[beam + 1], shown[-1]]


def _name(scene: Scene) -> str:
    return scene.commands_source.rpartition("/")[2].removesuffix(".yaml")
