import ast
import subprocess
import sys
from pathlib import Path

import pytest

import ekfsim
from ekfsim.systems import INSTRUMENTS, SYSTEMS

PACKAGE = Path(ekfsim.__file__).parent
MODULES = {
    ".".join(("ekfsim", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(
        ".__init__"
    ): path
    for path in PACKAGE.rglob("*.py")
    if "_packaged" not in path.parts
}
ROOMS = (  # each imports only from those above it, and from its own
    {"errors", "printable", "seeds", "version", "twins", "kept", "shown", "late"},
    {"geometry"},
    {"raycast"},
    {"models"},
    {"filters"},
    {"commands"},
    {"records"},
    {"systems"},  # below the records: a system says which of them its authors' filter is given
    {"floor"},
    {"world"},
    {"scene"},
    {"diagnostics"},
    {"provenance"},
    {"files"},
    {"simulation"},
    {"smoothing"},
    {"localization"},
    {"fitting"},
    {"study"},
    {"fast"},
    {"why"},
    {"student"},
    {"hunting"},
    {"views"},
    {"figures"},
    {"cli", "ekfsim"},
)
DOORS = {  # the imports from below, each made when it is called for
    ("ekfsim.twins", "ekfsim.fast.table"),  # `twins` asks the table
    ("ekfsim.filters.choice", "ekfsim.student.own.choice"),  # for filters of one's own
    # World.of and with_ read what they are given as a file is read
    ("ekfsim.world", "ekfsim.files.given.worlds"),
    ("ekfsim.world", "ekfsim.files.given.changes"),
    ("ekfsim.scene", "ekfsim.files.given.changes"),
    ("ekfsim.shown", "ekfsim.views.notebook.showing"),  # records show themselves in a notebook
    ("ekfsim.study", "ekfsim.views.notebook.studies"),  # as is `ekfsim.study(…)`
    ("ekfsim.why", "ekfsim.views.notebook.reasons"),  # and `ekfsim.why(…)`
    ("ekfsim.scene", "ekfsim.files.scenes.load"),  # the module itself is `ekfsim.scene(…)`
}
CORE = {
    "geometry",
    "raycast",
    "models",
    "filters",
    "systems",
    "floor",
    "world",
    "commands",
    "records",
    "scene",
    "diagnostics",
    "provenance",
    "simulation",
    "smoothing",
    "localization",
    "fast",
}
EXTRAS = ("numba", "av", "distributed", "dask")
HEAVY = ("numpy", "matplotlib", "PIL", "pydantic", "shapely", "yaml", "scipy", *EXTRAS)


def room_of(module):
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "ekfsim"


def level(room):
    return next(i for i, rooms in enumerate(ROOMS) if room in rooms)


def imported(tree):
    """Modules that a piece of source imports, with the names of `from … import …` joined where they
    are modules."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "no relative imports"
            for alias in node.names:
                joined = f"{node.module}.{alias.name}"
                yield joined if joined in MODULES else node.module


def at_module_level(path):
    """Imports that run when a module is imported: not those in functions, nor those for type
    checkers."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from imported(node)


@pytest.mark.parametrize("module", MODULES)
def test_every_module_has_its_room(module):
    assert any(room_of(module) in rooms for rooms in ROOMS)


@pytest.mark.parametrize("module", [module for module in MODULES if module != "ekfsim"])
def test_a_module_imports_only_from_rooms_above_its_own(module):
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    below = {
        other
        for other in imported(tree)
        if other.startswith("ekfsim.")
        and level(room_of(other)) > level(room_of(module))
        and (module, other) not in DOORS
    }
    assert below == set()


TEXT = (
    "models",
    "filters",
    "diagnostics",
)  # rooms of the textbook alone; what is quicker stands in fast/


@pytest.mark.parametrize("module", [module for module in MODULES if room_of(module) in TEXT])
def test_the_text_asks_for_no_form_no_axes_and_no_way(module):
    """No form for one robot beside that for many, no question how many axes there are, none what is
    installed."""
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    forms = [n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)]
    asked = [
        part.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Compare)
        for part in (node.left, *node.comparators)
        if isinstance(part, ast.Attribute) and part.attr == "ndim"
    ]
    assert [name for name in forms if name.endswith("_one")] == []
    assert asked == []
    assert {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module in ("ekfsim", "ekfsim.twins")
        for alias in node.names
    } <= {"twinned"}


EQUATIONS = {
    "motions": {"inputs", *"fFGMQ"},
    "sensors": {"outputs", *"hHR", "residual", "alternatives"},
}


@pytest.mark.parametrize(
    ("module", "kind"),
    [(m, kind) for kind in EQUATIONS for m in MODULES if m.startswith(f"ekfsim.models.{kind}.")],
)
def test_a_model_is_its_equations_and_nothing_else(module, kind):
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.ClassDef):
            told = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
            assert {name for name in told if not name.startswith("_")} <= EQUATIONS[kind]


def test_no_system_is_known_by_name_where_runs_are_made_and_filtered():
    own = {type(part).__name__ for s in SYSTEMS.values() for part in (s.robot, *s.instruments)}
    own |= {kind.__name__ for kind in INSTRUMENTS.values()}
    words = {*SYSTEMS, "coded", "printed"}
    for module in MODULES:
        if room_of(module) in ("localization", "simulation"):
            nodes = list(ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))))
            named = {node.id for node in nodes if isinstance(node, ast.Name)}
            told = {node.value for node in nodes if isinstance(node, ast.Constant)}
            assert (named & own, told & words) == (set(), set()), module


def test_modules_import_no_rings():
    graph = {
        name: {m for m in imported(ast.parse(path.read_text(encoding="utf-8"))) if m in MODULES}
        for name, path in MODULES.items()
    }
    done, path = set(), []

    def visit(module):
        assert module not in path, " → ".join([*path[path.index(module) :], module])
        if module not in done:
            path.append(module)
            doors = {other for at, other in DOORS if at == module}
            for other in graph[module] - {"ekfsim"} - doors:
                visit(other)
            path.pop()
            done.add(module)

    for module in graph:
        visit(module)


def is_compiled(module):
    """Whether a module is made by the extra `fast`: it stands beside its readable twin."""
    return "compiled" in module.split(".")


@pytest.mark.parametrize(
    "module",
    [module for module in MODULES if room_of(module) in CORE | {"errors", "printable", "version"}],
)
def test_the_core_needs_numpy_alone(module):
    allowed = {"numpy", "numba"} if is_compiled(module) else {"numpy"}
    assert {name.partition(".")[0] for name in at_module_level(MODULES[module])} & set(
        HEAVY
    ) <= allowed


@pytest.mark.parametrize("module", MODULES)
def test_what_an_extra_brings_is_imported_only_where_it_is_asked_for(module):
    imports = set(at_module_level(MODULES[module]))
    assert is_compiled(module) or not {name.partition(".")[0] for name in imports} & set(EXTRAS)
    assert is_compiled(module) or not any(map(is_compiled, imports & set(MODULES)))


@pytest.mark.parametrize("room", ["models", "filters", "geometry"])
def test_the_mathematics_reads_and_writes_nothing(room):
    for module, path in MODULES.items():
        if room_of(module) == room:
            calls = {
                n.func.id
                for n in ast.walk(ast.parse(path.read_text()))
                if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)
            }
            assert not calls & {"open", "print", "input"}, module


# the simulation, and the twin that draws the same numbers in its place, to the last bit
SEEDING = {"ekfsim.fast.one.draws", *(m for m in MODULES if room_of(m) == "simulation")}
DRAWING = {
    "ekfsim.filters.pf",
    "ekfsim.filters.particles.drawing",
    "ekfsim.raycast.ground",
    *SEEDING,
}


@pytest.mark.parametrize("module", [module for module in MODULES if room_of(module) in CORE])
def test_only_the_simulation_and_the_particle_filter_draw_random_numbers(module):
    """Others may name the type of a generator; the particle filter draws from those that it is
    handed."""
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    calls = [
        node.func.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and hasattr(node.func, "attr")
    ]
    if module not in DRAWING:
        assert not {"random", "standard_normal", "normal", "uniform", "integers", "choice"} & set(
            calls
        )
    if module not in SEEDING:
        assert not any(name.startswith("numpy.random") for name in at_module_level(MODULES[module]))
        assert not {"default_rng", "Generator", "seed"} & set(calls)


@pytest.mark.parametrize(
    "program",
    [
        "import ekfsim",
        "import sys; sys.argv = ['ekfsim', '--help']; import ekfsim.cli; ekfsim.cli.main()",
    ],
    ids=["import ekfsim", "ekfsim --help"],
)
def test_a_start_is_light(program):
    """The last line of the error stream lists what was imported."""
    told = (
        f"import atexit, sys; atexit.register(lambda: print(*sys.modules, file=sys.stderr)); "
        f"{program}"
    )
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True)
    assert not set(done.stderr.split()) & set(HEAVY)


def test_to_play_the_tour_imports_no_other_robot_and_no_window():
    """What its classroom does not have is imported by no run of it."""
    told = (
        "import atexit, sys; atexit.register(lambda: print(*sys.modules, file=sys.stderr)); "
        "sys.argv = ['ekfsim', 'play', 'tour', '--show', 'text']; import ekfsim.cli; "
        "ekfsim.cli.main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", told], capture_output=True, text=True, check=True, input="q"
    )
    imported = set(done.stderr.split())
    others = {"robots", "instruments", "drives", "watched", "interpolation", "echo"}
    own = {"ekfsim.filters.ekf", "ekfsim.systems.system", "ekfsim.views.terminal.drawing"}
    assert imported >= own
    assert not imported & {f"ekfsim.systems.{module}" for module in others}
    assert not imported & {f"ekfsim.files.keys.{part}" for part in ("system", "told", "faults")}
    assert not imported & {f"ekfsim.filters.{name}" for name in ("kf", "ukf", "pf", "iekf")}
    assert not imported & {"matplotlib", "PIL", "scipy", *EXTRAS}
