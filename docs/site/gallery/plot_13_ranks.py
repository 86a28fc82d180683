"""
Many ranks, one scan
====================
The projections of a scan shared out among processes, as ranks of MPI do: each takes every fourth one, and the sinogram is the same as
that of one process, bit for bit, noise included. Which process computed a line is in colour.
"""
import numpy as np

import skiagraph as sk
from figure import row

RANKS, PROJECTIONS = 4, 180
scene = sk.Scene()
scene.add("block", sk.Mesh.cuboid(50, 30, 20), material="water")
scene.add("rod", sk.Mesh.cylinder(4, 18, 48), material="Al", inside="block",
          pose=sk.translate(15, 5, 0))
scene.view = sk.View(source=(0, -400, 0), detector=(0, 100, 0), column_step=(0.5, 0, 0),
                     row_step=(0, 0, -0.5), pixels=(192, 1))
scene.beam = sk.Beam.tube(80, filters={"Al": 3}, mas=0.05)
scene.trajectory = sk.Scan(scene.view, PROJECTIONS)
whole = scene.scan(quantity="attenuation", noise=True)[:, 0]
shared = np.zeros_like(whole)
for rank in range(RANKS):  # under MPI: one of these
    mine = list(range(rank, PROJECTIONS, RANKS))
    shared[mine] = scene.scan(quantity="attenuation", noise=True, only=mine)[:, 0]
assert (shared == whole).all()

(grey, coloured), _ = row(2, 5, 4)
grey.imshow(whole, cmap="gray", aspect="auto", extent=(-48, 48, 360, 0))
for axes, title in ((grey, "one process"),
                    (coloured, "the first 24 projections, four processes")):
    axes.set_title(title, fontsize=10)
    axes.set_xlabel("mm on the detector")
    axes.set_ylabel("degrees")
colours = np.array([[0.9, 0.4, 0.2], [0.2, 0.6, 0.9], [0.3, 0.8, 0.4], [0.9, 0.8, 0.2]])
part = (whole[:24] / whole.max()).clip(0, 1)
part = part[..., None] * colours[np.arange(24) % RANKS][:, None]
coloured.imshow(part, aspect="auto", extent=(-48, 48, 48, 0), interpolation="nearest")
# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-ranks.png'
# sphinx_gallery_start_ignore
from figure import card

card("ranks", np.repeat(255 * part, 8, axis=0).astype(np.uint8))
# sphinx_gallery_end_ignore
