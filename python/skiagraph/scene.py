"""Scenes: parts, source and detector, and their images."""
from __future__ import annotations

import copy
import html
import os
from collections.abc import Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, ContextManager, overload

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _command, _edit, _look, _pickle, _projections, _save, _show, _source
from ._device import Device, device_of
from ._frames import Batch, Stale, run
from ._interface import ENUMS, ArgumentError, SceneError
from ._library import call, check, choice, encode, ffi, filled, integer, lib, listed, make, retained, struct
from ._plans import Plans
from ._progress import Progress
from .beam import Beam
from .material import Material, as_material
from .mesh import Mesh, as_mesh
from ._picture import write_picture
from .part import Part
from .report import Report
from .scan import Scan
from .view import View, as_views

#: The keV of a unit in which energies may be given.
_KEV = {"eV": 1e-3, "keV": 1.0, "MeV": 1e3}


class Scene:
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
        self._kept: _source.Kept | None = None
        self._open(_source.source_of(scene, settings, lenient, lengths_only), device, None)

    def _open(self, source: _source.Source, device: Device | str | None, elsewhere: Mapping[str, str] | None) -> None:
        self._device = device_of(device)
        self._source = source
        self._setup = self._motion = self._own_parts = ffi.NULL
        self._removed: list[str] = []
        self._said: set[str] = set()
        self._meshes: dict[Any, Mesh] = {}
        self._materials: dict[int, Material] = {}
        self._breath: dict[str, float] | None = None
        self._changed: set[str] = set()
        self._trajectory: Scan | None = None
        self._frames = 0
        with self._calls():
            self._setup = source.load(self._device.handle, elsewhere)
            handle = ffi.new("skg_scene **")
            call("skg_setup_scene_get", self._setup, handle)
            self._parts_handle = handle[0]
            spectrum, view = ffi.new("skg_spectrum **"), struct("skg_view")
            call("skg_setup_spectrum_get", self._setup, spectrum)
            call("skg_setup_view_get", self._setup, view)
            self._beam = Beam._borrowed(spectrum[0]) if spectrum[0] != ffi.NULL else None
            self._view = View._read(view) if view.columns else None
            self._plans = Plans(self._device)
            self._file_parts = len(self)
            self._names = list(range(len(self)))
            self._read_view = copy.deepcopy(self._view)
            self._read_poses = [part.pose for part in self]

    def _calls(self) -> ContextManager[None]:
        if self._setup == ffi.NULL and hasattr(self, "_plans"):
            raise ArgumentError("the scene was closed")
        return self._device.calls(self._said)

    # Parts

    def __len__(self) -> int:
        return integer("skg_scene_part_count", self._parts_handle)

    def __iter__(self) -> Iterator[Part]:
        return iter([Part(self, number) for number in range(len(self))])

    def __getitem__(self, label: str) -> Part:
        return Part(self, self._number(label))

    @property
    def parts(self) -> list[Part]:
        """The parts, in their order."""
        return list(self)

    def __contains__(self, label: object) -> bool:
        return isinstance(label, str) and any(part.label == label for part in self)

    def _number(self, label: str) -> int:
        if not isinstance(label, str):
            raise ArgumentError(f"the label of a part is a {type(label).__name__}; give its text")
        with self._calls():
            try:
                return integer("skg_scene_find", self._parts_handle, encode(label, "label"))
            except SceneError:
                raise _edit.unknown_label(label, [part.label for part in self]) from None

    def add(self, label: str, mesh: Any, *, material: Material | str, inside: str | Part | None = None,
            pose: Any = None, priority: int = 0, unit_mm: float = 1) -> Part:
        """Adds a part.

        mesh: a Mesh, (vertices, faces), an object of trimesh, meshio or PyVista, or the path of a file, in units of
        unit_mm. material: a Material or a name. inside: the part that it displaces. pose: 4 x 4, mm.
        """
        parent = inside.label if isinstance(inside, Part) else inside
        with self._calls():
            made = as_mesh(mesh, unit_mm=unit_mm, name=label, _context=self._device.handle)
            matter, part, name = as_material(material), struct("skg_part"), ffi.new("char[]", encode(label, "label"))
            part.mesh, part.material, part.label, part.priority = made._handle, matter._handle, name, int(priority)
            if parent is not None:
                part.inside = self._number(parent)
            if pose is not None:
                part.pose = _arrays.matrix(pose, "pose").ravel().tolist()
            number = integer("skg_scene_add", self._parts_handle, part)
            self._names.append(max(self._names, default=-1) + 1)
            self._materials[number] = matter
            self._meshes[_address(made._handle)] = made
            self._plans.clear()
            self._forget_motion()
        return Part(self, number)

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
        with self._calls():
            _edit.remove(self, self._number(label))

    def _mesh(self, handle: Any) -> Mesh:
        """One object for each mesh, so that it knows whether it was changed."""
        key = _address(handle)
        if key not in self._meshes:
            self._meshes[key] = Mesh._of(retained("skg_mesh", handle))
        return self._meshes[key]

    def _material(self, number: int, handle: Any) -> Material:
        return self._materials.get(number) or Material._borrowed(handle)

    # Source, detector and beam

    @property
    def view(self) -> View:
        """Source and detector. Its arrays may be changed in place; assign another View to replace it."""
        if self._view is None:
            raise SceneError("the scene has no source and detector; assign a View to scene.view")
        return self._view

    @view.setter
    def view(self, value: View) -> None:
        if not isinstance(value, View):
            raise ArgumentError(f"view is a {type(value).__name__}; give a View")
        self._view = value
        self._changed.add("view")

    @property
    def beam(self) -> Beam:
        """The photons by energy. Assign another Beam to replace it."""
        if self._beam is None:
            raise SceneError("the scene has no beam; assign a Beam to scene.beam")
        return self._beam

    @beam.setter
    def beam(self, value: Beam) -> None:
        if not isinstance(value, Beam):
            raise ArgumentError(f"beam is a {type(value).__name__}; give a Beam")
        self._beam = value
        self._changed.add("beam")
        self._plans.clear()

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
        (edges in keV), spot={"shape": "disc", "extent": 0.6}, response=, world=, repair="exact".
        """
        batch = Batch(1, index=self._number_frames(1, index, options))
        found = self._render(batch, out, False, True, unit, quantity=quantity, precision=precision,
                             tolerance=tolerance, **options)
        return found

    def images(self, quantity: str | None = None, *, poses: Mapping[str, Any] | None = None,
               views: Sequence[View] | None = None, unit: str | None = None, precision: str | None = None,
               tolerance: float | None = None, index: int | None = None, out: Any = None, progress: Progress = False,
               **options: Any) -> NDArray[Any]:
        """A batch of images, [n, row, column]; energy bands are an axis behind the first.

        poses: for each label n matrices, [n, 4, 4], or one for all. views: n Views. index: number of the first frame,
        for the noise, as of image(). progress: True for a line on standard error, or a function of (done, n). The rest is as in
        image(). An interrupt (Ctrl-C) ends the batch at once.
        """
        batch = self._batch(poses, views, 0)
        batch.index = self._number_frames(batch.count, index, options)
        if batch.views and tolerance and "views" not in options:
            options["views"] = batch.views
        return self._render(batch, out, progress, False, unit, quantity=quantity, precision=precision,
                            tolerance=tolerance, **options)

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
            wanted = [part.label for part in self] if label is None else list(label)
            given = {"poses": poses, "views": views, "progress": progress, "precision": precision, **options}
            for name in wanted:  # all of them, before the first is computed
                self._number(name)
            return {name: self.lengths(name, kind, **given) for name in wanted}
        one = poses is None and views is None
        batch = Batch(1) if one else self._batch(poses, views, 0)
        part, what = self._number(label), choice("lengths", kind, "kind")

        def submit(plan: Any) -> Any:
            def start(count: int, frames: Any, output: Any, job: Any) -> int:
                output.kind, output.part, output.lengths = ENUMS["output_kind"]["lengths"], part, what
                return int(lib.skg_plan_submit(plan, count, frames, output, job))

            return start

        with self._calls():
            return self._run(submit, batch, out, progress, one, False, {"precision": precision, **options})

    # Scans

    @property
    def trajectory(self) -> Scan:
        """Source and detector in each projection of scan(): the key Scan of the file. Assign a Scan to replace it."""
        if self._trajectory is not None:
            return self._trajectory
        with self._calls():
            if self._view != self._read_view:
                raise SceneError("the view was changed since the scene was read, and the key Scan turns the one of the "
                                 "file; assign a Scan of the new view to scene.trajectory")
            handle = ffi.new("skg_scan **")
            call("skg_setup_scan_get", self._setup, handle)
            return Scan._borrowed(handle[0])

    @trajectory.setter
    def trajectory(self, value: Scan) -> None:
        if not isinstance(value, Scan):
            raise ArgumentError(f"trajectory is a {type(value).__name__}; give a Scan")
        self._trajectory = value

    @overload
    def scan(self, out: str | os.PathLike[str], quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             flats: int = 1, darks: int = 1, overwrite: bool = False, progress: Progress = False,
             **options: Any) -> dict[str, Any]: ...

    @overload
    def scan(self, out: Any = None, quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             progress: Progress = False, **options: Any) -> NDArray[Any]: ...

    def scan(self, out: Any = None, quantity: str | None = None, *, only: Sequence[int] | None = None,
             breathing: bool = False, subframes: int = 1, precision: str | None = None, tolerance: float | None = None,
             flats: int = 1, darks: int = 1, overwrite: bool = False, progress: Progress = False,
             **options: Any) -> Any:
        """The projections of the scene's trajectory, [n, row, column], or a file of them.

        out: None; an array to write to; or the path of a file (.h5, .mha, .raw, .tif, or a folder), as the command
        `skiagraph scan` writes it. A file of the same scan that is not finished is continued, a finished one is left as it
        is, and one of another scan is refused unless overwrite is true. Then the result says what was done: projections,
        found, computed, finished, hash and file. flats, darks: fields in an .h5.
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
        wanted = _projections.Wanted(only, breathing, subframes, given, progress)
        if self._breath and not breathing:
            raise SceneError("the scene was posed by breathe(); give breathing=True to pose it at the time of each "
                             "projection, or images(views=scene.trajectory) for this pose")
        with self._calls():
            if isinstance(out, (str, os.PathLike)):
                return _projections.write(self, self.trajectory, wanted, out, (int(flats), int(darks)), overwrite)
            return _projections.compute(self, self.trajectory, wanted, out)

    def _number_frames(self, count: int, index: int | None, options: Mapping[str, Any]) -> int:
        """The number of the first of these frames: that of the caller, or the next one of a scene with noise."""
        if index is not None:
            return int(index)
        if options.get("noise_seed") is not None:
            return 0
        with self._calls():
            file = self._plans.options(self._setup, {}, [])
        given = [options.get("noise"), options.get("electronic_kev")]
        noise, electronic = (own if value is None else value for own, value in zip((file.noise, file.electronic_kev), given))
        first = self._frames
        if noise or electronic:
            self._frames += count
            return first
        return 0

    def _batch(self, poses: Mapping[str, Any] | None, views: Sequence[View] | None, index: int) -> Batch:
        count: int | None = None
        source = ""
        stacks, parts = [], []
        for label, value in (poses or {}).items():
            what = f"poses[{label!r}]"
            stack = _arrays.matrices(value, what)
            if stack.ndim == 3:
                count, source = _agree(count, source, len(stack), what)
            parts.append(self._number(label))
            stacks.append(stack)
        seen = [] if views is None else as_views(views)
        if views is not None:
            count, source = _agree(count, source, len(seen), "views")
        if not count:
            raise ArgumentError("there is nothing to compute: give views, or poses as {label: [n, 4, 4]}")
        together = None
        if parts:
            together = np.empty((count, len(parts), 4, 4))
            for i, stack in enumerate(stacks):
                together[:, i] = stack
        return Batch(count, index, parts, together, seen)

    def _render(self, batch: Batch, out: Any, progress: Progress, one: bool, unit: str | None,
                **options: Any) -> NDArray[Any]:
        if unit is not None and (unit not in _KEV or options.get("quantity") not in (None, "energy")):
            raise ArgumentError(f"unit {unit!r} with quantity {options.get('quantity') or 'energy'!r}: a unit is one of "
                                f"{', '.join(map(repr, _KEV))}, and for energy alone")

        def submit(plan: Any) -> Any:
            return lambda count, frames, output, job: lib.skg_plan_submit(plan, count, frames, output, job)

        with self._calls():
            image = self._run(submit, batch, out, progress, one, options.get("bands") is not None, options)
        if unit is not None and unit != "keV":
            image /= image.dtype.type(_KEV[unit])
        return image

    def _run(self, submit: Any, batch: Batch, out: Any, progress: Progress, one: bool, banded: bool,
             options: dict[str, Any]) -> NDArray[Any]:
        """Computes a batch with the plan of these options; a stale plan is made anew once."""
        batch.complete = self._complete()
        for again in (False, True):
            plan = self._plan(options, batch.views, again)
            channels = 1 if not banded else integer("skg_plan_channel_count", plan)
            rows, columns = batch.views[0].shape if batch.views else self.view.shape
            shape = (batch.count, channels, rows, columns)
            given = _shape(shape, one, banded)
            if out is None:
                target = np.empty(given, np.float64 if options.get("precision") == "double" else np.float32)
            else:
                target = _arrays.output(out, given)
            frames = target.reshape(shape) if out is None else _four(target, one, banded)
            try:
                run(self._device, submit(plan), batch, frames, progress)
                break
            except Stale as stale:
                if again:
                    raise SceneError(str(stale)) from None
        return target

    def _plan(self, options: Mapping[str, Any], views: list[View] | None = None, anew: bool = False) -> Any:
        view = views[0] if views else self.view
        return self._plans.get(self._setup, self._parts_handle, view, self.beam, options, anew)

    def plan(self, **options: Any) -> Report:
        """What is simulated, what is not, and why; options as of image()."""
        with self._calls():
            return Report(self._plan(options), [part.label for part in self])

    def save(self, path: str | os.PathLike[str], image: Any = None, quantity: str = "energy", *, display: str = "radiograph",
             range: tuple[float, float] | None = None, **options: Any) -> None:
        """Writes the scene as a scene file, .json, whose images have the same bits; or an image of it, .png, .tif or .mha.

        (Where vertices were moved, images of floats agree to their rounding, those of doubles bit for bit.) Meshes that were added or changed are written as PLY into a folder beside the file, NAME-parts. Other files that
        the scene names stay where they are. A scene that breathe() posed is written in this pose, without its breath.

        quantity: what it holds, or "lengths" for path lengths. display: "radiograph" or "transmission", and range: the
        values of black and white, of a .png. options: those that the image was computed with.
        """
        if image is None:
            with self._calls():
                _save.save(self, path)
            return
        with self._calls():
            view = self.view
            if quantity == "lengths":
                write_picture(path, image, names=["path length"], unit="mm", view=view, display=display, range=range)
                return
            channels = listed("skg_channel", "skg_plan_channel", self._plan({"quantity": quantity, **options}))
            write_picture(path, image, names=[c["name"] for c in channels], unit=channels[0]["unit"],
                          flat_field=channels[0]["flat_field"], quantity=quantity, view=view, display=display, range=range)

    def picture(self, pixels: Sequence[int] = (1024, 768), *, direction: Any = None, up: Any = None,
                orthographic: bool = False, image: Any = None, colours: Mapping[str, Any] | None = None) -> NDArray[np.uint8]:
        """Source, detector and parts from outside, [row, column, red green blue], 0 to 255.

        pixels: (columns, rows). direction: from the scene to the eye; by default obliquely from the side of the source.
        up: what is up in the picture. image: an image to show on the detector. colours: of parts by label, (red, green,
        blue) or with opacity, 0 to 1.
        """
        with self._calls():
            return _look.picture(self, pixels, direction, up, orthographic, image, colours or {})

    def show(self, *, height: int = 600) -> _show.Page:
        """The scene as a page that turns with the mouse, for a cell of a notebook; the command `skiagraph view` makes it.

        height: of the cell, in pixels. The page has save("scene.html"), and the command has to be installed.
        """
        with self._calls():
            return _show.page(self, height)

    # Breath

    def breathe(self, *, phase: float | None = None, time: float | None = None) -> dict[str, float]:
        """Poses the meshes at a phase of the breath (0 at end-inspiration), or at a time in s with the file's events.

        Returns where the breath is: phase, amplitude, depth of the needle and more. Images show it from now on.
        """
        if (phase is None) == (time is None):
            raise ArgumentError("give breathe(phase=...) or breathe(time=...), one of them")
        with self._calls():
            motion = self._linked()
            breath = {"phase": float(phase)} if phase is not None else {"time": float(time or 0)}
            self._pose(breath)
            self._breath = breath
            return filled("skg_motion_state", "skg_motion_state_get", motion)

    def _linked(self) -> Any:
        """The motion of the scene."""
        if self._removed:
            raise SceneError(f"{', '.join(map(repr, self._removed))} was removed, and the breath links the parts of the file; "
                             "take it out of the file instead")
        if self._motion == ffi.NULL:
            self._motion = make("skg_motion_create", "skg_motion", self._device.handle, self._setup)
        return self._motion

    def _pose(self, breath: dict[str, float]) -> None:
        for name, value in breath.items():
            call(f"skg_motion_pose_at_{name}", self._motion, value)

    def _complete(self) -> Any:
        if self._motion == ffi.NULL or self._breath is None:
            return None
        motion = self._motion
        return lambda frame: check(lib.skg_motion_fill(motion, frame))

    def _forget_motion(self) -> None:
        """The parts are others: the next breath links them anew."""
        motion, self._motion = self._motion, ffi.NULL
        if motion != ffi.NULL:
            self._device.drop("skg_motion", motion)

    # Costs

    def cost(self, *, quick: bool = False, within: float = 60, frames: int = 1) -> dict[str, Any]:
        """What accuracy costs: errors and times of the scene's settings, as the command `skiagraph cost` measures them.

        within: the time for measuring, in seconds; frames: the length of the batches that are timed. Of the result, "summary"
        says it in a sentence, and "sources" lists each source of error and what halving it costs.

        The command has to be installed. It reads the scene as it was loaded: a scene that was changed since is refused.
        """
        with self._calls():
            if self._is_changed():
                raise SceneError("the scene was changed since it was read, and cost() compares it as it was read; put "
                                 "the changes into the file, the dictionary or settings")
        return _command.cost(self._source, quick, within, frames)

    def _is_changed(self) -> bool:
        moved = any(mesh._changed for mesh in self._meshes.values()) or any(
            (part.pose != pose).any() for part, pose in zip(self, self._read_poses))
        return bool(self._changed or self._removed or self._materials or len(self) > self._file_parts or moved or self._breath
                    or self._view != self._read_view)

    # Life

    def close(self) -> None:
        """Frees the scene now instead of with its last reference."""
        if getattr(self, "_setup", ffi.NULL) == ffi.NULL:
            return
        if hasattr(self, "_plans"):
            self._plans.clear()
        self._forget_motion()
        setup, self._setup = self._setup, ffi.NULL
        own, self._own_parts = self._own_parts, ffi.NULL
        self._meshes.clear()
        self._materials.clear()
        if own != ffi.NULL:
            self._device.drop("skg_scene", own)
        self._device.drop("skg_setup", setup)

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()
        with self._device.calls():
            pass

    def __del__(self) -> None:
        self.close()

    def __getstate__(self) -> dict[str, Any]:
        with self._calls():
            return _pickle.content(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        _pickle.restore(self, state)

    def __repr__(self) -> str:
        if self._setup == ffi.NULL:
            return "<Scene, closed>"
        name = self._source.path or "scene"
        return f"<Scene {name}: {len(self)} parts, {'no view' if self._view is None else repr(self._view)}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{html.escape(p.label)}</td><td>{html.escape(p.material.name)}</td>"
                       f"<td>{p.density:g}</td><td>{html.escape(p.inside or '')}</td>"
                       f"<td>{p.mesh.health['triangles']}</td></tr>" for p in self)
        return (f"<p>{html.escape(repr(self))}</p><table><tr><th>part</th><th>material</th><th>g/cm3</th>"
                f"<th>inside</th><th>triangles</th></tr>{rows}</table>")


def _address(handle: Any) -> int:
    return int(ffi.cast("intptr_t", handle))


def _agree(count: int | None, source: str, given: int, what: str) -> tuple[int, str]:
    if count is not None and count != given:
        raise ArgumentError(f"{what} has {given} frames and {source} {count}; give as many")
    return given, what


def _shape(shape: tuple[int, ...], one: bool, banded: bool) -> tuple[int, ...]:
    """The shape as the caller sees it."""
    return (() if one else shape[:1]) + (shape[1:2] if banded else ()) + shape[2:]


def _four(array: NDArray[Any], one: bool, banded: bool) -> NDArray[Any]:
    """The caller's array with the axes that it lacks, on the same memory."""
    if not banded:
        array = array[..., None, :, :]
    return array[None] if one else array
