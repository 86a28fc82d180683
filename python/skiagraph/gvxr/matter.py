"""What meshes are made of."""
from __future__ import annotations

from typing import Any

import numpy as np

from .._interface import ArgumentError
from .._library import string
from ..material import Material, element_number
from .state import DENSITIES, ENERGIES, unit, world

__all__ = [
    "getDensity", "getDensityFromElement", "getDensityFromHU", "getElementAtomicNumber", "getElementSymbol",
    "getLinearAttenuationCoefficient", "getMassAttenuationCoefficient", "getMaterialLabel", "getMuFromHU",
    "setCompound", "setDensity", "setElement", "setHU", "setHounsfieldUnit", "setHounsfieldValue",
    "setLinearAttenuationCoefficient", "setMixture", "setMu",
]


def _fill(label: str, material: Material, description: str) -> None:
    node = world.node(label)
    node.material, node.description = material, description


def setHU(aLabel: str, HU: float) -> None:
    _fill(aLabel, Material.hu(HU), f"HU: {HU}")


setHounsfieldUnit = setHounsfieldValue = setHU


def setElement(aLabel: str, aName: str | int) -> None:
    symbol = string("skg_element_symbol_get", element_number(aName))
    _fill(aLabel, Material(symbol), f"Element: {symbol}")


def setMixture(aLabel: str, aSymbolSet: Any, aWeightSet: Any = None) -> None:
    """Elements with fractions by mass, or one text such as "Ti90Al6V4", by mass too. The density comes after."""
    if isinstance(aSymbolSet, str):
        _fill(aLabel, Material(aSymbolSet, by="mass"), f"Mixture: {aSymbolSet}")
        return
    weights = np.asarray(aWeightSet, dtype=float)
    fractions = dict(zip([str(symbol) for symbol in aSymbolSet], weights.tolist()))
    _fill(aLabel, Material.mixture(fractions, 0, aLabel), "Mixture: " + " ".join(map(str, aSymbolSet)))


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
    return world.material(aLabel).coefficients(anEnergy * unit(aUnitOfEnergy, ENERGIES))["total"]


def getMuFromHU(HU: float, anEnergy: float, aUnitOfEnergy: str) -> float:
    return float(Material.hu(HU).attenuation(anEnergy * unit(aUnitOfEnergy, ENERGIES)))


def getDensityFromHU(HU: float) -> float:
    return Material.hu(HU).density


def getDensityFromElement(anElement: str | int) -> float:
    return Material(string("skg_element_symbol_get", element_number(anElement))).density


def getElementSymbol(anElement: str | int) -> str:
    return string("skg_element_symbol_get", element_number(anElement))


def getElementAtomicNumber(anElement: str | int) -> int:
    return element_number(anElement)
