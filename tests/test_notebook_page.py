"""docs/notebook.ipynb runs from its first cell to its last, in a kernel of its own."""

from pathlib import Path

import pytest

PAGE = Path(__file__).parents[1] / "docs" / "notebook.ipynb"
nbformat = pytest.importorskip("nbformat", reason="the extra `test` brings it")
nbclient = pytest.importorskip("nbclient", reason="the extra `test` brings it")


def cells(page):
    return [cell for cell in page.cells if cell.cell_type == "code"]


def test_it_is_kept_without_what_its_cells_print():
    page = nbformat.read(PAGE, 4)
    nbformat.validate(page)
    assert all(cell.outputs == [] and cell.execution_count is None for cell in cells(page))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The notebook with what its cells give, by the beginning of each."""
    page = nbformat.read(PAGE, 4)
    told = {"metadata": {"path": str(tmp_path_factory.mktemp("notebook"))}}
    nbclient.NotebookClient(page, timeout=300, kernel_name="python3", resources=told).execute()
    return page


def outputs(page, words):
    """What the one cell gives in which these words stand."""
    (cell,) = [cell for cell in cells(page) if words in cell.source]
    return cell.outputs


def data(page, words):
    return outputs(page, words)[-1]["data"]


@pytest.mark.parametrize(
    ("words", "kinds"),
    [
        ("load_scene(", {"text/html", "image/png"}),
        ("views[6]  #", {"text/html", "image/png"}),
        ("ekfsim.draw(", {"image/png"}),
        ("ekfsim.table(", {"text/html"}),
        ("ekfsim.plot_errors(", {"image/png"}),
        ("ekfsim.animate(", {"text/html"}),
        ("runs=200)\n", {"text/html", "image/png"}),
        ("World.of(", {"text/html", "image/png"}),
    ],
)
def test_cells_show_what_they_hold(run, words, kinds):
    cell = next(cell for cell in cells(run) if words in f"{cell.source}\n")
    shown = [output.get("data", {}) for output in cell.outputs]
    assert any(kinds <= set(one) for one in shown), [list(one) for one in shown]


def test_cells_say_what_they_are_told_to(run):
    assert data(run, "ekfsim.animate(")["text/html"].startswith("<iframe srcdoc=")
    assert "did you mean 'noise.rangeSigmaRatio'?" in outputs(run, 'noise.rangeSigma"')[0]["text"]
    assert "over-confident" in data(run, "ekfsim.study(wrongly_told")["text/plain"]
    apart = data(run, "ekfsim.bring(")["text/plain"]
    assert float(apart.removeprefix("np.float64(").removesuffix(")")) < 1e-9
    assert len(data(run, ".table()")["text/html"]) > 100
