"""
Heel effect and anti-scatter grid
=================================
The flat field of a tube with an anode angle of 14 degrees, the same behind a focused grid that stands 200 mm too near, and both.
"""
import skiagraph as sk
from figure import row, show

TUBE = {"kVp": 80, "Filter": [["Al", 2.5, "mm"]], "TubeAngle": 14}
DETECTOR = {"Position": [0, 0, 1000, "mm"], "UpVector": [0, 1, 0],
            "NumberOfPixels": [215, 215], "Spacing": [2, 2, "mm"]}
GRID = {"Ratio": 10, "LinesPerCm": 40, "StripThickness": [0.05, "mm"],
        "Interspace": "Al", "FocusDistance": [1200, "mm"]}
CRUMB = {"Label": "crumb", "Cube": [0.01, "mm"], "Material": "water",
         "Transform": [["Translation", 0, 0, 500, "mm"]]}


def flat(heel, grid):
    source = {"Position": [0, 0, 0, "mm"], "Shape": "PointSource", "Beam": TUBE}
    if heel:
        source["Heel"] = {"Direction": [1, 0, 0]}
    detector = DETECTOR | {"Grid": GRID} if grid else DETECTOR
    scene = sk.Scene({"Source": source, "Detector": detector, "Samples": [CRUMB]})
    return scene.image("fluence")


whole = flat(False, False)
pictures, _ = row(3, 4, 3.4)
names = "heel effect", "grid out of focus", "both"
for axes, heel, grid, name in zip(pictures, (1, 0, 1), (0, 1, 1), names):
    show(axes, 100 * flat(heel, grid) / whole.max(), 2, name,
         "% of the open beam's maximum", cmap="viridis")
# sphinx_gallery_thumbnail_path = 'gallery-scripts/card-heel.png'
# sphinx_gallery_start_ignore
from figure import card

card("heel", flat(True, True), cmap="viridis")
# sphinx_gallery_end_ignore
