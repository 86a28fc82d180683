"""Images beside closed forms: polychromatic attenuation, photons per area, blur, focal spot, noise."""
from __future__ import annotations

import math
from typing import Any

import numpy as np
import packages
import skiagraph as sk
from page import Page, largest, percent, signed

BOX = (600.0, 600.0)  # mm across the beam


def slab_scene(material: str, depth: float, beam: sk.Beam, pixels: tuple[int, int] = (8, 8)) -> sk.Scene:
    """A slab across a parallel beam."""
    scene = sk.Scene()
    scene.view = sk.View(source=(0, 0, 1), detector=(0, 0, 500), column_step=(1, 0, 0), row_step=(0, 1, 0), pixels=pixels,
                         projection="parallel_from_infinity")
    scene.beam = beam
    scene.add("slab", sk.Mesh.cuboid(*BOX, depth), material=material)
    return scene


def polychromatic(page: Page) -> None:
    xraylib = packages.installed("xraylib")
    source = ("the sum over the beam's energies in double precision"
              + (", with xraylib's coefficients in the last two columns." if xraylib else "."))
    page.claim("Attenuation of a spectrum", source, "Transmitted energy over that of the open beam: Ebel's spectrum of tungsten, "
               "12 degrees, 2.5 mm of aluminium, an ideal detector, a slab across a parallel beam. The sum uses our coefficients; "
               "what is tested is the compression of the spectrum (`Tolerance`) and single precision.")
    cells: list[list[Any]] = []
    worst: dict[str, list[tuple[float, str]]] = {"every": [], "compressed": [], "xraylib": []}
    for kvp, name, formula, depth in ((60, "water", "H2O", 100.0), (120, "water", "H2O", 200.0), (120, "Al", "Al", 30.0),
                                      (100, "Cu", "Cu", 2.0), (150, "Pb", "Pb", 1.0)):
        beam = sk.Beam.tube(kvp, packages.AL, target_angle=12)
        material = sk.Material(name)
        energy = beam.energies * beam.photons
        exact = float(energy @ np.exp(-material.attenuation(beam.energies) * depth / 10) / energy.sum())
        scene = slab_scene(name, depth, beam)
        what = f"{depth:g} mm {name}, {kvp} kV"
        cell: list[Any] = [what, exact]
        for key, tolerance in (("every", 0.0), ("compressed", 1e-3)):
            ours = float(scene.image("transmission", tolerance=tolerance)[4, 4])
            worst[key].append((percent(ours, exact), what))
            cell += [f"{ours:.6g}", signed(worst[key][-1][0])]
        if xraylib:
            total = (lambda kev: xraylib.CS_Total_CP(formula, float(kev)))
            other = float(energy @ np.exp(-np.array([total(e) for e in beam.energies]) * material.density * depth / 10) / energy.sum())
            worst["xraylib"].append((percent(exact, other), what))
            cell += [other, signed(worst["xraylib"][-1][0])]
        cells.append(cell)
    page.table(["slab", "sum", "every energy", "difference", "tolerance 1e-3", "difference",
                *(["xraylib", "difference of the sums"] if xraylib else [])], cells)
    for key, bar, what in (("every", 0.01, "attenuation of a spectrum, every energy"),
                           ("compressed", 0.1, "attenuation of a spectrum, tolerance 1e-3"),
                           ("xraylib", 0.5, "attenuation of a spectrum beside xraylib")):
        if worst[key]:
            difference, note = largest(worst[key])
            page.judge(what, difference, bar, "%", note)


def _solid_angle(x: np.ndarray, y: np.ndarray, d: float) -> float:
    """Of the rectangle between the corners x, y of a plane at the distance d."""
    def corner(a: float, b: float) -> float:
        return math.atan2(a * b, d * math.sqrt(a * a + b * b + d * d))
    return corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])


def photons(page: Page) -> None:
    page.claim("Photons of an absolute beam", "photons per steradian times the solid angle of the detector, in closed form (the "
               "solid angle of a rectangle).", "A tube of 80 kV, 2 mAs, behind 3 mm of aluminium; a detector of 430 mm x 430 mm, at "
               "a distance of 1 m along the ray to its centre, turned about one axis. All photons of all pixels are added.")
    cells, worst = [], []
    filters = {"Al": 3.0}
    per_steradian = 1e6 * float(sk.Beam.tube(80, filters, target_angle=12, mas=2).photons.sum())  # 1 mm2 at 1 m: 1e-6 sr
    for angle in (0, 20, 45, 60):
        a, n, pitch = math.radians(angle), 256, 430 / 256
        source = [1000 * math.sin(a), 0.0, -1000 * math.cos(a)]
        scene = sk.Scene({"Source": {"Position": [*source, "mm"], "Shape": "PointSource",
                                     "Beam": {"kVp": 80, "mAs": 2, "TubeAngle": 12, "Filter": [["Al", 3, "mm"]]}},
                          "Detector": {"Position": [0, 0, 0, "mm"], "UpVector": [0, 1, 0], "RightVector": [1, 0, 0],
                                       "NumberOfPixels": [n, n], "Spacing": [pitch, pitch, "mm"]}})
        scene.add("dust", sk.Mesh.cube(1e-3), material="Air").pose = sk.translate(0, 300, -1)
        ours = float(scene.image("photons").astype(float).sum())
        edge = np.array([-215.0, 215.0])
        reference = per_steradian * _solid_angle(edge - source[0], edge, -source[2])
        worst.append((percent(ours, reference), f"{angle} degrees"))
        cells.append([f"{angle} degrees", f"{ours:.6g}", f"{reference:.6g}", signed(worst[-1][0])])
    page.table(["detector turned by", "ours", "closed form", "difference"], cells)
    difference, note = largest(worst)
    page.judge("photons of an absolute beam", difference, 0.01, "%", note)


def _edge(pixels: int, **options: Any) -> np.ndarray:
    """The profile behind the straight edge of an opaque plate that ends in the middle of the detector."""
    scene = sk.Scene()
    scene.view = sk.View(source=(0, 0, -1000), detector=(0, 0, 500), column_step=(0.1, 0, 0), row_step=(0, 0.1, 0), pixels=(pixels, 3))
    scene.beam = sk.Beam.mono(60, 1)
    scene.add("plate", sk.Mesh.cuboid(100, 100, 1e-3), material="mu:1e6").pose = sk.translate(-50, 0, 0)
    return scene.image("transmission", precision="double", **options)[1].astype(float)


def blur(page: Page) -> None:
    page.claim("Blur of the detector, penumbra of the focal spot", "closed forms: the error function of a Gaussian, the straight "
               "ramp of a line.", "The edge of an opaque plate in the middle between pixels. The blur is a line spread function of "
               "Gaussian shape with a standard deviation of 3 pixels, whose samples are integrals over pixels; the spot is a line "
               "of 2 mm at a magnification of 1.5, taken as 256 points, so that the "
               "ramp has steps of 1/256 and differs by up to half of one. Differences are shares of the open beam.")
    pixels, sigma = 202, 3.0
    middle = np.arange(pixels) - pixels / 2 + 0.5  # of the pixels, from the edge
    erf = np.array([math.erf(x / math.sqrt(2) / sigma) for x in np.arange(-18, 20) - 0.5])
    blurred = _edge(pixels, blur={"along_row": np.diff(erf), "along_column": [1.0]})
    gaussian = np.array([0.5 * (1 + math.erf(x / math.sqrt(2) / sigma)) for x in middle])
    spot = _edge(pixels, spot={"shape": "line", "extent": [2.0, 0, 0], "grid": 256})
    ramp = np.clip(0.5 + 0.1 * middle / (2.0 * 0.5), 0, 1)  # the penumbra is 1 mm wide: the spot times (magnification - 1)
    rows = [["blur, Gaussian", float(np.abs(blurred - gaussian).max())],
            ["penumbra, line of 2 mm", float(np.abs(spot - ramp).max())]]
    page.table(["edge", "largest difference"], rows)
    page.judge("blur of an edge", rows[0][1], 1e-6, "")
    page.judge("penumbra of an edge", rows[1][1], 2e-3, "")


def noise(page: Page) -> None:
    page.claim("Quantum noise", "Poisson statistics: the mean is the sum of N T E over the energies, the variance the sum of "
               "N T E^2 (an ideal detector); without blur, neighbouring pixels are independent.",
               "A slab of 100 mm of water across a parallel beam of tungsten, 80 kV, 2.5 mm of aluminium; 512 x 512 pixels. "
               "Differences are given in standard errors of that number of pixels (of the mean, of the variance, and of the "
               "correlation of neighbours), so 3 is a large one.")
    bare = sk.Beam.tube(80, packages.AL, target_angle=12)
    cells, worst = [], []
    for count in (0.5, 5, 50, 5000):  # photons per pixel behind the slab
        passed = bare.photons * np.exp(-sk.Material("water").attenuation(bare.energies) * 10)
        beam = bare.scaled(count / float(passed.sum()))
        image = slab_scene("water", 100.0, beam, (512, 512)).image("energy", noise=True, index=1).astype(float)
        photons = passed * count / passed.sum()
        moments = [float(photons @ bare.energies**k) for k in range(1, 5)]
        mean, variance, n = moments[0], moments[1], image.size
        of_mean = (image.mean() - mean) / math.sqrt(variance / n)
        # The variance of a sample's variance: the fourth cumulant of a compound Poisson number is the sum of N E^4.
        of_variance = (image.var() - variance) / math.sqrt((moments[3] + 2 * variance**2) / n)
        centred = image - image.mean()
        correlation = float((centred[:, 1:] * centred[:, :-1]).mean() / centred.var()) * math.sqrt(n)
        worst += [(of_mean, f"mean, {count:g} photons"), (of_variance, f"variance, {count:g} photons"),
                  (correlation, f"neighbours, {count:g} photons")]
        cells.append([f"{count:g}", f"{image.mean():.6g}", f"{mean:.6g}", f"{of_mean:+.2f}", f"{image.var():.6g}",
                      f"{variance:.6g}", f"{of_variance:+.2f}", f"{correlation:+.2f}"])
    page.table(["photons per pixel", "mean, ours, keV", "closed form", "standard errors", "variance, ours", "closed form",
                "standard errors", "correlation, standard errors"], cells)
    difference, note = largest(worst)
    page.judge("quantum noise", difference, 4, "standard errors", note)


def add(page: Page) -> None:
    polychromatic(page)
    photons(page)
    blur(page)
    noise(page)
