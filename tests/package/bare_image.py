"""One image of a cube, where there is nothing but Python and what pip brought."""
import math
import os
import sys

import skiagraph as sk

before = dict(os.environ)
try:
    sk.Device()
except sk.DeviceError as error:
    if "its compiler would end the process" not in str(error):
        raise
    print(f"skipped: {error}")
    sys.exit(77)
scene = sk.Scene({"Source": {"Position": [0, -40, 0, "cm"], "Shape": "PointSource",
                             "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1000}]},
                  "Detector": {"Position": [0, 10, 0, "cm"], "UpVector": [0, 0, -1],
                               "NumberOfPixels": [64, 48], "Size": [32, 24, "cm"]},
                  "Samples": [{"Label": "block", "Cube": [80, "mm"], "Material": ["mu", 0.2]}]})
image = scene.image("transmission")
# No ray is longer in the cube than one that leaves at the edge of its far face, 4 cm aside after 44 cm.
longest = 8 * math.hypot(1, 4 * math.sqrt(2) / 44)
assert image.shape == (48, 64) and image.max() == 1
assert math.exp(-0.2 * longest) < image.min() < math.exp(-0.2 * 8), image.min()
assert dict(os.environ) == before
print(f"{sk.devices()[0]['name']}: an image of {image.shape[0]} x {image.shape[1]} pixels, from {image.min():.4f} to 1")
