"""
An STL to a figure
==================
A mesh from a file, a material, a tube, and the picture. The mesh is a gyroid lattice of titanium, 3 cm wide.
"""
import skiagraph as sk
from figure import pixel_at, row, show

# A lattice stands for the file that you have.
sk.Mesh.gyroid((30, 30, 30), 10, level=0.45).save("lattice.stl")

# %%
# Without a detector in the scene one is fitted to the part, with 512 pixels along its longer side.
setup = {"Source": {"From": [1, -2, 0.7], "Shape": "PointSource",
                    "Beam": {"kVp": 100, "Filter": [["Al", 2.5, "mm"]]}},
         "Samples": [{"Path": "lattice.stl", "Unit": "mm", "Material": ["Element", "Ti"]}]}
scene = sk.Scene(setup)
image = scene.image("attenuation")
(axes,), _ = row(1, 6, 5)
show(axes, image, pixel_at(scene.view), "Titanium at 100 kV", "-ln(I/I0)")

# %%
# A corner of it, to turn with the mouse: ``scene.show()``.
#
# .. raw:: html
#
#    <iframe class="live" src="../turn-stl.html?bare" title="A corner of the lattice; drag to turn it" loading="lazy"></iframe>

# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-stl.png'
# sphinx_gallery_start_ignore
from figure import card, turning

card("stl", image, side=0.6)
sk.Mesh.gyroid((12, 12, 12), 10, level=0.45, cells=22).save("lattice.stl")  # few triangles: the page is small
turning("stl", sk.Scene(setup))
# sphinx_gallery_end_ignore
