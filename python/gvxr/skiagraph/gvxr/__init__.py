"""The calls of gVXR 2.1 that its tutorials use, computed by Skiagraph.

    from skiagraph import gvxr

instead of `from gvxrPython3 import gvxr`. Units are gVXR's: image values in MeV, path lengths in cm, matrices of 16
numbers column by column in mm. docs/gvxr.md lists every call of gVXR: the same, different, or refused. A refused call
raises UnsupportedError with the reason.

>>> from skiagraph import gvxr
>>> gvxr.createOpenGLContext()
>>> gvxr.setSourcePosition(0, -40, 0, "cm")
>>> gvxr.usePointSource()
>>> gvxr.setMonoChromatic(0.08, "MeV", 1000)
>>> gvxr.setDetectorPosition(0, 10, 0, "cm")
>>> gvxr.setDetectorUpVector(0, 0, -1)
>>> gvxr.setDetectorNumberOfPixels(64, 48)
>>> gvxr.setDetectorPixelSize(1, 1, "mm")
>>> gvxr.makeCube("cube", 3, "cm")
>>> gvxr.addPolygonMeshAsInnerSurface("cube")
>>> gvxr.setMu("cube", 0.2, "cm-1")
>>> image = gvxr.computeXRayImage()
>>> image.shape, round(float(image.max()))
((48, 64), 80)
>>> round(float(gvxr.computeLBuffer("cube").max()), 2)
3.0
>>> gvxr.destroyAllWindows()
"""
from __future__ import annotations

from typing import Any

from .._interface import UnsupportedError
from .beam import *
from .calls import description as _description
from .calls import CALLS as _CALLS
from .compare import *
from .detector import *
from .display import *
from .images import *
from .implicit import *
from .life import *
from .matter import *
from .meshes import *
from .places import *
from .readout import *
from .response import *
from .scans import *
from .shapes import *
from .space import *
from .tube import *


def _idle(name: str) -> Any:
    """A call that does nothing."""
    def call(*arguments: Any, **keys: Any) -> None:
        return None

    call.__name__ = call.__qualname__ = name
    call.__doc__ = _description(name)
    return call


def _describe() -> None:
    """Gives each call that has no words of its own those of the page."""
    for name in _CALLS:
        call = globals().get(name)
        if call is not None and not call.__doc__:
            call.__doc__ = _description(name)


_describe()


#: Calls that gVXR 2.1 has by another name than gVXR 2.0.
_OLDER = {"getLastVoxelisation": "getImplicitSurfaceLastVoxelisation", "voxelise": "voxeliseImplicitSurface"}


def __getattr__(name: str) -> Any:
    """Refuses the calls that are not there, with the reason; those about windows do nothing."""
    if name in _OLDER:
        return globals()[_OLDER[name]]
    kind, remark = _CALLS.get(name, ("", ""))
    if kind == "nothing":
        return _idle(name)
    if kind == "refused":
        raise UnsupportedError(f"gvxr.{name} is refused: {remark}")
    raise AttributeError(f"gVXR 2.1 has no call {name!r}")
