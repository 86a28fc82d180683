"""The notebooks of the examples run without a warning, what they show has a picture where it can, and their code fits a page."""
import ast
import json
import pathlib
import runpy
import warnings

import pytest

import skiagraph as sk

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


NOTEBOOKS = pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: path.name)
COLUMNS = 88


def cells_of(path):
    return [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]


def check_colour_bars(pyplot):
    """Each is as high as its image."""
    for number in pyplot.get_fignums():
        figure = pyplot.figure(number)
        figure.canvas.draw()
        for image in (image for axes in figure.axes for image in axes.images if image.colorbar):
            heights = [axes.get_window_extent().height for axes in (image.axes, image.colorbar.ax)]
            assert abs(heights[0] - heights[1]) < 2, f"an image of {heights[0]:.0f} pixels has a colour bar of {heights[1]:.0f}"
    pyplot.close("all")


@NOTEBOOKS
def test_the_code_of_a_notebook_fits_its_page_and_it_was_stored_without_a_warning(path):
    for cell in cells_of(path):
        assert [line for line in "".join(cell["source"]).splitlines() if len(line) > COLUMNS] == []
        assert [output for output in cell["outputs"] if output.get("name") == "stderr"] == []


@NOTEBOOKS
def test_a_notebook_runs(path):
    pytest.importorskip("matplotlib").use("agg")
    import matplotlib.pyplot as pyplot

    pyplot.close("all")  # those of other tests
    cells = cells_of(path)
    if any("import torch" in line for cell in cells for line in cell["source"]):
        pytest.importorskip("torch")
    names = {}
    for cell in cells:
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        with warnings.catch_warnings():
            warnings.simplefilter("error", sk.SkiagraphWarning)  # which a page shows as a red box
            exec(compile(tree, path.name, "exec"), names)
            shown = None if last is None else eval(compile(ast.Expression(last.value), path.name, "eval"), names)
        assert not isinstance(shown, sk.Scene | sk.Report) or "<table>" in shown._repr_html_()
        assert not isinstance(shown, sk.Scene) or shown._repr_html_().startswith("<img")
        check_colour_bars(pyplot)
    assert cells


def test_memory_is_shared(capsys):
    runpy.run_path(str(EXAMPLES / "share_memory.py"))
    assert "mean transmission 0." in capsys.readouterr().out
