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
