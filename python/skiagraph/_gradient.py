"""Gradients: the derivative of a loss by the scene, from its derivative by an image. Private."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays
from ._frames import Batch, cancel, wait
from ._images import number_frames
from ._interface import OK, ArgumentError, SceneError
from ._library import check, choice, ffi, integer, lib, struct, text

if TYPE_CHECKING:
    from ._state import State

#: What a gradient can be taken of.
NAMES = ("poses", "source", "detector", "vertices", "density", "mu")


class Differentiable:
    """Derivatives of the images of a scene."""

    _state: State

    def gradient(self, weights: ArrayLike, wrt: Sequence[str] = ("poses", "source", "detector"), quantity: str | None = None,
                 **options: Any) -> dict[str, Any]:
        """The derivative of a number, the loss, by the scene.

        weights: the derivative of the loss by the image, [row, column], with bands [band, row, column]. wrt: of "poses",
        "source", "detector", "vertices", "density", "mu". quantity and options: of the image, as in image().

        Returns a dictionary with these keys. "poses": {label: twist}, "source": [3], "detector": twist, "vertices": {label:
        [n, 3]} in the axes of the mesh, "density": {label: number} by the density over the present one, "mu": {label: [energies]} by the attenuation coefficient in
        1/cm at each of plan()["energies"], for the price of an image for each part. A twist is (tx, ty,
        tz in mm, rx, ry, rz in rad) in world axes about the world's origin; the image counts as if pose' = exp(twist) pose.
        The density of a volume of cells is a factor of all its cells. Its twist and "mu" are not numbers: images have no derivative by
        its place, and its cells have no common coefficient.
        docs/derivatives.md says what is exact, what counts as constant and what is refused.

        >>> import numpy as np, skiagraph as sk
        >>> scene = sk.Scene()
        >>> ball = scene.add("ball", sk.Mesh.sphere(40, 64), material="water")
        >>> scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
        ...                      pixels=(64, 64))
        >>> scene.beam = sk.Beam.mono(60, 1000)
        >>> to_the_right = np.linspace(-1, 1, 64) * np.ones((64, 1))
        >>> bool(scene.gradient(to_the_right, quantity="attenuation")["poses"]["ball"][0] > 0)
        True
        """
        for name in wrt:
            if name not in NAMES:
                raise ArgumentError(f"wrt has {name!r}; it is made of {', '.join(map(repr, NAMES))}")
        given = np.ascontiguousarray(_arrays.numbers(weights, "weights"), dtype=np.float64)
        if given.ndim not in (2, 3):
            raise ArgumentError(f"weights has the shape {given.shape}; it is [row, column] or [band, row, column]")
        with self._state.calls():
            return _gradient(self._state, given, list(wrt), {"quantity": quantity, **options})

    def derivative(self, direction: Mapping[str, Any] | Sequence[Mapping[str, Any]], quantity: str | None = None,
                   **options: Any) -> NDArray[np.float64]:
        """The derivative of the image along a direction, [row, column], with bands [band, row, column].

        direction: {"poses": {label: twist}, "source": [3], "detector": twist, "vertices": {label: [n, 3]}, "density": {label:
        number}, "mu": {label: [energies]}}, of which any may be missing: how fast each moves or changes, in the units of
        gradient(), whose results have the same shapes. Of a list of directions the result is [direction, ...]; further ones cost
        less than the first. quantity and options: of the image. The rest is as in gradient().

        >>> import skiagraph as sk
        >>> scene = sk.Scene()
        >>> ball = scene.add("ball", sk.Mesh.sphere(40, 64), material="water")
        >>> scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 200), column_step=(2, 0, 0), row_step=(0, 2, 0),
        ...                      pixels=(64, 64))
        >>> scene.beam = sk.Beam.mono(60, 1000)
        >>> scene.derivative([{"source": [1, 0, 0]}, {"density": {"ball": 0.01}}]).shape
        (2, 64, 64)
        """
        is_one = isinstance(direction, Mapping)
        directions: list[Mapping[str, Any]] = [direction] if isinstance(direction, Mapping) else list(direction)
        for one in directions:
            for name in one:
                if name not in NAMES:
                    raise ArgumentError(f"the direction has {name!r}; it is made of {', '.join(map(repr, NAMES))}")
        if not directions:
            raise ArgumentError("derivative() has a list of no directions; it needs one at least")
        with self._state.calls():
            found = _derivatives(self._state, directions, {"quantity": quantity, **options})
        return found[0] if is_one else found


def _pointer(array: NDArray[np.float64]) -> Any:
    return ffi.cast("double *", array.__array_interface__["data"][0])


def _vertex_arrays(state: State) -> list[NDArray[np.float64]]:
    return [np.zeros((len(part.mesh.vertices), 3)) for part in state.parts()]


def _gradient(state: State, weights: NDArray[np.float64], wrt: list[str], options: dict[str, Any]) -> dict[str, Any]:
    labels = [part.label for part in state.parts()]
    poses, source, detector = np.zeros((len(labels), 6)), np.zeros(3), np.zeros(6)
    densities = np.zeros(len(labels))
    vertices = _vertex_arrays(state) if "vertices" in wrt else []
    adjoint, wanted = struct("skg_adjoint"), struct("skg_gradient")
    adjoint.channels = weights.shape[0] if weights.ndim == 3 else 1
    adjoint.rows, adjoint.columns = weights.shape[-2:]
    adjoint.data = ffi.cast("void *", weights.__array_interface__["data"][0])
    keep = ffi.new("double *[]", [_pointer(one) for one in vertices])
    for name, array in (("poses", poses), ("source", source), ("detector", detector), ("density", densities)):
        if name in wrt:
            setattr(wanted, "densities" if name == "density" else name, _pointer(array))
    if vertices:
        wanted.vertices = keep
    coefficients = np.zeros((len(labels), 0))

    def start(plan: Any, frame: Any, job: Any) -> int:
        nonlocal coefficients
        wanted.nodes = integer("skg_plan_node_count", plan)
        coefficients = np.zeros((len(labels), wanted.nodes))
        if "mu" in wrt:
            wanted.attenuations = _pointer(coefficients)
        return int(lib.skg_plan_gradient_submit(plan, frame, adjoint, wanted, job))

    _run(state, options, start, "mu" in wrt, lambda: (poses, source, detector, densities, vertices, coefficients))
    found: dict[str, Any] = {"poses": dict(zip(labels, poses)), "source": source, "detector": detector,
                             "vertices": dict(zip(labels, vertices)),
                             "density": {label: float(x) for label, x in zip(labels, densities)},
                             "mu": dict(zip(labels, coefficients))}
    return {name: found[name] for name in wrt}


def _vector(value: Any, shape: tuple[int, ...], what: str) -> NDArray[np.float64]:
    array = np.ascontiguousarray(_arrays.numbers(value, what), dtype=np.float64)
    if array.shape != shape:
        raise ArgumentError(f"{what} has the shape {array.shape}; it is {shape}")
    return array


class _Direction:
    """A direction as C has it: fills `given`, and keeps the memory behind it."""

    def __init__(self, state: State, direction: Mapping[str, Any], given: Any) -> None:
        parts = state.parts()
        self._count, self._number, self._direction, self._given = len(parts), state.number, direction, given
        poses, vertices = np.zeros((len(parts), 6)), ffi.new("double *[]", len(parts))
        self._keep: list[Any] = [poses, vertices]
        for label, twist in direction.get("poses", {}).items():
            poses[state.number(label)] = _vector(twist, (6,), f"poses[{label!r}]")
        given.poses = _pointer(poses)
        for name, size in (("source", 3), ("detector", 6)):
            if direction.get(name) is not None:
                setattr(given, name, self._take(_vector(direction[name], (size,), name)))
        for label, moves in direction.get("vertices", {}).items():
            number = state.number(label)
            vertices[number] = self._take(_vector(moves, parts[number].mesh.vertices.shape, f"vertices[{label!r}]"))
        given.vertices = ffi.cast("double **", vertices)
        if "density" in direction:
            densities = np.zeros(len(parts))
            for label, change in direction["density"].items():
                densities[state.number(label)] = _arrays.real(change, f"density[{label!r}]")
            given.densities = self._take(densities)

    def _take(self, array: NDArray[np.float64]) -> Any:
        self._keep.append(array)
        return _pointer(array)

    def set_nodes(self, nodes: int) -> None:
        """Fills what depends on the energies of a plan."""
        self._given.nodes = nodes
        if "mu" not in self._direction:
            return
        coefficients = np.zeros((self._count, nodes))
        for label, change in self._direction["mu"].items():
            coefficients[self._number(label)] = _vector(change, (nodes,), f"mu[{label!r}]")
        self._given.attenuations = self._take(coefficients)


def _derivatives(state: State, directions: list[Mapping[str, Any]], options: dict[str, Any]) -> NDArray[np.float64]:
    given = struct("skg_direction", len(directions))
    filled = [_Direction(state, direction, given[k]) for k, direction in enumerate(directions)]
    bands = options.get("bands")
    shape = (() if bands is None else (len(_arrays.edges(bands)) - 1,)) + state.shape()
    found = np.empty((len(directions), *shape))
    output = struct("skg_output")
    output.type, output.data = choice("type", "float64", "the type"), _pointer(found)

    def start(plan: Any, frame: Any, job: Any) -> int:
        nodes = integer("skg_plan_node_count", plan)
        for one in filled:
            one.set_nodes(nodes)
        return int(lib.skg_plan_derivatives_submit(plan, frame, len(directions), given, output, ffi.NULL, job))

    _run(state, options, start, False, lambda: found)
    return found


def _run(state: State, options: dict[str, Any], start: Callable[[Any, Any, Any], int], has_nodes: bool,
         results: Callable[[], Any]) -> None:
    """Starts a job with the plan of the scene as it stands, and waits for it; a stale plan is made anew once.

    has_nodes: the first call may find that changed materials have other energies. results: the memory that the job fills.
    """
    batch = Batch(1, index=number_frames(state, 1, None, options), complete=state.completer())
    for again in (False, True):
        keep: list[Any] = []
        plan, frames = state.plan(options, None, again), batch.frames(0, 1, keep)
        job = state.device.begin((keep, results()))
        nodes = integer("skg_plan_node_count", plan)
        status = start(plan, frames, job)
        if has_nodes and status != OK and integer("skg_plan_node_count", plan) != nodes:
            status = start(plan, frames, job)
        if check(status) == OK and _finish(state, job) == OK:
            return
    raise SceneError(text(lib.skg_last_error()))


def _finish(state: State, job: Any) -> int:
    """Waits for a job; after an interrupt it is cancelled, and its memory stays until it is over."""
    try:
        wait(job)
    except BaseException:
        cancel(job)
        raise
    return check(state.device.end(job))
