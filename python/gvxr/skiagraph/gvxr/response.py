"""Response of the detector: energies, blur, bands and noise."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError
from ..beam import Response
from ..material import Material
from .state import ENERGIES, millimetres, unit, world

__all__ = [
    "clearDetectorEnergyResponse", "clearLSF", "disablePoissonNoise", "enablePoissonNoise", "getEnergyResponse", "getLSF",
    "getNumberOfPhotonCountingBands", "getOversamplingFactor", "getPhotonCountingBands", "getScintillatorMaterial",
    "getScintillatorThickness", "getSupportedScintillatorMaterials", "loadDetectorEnergyResponse",
    "mergePhotonCountingBands", "setDetectorEnergyResponse", "setLSF", "setOversamplingFactor", "setPhotonCountingBands",
    "setScintillator", "setSeed", "usePoissonNoise",
]

#: The names of gVXR, and what the tables call them, or their formula and density in g/cm3.
_SCINTILLATORS: dict[str, str | tuple[str, float]] = {
    "Cesium iodine": "Cesium iodine", "Cadmium tungstate": "Cadmium tungstate", "Yttrium oxyde": "Yttrium oxide",
    "Gadolinum oxyde": "Gadolinium oxide", "Yttrium gadolinum oxyde": "Yttrium gadolinium oxide",
    "Gadolinum silicate": ("Gd2SiO5", 6.71), "Gadox": "Gadox", "Gadox DRZ-Plus": "Gadox DRZ-Plus",
    "Sodium iodine": "Sodium Iodide", "Lanthanum hafnate": "Lanthanum hafnate",
    "Gadolinium gallium garnet": "Gadolinium gallium garnet", "Yttrium aluminium garnate": "Yttrium aluminium garnet"}


def _layer(name: str) -> Material:
    found = _SCINTILLATORS.get(name, name)
    return Material(found) if isinstance(found, str) else Material.formula(*found)


def setOversamplingFactor(aFactor: int = 1) -> None:
    world.detector_keys["Oversampling"] = int(aFactor)


def getOversamplingFactor() -> int:
    return int(world.detector_keys.get("Oversampling", 1))


def setLSF(aLSF: Sequence[float] | str | os.PathLike[str]) -> None:
    """Samples one pixel apart, or a text file of them. Along rows only, as gVXR has it."""
    samples = np.loadtxt(aLSF, dtype=float).ravel() if isinstance(aLSF, (str, os.PathLike)) else np.asarray(aLSF, float)
    if samples.ndim != 1 or samples.size % 2 == 0:
        raise ArgumentError(f"the line spread function has the shape {samples.shape}; give a list of an odd number of samples")
    world.detector_keys["LSF"] = [samples.tolist(), [1]]


def getLSF() -> tuple[float, ...]:
    """None if there is no blur."""
    return tuple(world.detector_keys["LSF"][0]) if "LSF" in world.detector_keys else ()


def clearLSF() -> None:
    world.detector_keys.pop("LSF", None)


# Energy response


def _scintillator(material: str, thickness_mm: float) -> Response:
    """A scintillator without the energy that scattered photons and K fluorescence carry out of the layer."""
    return Response.scintillator(_layer(material), thickness_mm, escape=True)


def setScintillator(aMaterial: str, aThickness: float, aUnitOfLength: str) -> None:
    clearDetectorEnergyResponse()
    thickness = aThickness * millimetres(aUnitOfLength)
    world.response = _scintillator(aMaterial, thickness)
    world.scintillator = aMaterial, thickness


def getScintillatorMaterial() -> str:
    return world.scintillator[0] if world.scintillator else ""


def getScintillatorThickness(aUnitOfLength: str) -> float:
    return world.scintillator[1] / millimetres(aUnitOfLength) if world.scintillator else 0.0


def getSupportedScintillatorMaterials() -> tuple[str, ...]:
    """Scintillators that gVXR names; every material of the tables and every formula of them will do."""
    return tuple(_SCINTILLATORS)


def loadDetectorEnergyResponse(aFileName: str, aUnitOfEnergy: str) -> None:
    """A text file of two columns: photon energy and mean recorded energy."""
    setDetectorEnergyResponse(np.loadtxt(aFileName, dtype=float, ndmin=2), aUnitOfEnergy)


def setDetectorEnergyResponse(anEnergyResponse: Any, aUnitOfEnergy: str) -> None:
    """Rows of photon energy and mean recorded energy."""
    rows = np.asarray(anEnergyResponse, dtype=float)
    if rows.ndim != 2 or rows.shape[1] < 2:
        raise ArgumentError(f"the energy response has the shape {rows.shape}; give rows of two energies")
    rows = rows[:, :2] * unit(aUnitOfEnergy, ENERGIES)
    clearDetectorEnergyResponse()
    world.response, world.response_rows = Response(rows[:, 0], rows[:, 1]), rows


def getEnergyResponse(*arguments: Any) -> tuple[tuple[float, float], ...]:
    """Rows of photon energy and mean recorded energy: (unit) of the detector, none if it records every energy in full;
    (material, thickness, unit of length, unit of energy) of a scintillator."""
    if len(arguments) == 4:
        material, thickness, length, energy = arguments
        return _rows(_sampled(_scintillator(material, thickness * millimetres(length))), energy)
    if len(arguments) != 1:
        raise ArgumentError("give a unit of energy, or material, thickness, unit of length and unit of energy")
    if world.response is None:
        return ()
    rows = world.response_rows if world.response_rows is not None else _sampled(world.response)
    return _rows(rows, arguments[0])


def _sampled(response: Response) -> NDArray[np.float64]:
    """At 1000 energies from 1 to 300 keV."""
    return np.array([(kev, response.at(kev)[0]) for kev in np.geomspace(1, 300, 1000)])


def _rows(rows: NDArray[np.float64], energy: str) -> tuple[tuple[float, float], ...]:
    return tuple((float(a), float(b)) for a, b in rows / unit(energy, ENERGIES))


def clearDetectorEnergyResponse() -> None:
    world.response, world.scintillator, world.response_rows = None, None, None


# Bands and noise


def setPhotonCountingBands(aMinEnergy: float, aMaxEnergy: float, aUnitOfEnergy: str, aNumberOfBands: int) -> None:
    kev = unit(aUnitOfEnergy, ENERGIES)
    world.bands = np.linspace(aMinEnergy * kev, aMaxEnergy * kev, int(aNumberOfBands) + 1).tolist()


def getPhotonCountingBands(aUnitOfEnergy: str) -> tuple[float, ...]:
    """The least energy of each band."""
    return tuple(kev / unit(aUnitOfEnergy, ENERGIES) for kev in (world.bands or ())[:-1])


def getNumberOfPhotonCountingBands() -> int:
    return len(world.bands) - 1 if world.bands else 0


def mergePhotonCountingBands() -> None:
    """The detector integrates energy again."""
    world.bands = None


def enablePoissonNoise() -> None:
    world.noise = True


def disablePoissonNoise() -> None:
    world.noise = False


def usePoissonNoise(aFlag: bool | None = None) -> bool:
    """Whether there is noise; with a flag, whether there will be."""
    if aFlag is not None:
        world.noise = bool(aFlag)
    return world.noise


def setSeed(aRandomGeneratorSeed: int) -> None:
    world.seed, world.frame = int(aRandomGeneratorSeed), 0
