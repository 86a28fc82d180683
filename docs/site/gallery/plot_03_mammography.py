"""
Mammography
===========
A compressed breast with gland, lobe, mass and four calcifications at 28 kV (tungsten and rhodium), without and with the quantum noise
of 60 mAs. The scene file is one of the examples.
"""
import numpy as np

import skiagraph as sk
from figure import SCENES, pixel_at, row, show

scene = sk.Scene(SCENES / "mammography.json")
clean, noisy = (scene.image("attenuation", noise=noise) for noise in (False, True))
rows, columns = clean.shape
part = np.s_[int(0.36 * rows):int(0.52 * rows), int(0.02 * columns):int(0.32 * columns)]
pictures, _ = row(3, 4, 4)
show(pictures[0], clean, pixel_at(scene.view), "the breast", "-ln(I/I0)",
     limits=(1.5, 3.2))
show(pictures[1], clean[part], pixel_at(scene.view), "a part, without noise",
     "-ln(I/I0)", limits=(2.7, 3.2))
show(pictures[2], noisy[part], pixel_at(scene.view), "with quantum noise", "-ln(I/I0)",
     limits=(2.7, 3.2))

# %%
# The compressed breast under its tube, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-mammography.html?bare" title="The compressed breast under its tube; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-mammography.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("mammography", clean, limits=(1.5, 3.2), middle=(0.45, 0), side=0.75)
turning("mammography", scene)
# sphinx_gallery_end_ignore
