"""Every function of the interface is called by the host code, the package of Python, a test, an example or a benchmark.

    python3 called.py INTERFACE SOURCE
"""
import json
import pathlib
import re
import sys

FOLDERS = ["host", "python", "tests", "examples", "bench"]
ENDS = {".c", ".h", ".hpp", ".cpp", ".py", ".f90"}


def calls(path):
    """The names in a file, without those of comments in C and of the functions that it defines."""
    text = path.read_text(errors="replace")
    if path.suffix in (".c", ".h"):
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
        text = re.sub(r"^[a-z].*\bskg_\w+(?=\()", "", text, flags=re.M)
    return set(re.findall(r"\bskg_\w+", text))


def main():
    source = pathlib.Path(sys.argv[2])
    names = [function["name"] for function in json.loads(pathlib.Path(sys.argv[1]).read_text())["functions"]]
    found = set()
    for folder in FOLDERS:
        for path in (source / folder).rglob("*"):
            if path.suffix in ENDS and not path.match("host/include/skiagraph/*.h"):
                found |= calls(path)
    # The inline skg_X_init call skg_X_init_sized.
    idle = [name for name in names if name not in found and name.removesuffix("_sized") not in found]
    if idle:
        sys.exit("nothing calls " + ", ".join(idle) + "; use each in a test, or take it out")


main()
