"""
Path lengths for a network
==========================
Every part's path lengths as channels: what a network is trained on, to take an image apart or to put one together. 40 poses in one
batch; here are the lengths of the first pose and its image.
"""
import numpy as np

import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene()
upright = sk.rotate("x", 90)  # cylinders are made along z
scene.add("muscle", sk.Mesh.cylinder(50, 160, 128),
          material="Muscle, skeletal (ICRU-44)", pose=upright)
scene.add("bone", sk.Mesh.cylinder(14, 160, 96), material="Bone, cortical (ICRU-44)",
          inside="muscle", pose=sk.translate(12, 0, 0) @ upright)
scene.add("marrow", sk.Mesh.cylinder(8, 160, 96), material="Adipose tissue (ICRU-44)",
          inside="bone", pose=sk.translate(12, 0, 0) @ upright)
scene.add("screw", sk.Mesh.cylinder(2, 44, 48), material="Ti", inside="muscle",
          priority=1, pose=sk.translate(12, 0, 0) @ sk.rotate("z", 70) @ upright)
scene.view = sk.View(source=(0, 0, -800), detector=(0, 0, 200), column_step=(0.6, 0, 0),
                     row_step=(0, 0.6, 0), pixels=(224, 224))
scene.beam = sk.Beam.tube(80, filters={"Al": 3})
lengths = scene.lengths()
moved = [sk.translate(0, y, 0) @ scene["screw"].pose for y in np.linspace(-60, 60, 40)]
batch = scene.images("attenuation", poses={"screw": np.stack(moved)})
print({label: channel.shape for label, channel in lengths.items()}, batch.shape)

pictures, _ = row(5, 3, 2.6)
for axes, (label, channel) in zip(pictures, lengths.items()):
    show(axes, channel, pixel_at(scene.view), label, "mm", cmap="viridis")
show(pictures[4], batch[20], pixel_at(scene.view), "the image", "-ln(I/I0)")

# %%
# The limb and its screw, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-network.html?bare" title="The limb and its screw; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-network.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("network", lengths["bone"], cmap="viridis", side=0.8)
turning("network", scene)
# sphinx_gallery_end_ignore
