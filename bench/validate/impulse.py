"""Angles of Compton scattering: the project's, Klein and Nishina's cross section times the scattering function, beside those of the
impulse approximation, shell by shell, which the reference's transport samples.

I. Kawrakow and others, The EGSnrc code system, NRC report PIRS-701, section 2.2.2; the shells' profile with one parameter: D. Brusa and
others, Fast sampling algorithm for the simulation of photon Compton scattering, Nuclear Instruments and Methods A 379 (1996) 167-175."""
from __future__ import annotations

from typing import Any

import numpy

ELECTRON_KEV, ANGSTROM_KEV, ATOMIC = 510.99895, 12.398420, 1 / 137.035999
WATER = ((1, 2.0), (8, 1.0))  # atomic number, atoms
ANGLES = numpy.concatenate([numpy.linspace(0.25, 30, 240), numpy.linspace(30.5, 180, 300)])  # degrees
PER_CM, COMPTON_PER_CM = 0.20554967, 0.176706  # of the reference at 60 keV


def _shells(xraylib: Any, z: int) -> list[tuple[float, float, float]]:
    """Electrons, binding energy in keV, profile at 0 in atomic units of each shell."""
    found = []
    for shell in range(31):
        try:
            found.append((xraylib.ElectronConfig(z, shell), xraylib.EdgeEnergy(z, shell), xraylib.ComptonProfile_Partial(z, shell, 0.0)))
        except ValueError:
            continue
    return found


def _probabilities(kev: float, cosine: Any, binding: float, profile: float) -> tuple[Any, Any]:
    """Probability that an electron of a shell scatters to an angle, over a free one at rest; and the mean energy that is left, over the
    free one's."""
    free = 1 / (1 + kev / ELECTRON_KEV * (1 - cosine))
    transfer = numpy.sqrt(1 + free * free - 2 * free * cosine)
    slope = numpy.maximum(transfer * (1 + free * (free - cosine) / transfer ** 2), 0)
    product = kev * (kev - binding) * (1 - cosine)
    most = (product - ELECTRON_KEV * binding) / numpy.sqrt(2 * product + binding ** 2) / ELECTRON_KEV
    momenta = numpy.concatenate([-numpy.geomspace(0.9, 1e-5, 500), numpy.geomspace(1e-5, 0.9, 500)])  # along the transfer, m c
    size = 2 * profile * numpy.abs(momenta) / ATOMIC
    density = profile / ATOMIC * (1 + size) * numpy.exp(0.5 - 0.5 * (1 + size) ** 2)
    factor = 1 + slope[:, None] * numpy.clip(momenta, -0.15, 0.15)
    # A momentum p moves the line by p times the transfer, to first order.
    energy = 1 + momenta * transfer[:, None] + momenta ** 2 * (free ** 2 - cosine)[:, None]
    weight = numpy.gradient(momenta) * density * factor * (momenta < most[:, None])
    chance = weight.sum(axis=1)
    return chance, (weight * energy).sum(axis=1) / numpy.maximum(chance, 1e-30)


def distributions(xraylib: Any, kev: float) -> tuple[Any, Any, Any]:
    """Of water at ANGLES: photons per sr by the scattering function; by the impulse approximation; mean energy of the latter, over that
    of free electrons. Both distributions have the integral 1."""
    radians = numpy.radians(ANGLES)
    cosine = numpy.cos(radians)
    free = 1 / (1 + kev / ELECTRON_KEV * (1 - cosine))
    klein = free ** 2 * (free + 1 / free - 1 + cosine ** 2) / 2
    functions, impulse, energy = numpy.zeros_like(cosine), numpy.zeros_like(cosine), numpy.zeros_like(cosine)
    for z, atoms in WATER:
        functions += atoms * numpy.array([xraylib.SF_Compt(z, float(kev / ANGSTROM_KEV * numpy.sin(angle / 2))) for angle in radians])
        for electrons, binding, profile in _shells(xraylib, z):
            chance, left = _probabilities(kev, cosine, binding, profile)
            impulse += atoms * electrons * chance
            energy += atoms * electrons * chance * left
    sphere = numpy.gradient(radians) * 2 * numpy.pi * numpy.sin(radians)
    return (klein * functions / (klein * functions * sphere).sum(), klein * impulse / (klein * impulse * sphere).sum(), energy / impulse)


def behind_water(xraylib: Any, kev: float = 60.0, points: int = 1 << 17) -> tuple[float, float]:
    """Energy of photons of one Compton scattering over the primary, whole detector of w1, by both distributions."""
    root = (1 + 5 ** 0.5) / 2
    for _ in range(60):  # the root of x^6 = x + 1, for a sequence of points that fill five dimensions evenly (M. Roberts 2018)
        root = (1 + root) ** (1 / 6)
    u = (0.5 + numpy.arange(1, points + 1)[:, None] * root ** -numpy.arange(1.0, 6.0)) % 1
    half, low, high = 15.0, numpy.array([-10.0, -15, -15]), numpy.array([10.0, 15, 15])
    way = numpy.column_stack([numpy.full(points, 120.0), (2 * u[:, 0] - 1) * half, (2 * u[:, 1] - 1) * half])
    distance = numpy.linalg.norm(way, axis=1)
    way /= distance[:, None]
    photons, path = 120.0 / distance ** 3, 20 / way[:, 0]
    at = numpy.array([-90.0, 0, 0]) + way * (80 / way[:, 0] + u[:, 2] * path)[:, None]
    out = numpy.column_stack([30 - at[:, 0], (2 * u[:, 3] - 1) * half - at[:, 1], (2 * u[:, 4] - 1) * half - at[:, 2]])
    far = numpy.linalg.norm(out, axis=1)
    out /= far[:, None]
    with numpy.errstate(divide="ignore"):
        leave = numpy.where(out > 0, (high - at) / out, (low - at) / out).min(axis=1)
    cosine = (way * out).sum(axis=1)
    left = 1 / (1 + kev / ELECTRON_KEV * (1 - cosine))
    energies = numpy.linspace(40, 60, 101)
    table = numpy.array([xraylib.CS_Total_CP("H2O", float(e)) for e in energies])
    attenuation = numpy.interp(kev * left, energies, table) * PER_CM / table[-1]
    weight = photons * path * numpy.exp(-PER_CM * u[:, 2] * path - attenuation * leave) * out[:, 0] / far ** 2 * (2 * half) ** 2
    weight *= COMPTON_PER_CM * left / (photons * numpy.exp(-PER_CM * path)).sum()
    angle = numpy.degrees(numpy.arccos(numpy.clip(cosine, -1, 1)))
    functions, impulse, energy = distributions(xraylib, kev)
    return (float((weight * numpy.interp(angle, ANGLES, functions)).sum()), float((weight * numpy.interp(angle, ANGLES, impulse * energy)).sum()))
