"""Matter of a scene that breathe() posed: the density of its lungs, and contrast medium as far as it fills a part. Private.

Frames carry both as overrides of the library. Whatever takes no frame, such as a scene file, needs materials instead.
"""
from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ._interface import SceneError
from ._library import call, ffi, struct
from .material import Material

if TYPE_CHECKING:
    from ._state import State

#: keV at which a coefficient that is the same at all energies is recognized.
_KEV = (10.0, 37.0, 60.0, 150.0)


def changes(state: State) -> dict[int, tuple[float, float]]:
    """(density over that of the material, fill fraction) of the parts of which one of both is not 1, by their numbers."""
    if state.breath is None or state.motion == ffi.NULL:
        return {}
    frame = struct("skg_frame")
    call("skg_motion_fill", state.motion, frame)
    found = {int(frame.override_parts[k]): (float(frame.density_ratios[k]), float(frame.fill_fractions[k]))
             for k in range(frame.override_count)}
    return {number: pair for number, pair in found.items() if pair != (1, 1)}


def matters(state: State) -> dict[int, Material]:
    """Materials that stand for the matter of these parts."""
    found, parts = changes(state), state.parts()

    def own(number: int) -> Material:
        ratio, material = found.get(number, (1.0, 1.0))[0], parts[number].material
        return material if ratio == 1 else _thinned(parts[number].label, material, ratio)

    made = {}
    for number, (_ratio, fill) in found.items():
        inside = parts[number].inside
        around = None if inside is None else own(state.number(inside))
        made[number] = own(number) if fill == 1 else _mixed(parts[number].label, own(number), fill, around)
    return made


def _thinned(label: str, material: Material, ratio: float) -> Material:
    if material.density > 0:
        return material.at_density(ratio * material.density)
    first, *others = material.attenuation(_KEV).tolist()
    if others == [first] * len(others):
        return Material.mu(ratio * first, material.name)
    raise SceneError(f"{label}: its density is {ratio:.4g} times that at rest, but its material, {material.name}, is a table of coefficients "
                     "without a density; give it a composition, or the key Breathing \"LungDensity\": false")


def _mixed(label: str, own: Material, fill: float, around: Material | None) -> Material:
    """The material of a part that fills this share of its volume, with that of the part around it."""
    if around is None or not own.elements or not around.elements:
        raise SceneError(f"{label}: {own.name} fills {100 * fill:.4g} % of it at this time, which makes a mixture only if it and the part "
                         "that it lies in have compositions; pose the scene at a time at which it is full")
    masses: dict[str, float] = {}
    for material, share in ((own, fill), (around, 1 - fill)):
        for element, fraction in material.elements.items():
            masses[element] = masses.get(element, 0) + share * material.density * fraction
    density = sum(masses.values())
    return Material.mixture({element: mass / density for element, mass in masses.items() if mass > 0}, density, own.name)


@contextlib.contextmanager
def weighed(state: State) -> Iterator[None]:
    """Gives these parts their matter as materials for the time of calls that take no frame."""
    made, parts = matters(state), state.parts()
    before = {number: parts[number].material for number in made}

    def assign(materials: dict[int, Material]) -> None:
        for number, material in materials.items():
            call("skg_scene_part_material_set", state.handle, number, material._handle)

    try:
        assign(made)
        yield
    finally:
        assign(before)
