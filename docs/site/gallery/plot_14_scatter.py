"""
Scattered photons
=================
20 cm of water with a bone in it, a field of 18 x 18 cm: the primary, the scatter with its standard error of 2 %, and their sum. Scatter
is smooth and hides what is behind much water.
"""
import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene()
scene.add("water", sk.Mesh.cuboid(200, 200, 200), material="water")
scene.add("bone", sk.Mesh.cylinder(12, 120, 64), material="Bone, cortical (ICRU-44)",
          inside="water", pose=sk.rotate("z", 30) @ sk.rotate("x", 90))
scene.view = sk.View(source=(0, 0, -900), detector=(0, 0, 150), column_step=(1.5, 0, 0),
                     row_step=(0, 1.5, 0), pixels=(140, 140))
scene.beam = sk.Beam.tube(80, filters={"Al": 3})
found = scene.scatter(0.02)
primary = found["total"] - found["image"]
print(f"scatter over primary {found['ratio']:.2f}, "
      f"standard error {100 * found['error']:.1f} %, {found['histories']} histories")

pictures, _ = row(3, 4.2, 3.6)
for axes, image, name in zip(pictures, (primary, found["image"], found["total"]),
                             ("primary", "scatter", "both")):
    show(axes, image, pixel_at(scene.view), name, "keV per pixel")

# %%
# The water, the bone and the field, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-scatter.html?bare" title="The water, the bone and the field; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-scatter.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("scatter", found["image"], cmap="magma")
turning("scatter", scene)
# sphinx_gallery_end_ignore
