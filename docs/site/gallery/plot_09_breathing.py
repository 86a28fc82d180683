"""
A film of a breath
==================
The generated thorax through one quiet breath, in 12 frames.
"""
import tempfile

import matplotlib.pyplot as plt
from matplotlib.animation import ArtistAnimation

import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene(sk.thorax(tempfile.mkdtemp()),
                 settings={"Detector.NumberOfPixels": [256, 256]})
frames = []
for k in range(12):
    scene.breathe(phase=k / 12)
    frames.append(scene.image("attenuation", noise=False))

(axes,), made = row(1, 4.4, 4)
show(axes, frames[0], pixel_at(scene.view), "a breath of 4 s", "-ln(I/I0)",
     limits=(0, 6))
drawn = [[axes.imshow(f, cmap="gray", vmin=0, vmax=6, animated=True)] for f in frames]
film = ArtistAnimation(made, drawn, interval=333)
plt.show()
# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-breathing.png'
# sphinx_gallery_start_ignore
from figure import card

card("breathing", frames[6], limits=(0, 6), middle=(0.62, 0.4), side=0.55)
# sphinx_gallery_end_ignore
