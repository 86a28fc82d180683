"""
A CT scan with its artefacts
============================
A water cylinder with two titanium pins, scanned at 80 kV and at one energy. The spectrum hardens behind the pins: the dark band between
them is in the tube's volume, and absent at one energy.
"""
import numpy as np

import skiagraph as sk
from figure import row, show

scene = sk.Scene()
scene.add("water", sk.Mesh.cylinder(40, 30, 96), material="water")
for x in (-18, 18):
    scene.add(f"pin {x}", sk.Mesh.cylinder(3, 20, 48), material="Ti", inside="water",
              pose=sk.translate(x, 0, 0))
scene.view = sk.View(source=(0, -400, 0), detector=(0, 200, 0), column_step=(1, 0, 0),
                     row_step=(0, 0, -1), pixels=(160, 5))
scene.trajectory = sk.Scan(scene.view, 360)


def volume(beam):
    scene.beam = beam
    return sk.reconstruct(scene.trajectory, scene.scan(quantity="attenuation"),
                          size=(192, 192, 1), voxel=0.5, filter="hann")[0]


tube, one = volume(sk.Beam.tube(80, filters={"Al": 3})), volume(sk.Beam.mono(50, 1000))
pictures, _ = row(2, 5, 4)
for axes, slice_, title in zip(pictures, (tube, one), ("80 kV", "50 keV")):
    show(axes, np.flipud(slice_), 0.5, title, "1/cm", limits=(0, 0.5))

# %%
# The cylinder and its pins, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-ct.html?bare" title="The cylinder and its pins; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-ct.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("ct", np.flipud(tube), limits=(0, 0.5), side=0.75)
turning("ct", scene)
# sphinx_gallery_end_ignore
