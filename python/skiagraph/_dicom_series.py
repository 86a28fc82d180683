"""CT images from folders of DICOM files, by pydicom. Private."""
from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._interface import ArgumentError, FileError

_SAME = 1e-4  # of direction cosines and spacings, which files give with some decimals
_EVEN = 0.01  # of the step between slices


def _slices(folder: pathlib.Path) -> list[Any]:
    """The data sets of the only series with places."""
    try:
        import pydicom
        from pydicom.errors import InvalidDicomError
    except ImportError as failure:
        raise ArgumentError(f"{folder}: reading a folder of DICOM files needs the package pydicom (pip install pydicom)") from failure
    series: dict[str, list[Any]] = {}
    for path in sorted(folder.iterdir()):
        if not path.is_file():
            continue
        try:
            data = pydicom.dcmread(path)
        except InvalidDicomError:  # other files may lie beside them
            continue
        if "PixelData" in data and int(data.get("NumberOfFrames", 1)) > 1:
            raise FileError(f"{path}: holds {data.NumberOfFrames} frames; convert it to .mha or .nii, or to a file a slice")
        if "PixelData" in data and "ImagePositionPatient" in data and "ImageOrientationPatient" in data:
            series.setdefault(str(data.get("SeriesInstanceUID", "")), []).append(data)
    if not series:
        raise FileError(f"{folder}: holds no DICOM slice with a place (ImagePositionPatient)")
    if len(series) > 1:
        each = ", ".join(f"{len(found)} slices of {found[0].get('SeriesDescription', '') or number!r}" for number, found in series.items())
        raise FileError(f"{folder}: holds {len(series)} series: {each}; give a folder of one")
    return next(iter(series.values()))


def _attribute(folder: pathlib.Path, slices: list[Any], name: str) -> NDArray[np.float64]:
    """What all slices have in common."""
    values = [np.atleast_1d(np.array(data.get(name, np.nan), np.float64)) for data in slices]
    for number, value in enumerate(values):
        if value.shape != values[0].shape or not np.all(np.abs(value - values[0]) <= _SAME * np.maximum(1, np.abs(values[0]))):
            raise FileError(f"{folder}: {name} of slice {number} is {value.tolist()}, of the first {values[0].tolist()}; a volume has one")
    return values[0]


def _step(folder: pathlib.Path, places: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """From a slice to the next one, aslant where the gantry was tilted; places in order along the normal."""
    if len(places) < 2:
        raise FileError(f"{folder}: holds 1 slice; its thickness as a volume is not known")
    along = np.diff(places @ normal)
    usual = float(np.median(along))
    if along.min() <= _EVEN * usual:
        raise FileError(f"{folder}: slices {int(along.argmin())} and {int(along.argmin()) + 1} lie at one place")
    worst = int(np.abs(along - usual).argmax())
    if abs(along[worst] - usual) > _EVEN * usual:
        raise FileError(f"{folder}: {along[worst]:.6g} mm lie between slices {worst} and {worst + 1}, {usual:.6g} mm between others; is one "
                        "missing?")
    step: NDArray[np.float64] = (places[-1] - places[0]) / (len(places) - 1)
    off = np.linalg.norm(places - places[0] - np.arange(len(places))[:, None] * step, axis=1)
    if off.max() > _EVEN * usual:
        raise FileError(f"{folder}: slice {int(off.argmax())} is shifted sideways by {off.max():.3g} mm")
    return step


def _no_hounsfield(first: Any) -> str:
    """What a slice says of its numbers that Hounsfield numbers do not have; CT images hold these unless they say otherwise."""
    scale, modality = (str(first.get(name, "") or "") for name in ("RescaleType", "Modality"))
    if scale == "HU" or (not scale and modality in ("", "CT")):
        return ""
    return f"RescaleType is '{scale}'" if scale else f"Modality is '{modality}'"


def read(folder: pathlib.Path) -> tuple[NDArray[Any], NDArray[np.float64], str]:
    """Cells [z, y, x] after the rescaling of each slice, and the matrix from (x, y, z) indices to mm, in DICOM's coordinates of the
    patient: left, back, head; and why the numbers are no Hounsfield numbers ("": they may be)."""
    slices = _slices(folder)
    turns = _attribute(folder, slices, "ImageOrientationPatient")
    spacing = _attribute(folder, slices, "PixelSpacing")
    _attribute(folder, slices, "Rows"), _attribute(folder, slices, "Columns")
    if turns.shape != (6,) or spacing.shape != (2,) or not (np.isfinite(turns).all() and (spacing > 0).all()):
        raise FileError(f"{folder}: its slices have no PixelSpacing or ImageOrientationPatient")
    right, down = turns[:3], turns[3:]
    normal = np.cross(right, down)
    slices.sort(key=lambda data: float(np.array(data.ImagePositionPatient, np.float64) @ normal))
    places = np.array([data.ImagePositionPatient for data in slices], np.float64)
    affine = np.eye(4)
    affine[:3, 0], affine[:3, 1] = right * spacing[1], down * spacing[0]
    affine[:3, 2], affine[:3, 3] = _step(folder, places, normal), places[0]
    for data in slices:
        if "ModalityLUTSequence" in data:
            raise FileError(f"{data.filename}: its values stand in a table (ModalityLUTSequence), which is not read; write them with "
                            "RescaleSlope")
        if not (abs(float(data.get("RescaleSlope", 1))) > 0 and np.isfinite(float(data.get("RescaleSlope", 1)))):
            raise FileError(f"{data.filename}: RescaleSlope is {data.RescaleSlope}; give one that is finite and not 0")
    try:
        stored = [data.pixel_array for data in slices]
    except (AttributeError, NotImplementedError, RuntimeError, ValueError) as failure:
        raise FileError(f"{folder}: its pixels cannot be read: {failure}") from failure
    if any(pixels.ndim != 2 for pixels in stored):
        raise FileError(f"{folder}: its pixels are colours; a volume has one number each")
    scaled = [pixels * float(data.get("RescaleSlope", 1)) + float(data.get("RescaleIntercept", 0)) for pixels, data in zip(stored, slices)]
    cells = np.stack(scaled)
    whole = cells.min() >= -32768 and cells.max() <= 32767 and (cells == np.rint(cells)).all()
    return cells.astype(np.int16 if whole else np.float32), affine, _no_hounsfield(slices[0])
