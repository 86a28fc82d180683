"""The command, for what the library does not do. Private."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from typing import Any

from . import _pocl
from ._interface import OutputError, UnsupportedError
from ._source import Source


def path() -> str:
    """The command of the package, or else that of the system."""
    inside = pathlib.Path(__file__).parent / "bin" / "skiagraph"
    found = str(inside) if inside.exists() else shutil.which("skiagraph")
    if not found:
        raise UnsupportedError("the command skiagraph is not installed; it is part of the library's package")
    return found


def cost(source: Source, quick: bool, within: float, frames: int, sensitivity: bool) -> dict[str, Any]:
    with tempfile.TemporaryDirectory(prefix="skiagraph-") as folder:
        scene = source.path
        if scene is None:
            scene = os.path.join(folder, "scene.json")
            pathlib.Path(scene).write_bytes(source.text)
        words = ["cost", scene, "--json", "--within", f"{within:g}", "--frames", str(frames)]
        if quick:
            words.append("--quick")
        if sensitivity:
            words.append("--sensitivity")
        if source.lenient:
            words.append("--lenient")
        for setting in source.settings:
            words += ["--set", setting]
        found: dict[str, Any] = json.loads(run(*words))
    return found


def run(*words: str, also: int = 0) -> str:
    """Output of the command for these words. Raises OutputError with its sentence if it fails; also: an exit status that is no failure."""
    done = subprocess.run([path(), *words], capture_output=True, text=True, check=False, env=_pocl.environment())
    if done.returncode not in (0, also):
        raise OutputError(done.stderr.strip() or done.stdout.strip() or f"skiagraph {words[0]} ended with {done.returncode}")
    return done.stdout


def main() -> int:
    """The command as a script of the package."""
    return subprocess.call([path(), *sys.argv[1:]], env=_pocl.environment())
