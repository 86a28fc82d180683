"""Projections of a scan for CIL (the Core Imaging Library), which has to be installed."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import gvxr
from .._interface import UnsupportedError
from .detector import getDetectorNumberOfPixels, getDetectorPixelSpacing, getDetectorRightVector, getDetectorUpVector
from .state import world

#: `from ... import *` brings what it brings in gVXR, except CIL's classes, which are imported when they are needed.
__all__ = ["gVXRDataReader", "gvxr", "np", "os"]


class gVXRDataReader:
    """Reads a folder of projections, with source and detector as they stand. Lengths are in mm."""

    def __init__(self, file_name: str | os.PathLike[str], angle_set: Sequence[float], rotation_axis_direction: Sequence[float],
                 rotation_axis_position: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        self.file_name = os.path.abspath(file_name)
        self.angle_set = list(angle_set)
        self.rotation_axis_direction = rotation_axis_direction
        self.rotation_axis_position = rotation_axis_position
        self.use_parallel_beam = world.shape == "ParallelBeam"

    def geometry(self) -> dict[str, Any]:
        """Arguments of CIL's geometry, by name."""
        source, centre = np.array(world.source), np.array(world.detector)
        made = {"detector_position": centre, "detector_direction_x": np.array(getDetectorRightVector()),
                "detector_direction_y": np.array(getDetectorUpVector()),
                "rotation_axis_position": np.array(self.rotation_axis_position, dtype=float),
                "rotation_axis_direction": np.array(self.rotation_axis_direction, dtype=float)}
        if self.use_parallel_beam:
            return {"ray_direction": (centre - source) / np.linalg.norm(centre - source), **made}
        return {"source_position": source, **made}

    def read(self) -> Any:
        """CIL's AcquisitionData."""
        try:
            from cil.framework import AcquisitionData, AcquisitionGeometry  # type: ignore[import-not-found, unused-ignore]
            from cil.io import TIFFStackReader  # type: ignore[import-not-found, unused-ignore]
        except ImportError:
            raise UnsupportedError("the reader makes data for CIL, which is not installed (conda install -c ccpi cil); "
                                   "skiagraph.reconstruct reconstructs without it") from None
        create = AcquisitionGeometry.create_Parallel3D if self.use_parallel_beam else AcquisitionGeometry.create_Cone3D
        made = create(**self.geometry())
        made.set_angles(self.angle_set)
        made.set_panel(getDetectorNumberOfPixels(), getDetectorPixelSpacing("mm"))
        made.set_labels(["angle", "vertical", "horizontal"])
        return AcquisitionData(TIFFStackReader(file_name=self.file_name).read(), deep_copy=False, geometry=made)
