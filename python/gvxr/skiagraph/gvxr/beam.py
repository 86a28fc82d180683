"""The source, and spectra that are given."""
from __future__ import annotations

from ..beam import Beam
from .._interface import SceneError
from .state import ENERGIES, millimetres, three, unit, world

__all__ = [
    "addEnergyBinToSpectrum", "addEnergyBinToSpectrumPerCm2At1m", "addEnergyBinToSpectrumPerPixelAtSDD",
    "getSourcePosition", "getSourceShape", "isUsingConeBeam", "isUsingFocalSpot", "isUsingParallelBeam",
    "isUsingParallelSource", "isUsingPointSource", "loadSpectrumFromTSV", "loadSpectrumFromTSVPerCm2At1m",
    "loadSpectrumFromTSVPerPixelAtSDD", "resetBeamSpectrum", "setFocalSpot", "setFocalSpotAsRectangle",
    "setFocalSpotAsSquare", "setMonoChromatic", "setMonoChromaticPerCm2At1m", "setMonoChromaticPerPixelAtSDD",
    "setSourcePosition", "useConeBeam", "useParallelBeam", "useParallelSource", "usePointSource",
]


def setSourcePosition(x: float, y: float, z: float, aUnitOfLength: str) -> None:
    world.source = three(x, y, z, millimetres(aUnitOfLength))


def getSourcePosition(aUnitOfLength: str) -> tuple[float, float, float]:
    return three(*world.source, 1 / millimetres(aUnitOfLength))


def usePointSource() -> None:
    world.shape, world.grid = "PointSource", 0


useConeBeam = usePointSource


def getSourceShape() -> str:
    """POINT, PARALLEL, SQUARE, RECTANGLE or CUBE."""
    if isinstance(world.shape, str):
        return "POINT" if world.shape == "PointSource" else "PARALLEL"
    return "CUBE" if world.shape[0] == "Cube" else "SQUARE" if world.shape[1] == world.shape[2] else "RECTANGLE"


def useParallelBeam() -> None:
    world.shape, world.grid = "ParallelBeam", 0


useParallelSource = useParallelBeam


def isUsingPointSource() -> bool:
    return bool(world.shape == "PointSource")


isUsingConeBeam = isUsingPointSource


def isUsingParallelBeam() -> bool:
    return bool(world.shape == "ParallelBeam")


isUsingParallelSource = isUsingParallelBeam


def isUsingFocalSpot() -> bool:
    return isinstance(world.shape, list)


def setFocalSpot(x: float, y: float, z: float, l: float, aUnitOfLength: str, i: int) -> None:
    """A cube, sampled at i x i x i points."""
    setSourcePosition(x, y, z, aUnitOfLength)
    world.shape, world.grid = ["Cube", l, aUnitOfLength], int(i)


def setFocalSpotAsSquare(x: float, y: float, z: float, l: float, aUnitOfLength: str, i: int) -> None:
    """A square, sampled at i x i points."""
    setSourcePosition(x, y, z, aUnitOfLength)
    world.shape, world.grid = ["Rectangle", l, l, aUnitOfLength], int(i)


def setFocalSpotAsRectangle(x: float, y: float, z: float, l: float, k: float, aUnitOfLength: str, i: int,
                            j: int) -> None:
    """A rectangle, l across the detector's up vector and k along it, sampled at n x n points, n the larger of i and j."""
    setSourcePosition(x, y, z, aUnitOfLength)
    world.shape, world.grid = ["Rectangle", l, k, aUnitOfLength], max(int(i), int(j))


def _fresh_spectrum(per_cm2: bool) -> None:
    if world.spectrum and world.per_cm2 != per_cm2:
        raise SceneError("photons are counted per pixel or per cm2 at 1 m, not both; call resetBeamSpectrum first")
    world.per_cm2 = per_cm2


def setMonoChromatic(anEnergy: float, aUnitOfEnergy: str, aNumberOfPhotons: float) -> None:
    world.spectrum = {anEnergy * unit(aUnitOfEnergy, ENERGIES): float(aNumberOfPhotons)}
    world.per_cm2 = False


setMonoChromaticPerPixelAtSDD = setMonoChromatic


def setMonoChromaticPerCm2At1m(anEnergy: float, aUnitOfEnergy: str, aNumberOfPhotons: float) -> None:
    setMonoChromatic(anEnergy, aUnitOfEnergy, aNumberOfPhotons)
    world.per_cm2 = True


def addEnergyBinToSpectrum(anEnergy: float, aUnitOfEnergy: str, aNumberOfPhotons: float) -> None:
    _fresh_spectrum(False)
    kev = anEnergy * unit(aUnitOfEnergy, ENERGIES)
    world.spectrum[kev] = world.spectrum.get(kev, 0) + float(aNumberOfPhotons)


addEnergyBinToSpectrumPerPixelAtSDD = addEnergyBinToSpectrum


def addEnergyBinToSpectrumPerCm2At1m(anEnergy: float, aUnitOfEnergy: str, aNumberOfPhotons: float) -> None:
    _fresh_spectrum(True)
    kev = anEnergy * unit(aUnitOfEnergy, ENERGIES)
    world.spectrum[kev] = world.spectrum.get(kev, 0) + float(aNumberOfPhotons)


def loadSpectrumFromTSV(aFileName: str, aUnitOfEnergy: str, aNormalisationFlag: bool = False) -> None:
    """Two columns; normalised: to a total energy of 1 MeV."""
    beam = Beam.load(aFileName, next(name for name in ("eV", "keV", "MeV") if ENERGIES[name] ==
                                     unit(aUnitOfEnergy, ENERGIES)))
    factor = unit("MeV", ENERGIES) / float(beam.energies @ beam.photons) if aNormalisationFlag else 1
    world.spectrum = dict(zip(beam.energies.tolist(), (factor * beam.photons).tolist()))
    world.per_cm2 = False


loadSpectrumFromTSVPerPixelAtSDD = loadSpectrumFromTSV


def loadSpectrumFromTSVPerCm2At1m(aFileName: str, aUnitOfEnergy: str, aNormalisationFlag: bool = False) -> None:
    loadSpectrumFromTSV(aFileName, aUnitOfEnergy, aNormalisationFlag)
    world.per_cm2 = True


def resetBeamSpectrum(aClearTubeParameterFlag: bool = True) -> None:
    world.spectrum = {}
    world.per_cm2 = False
    if aClearTubeParameterFlag:
        world.tube = {}
