"""
Foam
====
1,500 pores of an aluminium foam as one closed mesh: an image at 60 keV, and a slice of the volume from 200 of them.
"""
import skiagraph as sk
from figure import pixel_at, row, show

scene = sk.Scene()
scene.add("block", sk.Mesh.cuboid(20, 20, 20), material="Al")
scene.add("pores", sk.Mesh.foam((19, 19, 19), 0.7, spread=0.2, count=1500, segments=16),
          material="Air", inside="block")
scene.view = sk.View(source=(0, -200, 0), detector=(0, 100, 0), column_step=(0.2, 0, 0),
                     row_step=(0, 0, -0.2), pixels=(256, 200))
scene.beam = sk.Beam.mono(60, 1000)
scene.trajectory = sk.Scan(scene.view, 200)
projections = scene.scan(quantity="attenuation")
slices = sk.reconstruct(scene.trajectory, projections, size=(216, 216, 1), voxel=0.14)

(image, volume), _ = row(2, 5, 4)
show(image, projections[0], pixel_at(scene.view), "a projection", "-ln(I/I0)")
show(volume, slices[0], 0.14, "the middle slice", "1/cm")
# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-foam.png'
# sphinx_gallery_start_ignore
from figure import card

card("foam", slices[0], side=0.6)
# sphinx_gallery_end_ignore
