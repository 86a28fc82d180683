"""Materials: how strongly matter attenuates photons."""
from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays
from ._interface import ArgumentError
from ._library import call, doubles, encode, ffi, filled, integer, make, number, owned, retained, string


class Material:
    """Matter: a composition with a density, or a linear attenuation coefficient.

    name: an element, a name of the tables, a chemical formula, "HU:52" or "mu:0.2", as the command takes it.
    by: "atoms" or "mass", how the numbers of a formula count. density: g/cm3, instead of that of the tables.

    >>> Material("water").density
    1.0
    >>> Material("Ti90Al6V4", by="mass", density=4.43)
    <Material "Ti90Al6V4": 4.43 g/cm3>
    >>> round(float(Material("water").attenuation(60)), 4)
    0.2059
    """

    _recipe: tuple[Any, ...] | None = None

    def __init__(self, name: str, by: str = "atoms", *, density: float | None = None) -> None:
        if by not in ("atoms", "mass"):
            raise ArgumentError(f"by is {by!r}; give 'atoms' or 'mass'")
        words = f"weight:{name}" if by == "mass" else name
        self._make(("skg_material_create_named", encode(words, "name")), density)

    def _make(self, recipe: tuple[Any, ...], density: float | None = None) -> None:
        """Calls the library; a recipe is a function with its arguments, in Python's own types."""
        keep: list[Any] = []
        arguments = [_argument(value, keep) for value in recipe[1:]]
        self._handle = owned("skg_material", make(recipe[0], "skg_material", *arguments))
        if density is not None:
            dense = make("skg_material_create_at_density", "skg_material", self._handle, _arrays.real(density, "density"))
            self._handle = owned("skg_material", dense)
        self._recipe = (recipe, density)

    @classmethod
    def _from(cls, *recipe: Any, density: float | None = None) -> Material:
        made = cls.__new__(cls)
        made._make(recipe, density)
        return made

    @classmethod
    def _borrowed(cls, handle: Any) -> Material:
        made = cls.__new__(cls)
        made._handle = retained("skg_material", handle)
        return made

    @classmethod
    def mu(cls, per_cm: float, name: str = "mu") -> Material:
        """One linear attenuation coefficient, in 1/cm, at every energy.

        >>> float(Material.mu(0.2).attenuation(80))
        0.2
        """
        return cls._from("skg_material_create_mu", encode(name, "name"), _arrays.real(per_cm, "per_cm"))

    @classmethod
    def hu(cls, value: float) -> Material:
        """Human tissue by its Hounsfield number."""
        return cls._from("skg_material_create_hounsfield", _arrays.real(value, "value"))

    @classmethod
    def formula(cls, formula: str, density: float = 0) -> Material:
        """A compound by its chemical formula by atoms; density in g/cm3."""
        return cls._from("skg_material_create_formula", encode(formula, "formula"), _arrays.real(density, "density"))

    @classmethod
    def mixture(cls, fractions: Mapping[str, float] | Mapping[int, float], density: float, name: str = "mixture") -> Material:
        """Elements by symbol, name or atomic number, with their fractions by mass; density in g/cm3.

        >>> Material.mixture({"H": 0.112, "O": 0.888}, 1.0).elements
        {'H': 0.112, 'O': 0.888}
        """
        numbers = [element_number(element) for element in fractions]
        return cls._from("skg_material_create_mixture", encode(name, "name"), len(numbers), ("int32_t[]", numbers),
                         ("double[]", [_arrays.real(f, f"fraction of {e}") for e, f in fractions.items()]),
                         _arrays.real(density, "density"))

    @classmethod
    def table(cls, kev: Any, per_cm: Any, name: str = "table") -> Material:
        """Linear attenuation coefficients in 1/cm at rising energies in keV."""
        energies, values = np.atleast_1d(_arrays.numbers(kev, "kev")), np.atleast_1d(_arrays.numbers(per_cm, "per_cm"))
        if energies.shape != values.shape or energies.ndim != 1:
            raise ArgumentError(f"kev has the shape {energies.shape} and per_cm {values.shape}; give two lists alike")
        return cls._from("skg_material_create_table", encode(name, "name"), len(energies),
                         ("double[]", energies.astype(float).tolist()), ("double[]", values.astype(float).tolist()))

    @classmethod
    def load(cls, path: str | os.PathLike[str], unit: str = "keV") -> Material:
        """A text file with two columns, energy in this unit and linear attenuation coefficient in 1/cm."""
        made = cls.__new__(cls)
        made._handle = owned("skg_material", make("skg_material_load_table", "skg_material", encode(path, "path"),
                                                  encode(unit, "unit")))
        return made

    def at_density(self, density: float) -> Material:
        """This material with another density, g/cm3."""
        made = Material.__new__(Material)
        made._handle = owned("skg_material", make("skg_material_create_at_density", "skg_material", self._handle,
                                                  _arrays.real(density, "density")))
        if self._recipe:
            made._recipe = (self._recipe[0], density)
        return made

    def with_form_factor(self, per_angstrom: Any, squares: Any) -> Material:
        """This material with the form factors of its molecules: F^2, in any unit, at rising momentum transfers sin(theta/2) / wavelength
        in 1/Angstrom, up to 0.4 at least. They change where Rayleigh scattering sends photons."""
        momenta, values = np.atleast_1d(per_angstrom), np.atleast_1d(squares)
        if momenta.shape != values.shape or momenta.ndim != 1:
            raise ArgumentError(f"per_angstrom has the shape {momenta.shape} and squares {values.shape}; give two lists alike")
        keep: list[Any] = []
        made = Material.__new__(Material)
        made._handle = owned("skg_material", make("skg_material_create_form_factor", "skg_material", self._handle, len(momenta),
                                                  doubles(momenta, "per_angstrom", keep), doubles(values, "squares", keep)))
        made._recipe = self._recipe
        return made

    @property
    def form_factor(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Of its molecules: momentum transfers in 1/Angstrom, and F^2 of 1 g; None if its atoms are free."""
        count = ffi.new("int64_t *")
        call("skg_material_form_factor_get", self._handle, 0, ffi.NULL, ffi.NULL, count)
        if not count[0]:
            return None
        rows = np.empty((2, count[0]))
        x, squares = (ffi.cast("double *", ffi.from_buffer(row)) for row in rows)
        call("skg_material_form_factor_get", self._handle, count[0], x, squares, count)
        return _arrays.fixed(rows[0]), _arrays.fixed(rows[1])

    @property
    def name(self) -> str:
        return string("skg_material_name_get", self._handle)

    @property
    def note(self) -> str:
        """Remarks about the material: the source of its composition, or that fractions were scaled."""
        return string("skg_material_note_get", self._handle)

    @property
    def density(self) -> float:
        """g/cm3; 0 if it is unknown or has no meaning."""
        return number("skg_material_density_get", self._handle)

    @property
    def elements(self) -> dict[str, float]:
        """Fractions by mass, by the symbols of the elements; empty if they are unknown."""
        found = {}
        z, fraction = ffi.new("int32_t *"), ffi.new("double *")
        for i in range(integer("skg_material_element_count", self._handle)):
            call("skg_material_element_get", self._handle, i, z, fraction)
            found[string("skg_element_symbol_get", z[0])] = float(fraction[0])
        return found

    @property
    def edges(self) -> NDArray[np.float64]:
        """Energies in keV at which the attenuation jumps."""
        count = ffi.new("int64_t *")
        call("skg_material_edges_get", self._handle, 0, ffi.NULL, count)
        made = np.empty(count[0])
        if made.size:
            call("skg_material_edges_get", self._handle, made.size, ffi.cast("double *", ffi.from_buffer(made)), count)
        return _arrays.fixed(made)

    def attenuation(self, kev: Any) -> NDArray[np.float64]:
        """The linear attenuation coefficient in 1/cm, at one energy in keV or at an array of them."""
        return self._at(kev, "skg_material_attenuation_get")

    def hounsfield(self, kev: Any) -> NDArray[np.float64]:
        """The Hounsfield number at one energy in keV, or at an array of them."""
        return self._at(kev, "skg_material_hounsfield_get")

    def _at(self, kev: Any, name: str) -> NDArray[np.float64]:
        energies = _arrays.numbers(kev, "kev")
        return np.array([number(name, self._handle, float(e)) for e in energies.ravel()]).reshape(energies.shape)

    def coefficients(self, kev: float) -> dict[str, float]:
        """Mass attenuation coefficients in cm2/g by process, and their total."""
        return filled("skg_coefficients", "skg_material_coefficients_get", self._handle, _arrays.real(kev, "kev"))

    def __repr__(self) -> str:
        density = self.density
        return f'<Material "{self.name}"' + (f": {density:g} g/cm3>" if density else ">")

    def __reduce__(self) -> tuple[Any, ...]:
        recipe = self._recipe
        if recipe is None and self.elements:
            made = Material.mixture(self.elements, self.density, self.name)
            recipe = made._recipe
        if recipe is None:
            raise ArgumentError(f"{self.name} was read from a file; pickle the scene that it belongs to, or make it by "
                                "Material.table")
        return _remake, (*recipe, self.form_factor)


def _remake(recipe: tuple[Any, ...], density: float | None,
            form: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None) -> Material:
    made = Material._from(*recipe, density=density)
    return made.with_form_factor(*form) if form else made


def _argument(value: Any, keep: list[Any]) -> Any:
    if not isinstance(value, tuple):
        return value
    kind, items = value
    if kind == "double[]":
        return doubles(items, "numbers", keep)
    keep.append(ffi.new(kind, items))
    return keep[-1]


def element_number(element: str | int) -> int:
    """The atomic number of an element by symbol, name or number.

    >>> element_number("Fe")
    26
    """
    z = ffi.new("int32_t *")
    call("skg_element_number_get", encode(str(element), "element"), z)
    return int(z[0])


def element_symbol(element: str | int) -> str:
    """The symbol of an element by symbol, name or number.

    >>> element_symbol(26)
    'Fe'
    """
    return string("skg_element_symbol_get", element_number(element))


def element_name(element: str | int) -> str:
    """The name of an element by symbol, name or number.

    >>> element_name("Al")
    'Aluminium'
    """
    return string("skg_element_names_get", element_number(element)).split(";")[0]


def as_material(value: Any) -> Material:
    """A material, or the one of this name."""
    if isinstance(value, Material):
        return value
    if isinstance(value, str):
        return Material(value)
    raise ArgumentError(f"material is a {type(value).__name__}; give a Material or a name")


def materials() -> dict[str, float]:
    """The materials of the tables: their names, and their densities in g/cm3.

    >>> len(materials()) > 50
    True
    """
    found = {}
    name, density = ffi.new("const char **"), ffi.new("double *")
    for i in range(integer("skg_material_tabled_count")):
        call("skg_material_tabled_get", i, name, density)
        found[ffi.string(name[0]).decode()] = float(density[0])
    return found
