"""Copies what the site is made of into a folder, and writes the pages of the references.

Usage: stage.py SOURCE FOLDER. A page of C for each public header, a page of Python for each module of names.
"""
import shutil
import sys
from pathlib import Path

TREES = ["docs", "bench/results", "examples", "lib/include", "host/include", "python/skiagraph", "materials", "kernels", "lib/beam", "bench/validate", "tests/python"]
FILES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "CITATION.cff", "bench/README.md", "tests/README.md"]

#: Names of the package by subject.
PYTHON = {
    "Scenes": ["Scene", "Part", "View", "thorax"],
    "Meshes": ["Mesh", "translate", "rotate"],
    "Materials and beams": ["Material", "materials", "Beam", "Response"],
    "Scans": ["Scan", "reconstruct"],
    "Distances and fits": ["distance", "fit"],
    "Devices and reports": ["Device", "devices", "Report"],
}


def copy(source, target):
    for tree in TREES:
        shutil.copytree(source / tree, target / tree, ignore=shutil.ignore_patterns("__pycache__", "site"))
    for name in FILES:
        if (source / name).exists():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source / name, target / name)
    site = source / "docs/site"
    shutil.copytree(site / "pages", target, dirs_exist_ok=True)
    shutil.copytree(site / "gallery", target / "gallery-scripts")


def write_c(source, target):
    (target / "c").mkdir()
    headers = sorted(path.name for room in ("lib", "host") for path in (source / room / "include/skiagraph").glob("*.h"))
    for name in headers:
        (target / "c" / f"{name[:-2]}.md").write_text(f"# {name}\n```{{eval-rst}}\n.. doxygenfile:: {name}\n   :project: skiagraph\n```\n")
    lines = "\n".join(f"{name} <{name[:-2]}>" for name in headers)
    (target / "c/index.md").write_text(f"# Reference of C\nA page for each header; the headers are the manual.\n\n```{{toctree}}\n{lines}\n```\n")


def write_python(target):
    folder = target / "python-reference"
    folder.mkdir()
    pages = []
    for title, names in PYTHON.items():
        page = title.lower().replace(" ", "-")
        pages.append(page)
        entries = [f".. auto{'class' if name[0].isupper() else 'function'}:: skiagraph.{name}\n"
                   + ("   :members:\n   :inherited-members: Sequence, Mapping, dict\n" if name[0].isupper() else "") for name in names]
        (folder / f"{page}.md").write_text(f"# {title}\n```{{eval-rst}}\n" + "\n".join(entries) + "```\n")
    lines = "\n".join(pages)
    (folder / "index.md").write_text(f"# Reference of Python\nThe docstrings of the package.\n\n```{{toctree}}\n{lines}\n```\n")


if __name__ == "__main__":
    source, target = (Path(word).resolve() for word in sys.argv[1:3])
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    copy(source, target)
    write_c(source, target)
    write_python(target)
