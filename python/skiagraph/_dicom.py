"""Pictures as DICOM files, by pydicom: the attributes that the command writes. Private."""
from __future__ import annotations

import hashlib
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._interface import ArgumentError, OutputError
from .view import View

_CR = "1.2.840.10008.5.1.4.1.1.1"  # Computed Radiography Image Storage
_EMPTY = ("StudyDate", "StudyTime", "AccessionNumber", "ReferringPhysicianName", "PatientBirthDate", "PatientSex",
          "BodyPartExamined", "ViewPosition", "PatientOrientation")


def _stored(path: str, image: NDArray[Any]) -> tuple[NDArray[np.uint16], float, float]:
    """Values of 16 bits, slope and intercept, both as their nine digits say."""
    bad = int(image.size - np.count_nonzero(np.isfinite(image)))
    if bad:
        raise OutputError(f"{path}: {bad} of {image.size} pixels are not finite, which DICOM cannot hold; write a .mha")
    low, high = float(image.min()), float(image.max())
    slope = float(f"{(high - low) * (1 + 1e-8) / 65535:.9g}") if high > low else 1.0
    intercept = float(f"{low:.9g}")
    steps = np.floor((image.astype(np.float64) - intercept) / slope + 0.5)
    return np.clip(steps, 0, 65535).astype("<u2"), slope, intercept


def _describe(data: Any, view: View, kvp: float) -> None:
    rows, columns = float(np.linalg.norm(view.row_step)), float(np.linalg.norm(view.column_step))
    data.ImagerPixelSpacing = data.PixelSpacing = [f"{rows:.9g}", f"{columns:.9g}"]
    if view.projection == "point":
        data.DistanceSourceToDetector = f"{float(np.linalg.norm(view.detector - view.source)):.9g}"
    if kvp > 0:
        data.KVP = f"{kvp:.9g}"


def write(path: str | os.PathLike[str], image: NDArray[Any], *, name: str, unit: str, falls: bool, view: View | None,
          kvp: float) -> None:
    """[row, column]. falls: dense parts lower the values, so that small ones are shown white. kvp 0: not known."""
    where = os.fspath(path)
    try:
        import pydicom
        from pydicom.dataset import FileMetaDataset
        from pydicom.uid import UID, ExplicitVRLittleEndian, generate_uid
    except ImportError as failure:
        raise ArgumentError(f"{where}: writing it needs the package pydicom (pip install pydicom)") from failure
    if image.ndim == 3 and len(image) == 1:
        image = image[0]
    if image.ndim != 2:
        raise ArgumentError(f"{where}: a .dcm holds one channel, and the image has {image.shape[0]}; write a .tif or .mha")
    stored, slope, intercept = _stored(where, image)
    data = pydicom.Dataset()
    for word in _EMPTY:
        setattr(data, word, "")
    data.SpecificCharacterSet, data.ImageType = "ISO_IR 192", ["ORIGINAL", "PRIMARY"]
    data.SOPClassUID, data.Modality, data.Manufacturer = _CR, "CR", "Skiagraph"
    content = hashlib.sha256(stored.tobytes()).hexdigest()  # the same picture has the same identifiers
    for level in ("SOPInstanceUID", "StudyInstanceUID", "SeriesInstanceUID"):
        setattr(data, level, generate_uid(entropy_srcs=[level, content, name]))
    data.SeriesDescription, data.ImageComments = f"simulated: {name[:40]}", f"{name} in {unit}, simulated by Skiagraph"
    data.PatientName, data.PatientID = "Simulated^Skiagraph", "SIMULATED"
    data.StudyID, data.SeriesNumber, data.InstanceNumber = "1", 1, 1
    if view is not None:
        _describe(data, view, kvp)
    data.SamplesPerPixel, data.PixelRepresentation = 1, 0
    data.BitsAllocated, data.BitsStored, data.HighBit = 16, 16, 15
    data.Rows, data.Columns = image.shape
    data.PhotometricInterpretation = "MONOCHROME1" if falls else "MONOCHROME2"
    data.PixelIntensityRelationship, data.PixelIntensityRelationshipSign = ("LIN", 1) if falls else ("LOG", -1)
    low, high = float(image.min()), float(image.max())
    data.WindowCenter, data.WindowWidth = f"{(low + high) / 2:.9g}", f"{max(high - low, slope):.9g}"
    data.RescaleIntercept, data.RescaleSlope, data.RescaleType = f"{intercept:.9g}", f"{slope:.9g}", "US"
    data.PixelData = stored.tobytes()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID, data.file_meta.MediaStorageSOPInstanceUID = UID(_CR), data.SOPInstanceUID
    data.is_little_endian, data.is_implicit_VR = True, False
    _replace(where, data)


def _replace(path: str, data: Any) -> None:
    """The file appears whole or not at all."""
    import pydicom

    temporary = f"{path}.part-{os.getpid()}"
    try:
        pydicom.dcmwrite(temporary, data, write_like_original=False)
        os.replace(temporary, path)
    except OSError as failure:
        raise OutputError(f"{path}: cannot be written: {failure.strerror}") from failure
    finally:
        if os.path.exists(temporary):
            os.unlink(temporary)
