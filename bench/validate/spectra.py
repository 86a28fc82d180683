#!/usr/bin/env python3
"""Writes the spectra to which the tube is calibrated, as computed by SpekPy (pip install spekpy), to standard output.

Unfiltered, photons per mm2 and mAs at 1 m. A row of the continuum is a bin of 1 keV, photons per keV, in the middle of the
bin; a row of K or L is the sum over the lines of that shell."""
import importlib.metadata

import spekpy

TUBES = {
    "W": (74, (20, 25, 30, 35, 40, 50, 60, 70, 80, 90, 100, 120, 150, 160, 180, 200, 225, 250, 275, 300), (6, 8, 12, 16, 20)),
    "Mo": (42, (20, 25, 28, 30, 32, 35, 40, 49), (12, 16, 20)),
    "Rh": (45, (20, 25, 28, 30, 32, 35, 40, 49), (12, 16, 20)),
}
L_LINES = {"W": (6, 13)}  # keV; those of Mo and Rh, at 2 to 3 keV, pass no window
K_LINES = {"W": (56, 71), "Mo": (16, 21), "Rh": (19, 24)}


def spectrum(symbol, kvp, angle, brem):
    tube = spekpy.Spek(kvp=kvp, th=angle, targ=symbol, dk=1, z=100, mas=1, brem=brem, char=not brem)
    energies, photons = tube.get_spectrum()  # per keV and cm2
    return list(zip(energies, photons / 100))


def main():
    print("# SpekPy", importlib.metadata.version("spekpy"))
    print("z,kvp,angle,kind,kev,photons")
    for symbol, (z, voltages, angles) in TUBES.items():
        for kvp in voltages:
            for angle in angles:
                beam = f"{z},{kvp},{angle}"
                for kev, photons in spectrum(symbol, kvp, angle, True):
                    if photons > 0:
                        print(f"{beam},continuum,{kev:g},{photons:.7g}")
                lines = spectrum(symbol, kvp, angle, False)
                for kind, ranges in (("K", K_LINES), ("L", L_LINES)):
                    low, high = ranges.get(symbol, (0, 0))
                    photons = sum(p for kev, p in lines if low < kev < high)
                    if photons > 0:
                        print(f"{beam},{kind},0,{photons:.7g}")


if __name__ == "__main__":
    main()
