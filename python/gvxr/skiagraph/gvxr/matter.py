"""Materials, densities and coefficients of the meshes."""
from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._device import warn
from .._interface import ArgumentError, SceneError
from ..material import Material, element_name, element_number, element_symbol
from .densities import element
from .state import DENSITIES, ENERGIES, unit, world

__all__ = [
    "convertHU2mu", "getCompound", "getDensity", "getDensityFromElement", "getDensityFromHU", "getEffectiveAtomicNumber",
    "getEffectiveMolarMass", "getEffectiveZNumber", "getElementAtomicNumber", "getElementMolarMass", "getElementName",
    "getElementSymbol", "getLinearAttenuationCoefficient", "getMassAttenuationCoefficient", "getMassAttenuationFromCompound",
    "getMassAttenuationFromElement", "getMassAttenuationFromHU", "getMassAttenuationFromMixture", "getMaterialLabel",
    "getMixtureElementSet", "getMixtureWeightSet", "getMuFromHU", "setCompound", "setDensity", "setElement", "setHU",
    "setHounsfieldUnit", "setHounsfieldValue", "setLinearAttenuationCoefficient", "setMixture", "setMu",
]


#: g/mol
_HYDROGEN = 1.008
#: The exponent of Mayneord's effective atomic number.
_MAYNEORD = 2.94
#: An element of a mixture that is given as a text, and its part.
_MIXTURE = re.compile(r"([A-Z][a-z]?)(\d*\.?\d*)")


def _fill(label: str, material: Material, description: str) -> None:
    node = world.node(label)
    node.material, node.description = material, description


def setHU(aLabel: str, HU: float) -> None:
    _fill(aLabel, Material.hu(HU), f"HU: {HU}")


setHounsfieldUnit = setHounsfieldValue = setHU


def _element(name: str | int) -> Material:
    return element(element_symbol(name), element_number(name))


def setElement(aLabel: str, aName: str | int) -> None:
    """At the density that gVXR takes, until setDensity."""
    _fill(aLabel, _element(aName), f"Element: {aName if isinstance(aName, str) else element_name(aName)}")


def setMixture(aLabel: str, aSymbolSet: Any, aWeightSet: Any = None) -> None:
    """Elements with fractions by mass, or one text such as "Ti90Al6V4", by mass too. The density comes after.

    Fractions that do not sum to 1 are scaled, with a warning.
    """
    if isinstance(aSymbolSet, str):
        words = aSymbolSet if "(" in aSymbolSet else _scaled(aSymbolSet, aLabel)
        _fill(aLabel, Material(words, by="mass"), f"Mixture: {aSymbolSet}")
        return
    weights = np.asarray(aWeightSet, dtype=float)
    if weights.ndim != 1 or len(weights) != len(aSymbolSet):
        raise ArgumentError(f"{aLabel}: {len(aSymbolSet)} elements and {weights.size} weights; give as many")
    total = float(weights.sum())
    if not total > 0:
        raise ArgumentError(f"{aLabel}: the weights sum to {total:g}; give fractions by mass")
    if abs(total - 1) > 1e-6:
        warn(f"{aLabel}: the weights of the mixture sum to {total:g}; they are scaled to 1")
    fractions: dict[str, float] = {}
    for element, weight in zip(aSymbolSet, (weights / total).tolist()):
        symbol = element_symbol(element)
        fractions[symbol] = fractions.get(symbol, 0.0) + weight
    label = "".join(f"{symbol}{100 * fractions[symbol]:.10g}" for symbol in sorted(fractions, key=element_number))
    _fill(aLabel, Material.mixture(fractions, 0, aLabel), f"Mixture: {label}")


def _scaled(words: str, label: str) -> str:
    """A mixture as a text, in parts of 100."""
    parts = _MIXTURE.findall(words)
    if not parts or "".join(symbol + number for symbol, number in parts) != words:
        return words  # a name, or one that the library refuses with the reason
    total = sum(float(number or 1) for _, number in parts)
    if abs(total - 100) <= 0.5:  # rounded to whole parts
        return words
    warn(f"{label}: the parts of the mixture {words!r} sum to {total:g} instead of 100; they are scaled")
    return "".join(f"{symbol}{float(number or 1) * 100 / total:.10g}" for symbol, number in parts)


def setCompound(aLabel: str, aCompound: str) -> None:
    """A formula by atoms. The density comes after."""
    _fill(aLabel, Material.formula(aCompound), f"Compound: {aCompound}")


def setDensity(aLabel: str, aDensity: float, aUnit: str) -> None:
    node = world.node(aLabel)
    node.material = world.material(aLabel).at_density(aDensity * unit(aUnit, DENSITIES))


def setMu(aLabel: str, aCoefficient: float, aUnit: str) -> None:
    if aUnit != "cm-1":
        raise ArgumentError(f"the unit {aUnit!r} is unknown; there is 'cm-1'")
    _fill(aLabel, Material.mu(aCoefficient, aLabel), f"mu: {aCoefficient} cm-1")


setLinearAttenuationCoefficient = setMu


def getMaterialLabel(aLabel: str) -> str:
    return world.node(aLabel).description


def getDensity(aLabel: str) -> float:
    """g/cm3; 0 where it has no meaning."""
    return world.material(aLabel).density


def getLinearAttenuationCoefficient(aLabel: str, anEnergy: float, aUnitOfEnergy: str) -> float:
    return float(world.material(aLabel).attenuation(anEnergy * unit(aUnitOfEnergy, ENERGIES)))


def getMassAttenuationCoefficient(aLabel: str, anEnergy: float, aUnitOfEnergy: str) -> float:
    return _mass(world.material(aLabel), anEnergy, aUnitOfEnergy)


def getMuFromHU(HU: float, anEnergy: float, aUnitOfEnergy: str) -> float:
    return float(Material.hu(HU).attenuation(anEnergy * unit(aUnitOfEnergy, ENERGIES)))


def getDensityFromHU(HU: float) -> float:
    return Material.hu(HU).density


def getDensityFromElement(anElement: str | int) -> float:
    """g/cm3, of gVXR's table."""
    return _element(anElement).density


def getElementSymbol(Z: str | int) -> str:
    return element_symbol(Z)


def getElementName(anElement: str | int) -> str:
    """Name of the element, such as "Iron"."""
    return element_name(anElement)


def getElementMolarMass(anElement: str | int) -> float:
    """g/mol, from the atomic weights that the formulas of the library are read with."""
    symbol = element_symbol(anElement)
    if symbol == "H":
        return _HYDROGEN
    fractions = Material.formula(symbol + "H").elements
    return _HYDROGEN * fractions[symbol] / fractions["H"]


def getElementAtomicNumber(anElement: str | int) -> int:
    return element_number(anElement)


def getMassAttenuationFromElement(anElement: str | int, anEnergy: float, aUnitOfEnergy: str) -> float:
    return _mass(Material(element_symbol(anElement)), anEnergy, aUnitOfEnergy)


def getMassAttenuationFromCompound(aCompound: str, anEnergy: float, aUnitOfEnergy: str) -> float:
    return _mass(Material.formula(aCompound), anEnergy, aUnitOfEnergy)


def getMassAttenuationFromMixture(aMixture: str, anEnergy: float, aUnitOfEnergy: str) -> float:
    return _mass(Material(_scaled(aMixture, aMixture), by="mass"), anEnergy, aUnitOfEnergy)


def getMassAttenuationFromHU(HU: float, anEnergy: float, aUnitOfEnergy: str) -> float:
    return _mass(Material.hu(HU), anEnergy, aUnitOfEnergy)


def _mass(material: Material, energy: float, aUnitOfEnergy: str) -> float:
    return material.coefficients(energy * unit(aUnitOfEnergy, ENERGIES))["total"]


def convertHU2mu(anImage: Any, anEnergy: float, aUnitOfEnergy: str) -> NDArray[np.float32]:
    """1/cm of each Hounsfield number of an array."""
    numbers, inverse = np.unique(np.asarray(anImage, dtype=float), return_inverse=True)
    values = np.array([getMuFromHU(hu, anEnergy, aUnitOfEnergy) for hu in numbers], dtype=np.float32)
    return values[inverse].reshape(np.shape(anImage))


def getCompound(aLabel: str) -> str:
    """The formula; "" if the mesh is not of a compound."""
    kind, _, formula = world.node(aLabel).description.partition(": ")
    return formula if kind == "Compound" else ""


def getMixtureElementSet(aLabel: str) -> tuple[int, ...]:
    """Atomic numbers, rising."""
    return tuple(z for z, _ in _composition(aLabel))


def getMixtureWeightSet(aLabel: str) -> tuple[float, ...]:
    """Fractions by mass, in the order of getMixtureElementSet."""
    return tuple(weight for _, weight in _composition(aLabel))


def _composition(label: str) -> list[tuple[int, float]]:
    if world.node(label).description.partition(":")[0] not in ("Mixture", "Compound"):
        return []
    return sorted((element_number(symbol), weight) for symbol, weight in world.material(label).elements.items())


def getEffectiveAtomicNumber(aLabel: str) -> float:
    """Mayneord's: the mean of Z^2.94 over the electrons, and of this the root."""
    elements = [(element_number(symbol), w / getElementMolarMass(symbol)) for symbol, w in
                world.material(aLabel).elements.items()]
    if not elements:
        raise SceneError(f"{aLabel}: the elements of its material are unknown; call setElement, setMixture or setCompound")
    z, atoms = np.array(elements).T
    return float(np.average(z ** _MAYNEORD, weights=z * atoms) ** (1 / _MAYNEORD))


getEffectiveZNumber = getEffectiveAtomicNumber


def getEffectiveMolarMass(aLabel: str) -> float:
    """g/mol: of a compound that of its formula, else the mean of the elements by mass."""
    elements = world.material(aLabel).elements
    if not elements:
        raise SceneError(f"{aLabel}: the elements of its material are unknown; call setElement, setMixture or setCompound")
    if getCompound(aLabel):  # from what one more atom of hydrogen does to its fraction
        before, after = elements.get("H", 0.0), Material.formula(getCompound(aLabel) + "H").elements["H"]
        return _HYDROGEN * (1 - after) / (after - before)
    return sum(weight * getElementMolarMass(symbol) for symbol, weight in elements.items())
