"""
A needle, and what moves it in the image
========================================
The derivative of an image along a direction of a part: where, and by how much, the image changes when the needle moves by a
millimetre. Registrations and planners use its transpose, ``scene.gradient``.
"""
import numpy as np

import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene()
scene.add("liver", sk.Mesh.sphere(60, 128), material="water")
contrast = sk.Material.mixture({"I": 0.03, "H": 0.11, "O": 0.86}, 1.05)
scene.add("duct", sk.Mesh.cylinder(5, 70, 64), material=contrast, inside="liver",
          pose=sk.rotate("x", 90))
scene.add("needle", sk.Mesh.cylinder(0.8, 80, 32), material="Fe", inside="liver",
          priority=1,
          pose=sk.translate(-12, 14, 0) @ sk.rotate("z", 55) @ sk.rotate("x", 90))
scene.view = sk.View(source=(0, 0, -900), detector=(0, 0, 300),
                     column_step=(0.7, 0, 0), row_step=(0, 0.7, 0), pixels=(240, 240))
scene.beam = sk.Beam.tube(90, filters={"Al": 3})
# The needle's axis in the image is 55 degrees from y.
across = np.r_[np.sin(np.radians(35)), np.cos(np.radians(35)), 0]
change = scene.derivative({"poses": {"needle": np.r_[across, 0, 0, 0]}},
                          quantity="attenuation", supersampling=4)

(image, derivative), _ = row(2, 5, 4)
show(image, scene.image("attenuation"), pixel_at(scene.view),
     "bile duct with contrast, needle", "-ln(I/I0)")
limit = np.percentile(abs(change), 99.8)
show(derivative, change, pixel_at(scene.view), "moved across its axis", "change per mm",
     cmap="RdBu_r", limits=(-limit, limit))

# %%
# The liver, the duct and the needle, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-needle.html?bare" title="The liver, the duct and the needle; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-needle.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("needle", change, cmap="RdBu_r", limits=(-limit, limit), middle=(0.6, 0.42), side=0.4)
turning("needle", scene)
# sphinx_gallery_end_ignore
