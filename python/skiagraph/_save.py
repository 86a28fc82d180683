"""A scene as a scene file. Private.

The text that the scene was read from stays, with its settings, and what was changed since is written into it: positions as
doubles with all their digits, so that the file reads back to the same bits.
"""
from __future__ import annotations

import functools
import json
import os
import pathlib
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _breath
from ._interface import ArgumentError, OutputError, SceneError
from ._library import encode, ffi, string, struct
from ._source import schema
from .beam import Beam
from .material import Material
from .mesh import Mesh
from .part import Part
from .scan import Scan
from .view import View

if TYPE_CHECKING:
    from ._state import State

_SHAPES = ("Path", "Unit", "Cube", "Cuboid", "Cylinder", "Sphere", "StepWedge", "FlipNormals")
_Z_FROM_Y = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
_PLACES = ("Transform", "MoveToCentre")


def save(state: State, path: str | os.PathLike[str]) -> None:
    target = pathlib.Path(path)
    if target.suffix.lower() != ".json":
        raise ArgumentError(f"{target}: a scene is written as .json; give save({str(path)!r}, image) for an image")
    if target.name.lower().endswith(".ctsimu.json"):
        raise ArgumentError(f"{target}: the command writes scenarios of CTSimU: save the scene as .json, then skiagraph scan SCENE.json -o "
                            f"projections --geometry {target.name}")
    if not target.parent.is_dir():
        raise OutputError(f"{target}: there is no folder {target.parent}; make it first")
    text = settings_text(state)
    _rename_files(text, state.source.files, target.parent)
    _write_samples(state, text, target)
    if state.trajectory is not None:
        _put(text, "Scan", _scan_text(state.trajectory))
    if state.breath:
        _drop(text, "Breathing")
    text = {"$schema": "scene.schema.json", **text}
    _write_text(target, json.dumps(text, indent=1) + "\n")


def settings_text(state: State, placed: bool = False) -> dict[str, Any]:
    """Text of the scene as it is read, with its source, detector and beam as they are now. placed: also where the file has them fitted."""
    text: dict[str, Any] = json.loads(string("skg_setup_text_get", state.setup))
    if state.tuned != ffi.NULL:
        for key, value in json.loads(string("skg_setup_text_get", state.tuned)).items():
            _put(text, key, value)
    if placed or state.view != state.read_view:
        _write_view(state, text)
    if "beam" in state.changed:
        beam, (columns, rows) = state.require_beam(), _binning(text)
        if not beam.absolute and columns * rows > 1:  # a file counts photons per sensor pixel
            beam = beam.scaled(1 / (columns * rows))
        _put(_object(text, "Source"), "Beam", beam_text(beam))
    return text


def repairs(text: dict[str, Any]) -> set[str]:
    """Words of the key Repair."""
    given = _get(text, "Repair", [])
    return {word.lower() for word in ([given] if isinstance(given, str) else given)}


def without_parts(text: dict[str, Any]) -> dict[str, Any]:
    """Source, detector and options alone."""
    return {key: value for key, value in text.items() if _plain(key) not in ("samples", "scenegraph", "breathing")}


# Keys are compared as the library does


def _plain(name: str) -> str:
    return re.sub("[ _-]", "", name).lower()


def _named(found: dict[str, Any], name: str) -> str:
    """The key of this name as the object has it."""
    return next((key for key in found if _plain(key) == _plain(name)), name)


def _get(found: dict[str, Any], name: str, default: Any = None) -> Any:
    return found.get(_named(found, name), default)


def _put(found: dict[str, Any], name: str, value: Any) -> None:
    found[_named(found, name)] = value


def _drop(found: dict[str, Any], *names: str) -> None:
    for name in names:
        found.pop(_named(found, name), None)


@functools.cache
def _spellings(*names: str) -> list[str]:
    """These keys of a sample in every spelling that the schema has."""
    said = {f"another spelling of {name}" for name in names}
    keys = schema()["$defs"]["Sample"]["properties"]
    return [key for key, form in keys.items() if key in names or form.get("$comment") in said]


def _object(found: dict[str, Any], name: str) -> dict[str, Any]:
    made: dict[str, Any] = found.setdefault(_named(found, name), {})
    return made


def _rename_files(value: Any, files: dict[str, tuple[str, tuple[int, int]]], folder: pathlib.Path) -> None:
    """Names of files lead to the same files from the new folder."""
    items: Any = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, below in items:
        if isinstance(below, str) and below in files:
            value[key] = os.path.relpath(os.path.abspath(files[below][0]), os.path.abspath(folder))
        else:
            _rename_files(below, files, folder)


# Source and detector


def _mm(vector: NDArray[np.float64]) -> list[Any]:
    return [*vector.tolist(), "mm"]


def _binning(text: dict[str, Any]) -> tuple[int, int]:
    """Sensor pixels of a pixel, (columns, rows)."""
    columns, rows = _get(_get(text, "Detector", {}), "Binning", (1, 1))
    return int(columns), int(rows)


def _write_view(state: State, text: dict[str, Any]) -> None:
    view = state.view
    if view is None:
        return
    source, detector = _object(text, "Source"), _object(text, "Detector")
    _drop(source, "Position", "Direction", "From")
    infinite = view.projection == "parallel_from_infinity"
    source["Direction" if infinite else "Position"] = view.source.tolist() if infinite else _mm(view.source)
    shape = _get(source, "Shape")
    if not isinstance(shape, list) or view.projection != "point":
        _put(source, "Shape", "PointSource" if view.projection == "point" else "ParallelBeam")
    _drop(detector, "UpVector", "RightVector", "Size", "Spacing", "Curved")
    columns, rows = _binning(text)  # a file has the sensor's pixels
    pixels = [view.pixels[0] * columns, view.pixels[1] * rows]
    for name, value in (("Position", _mm(view.detector)), ("ColumnStep", _mm(view.column_step / columns)),
                        ("RowStep", _mm(view.row_step / rows)), ("NumberOfPixels", pixels)):
        _put(detector, name, value)
    if view.radius > 0:
        _put(detector, "Curved", {"Radius": [view.radius, "mm"], "Axis": "columns"})


def beam_text(beam: Beam) -> dict[str, Any]:
    """The value of the key Beam."""
    found: dict[str, Any] = {"Bins": [list(row) for row in zip(beam.energies.tolist(), beam.photons.tolist())]}
    return {**found, "At1m": True} if beam.absolute else found


def _scan_text(scan: Scan) -> dict[str, Any]:
    def row(view: View) -> list[float]:
        return [float(x) for v in (view.source, view.detector, view.column_step, view.row_step) for x in v]

    found: dict[str, Any] = {"Table": [row(view) for view in scan]}
    times = scan.times
    if len(times) > 1 and times.any():
        found.update(StartTime=float(times[0]), Interval=float(times[1] - times[0]))
    return found


# Samples


def _write_samples(state: State, text: dict[str, Any], target: pathlib.Path) -> None:
    samples = _file_samples(text)
    parts, old = state.parts(), state.names[:state.file_parts]
    changed, breath = _changed(state), _breath.matters(state)
    if not any(changed.values()) and len(old) == len(parts) and len(old) == len(samples):
        return
    if len(samples) <= max(old, default=-1):
        raise SceneError(f"{target}: the samples of the scene are not found in its text; this scene cannot be written")
    together = any(isinstance(sample, str) for sample in _get(text, "Samples") or [])  # the command MoveToCentre
    made: list[dict[str, Any]] = []
    for part, name in zip(parts, state.names):
        sample = dict(samples[name]) if name < len(samples) and len(made) < state.file_parts else {}
        if part.volume and not sample:
            raise SceneError(f"{part.label}: a volume that add_volume() added is not written into a scene; read a scene whose sample "
                             "names its file (the key Volume; an array may be written as .mha, for example by SimpleITK)")
        _say_all(sample, part)
        if not sample.get(_named(sample, "Transform")) or together or part.label in changed["poses"] + changed["meshes"]:
            _place(sample, part, part.label in changed["meshes"])
        if part.volume:
            made.append(sample)
            continue
        _write_material(state, sample, part, breath.get(part.number), target)
        shapes = _spellings(*_SHAPES)
        if not any(_named(sample, shape) in sample for shape in shapes) or part.label in changed["meshes"]:
            _drop(sample, *shapes)
            sample.update(Path=_mesh_file(state, target, part), Unit="mm")
        made.append(sample)
    _drop(text, "SceneGraph")
    _put(text, "Samples", made)


def _file_samples(text: dict[str, Any]) -> list[dict[str, Any]]:
    """The samples in the order of their parts."""
    found = [sample for sample in _get(text, "Samples") or [] if isinstance(sample, dict)]
    graph = _get(text, "SceneGraph")
    return found + ([graph] if isinstance(graph, dict) else [])


def _changed(state: State) -> dict[str, list[str]]:
    """Labels of the parts from the file whose place, material or mesh is another."""
    old = state.parts()[:state.file_parts]
    poses = [part.label for part, pose in zip(old, state.read_poses) if (part.pose != pose).any()]
    return {"poses": poses, "materials": [part.label for part in old if part.number in state.materials],
            "meshes": [part.label for part in old if state.breath or part.mesh._changed], "removed": state.removed}


def _say_all(sample: dict[str, Any], part: Part) -> None:
    """Label, parent and priority, all of them said."""
    _drop(sample, "Type", "Priority", "Through")
    if _named(sample, "Label") not in sample or _get(sample, "Label") != part.label:
        _put(sample, "Label", part.label)
    sample["Parent"] = part.inside
    if part.priority:
        if part.priority == 2 ** 31 - 1:
            sample["Through"] = True
        else:
            sample["Priority"] = part.priority


def _place(sample: dict[str, Any], part: Part, has_mesh: bool) -> None:
    """The pose, as one matrix. has_mesh: its mesh becomes a file."""
    _drop(sample, *_spellings(*_PLACES))
    pose = part.pose
    if _named(sample, "Cylinder") in sample and not has_mesh:
        pose = pose @ _Z_FROM_Y  # a sample's cylinder stands along y, that of the part along z
    if (pose != np.eye(4)).any():
        sample["Transform"] = [["Matrix", pose.T.ravel().tolist()]]


def _write_material(state: State, sample: dict[str, Any], part: Part, breath: Material | None, target: pathlib.Path) -> None:
    """breath: the material that the pose of the breath makes of it; None: its own."""
    own = state.materials.get(part.number) or part.material
    has_name = sample.get(_named(sample, "Material")) and part.number not in state.materials
    if has_name and breath is None:
        return
    _drop(sample, "Density")
    if has_name and breath is not None and breath.density > 0 and breath.elements == own.elements:  # the same at another density
        sample["Density"] = breath.density
        return
    sample[_named(sample, "Material")], density = material_text(breath or own, _writer(target, part))
    if density:
        sample["Density"] = density


def material_text(material: Material, write: Callable[[str], str]) -> tuple[Any, float | None]:
    """The keys Material and Density. write: makes a file of a text and gives its name."""
    recipe, density = material._recipe or (None, None)
    name, *arguments = recipe or ("",)
    if name == "skg_material_create_named":
        return arguments[0].decode(), density
    if name == "skg_material_create_mu":
        return ["mu", arguments[1]], None
    if name == "skg_material_create_hounsfield":
        return ["HU", arguments[0]], density
    if name == "skg_material_create_formula":
        return ["Compound", arguments[0].decode()], density or arguments[1] or None
    if name == "skg_material_create_table":
        rows = "".join(f"{kev!r} {mu!r}\n" for kev, mu in zip(arguments[2][1], arguments[3][1]))
        return ["Table", write(rows), "keV"], None
    if name == "skg_material_create_mixture":
        return ["Mixture", [x for pair in zip(arguments[2][1], arguments[3][1]) for x in pair]], density or arguments[4] or None
    if not material.elements:
        raise SceneError(f"{material.name}: was read from a file of another scene, and its table is not known any more; make it "
                         "by Material.table")
    return ["Mixture", [x for pair in material.elements.items() for x in pair]], material.density


# Files

def _write_text(path: pathlib.Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}") from None


def _beside(target: pathlib.Path, part: Part, suffix: str) -> tuple[pathlib.Path, str]:
    folder = target.with_name(target.stem + "-parts")
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be made: {error.strerror}") from None
    name = f"{part.number}-{re.sub('[^A-Za-z0-9]+', '-', part.label).strip('-')}{suffix}"
    return folder / name, f"{folder.name}/{name}"


def _mesh_file(state: State, target: pathlib.Path, part: Part) -> str:
    path, name = _beside(target, part, ".ply")
    mesh = part.mesh
    mesh.save(path)
    if mesh.health["same_way_edges"] and "none" not in state.repairs:
        read = Mesh._made("skg_mesh_load_as", ffi.NULL, encode(path, "path"), struct("skg_mesh_reading"))
        if (read.faces != mesh.faces).any():
            raise SceneError(f"{part.label}: its mesh is wound inconsistently and was left so (as_wound=True), but a scene file's meshes are "
                             "turned, and the images would differ. Make the mesh without as_wound, or the scene with \"Repair\": \"none\"; "
                             "pickle keeps the scene as it is")
    return name


def _writer(target: pathlib.Path, part: Part) -> Callable[[str], str]:
    def write(rows: str) -> str:
        path, name = _beside(target, part, ".txt")
        _write_text(path, rows)
        return name

    return write
