"""
Photon counting
===============
Three energy bands of one exposure. Iodine and bone, which look alike in one band, part in the ratio of bands around the K edge of
iodine at 33.2 keV.
"""
import numpy as np

import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene()
scene.add("water", sk.Mesh.cuboid(60, 40, 40), material="water")
scene.add("bone", sk.Mesh.cylinder(3, 30, 96), material="Bone, cortical (ICRU-44)",
          inside="water", pose=sk.translate(-18, 0, 0))
iodine = sk.Material.mixture({"I": 0.02, "H": 0.11, "O": 0.87}, 1.02)
scene.add("iodine", sk.Mesh.cylinder(6, 30, 96), material=iodine, inside="water",
          pose=sk.translate(18, 0, 0))
scene.view = sk.View(source=(0, 0, -600), detector=(0, 0, 200),
                     column_step=(0.3, 0, 0), row_step=(0, 0.3, 0), pixels=(300, 200))
scene.beam = sk.Beam.tube(90, filters={"Al": 3}, mas=2)
bands = scene.image("attenuation", bands=[15, 33, 50, 90], noise=True)

pictures, _ = row(4, 3.4, 2.8)
names = "15 to 33 keV", "33 to 50 keV", "50 to 90 keV"
for axes, image, name in zip(pictures, bands, names):
    show(axes, image, pixel_at(scene.view), name, "-ln(N/N0)", limits=(0, 4))
# Outside of the water the ratio is that of noise.
inside = np.where(bands[0] > 0.5, bands[0], np.nan)
show(pictures[3], bands[1] / inside, pixel_at(scene.view), "second over first", "ratio",
     cmap="magma", limits=(0.5, 1.1))

# %%
# The phantom of bone and iodine, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-counting.html?bare" title="The phantom of bone and iodine; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-counting.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("counting", bands[1] / inside, cmap="magma", limits=(0.5, 1.1), middle=(0.5, 0.9))
turning("counting", scene)
# sphinx_gallery_end_ignore
