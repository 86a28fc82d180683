"""Volumes of circular scans. Private."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._device import warn
from ._interface import ArgumentError, UnsupportedError
from ._library import call, choice, encode, ffi, filled, integer, make, release, struct
from ._progress import Progress, Watch
from .matrices import direction
from .scan import Scan
from .view import View

_Three = Union[Sequence[float], NDArray[Any]]


def reconstruct(scan: str | os.PathLike[str] | Scan, projections: Any = None, *, size: int | Sequence[int] | None = None,
                voxel: float | None = None, filter: str = "ramp", axis: str | _Three | None = None,
                centre: _Three | None = None, truncation: str = "none", progress: Progress = False) -> NDArray[np.float32]:
    """The volume of a circular scan in 1/cm, [z, y, x], by the method of Feldkamp, Davis and Kress.

    scan: an .h5 that scene.scan() wrote; or a Scan with its projections as -ln(I/I0), [n, row, column], as
    scene.scan(quantity="attenuation") computes them. size: voxels along each side, or (x, y, z); by default as many as columns.
    voxel: their edge in mm; by default the step of the columns as it is seen at the axis. filter: "ramp" or "hann". axis,
    centre: those of the scan's rotation, by default what scan or file says; of a table of poses "z" through the origin. The volume is about centre.
    truncation: "none", or "extrapolate", which continues rows that the detector cuts off; both are warned of. A displaced
    detector (half-fan) is weighted by itself. progress: True, or a function of (done, of); if it returns False, or raises, the reconstruction is cancelled.
    """
    reader = None
    try:
        if not isinstance(scan, Scan):
            if projections is not None:
                raise ArgumentError("projections go with a Scan; the file has its own")
            reader = make("skg_scan_reader_open", "skg_scan_reader", encode(scan, "scan"))
            handle = ffi.new("skg_scan **")
            call("skg_scan_reader_scan_get", reader, handle)
            views, found = Scan._borrowed(handle[0]), _axis_of(reader)
        else:
            views, found = scan, _turn_of(scan)
        options = _options(views[0], size, voxel, filter, found[0] if axis is None else direction(axis),
                           found[1] if centre is None else _arrays.vector(centre, "centre"))
        options.truncation = choice("fdk_truncation", truncation, "truncation")
        images = _checked(views, projections) if reader is None else None
        with Watch(progress, "projections") as options.progress:
            return _compute(views, reader, images, options)
    finally:
        if reader is not None:
            release("skg_scan_reader", reader)


def _axis_of(reader: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    axis, centre = ffi.new("double[3]"), ffi.new("double[3]")
    call("skg_scan_reader_axis_get", reader, axis, centre)
    return np.array(list(axis)), np.array(list(centre))


def _turn_of(scan: Scan) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Axis and centre; of a table of poses, which has none, z through the origin."""
    try:
        return scan.axis
    except UnsupportedError:
        return np.array([0.0, 0, 1]), np.zeros(3)


def _checked(scan: Scan, projections: Any) -> NDArray[np.float32]:
    if projections is None:
        raise ArgumentError("give the projections of the scan as -ln(I/I0): scene.scan(quantity=\"attenuation\")")
    images = _arrays.numbers(projections, "projections")
    if images.shape != (len(scan), *scan[0].shape):
        raise ArgumentError(f"projections has {_arrays.describe(images)}; the scan has {len(scan)} of {scan[0].shape[0]} x "
                            f"{scan[0].shape[1]} pixels")
    return np.ascontiguousarray(images, dtype=np.float32)


def _options(view: View, size: Any, voxel: float | None, filter: str, axis: Any, centre: Any) -> Any:
    options = struct("skg_fdk_options")
    options.filter = choice("fdk_filter", filter, "filter")
    voxels = [view.pixels[0] if size is None else size] * 3 if size is None or np.ndim(size) == 0 else list(size)
    if len(voxels) != 3:
        raise ArgumentError(f"size is {size!r}; give a number of voxels, or three")
    share = 1.0
    if view.projection == "point":
        share = float(np.linalg.norm(centre - view.source) / np.linalg.norm(view.detector - view.source))
    options.voxel_mm = share * float(np.linalg.norm(view.column_step)) if voxel is None else _arrays.real(voxel, "voxel")
    for k in range(3):
        options.voxels[k], options.axis[k] = _arrays.whole(voxels[k], "size", 1), axis[k]
        options.centre[k] = options.middle[k] = centre[k]
    return options


def _warn_beyond(options: Any, along_mm: Any) -> None:
    """Warns of slices across the axis that lie beyond the rows of the detector where they meet the axis."""
    axis = np.array(list(options.axis)) / np.linalg.norm(list(options.axis))
    k = int(np.abs(axis).argmax())
    count = int(options.voxels[k])
    places = options.middle[k] + (np.arange(count) - 0.5 * (count - 1)) * options.voxel_mm
    at, tiny = (places - options.centre[k]) / axis[k], 1e-6 * options.voxel_mm
    beyond = int(((at < along_mm[0] - tiny) | (at > along_mm[1] + tiny)).sum())
    if beyond:
        warn(f"{beyond} of {count} slices lie beyond the rows of the detector, which sees the axis from {along_mm[0]:.4g} to {along_mm[1]:.4g} mm "
             "of the centre of rotation; voxels there hold 0 or too little")


def _compute(scan: Scan, reader: Any, images: NDArray[np.float32] | None, options: Any) -> NDArray[np.float32]:
    fdk = make("skg_fdk_create", "skg_fdk", scan._handle, options)
    try:
        own = np.empty(scan[0].shape, np.float32)
        for k in range(integer("skg_scan_projection_count", scan._handle)):
            image = own if images is None else images[k]
            pointer = ffi.cast("float *", image.__array_interface__["data"][0])
            if reader is not None:
                call("skg_scan_reader_attenuation_get", reader, k, pointer)
            call("skg_fdk_add", fdk, k, pointer)
        seen = filled("skg_fdk_report", "skg_fdk_report_get", fdk)
        if seen["truncated"]:
            warn(f"projections are truncated: in {100 * seen['truncated']:.3g} % of the rows the shadow goes beyond the detector, and "
                 f"values are not to be trusted near {seen['covered_mm']:.4g} mm from the axis, nor elsewhere without "
                 "truncation=\"extrapolate\"")
        _warn_beyond(options, seen["along_mm"])
        volume = ffi.new("float **")
        call("skg_fdk_volume_get", fdk, volume)
        shape = tuple(int(options.voxels[k]) for k in (2, 1, 0))
        return np.frombuffer(ffi.buffer(volume[0], 4 * int(np.prod(shape))), np.float32).reshape(shape).copy()
    finally:
        release("skg_fdk", fdk)
