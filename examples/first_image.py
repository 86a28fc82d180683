"""A sphere of soft tissue, its image and its path lengths, from Python through ctypes alone.

    python3 first_image.py [path of libskiagraph.so.0]
"""
import ctypes as c
import sys

skg = c.CDLL(sys.argv[1] if len(sys.argv) > 1 else "libskiagraph.so.0")
skg.skg_last_error.restype = c.c_char_p


# Structs, field by field: their layout is in lib/bindings/interface.json.
class Part(c.Structure):
    _fields_ = [("size", c.c_int32), ("priority", c.c_int32), ("inside", c.c_int64), ("mesh", c.c_void_p),
                ("material", c.c_void_p), ("label", c.c_char_p), ("pose", c.c_double * 16)]


class View(c.Structure):
    _fields_ = [("size", c.c_int32), ("projection", c.c_int32), ("columns", c.c_int64), ("rows", c.c_int64),
                ("source", c.c_double * 3), ("centre", c.c_double * 3), ("column_step", c.c_double * 3),
                ("row_step", c.c_double * 3)]


class Output(c.Structure):
    _fields_ = [("size", c.c_int32), ("type", c.c_int32), ("data", c.c_void_p), ("row_stride", c.c_int64),
                ("channel_stride", c.c_int64), ("frame_stride", c.c_int64), ("kind", c.c_int32), ("lengths", c.c_int32),
                ("part", c.c_int64), ("buffer", c.c_void_p), ("offset", c.c_int64)]


def check(status):
    if status < 0:  # SKG_STALE and SKG_RANGE are positive, and no failures
        raise RuntimeError(skg.skg_last_error().decode())


def make(function, *arguments):
    """Calls a function whose last argument is the address of a new handle."""
    handle = c.c_void_p()
    check(getattr(skg, function)(*arguments, c.byref(handle)))
    return handle


def prepared(struct, name):
    """A struct with the library's defaults; the library writes no more than the size that we give."""
    made = struct()
    getattr(skg, name + "_init_sized")(c.byref(made), c.sizeof(made))
    return made


SIDE = 128
context = make("skg_context_create", None)
mesh = make("skg_mesh_create_sphere", c.c_double(40), c.c_int64(128))
tissue = make("skg_material_create_mu", b"soft tissue at 80 keV", c.c_double(0.1932))
beam = make("skg_spectrum_create_mono", c.c_double(80), c.c_double(1000))
scene = make("skg_scene_create", context)

part = prepared(Part, "skg_part")
part.mesh, part.material, part.label = mesh, tissue, b"ball"
number = c.c_int64()
check(skg.skg_scene_part_add(scene, c.byref(part), c.byref(number)))

view = prepared(View, "skg_view")
view.columns = view.rows = SIDE
view.source[2], view.centre[2] = -1000, 200
view.column_step[0] = view.row_step[1] = 1
plan = make("skg_plan_create", context, scene, c.byref(view), beam, None)

image = (c.c_float * (SIDE * SIDE))()
output = prepared(Output, "skg_output")
output.data = c.addressof(image)
check(skg.skg_plan_image(plan, c.byref(output)))

lengths = (c.c_double * (SIDE * SIDE))()
output.type, output.data, output.kind, output.part = 1, c.addressof(lengths), 1, number  # SKG_OUTPUT_LENGTHS
job = make("skg_plan_submit", plan, c.c_int64(1), None, c.c_int64(1), c.byref(output))
check(skg.skg_job_wait(c.byref(job)))

middle = SIDE // 2 * SIDE + SIDE // 2
print(f"energy {image[middle]:.1f} keV of {image[0]:.1f} keV, path length {lengths[middle]:.3f} mm")
for release, handle in (("plan", plan), ("scene", scene), ("spectrum", beam), ("material", tissue), ("mesh", mesh),
                        ("context", context)):
    getattr(skg, f"skg_{release}_release")(c.byref(handle))
if not (79 < lengths[middle] <= 80 and abs(image[0] - 80000) < 0.1):
    sys.exit("that is not the ball")
