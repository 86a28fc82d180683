"""Scene files of gVXR, section by section, by the calls of gVXR's module json2gvxr:

    from skiagraph import gvxr, json2gvxr

`params` is the file as it was read. A script may change it before the init... calls, which make calls of gvxr of it. A call
without a file name takes the file that was read last.
"""
from __future__ import annotations

import json
import os
import pathlib
import re
from typing import Any

import numpy as np

from .._interface import FormatError, SceneError
from . import beam, detector, display, life, matter, meshes, places, response, scans, shapes, spectra, tube
from .state import ENERGIES, unit, world

__all__ = ["JSON_path", "doCTScan", "getFilePath", "getFiltration", "getSpectrum", "getTargetEnergy", "initDetector",
           "initGVXR", "initSamples", "initScan", "initSourceGeometry", "initSpectrum", "params", "scan_params", "updatePath"]

params: Any = None
#: The folder of the file, to which its paths are relative.
JSON_path: str | None = None
scan_params: dict[str, Any] = {}


# The file


def updatePath(fname: str) -> None:
    """Paths are relative to the folder of this file from now on."""
    global JSON_path
    JSON_path = os.path.dirname(os.path.abspath(fname))


def getFilePath(fname: str) -> str:
    """The absolute path of a file that the scene names."""
    return fname if os.path.isabs(fname) or re.match(r"[A-Za-z]:\\", fname) else os.path.join(JSON_path or os.getcwd(), fname)


def _read(fname: str) -> dict[str, Any]:
    global params
    if fname:
        with open(fname, encoding="utf-8") as file:
            try:
                params = json.load(file)
            except ValueError as error:
                raise FormatError(f"{fname}: is no JSON: {error}") from None
        updatePath(fname)
    if params is None:
        raise SceneError("no scene file was read yet; call initGVXR, or give its name")
    found: dict[str, Any] = _listed(params)
    return found


def _listed(value: Any) -> Any:
    """A value of params as a file has it: arrays and tuples as lists, numbers of NumPy as Python's."""
    if isinstance(value, dict):
        return {key: _listed(inside) for key, inside in value.items()}
    if isinstance(value, (list, tuple)):
        return [_listed(inside) for inside in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _plain(name: str) -> str:
    return re.sub("[ _-]", "", name).lower().replace("center", "centre")


def _get(found: dict[str, Any], *names: str, default: Any = None) -> Any:
    """The member with one of these names, compared without regard to case, spaces, hyphens and underscores."""
    wanted = [_plain(name) for name in names]
    return next((value for key, value in found.items() if _plain(key) in wanted), default)


def _need(found: dict[str, Any], section: str, *names: str) -> Any:
    value = _get(found, *names)
    if value is None:
        raise FormatError(f"{section}: {names[0]} is missing")
    return value


def initGVXR(fname: str, renderer: str = "OPENGL", major: int = 3, minor: int = 2) -> None:
    """Reads a scene file and the size of its window; the rest concerns OpenGL."""
    size = _get(_read(fname), "WindowSize")
    if size:
        display.setWindowSize(*size)


# Source


def initSourceGeometry(fname: str = "", verbose: int = 0) -> None:
    source = _need(_read(fname), "the file", "Source")
    position, shape = _need(source, "Source", "Position"), _get(source, "Shape", default="PointSource")
    beam.setSourcePosition(*position)
    if isinstance(shape, str) and _plain(shape) in ("parallelbeam", "parallel"):
        beam.useParallelBeam()
    elif isinstance(shape, str) and _plain(shape) in ("pointsource", "point", "cone", "conebeam"):
        beam.usePointSource()
    elif isinstance(shape, list) and len(shape) == 4 and _plain(str(shape[0])) == "focalspot":
        x, y, z, length = position
        beam.setFocalSpot(x, y, z, shape[1] * life.getUnitOfLength(shape[2]) / life.getUnitOfLength(length), length, shape[3])
    else:
        raise FormatError(f"Source.Shape is {shape!r}; give \"PointSource\", \"ParallelBeam\" or [\"FocalSpot\", size, unit, n]")


def getTargetEnergy(input_unit: str, input_energy: Any, target_unit: str) -> Any:
    """An energy, or several, in another unit."""
    factor = unit(input_unit, ENERGIES) / unit(target_unit, ENERGIES)
    return np.asarray(input_energy) * factor if isinstance(input_energy, (list, np.ndarray)) else input_energy * factor


def getFiltration(verbose: int = 0) -> Any:
    """The filters of the tube, or None."""
    found = _need(_read(""), "the file", "Source")
    bundle = _get(found, "Beam")
    return _get(bundle, "Filter", "Filtration", "Filters") if isinstance(bundle, dict) else None


def getSpectrum(fname: str = "", target_unit: str = "keV", verbose: int = 0, apply_filtration: bool = True) -> Any:
    """Energies, photons and the unit of the beam of a file. A tube is Skiagraph's own."""
    bundle = _need(_need(_read(fname), "the file", "Source"), "Source", "Beam")
    if isinstance(bundle, list):
        found = [getTargetEnergy(_need(line, "Beam", "Unit"), _need(line, "Beam", "Energy"), target_unit) for line in bundle]
        return np.array(found), np.array([_need(line, "Beam", "PhotonCount") for line in bundle], dtype=float), target_unit
    file = _get(bundle, "TextFile", "GateMacro")
    if file is not None:
        given = _need(bundle, "Beam", "Unit")
        energies, counts, _ = spectra.getSpectrumTextFile(getFilePath(file), given)
        return getTargetEnergy(given, energies, target_unit), counts, target_unit
    _set_tube(bundle)
    filters = getFiltration() if apply_filtration else None
    most = _get(bundle, "MaxNumberOfEnergyBins")
    mas = tube.getmAs()
    energies, counts, _ = spectra.getSpectrumSpekpy(tube.getVoltage("kV"), filters, tube.getTubeAngle(), most,
                                                    mas if mas > 0 else None, 100, None)
    return getTargetEnergy("keV", energies, target_unit), counts, target_unit


def _set_tube(bundle: dict[str, Any]) -> None:
    tube.setVoltage(_need(bundle, "Beam", "kVp", "PeakKiloVoltage"), "kV")
    tube.setTubeAngle(_get(bundle, "TubeAngle", default=12))
    mas = _get(bundle, "mAs")
    time, current = _get(bundle, "ExposureTime"), _get(bundle, "X-ray tube current", "Current")
    if mas is None and time and current:
        mas = _scaled(time, {"s": 1, "sec": 1, "ms": 1e-3, "msec": 1e-3, "millisecond": 1e-3, "milliseconds": 1e-3}) * \
            _scaled(current, {"ma": 1, "milliampere": 1, "milliamperes": 1, "a": 1e3, "ampere": 1e3, "amperes": 1e3})
    tube.setmAs(-1 if mas is None else mas)


def _scaled(value: list[Any], units: dict[str, float]) -> float:
    if str(value[1]).lower() not in units:
        raise FormatError(f"the unit {value[1]!r} is unknown; there are {', '.join(units)}")
    return float(value[0]) * units[str(value[1]).lower()]


def initSpectrum(fname: str = "", verbose: int = 0) -> tuple[dict[float, float], str, Any, Any]:
    """Makes the beam of a file the beam's. Returns the spectrum, its unit, energies and photons per cm2 at 1 m.

    Energies and files count photons per pixel here, as gVXR's own addEnergyBinToSpectrum does.
    """
    bundle = _need(_need(_read(fname), "the file", "Source"), "Source", "Beam")
    beam.resetBeamSpectrum()
    tube.clearFiltration()
    if isinstance(bundle, dict) and _get(bundle, "kVp", "PeakKiloVoltage") is not None:
        _set_tube(bundle)
        most = _get(bundle, "MaxNumberOfEnergyBins")
        if most:
            tube.setEnergyBinSize(max(1, tube.getVoltage("kV") / int(most)), "keV")
        spectra.applyFiltration(getFiltration())
    else:
        energies, counts, name = getSpectrum("", verbose=verbose)
        spectra.loadSpectrum(energies, counts, name, False)
        spectra.applyFiltration(getFiltration())
    energies = tube.getEnergyBins("keV")
    counts = tube.getPhotonCountsPerCm2At1m() if detector.getDetectorVertices() else ()
    return dict(zip(energies, counts)), "keV", energies, counts


# Detector


def initDetector(fname: str = "", verbose: int = 0) -> None:
    found = _need(_read(fname), "the file", "Detector")
    detector.setDetectorPosition(*_need(found, "Detector", "Position"))
    detector.setDetectorUpVector(*_need(found, "Detector", "UpVector"))
    right = _get(found, "RightVector")
    world.right = None
    if right:
        detector.setDetectorRightVector(*right)
    detector.setDetectorNumberOfPixels(*_need(found, "Detector", "NumberOfPixels"))
    spacing, size = _get(found, "Spacing"), _get(found, "Size")
    if spacing:
        detector.setDetectorPixelSize(*spacing)
    else:
        detector.setDetectorSize(*(size or _need(found, "Detector", "Size")))
    response.setOversamplingFactor(_get(found, "Oversampling", default=1))
    _set_response(found)
    lines = _get(found, "LSF")
    response.clearLSF()
    if isinstance(lines, list) and len(lines) == 2 and lines[1] == [1]:  # along the rows alone, as gvxr2json writes it
        lines = lines[0]
    if lines is not None:
        response.setLSF(getFilePath(lines) if isinstance(lines, str) else lines)


def _set_response(found: dict[str, Any]) -> None:
    table, layer = _get(found, "EnergyResponse"), _get(found, "Scintillator")
    if table and layer:
        raise FormatError("Detector has both EnergyResponse and Scintillator; give one of them")
    response.clearDetectorEnergyResponse()
    if layer:
        response.setScintillator(*(_need(layer, "Scintillator", name) for name in ("Material", "Thickness", "Unit")))
    elif table and _get(table, "File"):
        response.loadDetectorEnergyResponse(getFilePath(_get(table, "File")), _get(table, "Unit", "Energy", default="keV"))
    elif table:
        response.setDetectorEnergyResponse(_need(table, "EnergyResponse", "LUT"), _get(table, "Unit", "Energy", default="keV"))


# Samples


def initSamples(fname: str = "", verbose: int = 0) -> None:
    """Replaces the meshes by those of a file."""
    found = _read(fname)
    meshes.removePolygonMeshesFromSceneGraph()
    samples = _get(found, "Samples", default=[])
    graph = _get(found, "SceneGraph")
    if graph and not samples and _get(graph, "Samples"):
        samples = [{"Path": _need(graph, "SceneGraph", "Path"), "Unit": _need(graph, "SceneGraph", "Unit"),
                    **sample} for sample in _get(graph, "Samples")]
        if len(samples) > 1:
            raise SceneError("SceneGraph has several samples, and the meshes of its file are read as one; give a file for each "
                             "sample")
    for number, sample in enumerate(samples):
        if isinstance(sample, dict):
            _add_sample(sample, f"Samples[{number}]")
            if verbose > 0:
                print(f"{sample.get('Label', number)}: {len(meshes.getIndexSet(_label(sample, number))) // 3} triangles")
    if any(isinstance(sample, str) and _plain(sample) == "movetocentre" for sample in samples):
        places.moveToCentre()


def _label(sample: dict[str, Any], number: Any) -> str:
    return str(_get(sample, "Label", default=f"sample {number}"))


def _add_sample(sample: dict[str, Any], where: str) -> None:
    label = str(_need(sample, where, "Label"))
    _make_shape(sample, label, where)
    _fill(label, _need(sample, where, "Material"), where)
    density = _get(sample, "Density")
    if density is not None:
        matter.setDensity(label, density, "g/cm3")
    # With a Transform, the centring is part of the mesh and comes first; gVXR ignores it without one.
    if _get(sample, "MoveToCentre") and _get(sample, "Transform"):
        places.moveToCentre(label)
        places.applyCurrentLocalTransformation(label)
    for entry in _get(sample, "Transform", default=[]):
        _transform(label, entry, where)
    if _plain(str(_get(sample, "Type", default="inner"))) == "outer":
        meshes.addPolygonMeshAsOuterSurface(label)
    else:
        meshes.addPolygonMeshAsInnerSurface(label)
    if _get(sample, "FlipNormal", "FlipNormals", "FlipNormalVectors", "InvertNormal", "InvertNormals", "InvertNormalVectors"):
        meshes.invertNormalVectors(label)
    _paint(sample, label)


def _paint(sample: dict[str, Any], label: str) -> None:
    ambient = _get(sample, "AmbientColour", "AmbientColor")
    if ambient:
        display.setColour(label, *ambient)
    for name, paint in (("Diffuse", display.setDiffuseColour), ("Specular", display.setSpecularColour)):
        colour = _get(sample, name + "Colour", name + "Color")
        if colour:
            paint(label, *colour)
    display.setShininess(label, _get(sample, "Shininess", default=50))


def _make_shape(sample: dict[str, Any], label: str, where: str) -> None:
    wedge, path = _get(sample, "StepWedge"), _get(sample, "Path")
    if _get(sample, "Cube"):
        meshes.makeCube(label, *_get(sample, "Cube"))
    elif _get(sample, "Cuboid", "Parallelepiped"):
        meshes.makeCuboid(label, *_get(sample, "Cuboid", "Parallelepiped"))
    elif _get(sample, "Cylinder"):
        meshes.makeCylinder(label, *_get(sample, "Cylinder"))
    elif wedge:
        names = ("NumberOfSteps", "TotalLength", "Width", "FirstStepHeight", "OtherStepHeight", "Unit")
        shapes.makeStepWedge(label, *(_need(wedge, where + ".StepWedge", name) for name in names))
    elif path:
        meshes.loadMeshFile(label, getFilePath(path), _need(sample, where, "Unit"), False)
    else:
        raise FormatError(f"{where}: {label!r} has no shape; give a Path, Cube, Cuboid, Cylinder or StepWedge")


def _fill(label: str, material: Any, where: str) -> None:
    kind, *values = material if isinstance(material, list) and len(material) > 1 else ("", material)
    kind = _plain(str(kind))
    if kind == "element":
        matter.setElement(label, values[0])
    elif kind == "mixture" and isinstance(values[0], str):
        matter.setMixture(label, values[0])
    elif kind == "mixture":
        matter.setMixture(label, values[0][0::2], values[0][1::2])
    elif kind == "compound":
        matter.setCompound(label, values[0])
    elif kind == "hu":
        matter.setHU(label, round(float(values[0])))
    elif kind == "mu":
        matter.setMu(label, float(values[0]), "cm-1")
    else:
        raise FormatError(f"{where}.Material is {material!r}; give [\"Element\", \"Cu\"], [\"Compound\", \"H2O\"], [\"Mixture\", ...], "
                          "[\"HU\", 50] or [\"mu\", 0.2]")


def _transform(label: str, entry: list[Any], where: str) -> None:
    calls = {"rotation": (places.rotateNode, 4), "translation": (places.translateNode, 4), "scaling": (places.scaleNode, 3),
             "matrix": (places.setLocalTransformationMatrix, 1)}
    kind = _plain(str(entry[0])) if entry else ""
    if kind not in calls or len(entry) != calls[kind][1] + 1:
        raise FormatError(f"{where}.Transform: {entry!r}: give [\"Rotation\", degrees, x, y, z], [\"Translation\", x, y, z, unit], "
                          "[\"Scaling\", x, y, z] or [\"Matrix\", [16 numbers]]")
    calls[kind][0](label, *entry[1:])  # type: ignore[operator]


# Scan


def initScan(fname: str = "") -> None:
    """Reads what doCTScan does, into scan_params."""
    found = _need(_read(fname), "the file", "Scan")
    count, step, last = (_get(found, name) for name in ("NumberOfProjections", "AngleStep", "FinalAngle"))
    first = float(_get(found, "StartAngle", default=0))
    closed = bool(_get(found, "IncludeLastAngle", "IncludeFinalAngle", default=False))
    if (count is None) + (step is None) + (last is None) > 1:
        raise FormatError("Scan: give two of NumberOfProjections, AngleStep and FinalAngle")
    if count is None:
        count = int((last - first) / step) + closed
    elif last is None:
        last = first + step * (count - closed)
    elif step is None:
        step = (last - first) / max(count - closed, 1)
    axis = _get(found, "RotationAxis") or _need(_need(_read(""), "the file", "Detector"), "Detector", "UpVector")
    scan_params.clear()
    scan_params.update({
        "OutFolder": pathlib.Path(getFilePath(_get(found, "OutFolder", default="output"))), "NumberOfProjections": int(count),
        "AngleStep": float(step), "FinalAngle": float(last), "StartAngle": first, "IncludeLastAngle": closed,
        "Flat-Field Correction": bool(_get(found, "Flat-Field Correction", default=False)), "RotationAxis": axis,
        "RotCentre": _get(found, "CentreOfRotation", default=[0, 0, 0, "mm"]),
        "NumberOfWhiteImages": int(_get(found, "NumberOfWhiteImages", default=1))})
    if _get(found, "GifPath"):
        scan_params["GifPath"] = getFilePath(_get(found, "GifPath"))


def doCTScan(verbose: bool = False) -> tuple[float, ...]:
    """Computes the scan of initScan and writes its projections into OutFolder. Returns the angles in degrees."""
    if not scan_params:
        raise SceneError("there is no scan yet; call initScan first")
    whites = scan_params["NumberOfWhiteImages"] if scan_params["Flat-Field Correction"] else 0
    x, y, z, length = [*scan_params["RotCentre"], "mm"][:4]
    u, v, w = scan_params["RotationAxis"]
    scans.computeCTAcquisition(
        str(scan_params["OutFolder"]), "", scan_params["NumberOfProjections"], scan_params["StartAngle"],
        scan_params["IncludeLastAngle"], scan_params["FinalAngle"], whites, x, y, z, length, u, v, w, True, int(verbose))
    return scans.getAngleSetCT()
