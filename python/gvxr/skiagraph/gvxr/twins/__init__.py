"""Twins of scanners: gVXR's descriptions in JSON5, with the settings that a script chooses.

A description is gVXR's and not part of Skiagraph: `python -m skiagraph.gvxr.dragon` fetches those of its wheel.
"""
from __future__ import annotations

from .beam import TwinBeam, TwinBeamFixedSpectrum, TwinBeamMonochromatic, TwinBeamTube, TwinFlux, beam_from_json
from .detector import TwinDetector, TwinGain, TwinScintillator
from .digital_twin import DigitalTwin, Positional, TwinBeamSettings, TwinDetectorSettings
from .stage import TwinStage, XYZRange
from .utils import createDigitalTwin, getDigitalTwinList

__all__ = [
    "DigitalTwin", "Positional", "TwinBeam", "TwinBeamFixedSpectrum", "TwinBeamMonochromatic", "TwinBeamSettings",
    "TwinBeamTube", "TwinDetector", "TwinDetectorSettings", "TwinFlux", "TwinGain", "TwinScintillator", "TwinStage",
    "XYZRange", "beam_from_json", "createDigitalTwin", "getDigitalTwinList",
]
