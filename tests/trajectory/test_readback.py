"""Files of `scan --geometry`, read by RTK (itk-rtk) and ASTRA (astra-toolbox), and run for TIGRE and CIL. Skipped without
both of the former.

Usage: test_readback.py SKIAGRAPH
"""

import json
import math
import runpy
import subprocess
import sys
import tempfile
import types
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: no Python package numpy")
    sys.exit(77)

try:
    import itk
    from itk import RTK as rtk
except ImportError:
    rtk = None
try:
    import astra
except ImportError:
    astra = None
if rtk is None and astra is None:
    print("skipped: neither itk-rtk nor astra-toolbox is there")
    sys.exit(77)

CENTRE, RADIUS, PER_CM = (12.0, -7.0, 5.0), 15.0, 0.2

SCENE = {
    "Source": {"Position": [3, -400, 2, "mm"], "Shape": "Point",
               "Beam": [{"Energy": 60, "Unit": "keV", "PhotonCount": 1}]},
    "Detector": {"Position": [-4, 200, 1, "mm"], "UpVector": [0, 0, -1], "NumberOfPixels": [90, 70],
                 "Spacing": [1.1, 0.9, "mm"]},
    "Samples": [{"Sphere": [256, RADIUS, "mm"], "Material": ["mu", PER_CM],
                 "Transform": [["Translation", *CENTRE, "mm"]]}],
    "Scan": {"NumberOfProjections": 12, "StartAngle": 17, "FinalAngle": 377, "CentreOfRotation": [2, 1, 0, "mm"],
             "DetectorOffset": [3, -2, "mm"], "DetectorTilt": [1, -2, 3]},
}


def on_detector(pose, point):
    """Where the ray from the source through a point meets the detector, mm along its steps."""
    source, centre, u, v = np.array(pose).reshape(4, 3)
    ray = point - source
    along = np.linalg.solve(np.column_stack([u / np.linalg.norm(u), v / np.linalg.norm(v), -ray]), source - centre)
    return along[:2]


def rtk_world():
    """Rows: the axes of RTK's world, y along the axis of rotation, z towards the source at angle 0."""
    y = np.array([0, 0, -1.0])  # RotationAxis is UpVector
    centre = np.array(SCENE["Scan"]["CentreOfRotation"][:3], float)
    z = np.array(SCENE["Source"]["Position"][:3], float) - centre
    z -= z.dot(y) * y
    z /= np.linalg.norm(z)
    return np.array([np.cross(y, z), y, z]), centre


def read_by_rtk(folder, poses):
    reader = rtk.ThreeDCircularProjectionGeometryXMLFileReader.New()
    reader.SetFilename(str(folder / "scan.xml"))
    reader.GenerateOutputInformation()
    geometry = reader.GetOutputObject()
    axes, origin = rtk_world()
    assert len(geometry.GetGantryAngles()) == len(poses)
    worst = 0
    for k, pose in enumerate(poses):
        matrix = itk.array_from_matrix(geometry.GetMatrix(k))
        for point in ((0, 0, 0), (20, -30, 15), (-25, 10, -12)):
            image = matrix @ np.append(axes @ (np.array(point, float) - origin), 1)
            worst = max(worst, np.abs(image[:2] / image[2] - on_detector(pose, np.array(point, float))).max())
    # The file has 17 digits, so double's epsilon times 1e3 mm and some ten operations remain.
    assert worst < 1e-9, worst
    print(f"RTK: {len(poses)} projections, largest difference {worst:.2g} mm")
    compare_images(folder, geometry, axes, origin)


def compare_images(folder, geometry, axes, origin):
    """RTK's exact lengths through a ball, with the stack's own spacing and origin, against the stack."""
    stack = itk.imread(str(folder / "scan.mha"))
    image_type = itk.Image[itk.F, 3]
    blank = rtk.ConstantImageSource[image_type].New()
    blank.SetSize(itk.size(stack))
    blank.SetSpacing(stack.GetSpacing())
    blank.SetOrigin(stack.GetOrigin())
    rays = rtk.RayEllipsoidIntersectionImageFilter[image_type, image_type].New()
    rays.SetInput(blank.GetOutput())
    rays.SetGeometry(geometry)
    rays.SetDensity(PER_CM / 10)
    rays.SetCenter([float(x) for x in axes @ (np.array(CENTRE) - origin)])
    rays.SetAxis([RADIUS] * 3)
    rays.Update()
    theirs, ours = itk.array_from_image(rays.GetOutput()), itk.array_from_image(stack)
    assert theirs.shape == ours.shape and ours.max() > 0.5
    # The sphere of 256 sectors is 0.1 % smaller than the ball; near its edge lengths grow as a square root:
    # sqrt(2 * 15 * 0.0023) mm of 30 mm is 0.9 % of the largest, twice that for both sides.
    worst = np.abs(theirs - ours).max() / ours.max()
    assert worst < 0.02, worst
    print(f"RTK: largest difference of images {worst:.2g} of the maximum")


def read_by_astra(poses):
    geometry = astra.create_proj_geom("cone_vec", 70, 90, np.array(poses))
    number = astra.data3d.create("-sino", geometry)
    back = astra.data3d.get_geometry(number)
    assert astra.geom_size(geometry) == (70, len(poses), 90)
    # ASTRA keeps them in another form: some roundings of 1e3 mm.
    assert back["type"] == "cone_vec" and np.abs(back["Vectors"] - np.array(poses)).max() < 1e-10
    astra.data3d.delete(number)
    print(f"ASTRA: {len(poses)} projections")


class Recorder:
    """Stands for an object of TIGRE or CIL: keeps what it is given."""

    def __init__(self, **given):
        self.__dict__.update(given)

    def __getattr__(self, name):
        return lambda *words, **named: setattr(self, name + "_given", (words, named))


def stand_in(name, **members):
    if name not in sys.modules:
        module = types.ModuleType(name)
        module.__dict__.update(members)
        sys.modules[name] = module


def run_for_tigre(folder, poses):
    """The file runs, and the shapes are those that TIGRE's check_geo asks for."""
    try:
        import tigre  # noqa: F401
    except ImportError:
        stand_in("tigre", geometry=Recorder)
    made = runpy.run_path(str(folder / "scan.tigre.py"))
    geo, count = made["geo"], len(poses)
    assert made["angles"].shape == geo.DSD.shape == geo.DSO.shape == (count,)
    assert geo.offOrigin.shape == geo.rotDetector.shape == (count, 3) and geo.offDetector.shape == (count, 2)
    assert np.allclose(geo.nVoxel * geo.dVoxel, geo.sVoxel) and list(geo.nDetector) == [70, 90]
    # The source's distance from the axis, which is z through (2, 1): hand-derived, to the rounding of 17 digits.
    assert np.abs(geo.DSO - math.hypot(3 - 2, -400 - 1)).max() < 1e-9
    print(f"TIGRE's file: {count} projections")


def run_for_cil(folder, poses):
    try:
        import cil.framework  # noqa: F401
    except ImportError:
        kinds = {"create_Cone3D": Recorder, "create_Cone3D_SOUV": Recorder, "create_Parallel3D": Recorder}
        stand_in("cil")
        stand_in("cil.framework", AcquisitionGeometry=types.SimpleNamespace(**kinds))
    geometry = runpy.run_path(str(folder / "scan.cil.py"))["geometry"]
    if isinstance(geometry, Recorder):
        (angles,), unit = geometry.set_angles_given
        assert angles.shape == (len(poses),) and unit == {"angle_unit": "degree"}
        assert geometry.set_panel_given[0] == ([90, 70],)
    print(f"CIL's file: {len(poses)} projections")


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.json").write_text(json.dumps(SCENE))
        subprocess.run([program, "scan", "scene.json", "-o", "scan.mha", "--quantity", "attenuation", "--geometry",
                        "scan.csv", "--geometry", "scan.xml", "--geometry", "scan.tigre.py", "--geometry", "scan.cil.py",
                        "--quiet"], cwd=folder, check=True)
        poses = [[float(x) for x in line.split(",")] for line in (folder / "scan.csv").read_text().splitlines()
                 if not line.startswith("#")]
        assert len(poses) == 12 and math.isclose(np.linalg.norm(poses[0][6:9]), 1.1)
        if rtk is not None:
            read_by_rtk(folder, poses)
        if astra is not None:
            read_by_astra(poses)
        run_for_tigre(folder, poses)
        run_for_cil(folder, poses)


if __name__ == "__main__":
    main(sys.argv[1])
