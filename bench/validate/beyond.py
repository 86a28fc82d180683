#!/usr/bin/env python3
"""How spectra of tungsten change from 300 to 400 kV beside xpecgen, and the factors that would make them follow (lib/beam/calibration.c).

usage: beyond.py; Python has skiagraph, numpy, scipy and xpecgen (1.3.1 was used: G. Hernandez and F. Fernandez, Med. Phys. 43 (2016) 4655,
whose electrons follow simulations by FLUKA). SpekPy, to which the tube is calibrated, ends at 300 kV; there the two differ, so that only the
change from 300 kV is taken. Factors are exp((e0 + e1 x + e2 x^2 + e3 x^3) ln(kV / 300)) with x = energy / tube voltage. Those printed come
on top of the factors in use: near 0 where these have been fitted."""
import warnings

import numpy as np
import scipy.optimize
import skiagraph
import xpecgen.xpecgen

VOLTAGES, ANGLES, MODELS = (300, 325, 350, 375, 400), (12, 20), ("Ebel", "Birch")
FILTERS = ({"Al": 2.5}, {"Al": 2.5, "Cu": 0.5}, {"Al": 2.5, "Cu": 2}, {"Al": 2.5, "Cu": 8})
SHARES = np.linspace(0.04, 0.995, 150)
K_LINES = (54, 72)  # keV, with a bin on each side


def theirs(kvp, angle):
    """Energies and photons of 1 keV, the continuum alone, and with the lines."""
    made = xpecgen.xpecgen.calculate_spectrum(kvp, angle, 5, 100, epsrel=0.1, monitor=None)
    energies = np.arange(8.5, kvp, 1.0)
    continuum = np.interp(energies, made.x, made.y)
    whole = continuum.copy()
    for line in made.discrete:
        whole[np.argmin(np.abs(energies - line[0]))] += line[1]
    return energies, continuum, whole


def ours(kvp, angle, model):
    beam = skiagraph.Beam.tube(float(kvp), target_angle=angle, model=model)
    return np.array(beam.energies), np.array(beam.photons)


def weights(kvp, energies, photons):
    """Shares of the energy behind the filters, by x; none where the lines are."""
    sum_of = np.zeros_like(SHARES)
    for layers in FILTERS:
        behind = skiagraph.Beam(energies, photons).filtered(layers)
        kev, energy = np.array(behind.energies), np.array(behind.photons) * np.array(behind.energies)
        sum_of += np.interp(SHARES, kev / kvp, energy / energy.sum())
    kev = SHARES * kvp
    sum_of[(kev > K_LINES[0]) & (kev < K_LINES[1]) | (SHARES * 300 > K_LINES[0]) & (SHARES * 300 < K_LINES[1])] = 0
    return sum_of / sum_of.sum()


def fit(spectra, model):
    ratio, wanted, weight, steps = {}, [], [], []
    for kvp in VOLTAGES:
        for angle in ANGLES:
            energies, continuum, _ = spectra[kvp, angle]
            own = ours(kvp, angle, model)
            ratio[kvp, angle] = (np.interp(SHARES, energies / kvp, np.log(continuum))
                                 - np.interp(SHARES, own[0] / kvp, np.log(own[1])))
            if kvp > VOLTAGES[0]:
                wanted.append(ratio[kvp, angle] - ratio[VOLTAGES[0], angle])
                weight.append(np.sqrt(weights(kvp, energies, continuum)))
                steps.append(np.log(kvp / VOLTAGES[0]))
    wanted, weight, steps = np.array(wanted), np.array(weight), np.array(steps)[:, None]
    found = scipy.optimize.least_squares(
        lambda e: (weight * (steps * np.polyval(e[::-1], SHARES) - wanted)).ravel(), np.zeros(4))
    print(f"    {model}: .e = {{{', '.join(f'{e:.5f}' for e in found.x)}}}, {100 * np.sqrt(2 * found.cost / len(wanted)):.2f} % off, "
          f"{100 * np.sqrt((weight ** 2 * wanted ** 2).sum() / len(wanted)):.2f} % without")


def change(beam, at_300, key):
    return beam.quality[key] / at_300.quality[key]


def compare(spectra, model):
    for layers in FILTERS:
        for kvp in VOLTAGES[1:]:
            row = []
            for key in ("air_kerma_ugy", "hvl1_mm_al", "hvl1_mm_cu"):
                their, own = ([maker(v) for v in (kvp, VOLTAGES[0])] for maker in
                              (lambda v: skiagraph.Beam(*spectra[v, 12][::2]).filtered(layers),
                               lambda v: skiagraph.Beam.tube(float(v), layers, target_angle=12, model=model)))
                row.append(f"{change(*their, key):.3f} {100 * (change(*own, key) / change(*their, key) - 1):+.1f} %")
            print(f"    {model}, {kvp} kV, {layers}: " + ", ".join(row))


def main():
    warnings.simplefilter("ignore")
    spectra = {(kvp, angle): theirs(kvp, angle) for kvp in VOLTAGES for angle in ANGLES}
    print("factors on top of those in use:")
    for model in MODELS:
        fit(spectra, model)
    print("air kerma and first half-value layers in Al and Cu over those at 300 kV, 12 degrees: xpecgen's, and how much ours differ")
    for model in MODELS:
        compare(spectra, model)


if __name__ == "__main__":
    main()
