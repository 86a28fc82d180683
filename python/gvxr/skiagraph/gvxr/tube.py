"""The X-ray tube, filters, and what they make of the spectrum."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .._interface import ArgumentError, SceneError
from ..beam import Beam
from ..material import element_number
from .state import ENERGIES, VOLTAGES, millimetres, unit, world

__all__ = [
    "addFilter", "addInherentFilter", "clearFiltration", "clearInherentFiltration", "getEnergyBinSize", "getEnergyBins",
    "getFiltrationMaterial", "getFiltrationThickness", "getInherentFiltrationMaterial", "getInherentFiltrationThickness",
    "getNumberOfPhotons", "getNumberOfPhotonsPerCm2At1m", "getNumberOfPhotonsPerPixelAtSDD", "getPhotonCountEnergyBins",
    "getPhotonCountsPerCm2At1m", "getPhotonCountsPerPixelAtSDD", "getTotalEnergyWithDetectorResponse",
    "getTotalEnergyWithoutDetectorResponse", "getTubeAngle", "getUnitOfElectriPotential", "getVoltage", "getmAs",
    "setEnergyBinSize", "setFiltration", "setFirstEnergyBin", "setNumberOfPhotons", "setNumberOfPhotonsPerCm2At1m",
    "setNumberOfPhotonsPerPixelAtSDD", "setTubeAngle", "setVoltage", "setmAs",
]


def setVoltage(aVoltage: float, aUnitOfElectriPotential: str) -> None:
    """The spectrum is that of a tube from now on."""
    world.spectrum = {}
    world.per_cm2 = False
    world.tube.pop("factor", None)
    world.tube["kVp"] = aVoltage * unit(aUnitOfElectriPotential, VOLTAGES)


def getVoltage(aUnitOfElectriPotential: str) -> float:
    """A negative number if there is no tube."""
    return world.tube.get("kVp", -1.0) / unit(aUnitOfElectriPotential, VOLTAGES)


def getUnitOfElectriPotential(aUnitOfElectriPotential: str) -> float:
    """A unit of voltage in MV."""
    return unit(aUnitOfElectriPotential, VOLTAGES) / unit("MV", VOLTAGES)


def setTubeAngle(anAngle: float) -> None:
    world.tube["TubeAngle"] = float(anAngle)


def getTubeAngle() -> float:
    return world.tube.get("TubeAngle", 12.0)


def setmAs(an_mAs: float) -> None:
    """-1: the exposure is not known, as at the beginning; others above 0."""
    if not (an_mAs > 0 or an_mAs == -1):
        raise ArgumentError(f"setmAs({an_mAs!r}): give mA s above 0, or -1 where the exposure is not known")
    world.tube.pop("factor", None)
    world.tube["mAs"] = float(an_mAs)


def getmAs() -> float:
    return world.tube.get("mAs", -1.0)


def setEnergyBinSize(anEnergyBinSize: float, aUnitOfEnergy: str) -> None:
    world.tube["bin_kev"] = anEnergyBinSize * unit(aUnitOfEnergy, ENERGIES)


def getEnergyBinSize(aUnitOfEnergy: str) -> float:
    return world.tube.get("bin_kev", 1.0) / unit(aUnitOfEnergy, ENERGIES)


def setFirstEnergyBin(aFirstEnergyBin: float, aUnitOfEnergy: str) -> None:
    """Energies of the tube below this are left out."""
    world.tube["first_kev"] = aFirstEnergyBin * unit(aUnitOfEnergy, ENERGIES)


# Filters


def _layer(material: int | str, thickness: float, length: str) -> tuple[int | str, float]:
    try:
        return element_number(material), thickness * millimetres(length)
    except ArgumentError:  # a compound, by its name or formula
        return str(material), thickness * millimetres(length)


def addFilter(aMaterial: int | str, aThickness: float, aUnitOfLength: str) -> None:
    world.filters.append(_layer(aMaterial, aThickness, aUnitOfLength))


def setFiltration(aSetOfFilters: Sequence[tuple[int, float]], aUnitOfLength: str) -> None:
    clearFiltration()
    for material, thickness in aSetOfFilters:
        addFilter(material, thickness, aUnitOfLength)


def clearFiltration() -> None:
    """Inherent filters stay."""
    world.filters = []


def addInherentFilter(aMaterial: int | str, aThickness: float, aUnitOfLength: str) -> None:
    world.inherent.append(_layer(aMaterial, aThickness, aUnitOfLength))


def clearInherentFiltration() -> None:
    world.inherent = []


def getFiltrationMaterial() -> tuple[int | str, ...]:
    """Atomic numbers; of a compound its name."""
    return tuple(material for material, _ in world.filters)


def getFiltrationThickness(aUnitOfLength: str) -> tuple[float, ...]:
    return tuple(mm / millimetres(aUnitOfLength) for _, mm in world.filters)


def getInherentFiltrationMaterial() -> tuple[int | str, ...]:
    """Atomic numbers; of a compound its name."""
    return tuple(material for material, _ in world.inherent)


def getInherentFiltrationThickness(aUnitOfLength: str) -> tuple[float, ...]:
    return tuple(mm / millimetres(aUnitOfLength) for _, mm in world.inherent)


# Numbers of photons


def _beam(filtered: bool) -> Beam:
    """The beam in photons per pixel."""
    beam = world.scene().beam if filtered and world.file and not world.beam_changed() else world.beam(filtered)
    return beam.resolved(world.view()) if beam.absolute else beam


def _photons(filtered: bool) -> NDArray[np.float64]:
    return _beam(filtered).photons if world.has_beam() else np.zeros(0)


def getEnergyBins(aUnitOfEnergy: str) -> tuple[float, ...]:
    """None before there is a beam."""
    if not world.has_beam():
        return ()
    return tuple((world.beam().energies / unit(aUnitOfEnergy, ENERGIES)).tolist())


def getPhotonCountEnergyBins(anApplyFiltrationFlag: bool = True) -> tuple[float, ...]:
    """Photons per pixel, behind the filters."""
    return tuple(_photons(anApplyFiltrationFlag).tolist())


getPhotonCountsPerPixelAtSDD = getPhotonCountEnergyBins


def getPhotonCountsPerCm2At1m(anApplyFiltrationFlag: bool = True) -> tuple[float, ...]:
    found = _photons(anApplyFiltrationFlag)
    return tuple((found / world.pixel_share()).tolist()) if len(found) else ()


def getNumberOfPhotons(anApplyFiltrationFlag: bool = True) -> float:
    """Photons per pixel."""
    return float(_photons(anApplyFiltrationFlag).sum())


getNumberOfPhotonsPerPixelAtSDD = getNumberOfPhotons


def getNumberOfPhotonsPerCm2At1m(anApplyFiltrationFlag: bool = True) -> float:
    return float(sum(getPhotonCountsPerCm2At1m(anApplyFiltrationFlag)))


def setNumberOfPhotons(aNumberOfPhotons: float, anApplyFiltrationFlag: bool = False) -> None:
    """Scales the spectrum to this number per pixel, behind the filters or before them."""
    now = getNumberOfPhotons(anApplyFiltrationFlag)
    if not now > 0:
        raise SceneError("there is no beam to scale; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage first")
    if world.spectrum:
        world.spectrum = {kev: n * aNumberOfPhotons / now for kev, n in world.spectrum.items()}
    else:
        world.tube["factor"] = world.tube.get("factor", 1.0) * aNumberOfPhotons / now


setNumberOfPhotonsPerPixelAtSDD = setNumberOfPhotons


def setNumberOfPhotonsPerCm2At1m(aNumberOfPhotons: float, anApplyFiltrationFlag: bool = False) -> None:
    """Scales the spectrum to this number per cm2 at 1 m, behind the filters or before them."""
    setNumberOfPhotons(aNumberOfPhotons * world.pixel_share(), anApplyFiltrationFlag)


def getTotalEnergyWithoutDetectorResponse(anApplyFiltrationFlag: bool = True) -> float:
    """MeV per pixel."""
    if not world.has_beam():
        return 0.0
    beam = _beam(anApplyFiltrationFlag)
    return float(beam.energies @ beam.photons) / unit("MeV", ENERGIES)


def getTotalEnergyWithDetectorResponse(anApplyFiltrationFlag: bool = True) -> float:
    """MeV per pixel that the detector records of the open beam, without falloff."""
    if not world.has_beam():
        return 0.0
    if not anApplyFiltrationFlag:
        beam = _beam(False)
        recorded = [kev if world.response is None else world.response.at(kev)[0] for kev in beam.energies]
        return float(np.dot(recorded, beam.photons)) / unit("MeV", ENERGIES)
    plan = world.scene().plan(**world.options())
    return float(plan["channels"][0]["flat_field"]) / unit("MeV", ENERGIES)
