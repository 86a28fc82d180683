"""Scenes: parts, source and detector, and their images."""
from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from . import (_arrays, _command, _dose, _edit, _gradient, _images, _look, _parts, _pickle, _projections, _register, _save, _scatter, _show, _source,
               _volume)
from ._device import Device
from ._frames import Batch
from ._interface import ArgumentError, SceneError
from ._library import call, encode, ffi, filled, listed, release, struct
from ._live import widget as _widget
from ._picture import write_picture
from ._progress import Progress
from ._state import State
from .beam import Beam
from .material import Material, as_material
from .part import Part
from .report import Report
from .scan import Scan
from .view import View


class Scene(_gradient.Differentiable):
    """Parts in the world, a source, a detector and a beam.

    scene: the path of a scene file; a dictionary with the same keys, of which any may be missing; None: nothing yet.
    settings: changes of the file before it is read, {"Detector.NumberOfPixels": [64, 64]} or ["KEY=VALUE"].
    device: a Device, its configuration, or None for the one that the process shares. lenient: what can be passed over in
    a file is a warning, not an error. lengths_only: only lengths() are wanted, so beam and materials may be missing.

    >>> from skiagraph import Beam, Mesh, Scene, View, translate
    >>> scene = Scene()
    >>> scene.add("ball", Mesh.sphere(40, 64), material="water")
    <Part 'ball': Water, Liquid>
    >>> scene.view = View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
    ...                   pixels=(64, 48))
    >>> scene.beam = Beam.mono(60, 1000)
    >>> scene.image().shape
    (48, 64)
    >>> round(float(scene.lengths("ball").max()))
    80
    >>> scene["ball"].pose = translate(10, 0, 0) @ scene["ball"].pose
    >>> "ball" in scene, len(scene)
    (True, 1)
    """

    def __init__(self, scene: str | os.PathLike[str] | Mapping[str, Any] | None = None, *,
                 settings: Mapping[str, Any] | Sequence[str] = (), device: Device | str | None = None,
                 lenient: bool = False, lengths_only: bool = False) -> None:
        self._state = State.read(_source.source_of(scene, settings, lenient, lengths_only), device)

    # Parts

    def __len__(self) -> int:
        return self._state.count()

    def __iter__(self) -> Iterator[Part]:
        return iter(self._state.parts())

    def __getitem__(self, label: str) -> Part:
        return Part(self._state, self._state.number(label))

    @property
    def parts(self) -> _parts.Parts:
        """The parts, in their order. Called, scene.parts(), they are measured: the table that `skiagraph parts` prints.

        >>> from skiagraph import Beam, Mesh, Scene, View
        >>> scene = Scene()
        >>> scene.add("cube", Mesh.cube(20), material="water")
        <Part 'cube': Water, Liquid>
        >>> scene.view = View(source=(0, -900, 0), detector=(0, 100, 0), column_step=(1, 0, 0), row_step=(0, 0, -1), pixels=(64, 64))
        >>> scene.beam = Beam.mono(60, 1000)
        >>> [(row["label"], round(row["mass_g"], 6), round(row["share"], 6)) for row in scene.parts()["parts"]]
        [('cube', 8.0, 1.0)]
        """
        return _parts.Parts(self._state)

    def __contains__(self, label: object) -> bool:
        return isinstance(label, str) and any(part.label == label for part in self)

    def add(self, label: str, mesh: Any, *, material: Material | str, inside: str | Part | None = None,
            pose: Any = None, priority: int = 0, unit_mm: float | None = None) -> Part:
        """Adds a part.

        mesh: a Mesh, (vertices, faces), an object of trimesh, meshio or PyVista, or the path of a file, in units of
        unit_mm (None: the file's or trimesh's own, otherwise mm). material: a Material or a name. inside: the part that it displaces. pose: 4 x 4, mm.
        Where the key Repair of the scene has "orientation" and components of a Mesh are inverted, the part has a mesh of its own.
        """
        parent = inside.label if isinstance(inside, Part) else inside
        state = self._state
        with state.calls():
            matter, part, name = as_material(material), struct("skg_part"), ffi.new("char[]", encode(label, "label"))
            made = state.mended(mesh, unit_mm, label)
            part.label, part.priority = name, _arrays.whole(priority, "priority", -2 ** 31, 2 ** 31 - 1)
            if parent is not None:
                part.inside = state.number(parent)
            if pose is not None:
                part.pose = _arrays.matrix(pose, "pose").ravel().tolist()
            return Part(state, state.add(part, made, matter))

    def add_volume(self, label: str, array: Any, affine: Any = None, values: str = "HU", *, material: Material | str | None = None,
                   classes: Sequence[tuple[float, Material | str]] | None = None, inside: str | Part | None = None,
                   pose: Any = None, priority: int = 0, interpolation: str = "cells") -> Part:
        """Adds a volume of cells, such as a CT image.

        array: cells [z, y, x], copied, an image of SimpleITK, or the path of a file (.mha, .nrrd, .nii) or of a folder of DICOM
        slices of one series (pydicom). affine: 4 x 4 from the indices (x, y, z) of a cell to its centre, mm;
        None: that of the image. values: "HU", "density" (g/cm3) or "mu" (1/cm). material: the composition of all cells;
        classes: [(-1000, "Air"), (-400, "Lung")], from which value on a cell is of which; neither: Schneider's table (HU).
        inside, pose and priority are as in add(). Parts inside it displace its cells. interpolation: "cells": each has one value
        throughout; "linear": the attenuation changes linearly between their centres.

        >>> import numpy as np
        >>> from skiagraph import Mesh, Scene
        >>> scene = Scene()
        >>> scene.add_volume("patient", np.zeros((20, 30, 40), np.int16), np.diag([2, 2, 2, 1]))
        <Part 'patient': cells of a volume>
        >>> scene.add("needle", Mesh.cube(3), material="Ti", inside="patient")
        <Part 'needle': Ti, inside 'patient'>
        """
        parent = inside.label if isinstance(inside, Part) else inside
        state = self._state
        with state.calls():
            part, name = struct("skg_part"), ffi.new("char[]", encode(label, "label"))
            part.label, part.priority = name, _arrays.whole(priority, "priority", -2 ** 31, 2 ** 31 - 1)
            if parent is not None:
                part.inside = state.number(parent)
            if pose is not None:
                part.pose = _arrays.matrix(pose, "pose").ravel().tolist()
            part.volume, content = _volume.make_volume(label, array, affine, values, material, classes, interpolation)
            try:
                _volume.warn_of(label, part.volume, material is not None or bool(classes))
                made = Part(state, state.add_part(part))
                state.volumes[made._name] = content
                return made
            finally:
                release("skg_volume", part.volume)

    def remove(self, label: str) -> None:
        """Removes a part. What lies inside it lies inside what it lay in from then on. A scene from which parts were
        removed does not breathe.

        >>> from skiagraph import Mesh, Scene
        >>> scene = Scene()
        >>> scene.add("cup", Mesh.cube(40), material="water")
        <Part 'cup': Water, Liquid>
        >>> scene.remove("cup")
        >>> scene.parts
        []
        """
        with self._state.calls():
            _edit.remove(self._state, self._state.number(label))

    # Source, detector and beam

    @property
    def view(self) -> View:
        """Source and detector. Its arrays may be changed in place; assign another View to replace it."""
        return self._state.require_view()

    @view.setter
    def view(self, value: View) -> None:
        if not isinstance(value, View):
            raise ArgumentError(f"view is a {type(value).__name__}; give a View")
        self._state.view = value
        self._state.changed.add("view")

    @property
    def beam(self) -> Beam:
        """The photons by energy. Assign another Beam to replace it."""
        return self._state.require_beam()

    @beam.setter
    def beam(self, value: Beam) -> None:
        if not isinstance(value, Beam):
            raise ArgumentError(f"beam is a {type(value).__name__}; give a Beam")
        self._state.beam = value
        self._state.changed.add("beam")
        self._state.plans.clear()

    # Images

    def image(self, quantity: str | None = None, *, unit: str | None = None, precision: str | None = None,
              tolerance: float | None = None, index: int | None = None, out: Any = None, **options: Any) -> NDArray[Any]:
        """One image, [row, column]; energy bands are a leading axis.

        quantity: "energy" (keV per pixel, the default), "fluence", "photons", "transmission" or "attenuation".
        unit: "eV", "keV" or "MeV", of an energy. precision: "single", "double" or "half". tolerance: the error that
        fewer energies may make. index: number of the frame for the noise; without it, noisy frames of a scene are
        counted from 0 on, so that each has noise of its own, and with noise_seed, frames of each call, so that a call
        with a seed can be repeated. out: an array to write to.
        options: others of the library's skg_plan_options, such as noise=True, supersampling=2, bands=[20, 40, 60]
        (edges in keV), spot={"shape": "disc", "extent": 0.6}, response=, world=, repair="exact",
        scatter=0.01 (scattered photons, to this error of their mean; {"histories": 1e6}; False for none).
        """
        batch = Batch(1, index=_images.number_frames(self._state, 1, index, options))
        made = _images.render(self._state, batch, out, False, True, unit, quantity=quantity, precision=precision,
                              tolerance=tolerance, **options)
        return self._state.show(made, quantity or "energy")

    def images(self, quantity: str | None = None, *, poses: Mapping[str, Any] | None = None,
               views: Sequence[View] | None = None, unit: str | None = None, precision: str | None = None,
               tolerance: float | None = None, index: int | None = None, out: Any = None, progress: Progress = False,
               **options: Any) -> NDArray[Any]:
        """A batch of images, [n, row, column]; energy bands are an axis behind the first.

        poses: for each label n matrices, [n, 4, 4], or one for all. views: n Views. index: number of the first frame,
        for the noise, as of image(). progress: True for a line on standard error, or a function of (done, n). The rest is as in
        image(). An interrupt (Ctrl-C) ends the batch at once.
        """
        batch = _images.batch_of(self._state, poses, views)
        batch.index = _images.number_frames(self._state, batch.count, index, options)
        if batch.views and tolerance and "views" not in options:
            options["views"] = batch.views
        made = _images.render(self._state, batch, out, progress, False, unit, quantity=quantity, precision=precision,
                              tolerance=tolerance, **options)
        return self._state.show(made, quantity or "energy")

    def noise(self, quantity: str | None = None, *, poses: Mapping[str, Any] | None = None, views: Sequence[View] | None = None,
              precision: str | None = None, tolerance: float | None = None, progress: Progress = False,
              **options: Any) -> dict[str, NDArray[Any]]:
        """Mean and variance of noisy images, without drawing noise: "mean", the image that is expected, and "variance", that of each pixel.

        Both are [row, column] as of image(), or [n, row, column] with poses or views as of images(), with bands= before the
        rows; the variance is in the square of the image's unit. The scene or the options need noise=True, electronic_kev= or
        quantum_step_kev=. The variance of an attenuation holds where the noise is small against the transmission.
        """
        one = poses is None and views is None
        batch = Batch(1) if one else _images.batch_of(self._state, poses, views)
        if batch.views and tolerance and "views" not in options:
            options["views"] = batch.views
        return _images.expected(self._state, batch, one, progress, {"quantity": quantity, "precision": precision,
                                                                    "tolerance": tolerance, **options})

    @overload
    def lengths(self, label: str, kind: str = "net", *, poses: Mapping[str, Any] | None = None,
                views: Sequence[View] | None = None, out: Any = None, progress: Progress = False,
                precision: str | None = None, **options: Any) -> NDArray[Any]: ...

    @overload
    def lengths(self, label: Sequence[str] | None = None, kind: str = "net", *, poses: Mapping[str, Any] | None = None,
                views: Sequence[View] | None = None, progress: Progress = False, precision: str | None = None,
                **options: Any) -> dict[str, NDArray[Any]]: ...

    def lengths(self, label: Any = None, kind: str = "net", *, poses: Mapping[str, Any] | None = None,
                views: Sequence[View] | None = None, out: Any = None, progress: Progress = False,
                precision: str | None = None, **options: Any) -> Any:
        """Path lengths through a part in mm, [row, column], or [n, row, column] with poses or views.

        label: of a part; several, or none for all: then {label: lengths}. kind: "net", without what lies inside the part,
        or "surface", between the surfaces of its mesh.
        """
        if not isinstance(label, str):
            if out is not None:
                raise ArgumentError("out= takes the lengths of one part; give one label")
        if label is not None and not isinstance(label, Iterable):
            raise ArgumentError(f"label is a {type(label).__name__}; give the label of a part, or several")
        wanted = [part.label for part in self] if label is None else [label] if isinstance(label, str) else list(label)
        found = _images.lengths(self._state, wanted, kind, poses, views, out, progress, {"precision": precision, **options})
        for one in found:
            self._state.show(one, "lengths")
        return found[0] if isinstance(label, str) else dict(zip(wanted, found))

    def scatter(self, tolerance: float | None = None, *, histories: float | None = None, components: bool = False,
                quantity: str | None = None, **options: Any) -> dict[str, Any]:
        """The scattered part of an image, by itself.

        tolerance: its standard error over its mean; histories: instead, the number of photons. Without both, as the file
        says, or 0.01. components: whether orders and kinds are wanted apart. The rest is as in image(). Returns "image", the scatter, "sigma", its standard error, and "total", the
        image with it, [row, column], with bands= [band, row, column], and numbers: docs/python.md lists them.
        """
        return _scatter.planes(self._state, quantity, components, {**options, "scatter": _scatter.accuracy(tolerance, histories)})

    def scatter_predicted(self, **options: Any) -> dict[str, Any]:
        """Predicts the scatter in images, from some 8,000 histories, in about 0.2 s; options as of image().

        "ratio": scatter over primary in the shadow of the parts, right to about 15 %; "called_for": whether it is above the
        tolerance; "rms" and "max" of the scatter, as fractions of the open beam; "grid": what a grid passes of "primary",
        "scatter" and "total".
        """
        return _scatter.prediction(self._state, options)

    def dose(self, at: Any = None, *, scan: Scan | None = None, times: float = 1, histories: int | None = None, seed: int = 0,
             progress: Progress = False, **options: Any) -> dict[str, Any]:
        """Doses of people and things by one exposure.

        at: a place [x, y, z] in mm, or several; without it, where the middle ray of the field enters the first part. scan: all its
        projections together, such as those of scene.trajectory. times: how many such exposures or scans together, such as the frames
        of a film. histories: photons that are followed through the parts, 200,000 by default. options as of image(). Returns "kerma", a list of {"at",
        "air_kerma_uGy", "backscatter"}; "kap_uGy_cm2"; "detector_air_kerma_uGy"; "exposure_index"; "parts", a list of {"label",
        "dose_uGy", "sigma", "energy_keV"}; "hvl1_mm_al" and "hvl2_mm_al"; with noise "darkest". What is not known is None.

        BeamError if the scene does not say how many photons there are, by the mAs of a tube or by photons of a pixel.
        """
        return _dose.dose(self._state, at, scan, times, histories, seed, progress, options)

    # Scans

    @property
    def trajectory(self) -> Scan:
        """Source and detector in each projection of scan(): the key Scan of the file. Assign a Scan to replace it."""
        if self._state.trajectory is not None:
            return self._state.trajectory
        with self._state.calls():
            if self._state.view != self._state.read_view:
                raise SceneError("the view was changed since the scene was read, and the key Scan turns the one of the "
                                 "file; assign a Scan of the new view to scene.trajectory")
            handle = ffi.new("skg_scan **")
            call("skg_setup_scan_get", self._state.setup, handle)
            return Scan._borrowed(handle[0])

    @trajectory.setter
    def trajectory(self, value: Scan) -> None:
        if not isinstance(value, Scan):
            raise ArgumentError(f"trajectory is a {type(value).__name__}; give a Scan")
        self._state.trajectory = value

    @overload
    def scan(self, out: str | os.PathLike[str], quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             flats: int | None = None, darks: int | None = None, overwrite: bool = False, progress: Progress = False,
             **options: Any) -> dict[str, Any]: ...

    @overload
    def scan(self, out: Any = None, quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             progress: Progress = False, **options: Any) -> NDArray[Any]: ...

    def scan(self, out: Any = None, quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             flats: int | None = None, darks: int | None = None, overwrite: bool = False, progress: Progress = False,
             **options: Any) -> Any:
        """The projections of the scene's trajectory, [n, row, column], or a file of them.

        out: None; an array to write to; or the path of a file (.h5, .nxs, .mha, .raw, .tif, or a folder), as the command
        `skiagraph scan` writes it. A file of the same scan that is not finished is continued, a finished one is left as it
        is, and one of another scan is refused unless overwrite is true. Then the result says what was done: projections,
        found, computed, finished, hash and file. flats, darks: numbers of flat and dark fields: in an .h5, 1 by default;
        in a folder (flat-00000.tif) or beside a stack (scan-flats.mha), if one is given or pixels differ without parts.
        only: numbers of projections, rising. breathing: poses the scene at the time of each projection. subframes: frames
        from which each projection is averaged over its exposure. The rest is as in images(). An interrupt (Ctrl-C) ends
        the scan at once, and what a file has by then it keeps.

        >>> from skiagraph import Beam, Mesh, Scan, Scene, View
        >>> scene = Scene()
        >>> scene.add("ball", Mesh.sphere(40, 64), material="water")
        <Part 'ball': Water, Liquid>
        >>> scene.view = View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
        ...                   pixels=(64, 48))
        >>> scene.beam = Beam.mono(60, 1000)
        >>> scene.trajectory = Scan(scene.view, 8, axis="y")
        >>> scene.scan(quantity="attenuation").shape
        (8, 48, 64)
        """
        given = {"quantity": quantity, "precision": precision, "tolerance": tolerance, **options}
        wanted = _projections.Wanted(only, breathing, _arrays.whole(subframes, "subframes"), given, progress)
        if self._state.breath and not breathing:
            raise SceneError("the scene was posed by breathe(); give breathing=True to pose it at the time of each "
                             "projection, or images(views=scene.trajectory) for this pose")
        with self._state.calls():
            if isinstance(out, (str, os.PathLike)):
                return _projections.write(self._state, self.trajectory, wanted, out, (flats, darks), overwrite)
            return _projections.compute(self._state, self.trajectory, wanted, out)

    def plan(self, **options: Any) -> Report:
        """Report of the effects that images have and lack, and why; options as of image()."""
        with self._state.calls():
            return Report(self._state.plan(options), [part.label for part in self])

    @staticmethod
    def schema() -> dict[str, Any]:
        """The JSON Schema (draft 2020-12) of scene files, made of the tables by which they are read: `jsonschema.validate(text, Scene.schema())`."""
        return _source.schema()

    def save(self, path: str | os.PathLike[str], image: Any = None, quantity: str | None = None, *, display: str = "radiograph",
             range: tuple[float, float] | None = None, **options: Any) -> None:
        """Writes the scene as a scene file, .json, whose images have the same bits; or an image of it, .png, .tif, .mha or .dcm.

        (Where vertices were moved, images of floats agree to their rounding, those of doubles bit for bit.) Meshes that were added or changed are written as PLY into a folder beside the file, NAME-parts. Other files that
        the scene names stay where they are. A scene that breathe() posed is written in this pose, with its densities and without its breath.

        quantity: what it holds, or "lengths" for path lengths; by default what it was computed as, and "energy" for an array that no
        call of the scene made. display: "radiograph" or "transmission", and range: the
        values of black and white, of a .png. A .dcm (pydicom) holds 65536 steps between the least and the largest value. options: those that the image was computed with.
        """
        if image is None:
            with self._state.calls():
                _save.save(self._state, path)
            return
        with self._state.calls():
            view = self.view
            quantity = quantity or self._state.shows(image) or "energy"
            if quantity == "lengths":
                write_picture(path, image, names=["path length"], unit="mm", view=view, display=display, range=range)
                return
            channels = listed("skg_channel", "skg_plan_channel", self._state.plan({"quantity": quantity, **options}))
            write_picture(path, image, names=[c["name"] for c in channels], unit=channels[0]["unit"],
                          flat_field=channels[0]["flat_field"], quantity=quantity, view=view, display=display, range=range,
                          kvp=float(max(self.beam.energies)))

    def picture(self, pixels: Sequence[int] = (1024, 768), *, direction: Any = None, up: Any = None,
                orthographic: bool = False, image: Any = None, colours: Mapping[str, Any] | None = None) -> NDArray[np.uint8]:
        """Source, detector and parts from outside, [row, column, red green blue], 0 to 255.

        pixels: (columns, rows). direction: from the scene to the eye; by default obliquely from the side of the source.
        up: what is up in the picture. image: an image to show on the detector. colours: of parts by label, (red, green,
        blue) or with opacity, 0 to 1.
        """
        with self._state.calls():
            return _look.picture(self._state, pixels, direction, up, orthographic, image, colours or {})

    def show(self, *, height: int = 600) -> _show.Page:
        """The scene as a page that turns with the mouse, for a cell of a notebook; the command `skiagraph view` makes it.

        height: of the cell, in pixels. The page has save("scene.html"), and the command has to be installed.
        """
        with self._state.calls():
            return _show.page(self._state, height)

    def live(self, *, height: int = 640) -> Any:
        """The scene under one's hands, for a cell of a notebook: the page of the command `skiagraph live` as a widget.

        What is dragged there is in the scene: poses, view, beam, breath, and the options of its images. What Python assigns is
        shown when its cell has ended, or by refresh(). While a cell runs, what is dragged waits. height: of the cell, in pixels.
        Needs anywidget: pip install "skiagraph[notebook]".
        """
        with self._state.calls():
            return _widget.widget(self._state, height)

    # Breath

    def breathe(self, *, phase: float | None = None, time: float | None = None) -> dict[str, float]:
        """Poses the meshes at a phase of the breath (0 at end-inspiration), or at a time in s with the file's events.

        Returns where the breath is: phase, amplitude, depth of the needle and more. Images show it from now on.
        """
        if (phase is None) == (time is None):
            raise ArgumentError("give breathe(phase=...) or breathe(time=...), one of them")
        with self._state.calls():
            motion = self._state.linked()
            breath = {"phase": _arrays.real(phase, "phase")} if phase is not None else {"time": _arrays.real(time, "time")}
            self._state.pose(breath)
            self._state.breath = breath
            return filled("skg_motion_state", "skg_motion_state_get", motion)

    # Costs

    def cost(self, *, quick: bool = False, within: float = 60, frames: int = 1, sensitivity: bool = False) -> dict[str, Any]:
        """Errors and times of the scene's settings, as the command `skiagraph cost` measures them.

        within: the time for measuring, in seconds; frames: the length of the batches that are timed. Of the result, "summary"
        says it in a sentence, and "sources" lists each source of error and what halving it costs. sensitivity: "sensitivity" lists
        how much the image changes when each part moves by a mm, as a fraction of the open beam.

        The command has to be installed. It reads the scene as it was loaded: a scene that was changed since is refused.
        """
        with self._state.calls():
            if self._state.is_changed():
                raise SceneError("the scene was changed since it was read, and cost() compares it as it was read; put "
                                 "the changes into the file, the dictionary or settings")
        return _command.cost(self._state.source, quick, within, frames, sensitivity)

    def register(self, images: Any, parts: str | Sequence[str] = (), *, free: str = "pose", loss: str = "lsq",
                 quantity: str | None = "attenuation", out: str | os.PathLike[str] | None = None, polish: bool = False,
                 start: Sequence[float] | None = None, restarts: int = 0, seed: int = 1, mask: Any = None, flat: Any = None,
                 report: str | os.PathLike[str] | None = None) -> dict[str, Any]:
        """Finds where parts are in radiographs, or where source and detector were, as the command `skiagraph register`.

        images: an array [row, column] of the scene's own view, a list of arrays of the projections of the scene's scan, or
        {projection: array}; an array may be a file. parts: a label, in which * stands for any text; all that fit move as one. Of
        several, each is registered after the one before. free: "pose", "source", "detector" or "geometry". loss: "lsq", "ncc" or
        "gradient-ncc". quantity: "attenuation", "transmission" or "intensity"; None: as the files say. start: six numbers, a twist in mm
        and rad. out: the scene with what was found, .json; report: a page, .html.

        Returns what the command prints: status, verdict, parts (label, twist, sigma, determined, directions), loss and more. The
        scene itself stays as it is. The command has to be installed.
        """
        with self._state.calls():
            flags = {"--free": free, "--loss": loss, "--quantity": quantity, "--polish": polish, "--restarts": restarts or None,
                     "--seed": seed, "--start": None if start is None else tuple(_arrays.real(x, "start") for x in start),
                     "--report": None if report is None else os.fspath(report)}
            return _register.register(self._state, images, parts, out, flags, mask, flat)

    # Life

    def close(self) -> None:
        """Frees the scene now instead of with its last reference."""
        self._state.close()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()
        with self._state.device.calls():
            pass

    def __getstate__(self) -> dict[str, Any]:
        with self._state.calls():
            return _pickle.content(self._state)

    def __setstate__(self, content: dict[str, Any]) -> None:
        self._state = _pickle.opened(content)
        _pickle.restore(self, self._state, content)

    def __repr__(self) -> str:
        if self._state.setup == ffi.NULL:
            return "<Scene, closed>"
        name, view = os.path.basename(self._state.source.path or "scene"), self._state.view
        return f"<Scene {name}: {len(self)} parts, {'no view' if view is None else repr(view)}>"

    def _repr_html_(self) -> str:
        return _show.summary(self)


def state_of(scene: Scene) -> State:
    """State of a scene, for functions outside of the class."""
    return scene._state
