"""Volumes of cells from arrays. Private."""
from __future__ import annotations

import hashlib
import os
import pathlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _dicom_series
from ._device import warn
from ._interface import ENUMS, ArgumentError, Error, UnsupportedError
from ._library import call, encode, ffi, filled, make, struct, text
from .material import Material, as_material

_VALUES, _TYPES, _INTERPOLATIONS = ENUMS["volume_values"], ENUMS["volume_type"], ENUMS["volume_interpolation"]


def _of_image(image: Any) -> tuple[NDArray[Any], NDArray[np.float64]]:
    """The array and the affine of an image of SimpleITK, whose coordinates are taken as they are."""
    import SimpleITK

    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise ArgumentError(f"array is an image of SimpleITK of {image.GetDimension()} dimensions and {image.GetNumberOfComponentsPerPixel()} values a "
                            "pixel; give one of 3 dimensions and 1 value")
    affine = np.eye(4)
    affine[:3, :3] = np.array(image.GetDirection()).reshape(3, 3) @ np.diag(image.GetSpacing())
    affine[:3, 3] = image.GetOrigin()
    return SimpleITK.GetArrayFromImage(image), affine


def _cells(array: Any) -> NDArray[Any]:
    """An array [z, y, x] of a type that the library reads, dense."""
    cells = _arrays.numbers(array, "array")
    if cells.ndim != 3 or cells.size == 0:
        raise ArgumentError(f"array has {_arrays.describe(cells)}; give cells [z, y, x]")
    cells = cells.astype(cells.dtype.newbyteorder("="), copy=False)  # of files in the other byte order
    if cells.dtype.name not in _TYPES:
        whole = cells.dtype.kind in "iub"
        fits = [name for name in ("int16", "uint16") if whole and np.iinfo(name).min <= cells.min() and cells.max() <= np.iinfo(name).max]
        cells = cells.astype(fits[0] if fits else "float64" if whole or cells.itemsize > 4 else "float32")
    return np.ascontiguousarray(cells)


def _load(path: pathlib.Path, source: Any) -> Any:
    """A volume from a file, or from a folder of DICOM slices, which pydicom expands where the library does not and it is there."""
    def load(name: str) -> Any:
        return make("skg_volume_load", "skg_volume", encode(name, "array"), 0.0, source)
    try:
        return load(os.fspath(path))
    except UnsupportedError:
        if not path.is_dir():
            raise
        try:
            with _dicom_series.expanded(path) as folder:
                try:
                    return load(folder)
                except Error as failure:
                    raise type(failure)(str(failure).replace(folder, os.fspath(path))) from None
        except ImportError:
            pass
        raise


def _digest(path: pathlib.Path) -> str:
    """Of a file, or of all files in a folder."""
    files = sorted(entry for entry in path.iterdir() if entry.is_file()) if path.is_dir() else [path]
    return hashlib.sha256(b"".join(hashlib.sha256(file.read_bytes()).digest() for file in files)).hexdigest()


def make_volume(label: str, array: Any, affine: Any, values: str, material: Material | str | None,
                classes: Sequence[tuple[float, Material | str]] | None, interpolation: str) -> tuple[Any, list[Any]]:
    """A volume, which the caller releases, and what its hash is made of."""
    source, name = struct("skg_volume_source"), ffi.new("char[]", encode(label, "label"))
    if not isinstance(values, str) or values.lower() not in _VALUES:
        raise ArgumentError(f"values is {values!r}; give 'HU', 'density' or 'mu'")
    if interpolation not in _INTERPOLATIONS:
        raise ArgumentError(f"interpolation is {interpolation!r}; give 'cells' or 'linear'")
    source.values, source.name, source.interpolation = _VALUES[values.lower()], name, _INTERPOLATIONS[interpolation]
    of_all = None if material is None else as_material(material)
    if of_all is not None:
        source.material = of_all._handle
    try:
        pairs = [(start, matter) for start, matter in classes or ()]
    except (TypeError, ValueError):
        raise ArgumentError(f"classes is {classes!r}; give pairs of a value and a material, such as [(-1000, 'Air')]") from None
    rows = [(_arrays.real(start, "classes"), as_material(matter)) for start, matter in pairs]
    limits, matters = ffi.new("double[]", [row[0] for row in rows]), ffi.new("skg_material *[]", [row[1]._handle for row in rows])
    source.class_count = len(rows)
    if rows:
        source.class_from, source.class_materials = limits, matters
    if isinstance(array, (str, os.PathLike)):
        if affine is not None:
            raise ArgumentError("affine is given beside a file, which says where its cells are; leave it out, or give pose")
        return _load(pathlib.Path(array), source), [values, interpolation, of_all or "", rows, _digest(pathlib.Path(array))]
    if hasattr(array, "GetDirection") and affine is None:
        array, affine = _of_image(array)
    if affine is None:
        raise ArgumentError("affine is missing; give the 4 x 4 matrix from (x, y, z) indices to mm, or an image of SimpleITK")
    cells = _cells(array)
    source.type, source.cells = _TYPES[cells.dtype.name], ffi.cast("void *", ffi.from_buffer(cells))
    source.slices, source.rows, source.columns = cells.shape
    source.affine = _arrays.matrix(affine, "affine").ravel().tolist()
    return (make("skg_volume_create", "skg_volume", source),
            [values, interpolation, of_all or "", rows, str(cells.dtype), hashlib.sha256(cells.tobytes()).hexdigest(), np.asarray(affine, np.float64)])


def _remarks(volume: Any, count: int) -> list[str]:
    """Remarks about the file of a volume: values that it leaves open."""
    level, sentence, remarks = ffi.new("int32_t *"), ffi.new("char **"), []
    for index in range(count):
        call("skg_volume_remark_get", volume, index, level, sentence)
        remarks.append(text(sentence[0]))
    return remarks


def warn_of(label: str, volume: Any, named: bool) -> None:
    """Warns of what its file leaves open, and of cells that no tissue is. named: their compositions were given."""
    found = filled("skg_volume_contents", "skg_volume_contents_get", volume)
    for sentence in _remarks(volume, found["remarks"]):
        warn(f"{label}: {sentence}")
    if found["values"] == _VALUES["density"] and found["high"] > 23:  # osmium has 22.6
        warn(f"{label}: its densities go up to {found['high']:g} g/cm3, which nothing has; are they mg/cm3 or Hounsfield numbers?")
    if found["beyond"] and not named:
        warn(f"{label}: {found['beyond']} cells are above HU 3000, up to HU {found['high']:g}, and are taken for bone of rising density; if "
             "they are metal, name it by classes")


def describe(volume: Any) -> dict[str, Any]:
    """Contents of a volume, and the shares of its cells by composition."""
    found = filled("skg_volume_contents", "skg_volume_contents_get", volume)
    found["values"] = next(name for name, value in _VALUES.items() if value == found["values"])
    found["remarks"] = _remarks(volume, found["remarks"])
    name, share, classes = ffi.new("char **"), ffi.new("double *"), {}
    for index in range(found["classes"]):
        call("skg_volume_class_get", volume, index, name, share)
        classes[text(name[0])] = float(share[0])
    found["classes"] = classes
    return found
