"""
Laminography
============
A flat board with two printed layers turns about its normal, which is oblique to the beam, so that no ray has to cross the board along
its width. Adding up the projections along the rays brings one layer into focus and blurs the other.
"""
import numpy as np

import skiagraph as sk
from figure import row, show

scene = sk.Scene()
scene.add("board", sk.Mesh.cuboid(40, 40, 3),
          material=sk.Material.formula("C5H8O2", 1.2))
scene.add("star", sk.Mesh.star(12, 2, 12, 0.2), material="Cu", inside="board",
          pose=sk.translate(0, 0, 1))
scene.add("lines", sk.Mesh.line_pairs([0.25, 0.5, 1], 4, 14, 0.2), material="Cu",
          inside="board", pose=sk.translate(0, 0, -1))
# The beam is 55 degrees from the normal.
s, c = np.sin(np.radians(35)), np.cos(np.radians(35))
scene.view = sk.View(source=(0, -150 * c, -150 * s), detector=(0, 150 * c, 150 * s),
                     column_step=(0.25, 0, 0), row_step=(0, -0.25 * s, 0.25 * c),
                     pixels=(400, 320))
scene.beam = sk.Beam.tube(70, filters={"Al": 2})
scan = scene.trajectory = sk.Scan(scene.view, 90, axis="z")
projections = scene.images("attenuation", views=scan)


# %%
# Where the ray from the source through a point of a layer meets the detector: Cramer's rule for the two steps.
def layer(z, side=30, voxel=0.1):
    x, y = np.meshgrid(*2 * [np.arange(-side / 2, side / 2, voxel)])
    points = np.stack([x, y, np.full_like(x, z)], -1)
    found = np.zeros_like(x)
    for view, image in zip(scan, projections):
        normal = np.cross(view.column_step, view.row_step)
        rays = points - view.source
        way = (normal @ (view.detector - view.source)) / (rays @ normal)
        hits = rays * way[..., None] + view.source - view.detector
        indices = []
        for step, count in zip((view.row_step, view.column_step), image.shape):
            index = np.rint(hits @ step / (step @ step) + (count - 1) / 2)
            indices.append(index.astype(int).clip(0, count - 1))
        found += image[tuple(indices)]
    return found / len(scan)


pictures, _ = row(3, 4, 3.6)
show(pictures[0], projections[0], 0.125, "one projection", "-ln(I/I0)")
for axes, z, name in zip(pictures[1:], (1, -1), ("the upper layer", "the lower layer")):
    show(axes, layer(z), 0.1, name, "mean of -ln(I/I0)")

# %%
# The board and its two layers, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-laminography.html?bare" title="The board and its two layers; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-laminography.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("laminography", layer(1), side=0.9)
turning("laminography", scene)
# sphinx_gallery_end_ignore
