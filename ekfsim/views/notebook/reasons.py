"""Why the run of a scene was lost, as the command line says it."""

from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import load_scene
from ekfsim.scene import Scene
from ekfsim.why import Explanation, explain


def why(scene: Scene | str | Path, runs: int = 1000, budget: int | None = None) -> Explanation:
    """Play the run of a scene again with one thing put right at a time, on the same draws: what
    cures it is why it was lost. A notebook shows what `ekfsim why` prints, and its picture.

    runs : of the seed, that stand behind the name and the shares; budget : how many times the run
    is played again, at most. Raises UsageError or InputError where what is asked is no sound scene.
    """
    one = scene if isinstance(scene, Scene) else load_scene(scene)
    if one.beside:
        raise UsageError("why: one filter is asked; name one")
    if runs < 1 or (budget is not None and budget < 1):
        raise UsageError(f"why: runs {runs}, budget {budget}: each is 1 at least")
    return explain(one, runs, budget)
