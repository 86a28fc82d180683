"""Images as a function of PyTorch, which differentiates them by poses, vertices and source. PyTorch is needed when image() is called.

    image = skiagraph.torch.image(scene, poses={"femur": pose}, source=source, quantity="attenuation")
    (image - measured).square().sum().backward()
"""
from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._interface import ArgumentError

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["image"]


def image(scene: Scene, poses: Mapping[str, Any] | None = None, vertices: Mapping[str, Any] | None = None, source: Any = None,
          **options: Any) -> Any:
    """The image of a scene as a tensor [row, column] of the CPU, of doubles with precision="double".

    poses: {label: [4, 4]}, vertices: {label: [n, 3]} in mm in the mesh's axes, source: [3]; tensors, which become those of the
    scene. The derivative by a pose is that by its twelve entries, so that any parameters of a rigid motion may stand behind
    it. options: as of scene.image().
    """
    moved, bent = dict(poses or {}), dict(vertices or {})
    values = [*moved.values(), *bent.values(), *([] if source is None else [source])]
    return _function().apply(scene, list(moved), list(bent), source is not None, options, *values)


@functools.cache
def _function() -> Any:
    """The torch.autograd.Function; made once."""
    torch = importlib.import_module("torch")

    def forward(ctx: Any, scene: Scene, moved: list[str], bent: list[str], from_source: bool, options: dict[str, Any],
                *values: Any) -> Any:
        ctx.given = (scene, moved, bent, from_source, options)
        ctx.save_for_backward(*values)
        _set(scene, moved, bent, from_source, values)
        return torch.from_numpy(scene.image(**options))

    def backward(ctx: Any, weights: Any) -> Any:
        scene, moved, bent, from_source, options = ctx.given
        values = ctx.saved_tensors
        _set(scene, moved, bent, from_source, values)
        wrt = ["vertices"] * bool(moved or bent) + ["source"] * from_source
        found = scene.gradient(weights.detach().cpu().numpy(), wrt=wrt, **options)
        arrays = [_affine(scene, label, found["vertices"][label]) for label in moved]
        arrays += [found["vertices"][label] for label in bent]
        arrays += [found["source"]] if from_source else []
        return (None,) * 5 + tuple(torch.from_numpy(array).to(value) for array, value in zip(arrays, values))

    return type("SkiagraphImage", (torch.autograd.Function,),
                {"forward": staticmethod(forward), "backward": staticmethod(backward)})


def _numpy(value: Any, shape: tuple[int, ...], what: str) -> NDArray[np.float64]:
    array = np.ascontiguousarray(value.detach().cpu().numpy(), dtype=np.float64)
    if array.shape != shape:
        raise ArgumentError(f"{what} has the shape {array.shape}; it is {shape}")
    return array


def _affine(scene: Scene, label: str, by_vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """From derivatives by vertices in the mesh's axes to that by the part's 4 x 4 pose."""
    part = scene[label]
    in_world = np.linalg.solve(part.pose[:3, :3].T, by_vertices.T)
    places = np.hstack([part.mesh.vertices, np.ones((len(by_vertices), 1))])
    return np.vstack([in_world @ places, np.zeros((1, 4))])


def _set(scene: Scene, moved: list[str], bent: list[str], from_source: bool, values: Any) -> None:
    """Gives the scene what the tensors hold."""
    for label, value in zip(moved, values):
        scene[label].pose = _numpy(value, (4, 4), f"poses[{label!r}]")
    for label, value in zip(bent, values[len(moved):]):
        mesh = scene[label].mesh
        mesh.vertices = _numpy(value, mesh.vertices.shape, f"vertices[{label!r}]")
    if from_source:
        view = scene.view
        view.source = _numpy(values[-1], (3,), "source")
        scene.view = view
