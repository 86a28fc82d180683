"""The script that runs what a user has beside the checkout."""
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent


def run(folder):
    done = subprocess.run([sys.executable, str(HERE / "gvxr_scripts.py"), str(folder), "100"], capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stdout.splitlines(), done.stdout + done.stderr


def test_scripts_run_with_the_import_alone_changed(tmp_path):
    (tmp_path / "old.py").write_text("""from gvxrPython3 import gvxr, json2gvxr
from gvxrPython3.utils import has_k3d
import os, gvxrPython3.tests
json2gvxr.initDetector("scene.json")
assert os.path.basename(os.path.dirname(gvxr.__file__)) == "gvxr" and has_k3d
print(gvxr.getVersionOfSimpleGVXR(), gvxr.getDetectorNumberOfPixels())
""")
    (tmp_path / "older.py").write_text("import gvxrPython3 as gvxr\ngvxr.createWindow()\nprint(gvxr.getVersionOfCoreGVXR())\n")
    (tmp_path / "bad.py").write_text("from gvxrPython3 import gvxr\ngvxr.computeSinogram()\n")
    cells = [{"cell_type": "markdown", "source": ["# gvxrPython3"]},
             {"cell_type": "code", "source": ["%matplotlib inline\n", "from gvxrPython3 import gvxr\n"]},
             {"cell_type": "code", "source": ["!pip install gvxr\n", "gvxr.createOpenGLContext()"]}]
    (tmp_path / "book.ipynb").write_text(json.dumps({"cells": cells}))
    (tmp_path / "other.py").write_text("raise SystemExit('not gVXR')\n")
    (tmp_path / "scene.json").write_text(json.dumps({"Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1],
                                                                  "NumberOfPixels": [32, 24], "Size": [64, 48, "mm"]}}))
    status, lines, said = run(tmp_path)
    assert status == 1 and lines[-1].startswith("3 of 4 scripts"), said
    assert "FAIL bad.py" in lines[0] and "refused" in lines[0] and lines[1:4] == [
        "ok   book.ipynb", "ok   old.py", "ok   older.py"]


def test_a_script_has_its_project_about_it(tmp_path):
    code = tmp_path / "project" / "code"
    code.mkdir(parents=True)
    (tmp_path / "project" / "results").mkdir()
    (tmp_path / "project" / "results" / "data.txt").write_text("7")
    (code / "helper.py").write_text("from gvxrPython3 import gvxr\nraise SystemExit(gvxr.__name__ != 'skiagraph.gvxr')\n")
    (code / "main.py").write_text("""# arguments: --name 'two words'
import sys
from gvxrPython3 import gvxr
try:
    import matplotlib
    matplotlib.use("TkAgg")  # there is no screen
except ImportError:
    pass
assert open("../results/data.txt").read() == "7" and sys.argv[1:] == ["--name", "two words"]
import helper
""")
    assert run(tmp_path)[1] == ["ok   project/code/main.py", "1 of 1 scripts run with the import alone changed"]
