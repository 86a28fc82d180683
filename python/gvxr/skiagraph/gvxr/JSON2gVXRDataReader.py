"""Projections of a scene file for CIL (the Core Imaging Library), which has to be installed."""
from __future__ import annotations

import json
import os
from typing import Any

import numpy as np

from .. import gvxr
from . import json2gvxr, scans
from .gVXRDataReader import gVXRDataReader
from .state import millimetres

#: `from ... import *` brings what it brings in gVXR, except CIL's classes, which are imported when they are needed.
__all__ = ["JSON2gVXRDataReader", "gvxr", "json", "np", "os"]


class JSON2gVXRDataReader:
    """Reads the projections of the OutFolder of a scene file, with its geometry."""

    def __init__(self, file_name: str | os.PathLike[str]) -> None:
        self.file_name = os.fspath(file_name)

    def read(self, verbose: int = 0) -> Any:
        """CIL's AcquisitionData."""
        json2gvxr.initSourceGeometry(self.file_name)
        json2gvxr.initDetector()
        json2gvxr.initScan()
        said = json2gvxr.scan_params
        angles = scans.angles_of(said["NumberOfProjections"], said["StartAngle"], said["FinalAngle"], said["IncludeLastAngle"])
        centre = [*said["RotCentre"], "mm"][:4]
        return gVXRDataReader(str(said["OutFolder"]), angles, said["RotationAxis"],
                              [x * millimetres(centre[3]) for x in centre[:3]]).read()
