"""
A thorax, and where it stands
=============================
The generated thorax of 113 parts, seen from outside with its beam, and its X-ray image.
"""
import tempfile

import skiagraph as sk
from figure import pixel_at, row, show

folder = tempfile.mkdtemp()
scene = sk.Scene(sk.thorax(folder))
image = scene.image("attenuation")

(room, picture), _ = row(2, 5, 4.2)
room.imshow(scene.picture((900, 800)))
room.set_axis_off()
room.set_title("source, beam and detector", fontsize=10)
show(picture, image, pixel_at(scene.view), "PA, 512 x 512 pixels", "-ln(I/I0)")

# %%
# The thorax between tube and detector, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-thorax.html?bare" title="The thorax between tube and detector; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-thorax.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("thorax", image, limits=(0, 6), middle=(0.3, 0.5), side=0.8)
turning("thorax", scene)
# sphinx_gallery_end_ignore
