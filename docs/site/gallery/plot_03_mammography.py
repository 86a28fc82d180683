"""
Mammography
===========
A compressed breast with gland, lobe, mass and four calcifications at 28 kV (tungsten and rhodium), without and with the quantum noise
of 60 mAs. The scene file is one of the examples.
"""
import skiagraph as sk
from figure import SCENES, pixel_at, row, show

scene = sk.Scene(SCENES / "mammography.json")
pictures, _ = row(2, 4.6, 4.6)
for axes, noise in zip(pictures, (False, True)):
    image = scene.image("attenuation", noise=noise)
    show(axes, image, pixel_at(scene.view), "with quantum noise" if noise else "without noise", "-ln(I/I0)", limits=(1.5, 3.2))
