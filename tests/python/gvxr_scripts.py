"""Runs scripts and notebooks of gVXR with the import alone changed, and counts those that end without an error.

    python3 gvxr_scripts.py FOLDER [SECONDS]

FOLDER holds what a user has beside the checkout: a folder per project with its .py and .ipynb at any depth and the files
that they read. Each script runs in its own folder in a copy of its whole project, for at most SECONDS (600), and with the
words of a comment "# arguments: ..." among its first five lines. Files that other scripts of the project import are modules:
they are not run. No window opens: whatever backend a script asks Matplotlib for, it gets none. The exit status is 0 if all
end well.
"""
import ast
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

#: Lines of notebooks that are none of Python's.
MAGIC = re.compile(r"^(\s*)[%!].*$", re.M)
ARGUMENTS = re.compile(r"\A(?:.*\n){0,4}?# arguments:(.*)")
#: From the most special to the least.
ALIASES = (
    (re.compile(r"\bfrom\s+gvxrPython3\s+import\b"), "from skiagraph import"),
    (re.compile(r"\bimport\s+gvxrPython3\s+as\s+gvxr\b"), "from skiagraph import gvxr"),  # older than the package
    (re.compile(r"\bimport\s+gvxrPython3\s+as\b"), "import skiagraph as"),
    (re.compile(r"\bimport\s+gvxrPython3\s*$", re.M), "import skiagraph as gvxrPython3"),
    (re.compile(r"\bgvxrPython3\.gvxr\b"), "skiagraph.gvxr"),
    (re.compile(r"\bgvxrPython3\.(\w+)"), r"skiagraph.gvxr.\1"),
)
#: Read by Python before a script: a script's matplotlib.use("TkAgg") would fail without a screen.
BEFORE = """try:
    import matplotlib
    matplotlib.use = lambda *backend, **keys: None
except ImportError:
    pass
"""


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


def parsed(text):
    try:
        return ast.parse(text)
    except SyntaxError:
        return None


def imported(tree):
    """The last names of the modules that a script imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[-1] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").split(".")[-1]
            yield from (alias.name for alias in node.names)


def project_of(path, folder):
    """The folder that is copied for a script: what lies right in FOLDER, or FOLDER itself."""
    parts = path.relative_to(folder).parts
    return folder / parts[0] if len(parts) > 1 else folder


def scripts_of(folder):
    """Scripts of a folder that use gVXR and are no modules of others."""
    texts = {path: source_of(path) for path in sorted(folder.rglob("*")) if path.suffix in (".py", ".ipynb") and path.is_file()}
    trees = {path: parsed(text) for path, text in texts.items()}
    modules = {(project_of(path, folder), name) for path, tree in trees.items() if tree for name in imported(tree)}
    return [path for path, text in texts.items() if trees[path] and "gvxrPython3" in text
            and (project_of(path, folder), path.stem) not in modules]


def copied(project, place):
    """A copy of a project, its Python files with the import changed."""
    shutil.copytree(project, place)
    for path in place.rglob("*.py"):
        path.write_text(aliased(path.read_text(encoding="utf-8")), encoding="utf-8")


def run(path, folder, seconds):
    """The last line of what went wrong; "" if nothing did."""
    text = source_of(path)
    words = ARGUMENTS.match(text)
    with tempfile.TemporaryDirectory() as place:
        project = project_of(path, folder)
        copied(project, pathlib.Path(place, "copy"))
        here = pathlib.Path(place, "copy") / path.parent.relative_to(project)
        script = here / (path.stem + "-skiagraph.py")
        script.write_text(aliased(text), encoding="utf-8")
        pathlib.Path(place, "before").mkdir()
        pathlib.Path(place, "before", "sitecustomize.py").write_text(BEFORE, encoding="utf-8")
        search = os.pathsep.join([str(pathlib.Path(place, "before")), os.environ.get("PYTHONPATH", "")])
        try:
            done = subprocess.run([sys.executable, script.name, *shlex.split(words[1] if words else "")], cwd=here,
                                  capture_output=True, text=True, timeout=seconds, stdin=subprocess.DEVNULL, check=False,
                                  env={**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": search})
        except subprocess.TimeoutExpired:
            return f"not finished after {seconds:g} s"
    lines = done.stderr.strip().splitlines() or ["no word of why"]
    return lines[-1] if done.returncode else ""


def main(folder, seconds=600.0):
    folder = pathlib.Path(folder)
    found = scripts_of(folder)
    good = 0
    for path in found:
        fault = run(path, folder, float(seconds))
        good += not fault
        print(f"{'ok  ' if not fault else 'FAIL'} {path.relative_to(folder)}{': ' + fault if fault else ''}", flush=True)
    print(f"{good} of {len(found)} scripts run with the import alone changed")
    return 0 if good == len(found) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
