"""Runs scripts and notebooks of gVXR with the import alone changed, and counts those that end without an error.

    python3 gvxr_scripts.py FOLDER [SECONDS]

FOLDER holds what a user has beside the checkout: .py and .ipynb at any depth, with the files that they read. Each runs in a
copy of its folder, for at most SECONDS (600). The exit status is 0 if all of them end well.
"""
import ast
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

#: Lines of notebooks that are none of Python's.
MAGIC = re.compile(r"^(\s*)[%!].*$", re.M)
#: From the most special to the least.
ALIASES = (
    (re.compile(r"\bfrom\s+gvxrPython3\s+import\b"), "from skiagraph import"),
    (re.compile(r"\bimport\s+gvxrPython3\s+as\s+gvxr\b"), "from skiagraph import gvxr"),  # older than the package
    (re.compile(r"\bimport\s+gvxrPython3\s+as\b"), "import skiagraph as"),
    (re.compile(r"\bimport\s+gvxrPython3\s*$", re.M), "import skiagraph as gvxrPython3"),
    (re.compile(r"\bgvxrPython3\.gvxr\b"), "skiagraph.gvxr"),
    (re.compile(r"\bgvxrPython3\.(\w+)"), r"skiagraph.gvxr.\1"),
)


def source_of(path):
    """The text of a script, or of the cells of a notebook."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".ipynb":
        return text
    cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    return MAGIC.sub(r"\1pass", "\n\n".join("".join(cell["source"]) for cell in cells))


def aliased(text):
    """The text with gVXR's package named as Skiagraph's."""
    for pattern, other in ALIASES:
        text = pattern.sub(other, text)
    return text


def uses_gvxr(text):
    try:
        ast.parse(text)
    except SyntaxError:
        return False
    return "gvxrPython3" in text


def run(path, seconds):
    """The last line of what went wrong; "" if nothing did."""
    with tempfile.TemporaryDirectory() as folder:
        here = pathlib.Path(folder, "copy")
        shutil.copytree(path.parent, here)
        script = here / (path.stem + "-skiagraph.py")
        script.write_text(aliased(source_of(path)), encoding="utf-8")
        try:
            done = subprocess.run([sys.executable, script.name], cwd=here, capture_output=True, text=True, timeout=seconds,
                                  env={**os.environ, "MPLBACKEND": "Agg"}, stdin=subprocess.DEVNULL, check=False)
        except subprocess.TimeoutExpired:
            return f"not finished after {seconds:g} s"
    lines = done.stderr.strip().splitlines() or ["no word of why"]
    return lines[-1] if done.returncode else ""


def main(folder, seconds=600.0):
    found = sorted(path for path in pathlib.Path(folder).rglob("*") if path.suffix in (".py", ".ipynb")
                   and uses_gvxr(source_of(path)))
    good = 0
    for path in found:
        fault = run(path, float(seconds))
        good += not fault
        print(f"{'ok  ' if not fault else 'FAIL'} {path.relative_to(folder)}{': ' + fault if fault else ''}", flush=True)
    print(f"{good} of {len(found)} scripts run with the import alone changed")
    return 0 if good == len(found) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
