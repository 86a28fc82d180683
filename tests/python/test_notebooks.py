"""The notebooks of the examples run, and what a cell ends with has a rich representation or a plain one."""
import ast
import json
import pathlib
import runpy

import pytest

import skiagraph as sk

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: path.name)
def test_a_notebook_runs(path):
    pytest.importorskip("matplotlib").use("agg")
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    if any("import torch" in line for cell in cells for line in cell["source"]):
        pytest.importorskip("torch")
    names = {}
    for cell in cells:
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, path.name, "exec"), names)
        if last is not None:
            shown = eval(compile(ast.Expression(last.value), path.name, "eval"), names)
            assert not isinstance(shown, sk.Scene | sk.Report) or "<table>" in shown._repr_html_()
    assert cells


def test_memory_is_shared(capsys):
    runpy.run_path(str(EXAMPLES / "share_memory.py"))
    assert "mean transmission 0." in capsys.readouterr().out
