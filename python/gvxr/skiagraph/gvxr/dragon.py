"""The dragon that gVXR's tutorials load from the folder of their module, and the descriptions of its twins of scanners.
They are not part of Skiagraph:

    python -m skiagraph.gvxr.dragon            # pip fetches the wheel of gVXR 2.1.0
    python -m skiagraph.gvxr.dragon gvxr.whl   # a wheel that is there already

puts the dragon beside this file, where `os.path.dirname(gvxr.__file__) + "/welsh-dragon-small.stl"` finds it, and the
descriptions into twins/models.
"""
from __future__ import annotations

import pathlib
import subprocess
import sys
import tempfile
import zipfile

from .wheel import DRAGON


def _home() -> pathlib.Path:
    return pathlib.Path(__file__).parent


def take(wheel: str | pathlib.Path, folder: str | pathlib.Path | None = None) -> pathlib.Path:
    """Copies the dragon and the twins out of a wheel of gVXR, into the folder of this package by default."""
    home = pathlib.Path(folder or _home())
    target = home / DRAGON
    with zipfile.ZipFile(wheel) as archive:
        inside = [name for name in archive.namelist() if name.rsplit("/", 1)[-1] == DRAGON]
        if not inside:
            raise FileNotFoundError(f"{wheel}: has no {DRAGON}; give the wheel of gVXR 2.1.0")
        target.write_bytes(archive.read(inside[0]))
        for name in archive.namelist():
            if name.endswith(".json5"):
                twin = home / "twins" / "models" / name.rsplit("/", 1)[-1]
                twin.parent.mkdir(parents=True, exist_ok=True)
                twin.write_bytes(archive.read(name))
    return target


def main(words: list[str]) -> int:
    if words:
        print(take(words[0]))
        return 0
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as folder:
        asked = [sys.executable, "-m", "pip", "download", "--no-deps", "-q", "-d", folder, "gvxr==2.1.0"]
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        wheels = list(pathlib.Path(folder).glob("*.whl"))
        if done.returncode or not wheels:
            reason = (done.stderr.strip() or "there is no wheel for this system").splitlines()[-1]
            print(f"gvxr-2.1.0-*.whl: pip could not fetch it: {reason}\nTake the wheel of gvxr 2.1.0 from the Python Package Index and "
                  f"give its path: python -m skiagraph.gvxr.dragon WHEEL; or put {DRAGON}, which lies in it, into {_home()}",
                  file=sys.stderr)
            return 1
        print(take(wheels[0]))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
