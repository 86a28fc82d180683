"""The world of gVXR's calls as a scene file, by the call of gVXR's module gvxr2json:

    from skiagraph import gvxr2json
    gvxr2json.saveJSON("scene.json")

The file is read by json2gvxr, by skiagraph.Scene and by the command.
"""
from __future__ import annotations

import json
import os
import pathlib
import re
from typing import Any

import numpy as np

from .._interface import SceneError
from . import detector, display, response, scans, tube
from .beam import getSourcePosition
from .state import Node, world

__all__ = ["getRelativePath", "saveJSON"]


def getRelativePath(JSON_fname: str, target_fname: str) -> str:
    """The path of a file from the folder of the scene file."""
    return os.path.relpath(os.path.abspath(target_fname), os.path.dirname(os.path.abspath(JSON_fname)))


def saveJSON(fname: str) -> None:
    """Meshes that were made or changed are written as PLY into a folder beside the file, NAME-parts."""
    found: dict[str, Any] = {"File format version": [1, 0, 0], "Window size": list(display.getWindowSize()),
                             "Source": _source(), "Detector": _detector()}
    if scans.getNumberOfProjectionsCT() > 1:
        found["Scan"] = _scan(fname)
    found["Samples"] = [_sample(fname, label, node) for label, node in world.nodes.items()
                        if node.mesh is not None and node.surface]
    pathlib.Path(fname).write_text(json.dumps(found, indent=4) + "\n", encoding="utf-8")


def _source() -> dict[str, Any]:
    shape = world.shape
    if isinstance(shape, list) and shape[0] == "Cube":
        shape = ["FocalSpot", *shape[1:], world.grid]
    made = {"Position": [*getSourcePosition("mm"), "mm"], "Shape": shape}
    if isinstance(shape, list) and shape[0] == "Rectangle":
        made["Grid"] = world.grid
    if not world.has_beam():
        raise SceneError("there is no beam to write; call setMonoChromatic, addEnergyBinToSpectrum or setVoltage first")
    if world.spectrum:
        made["Beam"] = [{"Energy": kev, "Unit": "keV", "PhotonCount": count} for kev, count in
                        zip(tube.getEnergyBins("keV"), tube.getPhotonCountEnergyBins())]
        return made
    beam: dict[str, Any] = {"Peak kilo voltage": tube.getVoltage("kV"), "Tube angle": tube.getTubeAngle()}
    if tube.getmAs() > 0:
        beam["mAs"] = tube.getmAs()
    layers = [[material, mm, "mm"] for material, mm in [*world.inherent, *world.filters]]
    return {**made, "Beam": {**beam, "Filter": layers} if layers else beam}


def _detector() -> dict[str, Any]:
    made: dict[str, Any] = {
        "Position": [*detector.getDetectorPosition("mm"), "mm"], "UpVector": list(detector.getDetectorUpVector()),
        "RightVector": list(detector.getDetectorRightVector()), "NumberOfPixels": list(detector.getDetectorNumberOfPixels()),
        "Spacing": [*detector.getDetectorPixelSpacing("mm"), "mm"]}
    if response.getOversamplingFactor() > 1:
        made["Oversampling"] = response.getOversamplingFactor()
    if response.getLSF():
        made["LSF"] = world.detector_keys["LSF"]
    if world.scintillator:
        name, thickness = world.scintillator
        made["Scintillator"] = {"Material": name, "Thickness": thickness, "Unit": "mm", "Escape": True}
    elif world.response_rows is not None:
        made["Energy response"] = {"Unit": "keV", "LUT": world.response_rows.tolist()}
    return made


def _scan(fname: str) -> dict[str, Any]:
    angles = scans.getAngleSetCT()
    made: dict[str, Any] = {
        "NumberOfProjections": len(angles), "AngleStep": angles[1] - angles[0], "StartAngle": scans.getFirstAngleCT(),
        "FinalAngle": scans.getLastAngleCT(), "IncludeLastAngle": scans.getIncludeLastAngleFlagCT(),
        "Flat-Field Correction": scans.getWhiteImagesInFlatFieldCT() > 0,
        "CentreOfRotation": [*scans.getCentreOfRotationPositionCT("mm"), "mm"], "RotationAxis": list(scans.getRotationAxisCT())}
    if scans.getWhiteImagesInFlatFieldCT():
        made["NumberOfWhiteImages"] = scans.getWhiteImagesInFlatFieldCT()
    if scans.getProjectionOutputPathCT():
        made["OutFolder"] = getRelativePath(fname, scans.getProjectionOutputPathCT())
    return made


def _sample(fname: str, label: str, node: Node) -> dict[str, Any]:
    made: dict[str, Any] = {"Label": label, **_mesh(fname, label, node), "Material": _material(label, node)}
    if node.material is not None and node.material.density and made["Material"][0] not in ("HU", "mu"):
        made["Density"] = node.material.density
    matrix = world.scene_matrix @ world.world_matrix(label)
    if not np.array_equal(matrix, np.eye(4)):
        made["Transform"] = [["Matrix", matrix.T.ravel().tolist()]]
    made["Type"] = node.surface
    for name, get in (("Ambient", display.getAmbientColour), ("Diffuse", display.getDiffuseColour),
                      ("Specular", display.getSpecularColour)):
        made[name + "Colour"] = list(get(label))
    return {**made, "Shininess": display.getShininess(label)}


def _mesh(fname: str, label: str, node: Node) -> dict[str, str]:
    if node.file and not node.inverted:
        return {"Path": getRelativePath(fname, node.file), "Unit": node.unit}
    folder = pathlib.Path(fname).with_suffix("")
    folder = folder.with_name(folder.name + "-parts")
    folder.mkdir(exist_ok=True)
    path = folder / (re.sub("[^A-Za-z0-9]+", "-", label).strip("-") + ".ply")
    world.mesh(label).save(path)
    return {"Path": getRelativePath(fname, str(path)), "Unit": "mm"}


def _material(label: str, node: Node) -> list[Any]:
    kind, _, value = node.description.partition(": ")
    if kind == "Mixture":
        elements = world.material(label).elements
        return ["Mixture", [x for pair in elements.items() for x in pair]]
    if kind in ("Element", "Compound"):
        return [kind, value]
    if kind == "HU":
        return ["HU", float(value)]
    if kind == "mu":
        return ["mu", float(value.split()[0])]
    raise SceneError(f"{label}: its material {node.description!r} is none that the file can name; call setHU, setElement, "
                     "setMixture, setCompound or setMu")
