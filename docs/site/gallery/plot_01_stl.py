"""
An STL to a figure
==================
A mesh from a file, a material, a tube, and the picture. The mesh is a gyroid lattice of titanium, 3 cm wide.
"""
import skiagraph as sk
from figure import pixel_at, row, show

sk.Mesh.gyroid((30, 30, 30), 10).save("lattice.stl")  # stands for the file that you have

# %%
# Without a detector in the scene one is fitted to the part, with 512 pixels along its longer side.
scene = sk.Scene({"Source": {"From": [1, -2, 0.7], "Shape": "PointSource", "Beam": {"kVp": 100, "Filter": [["Al", 2.5, "mm"]]}},
                  "Samples": [{"Path": "lattice.stl", "Unit": "mm", "Material": ["Element", "Ti"]}]})
image = scene.image("attenuation")
(axes,), _ = row(1, 6, 5)
show(axes, image, pixel_at(scene.view), "Titanium at 100 kV", "-ln(I/I0)")
