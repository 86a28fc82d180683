"""Poses of scenarios against the toolbox `ctsimu` of the format's authors. Skipped without it.

Usage: test_toolbox.py PROGRAM, the one that poses.c makes.
"""

import contextlib
import io
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    from ctsimu.scenario import Scenario
except ImportError:
    try:
        with open(sys.argv[2], encoding="ascii") as file:
            print("skipped: no Python package ctsimu:", file.read().strip())
    except OSError:
        print("skipped: no Python package ctsimu, which ./check installs")
    sys.exit(77)

# Both compute in double; coordinates are below 1e3 mm and pass some ten rotations, 1e3 * 1e-16 * 1e2.
TOLERANCE_MM = 1e-10


def parameter(value, unit=None, drifts=None):
    result = {"value": value}
    if unit:
        result["unit"] = unit
    if drifts:
        result["drifts"] = drifts
    return result


def vector(names, values, unit=None):
    return {n: v if isinstance(v, dict) else parameter(v, unit) for n, v in zip(names, values)}


def placement(centre, u, w, deviations=(), axes="xyz", names="uw"):
    return {
        "center": vector(axes, centre, "mm"),
        "vector_" + names[0]: vector(axes, u),
        "vector_" + names[1]: vector(axes, w),
        "deviations": list(deviations),
    }


def rotation(axis, degrees, pivot=None, known=True, drifts=None):
    result = {"type": "rotation", "axis": axis, "amount": parameter(degrees, "deg", drifts)}
    if pivot:
        result["pivot"] = pivot
    result["known_to_reconstruction"] = known
    return result


def shift(axis, mm, known=True, drifts=None):
    return {"type": "translation", "axis": axis, "amount": parameter(mm, "mm", drifts),
            "known_to_reconstruction": known}


def drift(values, unit="mm", known=True):
    return [{"value": values, "unit": unit, "known_to_reconstruction": known}]


def sample(name, position):
    return {"name": name, "file": parameter("box.stl"), "unit": "mm", "material_id": "Al", "position": position,
            "scaling_factor": vector("rst", (0.5, 0.75, 1.25))}


def scenario(detector, source, stage, samples, **acquisition):
    keys = {"start_angle": parameter(0, "deg"), "stop_angle": parameter(360, "deg"), "direction": "CCW",
            "number_of_projections": 9, "include_final_angle": False}
    keys.update(acquisition)
    return {
        "file": {"file_type": "CTSimU Scenario", "file_format_version": {"major": 1, "minor": 2}},
        "geometry": {"detector": detector, "source": dict(source, type="cone"), "stage": stage},
        "detector": {"columns": parameter(40), "rows": parameter(30),
                     "pixel_pitch": {"u": parameter(0.5, "mm"), "v": parameter(400, "um")}},
        "source": {"voltage": parameter(100, "kV"), "current": parameter(1, "mA"),
                   "spectrum": {"monochromatic": True}},
        "samples": samples,
        "acquisition": keys,
        "materials": [{"id": "Al", "density": parameter(2.7, "g/cm^3"),
                       "composition": [{"formula": parameter("Al"), "mass_fraction": parameter(1)}]}],
    }


DETECTOR = ((400, 3, -2), (0, -1, 0), (1, 0, 0))
SOURCE = ((-5, 0, 1), (0, -1, 0), (1, 0, 0))
STAGE = ((275, 1, 2), (1, 0, 0), (0, 0, 1))
ON_STAGE = placement((3, 20, -4), (1, 0, 0), (0, 0, 1), axes="uvw", names="rt")
IN_WORLD = placement((280, 4, 9), (1, 0, 0), (0, 1, 0), names="rt")

CASES = {
    "circle": scenario(placement(*DETECTOR), placement(*SOURCE), placement(*STAGE),
                       [sample("a", ON_STAGE), sample("b", IN_WORLD)]),
    "clockwise, with the last angle": scenario(
        placement(*DETECTOR), placement(*SOURCE), placement(*STAGE), [sample("a", ON_STAGE)], direction="CW",
        include_final_angle=True, start_angle=parameter(0.3, "rad"), stop_angle=parameter(4, "rad")),
    "helix with an error of its motion": scenario(
        placement(*DETECTOR), placement(*SOURCE),
        placement((275, 0, parameter(0, "mm", drift([-100, 100]) + drift([0, 2, -1, 0.5], known=False))), *STAGE[1:]),
        [sample("a", ON_STAGE), sample("b", IN_WORLD)], stop_angle=parameter(720, "deg")),
    "axis tilt": scenario(placement(*DETECTOR), placement(*SOURCE),
                          placement(*STAGE, [rotation("x", 4, known=False)]), [sample("a", ON_STAGE)]),
    "wobble": scenario(placement(*DETECTOR), placement(*SOURCE),
                       placement(*STAGE, [rotation(vector("uvw", (1, 1, 0)), 4)]), [sample("a", ON_STAGE)]),
    "detector": scenario(
        placement(*DETECTOR, [
            shift("x", 0.5, known=False), rotation("w", 1.3), shift(vector("uvw", (1, 2, 2)), 3),
            rotation(vector("xyz", (2, -3, 5.3)), 1.3, vector("xyz", (2, -3, 5.3), "mm")),
            rotation(vector("uvw", (0, 1, 0.5)), -2, vector("uvw", (1, -2, 2.5), "mm")),
        ]), placement(*SOURCE, [shift("z", 0, drifts=drift([0, 0.1, 0.3]))]), placement(*STAGE),
        [sample("a", ON_STAGE)]),
    "gantry": scenario(
        placement(*DETECTOR, [rotation("z", 0, vector("xyz", STAGE[0], "mm"), drifts=drift([0, 300], "deg"))]),
        placement(*SOURCE, [rotation("z", 0, vector("xyz", STAGE[0], "mm"), drifts=drift([0, 300], "deg"))]),
        placement(*STAGE), [sample("a", ON_STAGE)], stop_angle=parameter(0, "deg")),
    # Axis and pivot as bare numbers, as in the format's examples 10 and 11.
    "gantry on a cone": scenario(
        placement(*DETECTOR, [rotation({"x": 1, "y": 0, "z": 1}, 0, {"x": 275, "y": 1, "z": 2},
                                       drifts=drift([0, 360], "deg"))]),
        placement(*SOURCE, [rotation({"x": 1, "y": 0, "z": 1}, 0, {"x": 275, "y": 1, "z": 2},
                                     drifts=drift([0, 360], "deg"))]),
        placement(*STAGE), [sample("a", ON_STAGE)], stop_angle=parameter(0, "deg")),
    "samples deviate": scenario(
        placement(*DETECTOR), placement(*SOURCE), placement(*STAGE, [rotation("u", 2)]),
        [sample("a", placement((3, 20, parameter(-4, "mm", drift([0, 5]))), (1, 0, 0), (0, 0.2, 1), [
            rotation("t", 10, drifts=drift([0, 20], "deg")), shift("x", 2),
            rotation("u", 5, vector("xyz", (270, 3, 1), "mm")), shift("r", 1),
            rotation(vector("rst", (1, 1, 0)), 7, vector("rst", (1, 2, 3), "mm")),
        ], "uvw", "rt")),
         sample("b", placement((280, 4, 9), (0, 1, 0), (0, 0, 1), [rotation("z", 0, drifts=drift([0, 90], "deg"))],
                               names="rt"))]),
    "one projection": scenario(placement(*DETECTOR), placement(*SOURCE), placement(*STAGE), [sample("a", ON_STAGE)],
                               number_of_projections=1, stop_angle=parameter(0, "deg")),
}

SIZE = (20, 12, 8)


def write_box(path):
    corners = [(x, y, z) for x in (0, SIZE[0]) for y in (0, SIZE[1]) for z in (0, SIZE[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    with open(path, "wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            numbers = [x for corner in triangle for x in corners[corner]]
            file.write(struct.pack("<12fH", 0, 0, 0, *numbers, 0))


def numbers_of(v):
    return [v.x(), v.y(), v.z()]


def axes_of(system):
    return [numbers_of(system.u), numbers_of(system.v), numbers_of(system.w)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def into(stage, direction):
    return [dot(axis, direction) for axis in axes_of(stage)]


def point_into(stage, point):
    return into(stage, [p - c for p, c in zip(point, numbers_of(stage.center))])


def views_of(scene, pitch):
    stage = scene.stage.coordinate_system
    detector = axes_of(scene.detector.coordinate_system)
    result = point_into(stage, numbers_of(scene.source.coordinate_system.center))
    result += point_into(stage, numbers_of(scene.detector.coordinate_system.center))
    for k in range(2):
        result += [pitch[k] * x for x in into(stage, detector[k])]
    return result


def pose_of(one, stage, scale):
    """Row by row, from the mesh's own axes, whose box begins at the origin, to those of the stage."""
    system = one.coordinate_system
    axes, centre = axes_of(system), numbers_of(system.center)
    if not one.is_attached_to_stage():
        axes, centre = [into(stage, axis) for axis in axes], point_into(stage, centre)
    columns = [[s * x for x in axis] for s, axis in zip(scale, axes)]
    offset = [c - sum(columns[k][j] * SIZE[k] / 2 for k in range(3)) for j, c in enumerate(centre)]
    rows = []
    for j in range(3):
        rows += [columns[0][j], columns[1][j], columns[2][j], offset[j]]
    return rows + [0, 0, 0, 1]


def expected(path):
    with contextlib.redirect_stdout(io.StringIO()):
        scene = Scenario(str(path))
    for k in range(scene.n_frames()):
        line = []
        for known in (False, True):
            # A part without drifts keeps its first system, so the scenario is read anew.
            with contextlib.redirect_stdout(io.StringIO()):
                scene = Scenario(str(path))
            scene.set_frame(k, reconstruction=known)
            line += views_of(scene, (0.5, 0.4))
            if not known:
                angle = math.radians(scene.current_stage_angle())
                poses = [x for one in scene.samples
                         for x in pose_of(one, scene.stage.coordinate_system, (0.5, 0.75, 1.25))]
        yield line + [angle] + poses


def main(program):
    worst = 0
    with tempfile.TemporaryDirectory() as folder:
        write_box(Path(folder) / "box.stl")
        for name, case in CASES.items():
            path = Path(folder) / "case.json"
            path.write_text(json.dumps(case))
            ours = subprocess.run([program, path], check=True, capture_output=True, text=True).stdout
            lines = [[float(x) for x in line.split()] for line in ours.splitlines()]
            theirs = list(expected(path))
            assert len(lines) == len(theirs), (name, len(lines))
            for k, (a, b) in enumerate(zip(lines, theirs)):
                assert len(a) == len(b), (name, k, len(a), len(b))
                difference = max(abs(x - y) for x, y in zip(a, b))
                where = max(range(len(a)), key=lambda i: abs(a[i] - b[i]))
                assert difference < TOLERANCE_MM, f"{name}, projection {k}: number {where}: {a[where]} for {b[where]}"
                worst = max(worst, difference)
            print(f"{name}: {len(lines)} projections agree")
    print(f"largest difference {worst:.2g}")


if __name__ == "__main__":
    main(sys.argv[1])
