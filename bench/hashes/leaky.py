"""leaky.py FROM.ply TO.stl|obj|ply EVERY: a mesh of `skiagraph thorax` as text, without every EVERY-th triangle."""
import struct
import sys

source, target, every = sys.argv[1], sys.argv[2], int(sys.argv[3])
header, data = open(source, "rb").read().split(b"end_header\n", 1)
counts = [int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")]
positions = [struct.unpack_from("<3d", data, 24 * i) for i in range(counts[0])]
triangles = [struct.unpack_from("<3i", data, 24 * counts[0] + 13 * i + 1) for i in range(counts[1])]
kept = [triangle for i, triangle in enumerate(triangles) if i % every]

with open(target, "w") as out:
    if target.endswith(".stl"):
        out.write("solid leaky\n")
        for triangle in kept:
            corners = "".join("vertex %r %r %r\n" % positions[i] for i in triangle)
            out.write("facet normal 0 0 0\nouter loop\n" + corners + "endloop\nendfacet\n")
        out.write("endsolid leaky\n")
    else:
        is_obj = target.endswith(".obj")
        if not is_obj:
            out.write("ply\nformat ascii 1.0\nelement vertex %d\n" % counts[0])
            out.write("".join("property double %s\n" % axis for axis in "xyz"))
            out.write("element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(kept))
        for position in positions:
            out.write(("v " if is_obj else "") + "%r %r %r\n" % position)
        for a, b, c in kept:
            out.write("f %d %d %d\n" % (a + 1, b + 1, c + 1) if is_obj else "3 %d %d %d\n" % (a, b, c))
