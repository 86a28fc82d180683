/* Projects every vertex of every part: x, y in pixels relative to the part's pixel, z = r / t, t. */

/* Rows of this little height are none: then no slope of an edge overflows. */
#define SKG_FLAT 0x1p-40f

__kernel void skg_project(skg_frame_args frame, __global const skg_part_entry *parts, __global const int *blocks,
                          __global const skg_real *vertices, __global skg_real4 *projected, __global int *bad_vertex) {
    const int number = (int)get_global_id(0);
    if (number >= frame.vertices) return;
    __global const skg_part_entry *p = &parts[skg_part_of_vertex(parts, blocks, number)];
    __global const skg_real *v = vertices + 3 * (p->mesh_vertex + number - p->first_vertex);
    const skg_real x = v[0], y = v[1], z = v[2];
    const skg_real r = p->offset_r + fma(p->row2[0], x, fma(p->row2[1], y, p->row2[2] * z));
    const skg_real across = p->offset_x + fma(p->row0[0], x, fma(p->row0[1], y, p->row0[2] * z));
    const skg_real down = p->offset_y + fma(p->row1[0], x, fma(p->row1[1], y, p->row1[2] * z));
    const skg_real t = p->reference + r;
#if SKG_PARALLEL
    skg_real4 out = (skg_real4)(p->anchor_x + across, p->anchor_y + down, r, t);
#else
    skg_real4 out = (skg_real4)(p->anchor_x + across / t, p->anchor_y + down / t, r / t, t);
#endif
    if (fabs(out.y) < (skg_real)SKG_FLAT) out.y = 0;
    /* Not finite: told, and out of the way. 0 * x is 0 for finite x only. */
    if (!(0 * (x + y + z) == 0) || !(0 * (across + down + r) == 0)) {
        atomic_min(bad_vertex, number);
        out = (skg_real4)(0, 0, 0, 1);
    }
    projected[number] = out;
}
