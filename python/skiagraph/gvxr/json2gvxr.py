"""Scene files, by the calls of gVXR's module json2gvxr:

    from skiagraph import gvxr
    from skiagraph.gvxr import json2gvxr

initGVXR reads the whole file; the calls that follow it in gVXR's tutorials have nothing left to do, unless they name
another file. doCTScan is refused: give the angles to gvxr.computeCTAcquisition.
"""
from __future__ import annotations

import os
from typing import Any

from .._interface import SceneError, UnsupportedError
from .life import loadSceneFile

__all__ = ["doCTScan", "initDetector", "initGVXR", "initSamples", "initScan", "initSourceGeometry", "initSpectrum"]

_read = ""


def initGVXR(fname: str, renderer: str = "OPENGL", major: int = 3, minor: int = 2, **others: Any) -> None:
    """Reads a scene file; the rest concerns OpenGL and is ignored."""
    global _read
    loadSceneFile(fname)
    _read = os.path.abspath(fname)


def _again(fname: str) -> None:
    if fname and os.path.abspath(fname) != _read:
        initGVXR(fname)
    elif not _read:
        raise SceneError("no scene file was read yet; call initGVXR")


def initSourceGeometry(fname: str = "", verbose: int = 0) -> None:
    _again(fname)


def initSpectrum(fname: str = "", verbose: int = 0) -> None:
    _again(fname)


def initDetector(fname: str = "", verbose: int = 0) -> None:
    _again(fname)


def initSamples(fname: str = "", verbose: int = 0) -> None:
    _again(fname)


def initScan(fname: str = "") -> None:
    _again(fname)


def doCTScan(verbose: bool = False) -> None:
    raise UnsupportedError("json2gvxr.doCTScan is refused: give the angles of the file to gvxr.computeCTAcquisition")
