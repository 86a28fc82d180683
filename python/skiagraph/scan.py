"""Scans: where source and detector are in each projection, and when."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ArgumentError
from ._library import call, encode, ffi, fill, integer, make, number, owned, retained, struct
from .matrices import direction, rotate
from .view import View

#: Fields of the library's skg_scan_options that are angles. Here they are in degrees and have no suffix.
_ANGLES = ("start", "step", "detector_tilt", "detector_skew", "angle_jitter")


class Scan(Sequence[View]):
    """The projections of a CT scan. A scan is a sequence of Views, so that images(views=scan) takes it as well.

    view: source and detector at angle 0. projections: their number. step: degrees from one projection to the next, by
    default a full turn in all. start: degrees. axis: "x", "y", "z" or a direction, through the point `centre`, mm. Angles
    are those of samples that turn counter-clockwise as seen from the tip of the axis.
    fields: others of the library's skg_scan_options: pitch_mm, source_travel_mm, detector_fixed, detector_offset_mm,
    detector_tilt and detector_skew (degrees), source_drift_mm, detector_drift_mm, source_jitter_mm, detector_jitter_mm,
    angle_jitter (degrees), jitter_seed, start_s, interval_s, exposure_s.

    >>> from skiagraph import View
    >>> view = View(source=(0, -500, 0), detector=(0, 100, 0), column_step=(1, 0, 0), row_step=(0, 0, -1), pixels=(64, 48))
    >>> scan = Scan(view, 4)
    >>> len(scan), scan.angles.round(9).tolist()
    (4, [0.0, 90.0, 180.0, 270.0])
    >>> scan[1].source.round(9) + 0  # no -0
    array([-500.,    0.,    0.])
    """

    def __init__(self, view: View, projections: int, step: float | None = None, *, start: float = 0,
                 axis: str | Sequence[float] | NDArray[Any] = "z", centre: Sequence[float] | NDArray[Any] = (0, 0, 0),
                 **fields: Any) -> None:
        count = _arrays.whole(projections, "projections", 1)
        given = {**fields, "projections": count, "start": start, "axis": direction(axis),
                 "step": 360 / count if step is None else step, "centre": _arrays.vector(centre, "centre")}
        self._make("skg_scan_create", view, given, None)

    def _make(self, name: str, view: View, fields: dict[str, Any], poses: NDArray[np.float64] | None,
              *arguments: Any) -> None:
        if not isinstance(view, View):
            raise ArgumentError(f"view is a {type(view).__name__}; give a View")
        keep: list[Any] = []
        values = {n + "_rad" if n in _ANGLES else n: np.radians(_arrays.numbers(v, n)) if n in _ANGLES else v for n, v in fields.items()}
        options = fill(struct("skg_scan_options"), "skg_scan_options", values, keep, "the field of a scan")
        if poses is not None:
            arguments = (len(poses), ffi.cast("double *", ffi.from_buffer(poses)))
        self._handle = owned("skg_scan", make(name, "skg_scan", view._write(struct("skg_view")), options, *arguments))
        self._recipe: tuple[Any, ...] | None = (name, view, fields, poses)

    @classmethod
    def _borrowed(cls, handle: Any) -> Scan:
        made = cls.__new__(cls)
        made._handle, made._recipe = retained("skg_scan", handle), None
        return made

    @classmethod
    def table(cls, view: View, poses: Any, **fields: Any) -> Scan:
        """A scan of calibrated poses, [n, 12]: x, y, z of source, detector's centre, column step and row step, mm.

        view: the numbers of pixels and the kind of projection. fields: as of Scan; those of the rotation have no effect.

        >>> view = View(source=(0, -500, 0), detector=(0, 100, 0), column_step=(1, 0, 0), row_step=(0, 0, -1), pixels=(64, 48))
        >>> Scan.table(view, [(0, -500, 0, 0, 100, 0, 1, 0, 0, 0, 0, -1), (9, -500, 0, 0, 100, 0, 1, 0, 0, 0, 0, -1)])
        <Scan: 2 projections of 64 x 48 pixels>
        """
        rows = _arrays.numbers(poses, "poses")
        if rows.ndim != 2 or rows.shape[1] != 12:
            raise ArgumentError(f"poses has {_arrays.describe(rows)}; give rows of 12 numbers, [n, 12]")
        return _remake("skg_scan_create_table", view, fields, np.array(rows, dtype=np.float64, order="C"))

    @classmethod
    def load(cls, view: View, path: str | os.PathLike[str], **fields: Any) -> Scan:
        """A scan of poses from a text file: a line for each projection with the 12 numbers of table(), and of a curved detector its
        radius, mm."""
        read = cls.__new__(cls)
        read._make("skg_scan_load_table", view, {}, None, encode(path, "path"))
        return cls.table(read[0], [np.concatenate((v.source, v.detector, v.column_step, v.row_step)) for v in read], **fields)

    @classmethod
    def xtekct(cls, path: str | os.PathLike[str]) -> Scan:
        """The scan of a Nikon .xtekct file, in the frame of CIL's NikonDataReader: the axis of rotation passes the origin, the beam
        goes along y, z is up, and the sample turns clockwise. Give scene.view its first projection, and scene.trajectory the scan.

        Read: Projections, DetectorPixelsX and Y, DetectorPixelSizeX and Y, SrcToObject, SrcToDetector, InitialAngle, AngularStep,
        and ObjectOffsetX, ObjectRoll, ObjectTilt, or CentreOfRotationTop and Bottom instead. Other keys of the geometry that are
        not 0, such as DetectorOffsetX, are refused.
        """
        handle = make("skg_scan_load_xtekct", "skg_scan", encode(path, "path"), ffi.NULL, ffi.NULL, 0)
        read = cls.__new__(cls)
        read._handle, read._recipe = owned("skg_scan", handle), None
        (axis, centre), angles = read.axis, read.angles
        step = float(angles[1] - angles[0]) if len(angles) > 1 else 0.0
        return cls(rotate(axis, float(angles[0]), about=centre) @ read[0], len(angles), step, start=float(angles[0]), axis=axis,
                   centre=centre)

    def __len__(self) -> int:
        return integer("skg_scan_projection_count", self._handle)

    @overload
    def __getitem__(self, index: int) -> View: ...

    @overload
    def __getitem__(self, index: slice) -> list[View]: ...

    def __getitem__(self, index: int | slice) -> View | list[View]:
        count = len(self)
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(count))]
        number = _arrays.whole(index, "the number of a projection", -2 ** 63)
        if not -count <= number < count:
            raise IndexError(f"projection {number} of a scan with {count}")
        view = struct("skg_view")
        call("skg_scan_view_get", self._handle, number % count, view)
        return View._read(view)

    @property
    def angles(self) -> NDArray[np.float64]:
        """The nominal angle of each projection, degrees; 0 in a table of poses."""
        return _arrays.fixed(np.degrees([number("skg_scan_angle_get", self._handle, k) for k in range(len(self))]))

    @property
    def axis(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The direction of the axis of rotation, of length 1, and a point on it, mm; a table of poses has none, and is refused."""
        direction, centre = ffi.new("double[3]"), ffi.new("double[3]")
        call("skg_scan_axis_get", self._handle, direction, centre)
        return _arrays.fixed(np.array(list(direction))), _arrays.fixed(np.array(list(centre)))

    @property
    def times(self) -> NDArray[np.float64]:
        """When the middle of each exposure is, s."""
        time, made = ffi.new("double *"), np.empty(len(self))
        for k in range(len(made)):
            call("skg_scan_time_get", self._handle, k, time, ffi.NULL)
            made[k] = time[0]
        return _arrays.fixed(made)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the geometry: .csv (what load() reads, and ASTRA's cone_vec), .xml (RTK), .tigre.py, .cil.py or transforms.json."""
        call("skg_scan_geometry_save", self._handle, encode(path, "path"))

    def __repr__(self) -> str:
        rows, columns = self[0].shape
        return f"<Scan: {len(self)} projections of {columns} x {rows} pixels>"

    def __reduce__(self) -> tuple[Any, ...]:
        if self._recipe is None:
            raise ArgumentError("the scan belongs to a scene file; pickle the scene")
        return _remake, self._recipe


def _remake(name: str, view: View, fields: dict[str, Any], poses: NDArray[np.float64] | None) -> Scan:
    made = Scan.__new__(Scan)
    made._make(name, view, fields, poses)
    return made
