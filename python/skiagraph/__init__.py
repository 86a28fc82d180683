"""Skiagraph: X-ray images of triangle meshes on any OpenCL device.

>>> import skiagraph as sk
>>> scene = sk.Scene({"Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
...                              "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
...                   "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1],
...                                "NumberOfPixels": [64, 48], "Size": [32, 24, "cm"]},
...                   "Samples": [{"Label": "block", "Cube": [80, "mm"], "Material": ["mu", 0.2]}]})
>>> image = scene.image("transmission")
>>> image.shape, round(float(image.min()), 2)
((48, 64), 0.2)

Lengths are in mm, energies in keV, attenuation coefficients in 1/cm, densities in g/cm3, angles in degrees. A failure of
the library is an Error, with a subclass for each status.
"""
from typing import Any as _Any

from ._beside import folders as _folders

__path__ = _folders(__path__)

from . import torch
from ._device import Device, RangeWarning, SkiagraphWarning, devices
from ._distance import distance
from ._fit import fit
from ._interface import *
from ._interface import __all__ as _errors
from ._library import lib as _lib, text as _text
from ._reconstruct import reconstruct
from .beam import Beam, Response
from .counter import Counter
from .lag import Lag
from .material import Material, element_number, materials
from .matrices import rotate, translate
from .mesh import Mesh
from .part import LabelError, Part
from .report import Report
from .scan import Scan
from .scene import Scene
from .thorax import thorax
from .view import View

__version__ = _text(_lib.skg_version())
__all__ = [*_errors, "Beam", "Counter", "Device", "LabelError", "Lag", "Material", "Mesh", "Part", "RangeWarning", "Report", "Response", "Scan", "Scene",
           "SkiagraphWarning", "View", "devices", "distance", "element_number", "fit", "materials", "reconstruct", "rotate", "thorax", "torch", "translate"]


def __getattr__(name: str) -> _Any:
    """gVXR's modules beside its calls: `from skiagraph import gvxr, json2gvxr, gvxr2json`, of the package skiagraph-gvxr."""
    if name in ("gvxr", "json2gvxr", "gvxr2json"):
        import importlib

        return importlib.import_module(f"{__name__}.gvxr" + ("" if name == "gvxr" else f".{name}"))
    raise AttributeError(f"skiagraph has no {name!r}")
