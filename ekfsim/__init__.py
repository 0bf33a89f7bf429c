"""A teaching simulator for the extended Kalman filter in mobile-robot localization.

A notebook needs no more than this module:

>>> import ekfsim
>>> scene = ekfsim.load_scene("square")   # a path, or the name of one that comes along
>>> steps = list(ekfsim.play(scene))       # simulate and localize; a Step for each command
>>> views = list(ekfsim.Playback(steps))   # one for each press of n; view 0 is the start
>>> print(ekfsim.narrate(views[1], scene).splitlines()[0])
==>The robot moved: distance=3, angle=90

and `ekfsim.draw(views[1], scene, axes)` puts the picture on matplotlib axes;
`ekfsim.plot_errors(steps)` plots errors with their ±2σ, NIS and NEES over the steps;
`ekfsim.table(steps)` has the columns of `run --csv`, a DataFrame where pandas is installed;
`ekfsim.smooth(steps)` gives the same steps, each with the readings that came after it, too;
`ekfsim.animate(scene)` plays in the cell. Scenes, steps, views, summaries and studies show
themselves there, and nobody can write into what is handed out. All of it: docs/notebook.ipynb.
`scene.with_("noise.rangeSigmaRatio", 0.1)` is the same scene with another number, told to the truth
and to the filter alike, as `--set` does it; so are `scene.with_(filter="ukf", gate=0.99, seed=3)`
and `scene.with_("filter.particles", 20_000)`, a number that a filter alone has (see Tuning).
`ekfsim.scene` and `load_scene` take the text of a file, or a dict, as well, and
`ekfsim.World.of(boundary=…, start=…, noise=…)` makes a world of lists and arrays, with all the
checks of a file. `ekfsim.study(scene, runs=1000)` and `ekfsim.compare(scene, {"guard": "off"},
{"guard": "skip"})` have the numbers and the words of the command line. One level deeper, the two
halves of `play`:
`ekfsim.simulate(scene)` gives the Entries (what happened), `ekfsim.localize(entries, filter,
belief)` the Steps (what a filter made of them), with `ekfsim.filter_of(scene)` and
`ekfsim.first_belief(scene)` to begin with. A filter of your own is two functions, or a class, that
`ekfsim.bring` makes one of them all (see docs/course/own-filter.md):

>>> def predict(x, P, u, motion):
...     F, G = motion.F(x, u), motion.G(x, u)
...     return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T
>>> def update(x, P, z, sensor):
...     return x, P  # it learns nothing
>>> ekfsim.bring(predict, update, name="mine")
'mine'
>>> mine = list(ekfsim.play(scene.with_(filter="mine")))
>>> bool(abs(mine[1].posterior.mean - steps[1].posterior.mean).max() < 1e-9)  # after one move
True

`ekfsim.why(scene)` says why its run was lost, and what cures it: one thing put right at a time, on
the same draws.

Where only the beliefs matter, `ekfsim.stretch(belief, motion, U)` predicts thousands of inputs of
planar odometry at once.

Notation, letter for letter as in the code (Bar-Shalom, Särkkä, Barfoot; Thrun's book swaps Q and
R):

    x  state                            P  its covariance
    e  error of the pose: estimate − truth
    u  motion input                     f  motion: x⁺ = f(x, u)       F  ∂f/∂x        G  ∂f/∂u
    M  covariance of the input's noise  Q  covariance of the process noise
    z  reading                          h  sensor: z = h(x)           H  ∂h/∂x
    R  covariance of its noise
    ν  innovation: z − h(x⁻)            S  its covariance             K  gain
    NIS  νᵀ S⁻¹ ν                       NEES  eᵀ P⁺ e
    ⁻  before the reading, the prior

In the classroom x is the pose x, y, θ in m, m, rad, and u is d, a in m, rad; its assignment's names
for the rest are Φ = f, J_x = F, J_u = G, P_u = M, H[x] = h, J_H = H, C_v = R, r = ν. The other
systems' states stand in `ekfsim.models.layout`, and which line is which equation of which document
in `ekfsim.systems`.

Shapes: arrays carry leading axes (…): none for one run, (N,) for N runs side by side. x is (…, n),
P is (…, n, n). x points east, y north, θ turns counter-clockwise from +x and lies in (−π, π].
Metres and radians inside, degrees where a person reads or writes.

More names, each with a page of its own such as `help(ekfsim.Scene)`: Scene and World, what is to be
played; Entry, Step and Playback, what was; Gaussian, Summary, Verdict and Evidence, what is
believed and judged; EKF, and FILTERS by their names; MoveTurn and Laser, the classroom's models;
Look, the options of a picture. Mistakes in files raise `ekfsim.InputError`, missing files
`ekfsim.UsageError`; both are an `ekfsim.EkfsimError`, and so is what a filter of your own raises
where its code fails, with file, line and step.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ekfsim.diagnostics.nees import nees as nees
    from ekfsim.diagnostics.summary import Summary as Summary
    from ekfsim.diagnostics.verdict import Evidence as Evidence
    from ekfsim.diagnostics.verdict import Verdict as Verdict
    from ekfsim.errors import EkfsimError as EkfsimError
    from ekfsim.errors import InputError as InputError
    from ekfsim.errors import UsageError as UsageError
    from ekfsim.files.scenes.load import load_scene as load_scene
    from ekfsim.files.scenes.load import load_world as load_world
    from ekfsim.filters import FILTERS as FILTERS
    from ekfsim.filters.belief import Gaussian as Gaussian
    from ekfsim.filters.ekf import EKF as EKF
    from ekfsim.filters.stretch import stretch as stretch
    from ekfsim.filters.tuning import Tuning as Tuning
    from ekfsim.geometry.ellipse import ellipse as ellipse
    from ekfsim.localization import filter_of as filter_of
    from ekfsim.localization import first_belief as first_belief
    from ekfsim.models.motions.move_turn import MoveTurn as MoveTurn
    from ekfsim.models.sensors.laser import Laser as Laser
    from ekfsim.records import Entry as Entry
    from ekfsim.records import Step as Step
    from ekfsim.scene import Scene as Scene
    from ekfsim.smoothing.rts import smooth as smooth
    from ekfsim.student.own.bring import bring as bring
    from ekfsim.views.curves.errors import plot_errors as plot_errors
    from ekfsim.views.notebook.animation import animate as animate
    from ekfsim.views.notebook.drawing import draw as draw
    from ekfsim.views.notebook.playing import localize as localize
    from ekfsim.views.notebook.playing import play as play
    from ekfsim.views.notebook.playing import simulate as simulate
    from ekfsim.views.notebook.studies import compare as compare
    from ekfsim.views.notebook.studies import study as study
    from ekfsim.views.notebook.table import table as table
    from ekfsim.views.picture.look import Look as Look
    from ekfsim.views.playback.playback import Playback as Playback
    from ekfsim.views.words.closing import conclude as conclude
    from ekfsim.views.words.narrative.narrating import narrate as narrate
    from ekfsim.world import World as World

    scene = load_scene  # the module of that name, as it is called

# Where each name lives. They are imported when first used: `ekfsim --help` must not wait for numpy.
_HOMES = {
    "diagnostics.nees": ("nees",),
    "diagnostics.summary": ("Summary",),
    "diagnostics.verdict": ("Evidence", "Verdict"),
    "errors": ("EkfsimError", "InputError", "UsageError"),
    "files.scenes.load": ("load_scene", "load_world"),
    "filters": ("FILTERS",),
    "filters.belief": ("Gaussian",),
    "filters.ekf": ("EKF",),
    "filters.stretch": ("stretch",),
    "filters.tuning": ("Tuning",),
    "geometry.ellipse": ("ellipse",),
    "localization": ("filter_of", "first_belief"),
    "models.sensors.laser": ("Laser",),
    "models.motions.move_turn": ("MoveTurn",),
    "records": ("Entry", "Step"),
    "scene": ("Scene",),
    "smoothing.rts": ("smooth",),
    "student.own.bring": ("bring",),
    "views.words.closing": ("conclude",),
    "views.curves.errors": ("plot_errors",),
    "views.notebook.animation": ("animate",),
    "views.notebook.drawing": ("draw",),
    "views.notebook.playing": ("localize", "play", "simulate"),
    "views.notebook.studies": ("compare",),
    "views.notebook.table": ("table",),
    "views.picture.look": ("Look",),
    "views.words.narrative.narrating": ("narrate",),
    "views.playback.playback": ("Playback",),
    "world": ("World",),
}
_HOME_OF = {name: f"ekfsim.{home}" for home, names in _HOMES.items() for name in names}
# Modules that can be called, by the same names whatever is imported first.
_ROOMS = ("scene", "study", "why")
# What `help(ekfsim)` tells at length; the classes have pages of their own, or it would run to a
# thousand lines.
__all__ = sorted(name for name in _HOME_OF if name[0].islower())


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return import_module(f"ekfsim.{name}")
    if name not in _HOME_OF:
        raise AttributeError(f"module 'ekfsim' has no attribute {name!r}")
    return getattr(import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return [*globals(), *_HOME_OF, *_ROOMS]
