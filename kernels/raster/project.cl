/* Projects every vertex of every part to (x, y, z, t): x, y in pixels relative to the part's pixel, z = r / t, t. With SKG_RESTS
 * the rests of x and y stand for t (fine.clh), with SKG_ROW_RESTS that of y, with SKG_CURVED the
 * first row that is not above the vertex. A work-item takes one vertex on a GPU; on a CPU a run, so that compilers can turn
 * the loop over the vertices of a part into vectors. */
#define SKG_RUN (SKG_CPU ? SKG_CPU_RUN : 1)

/* Projects one vertex. *finite: 0 if it is not finite. */
static skg_real4 skg_project_one(skg_real x, skg_real y, skg_real z, const skg_part_entry *p,
                                 __global const skg_real *lines, int *finite) {
    const skg_real r = p->offset_r + fma(p->row2[0], x, fma(p->row2[1], y, p->row2[2] * z));
    const skg_real across = p->offset_x + fma(p->row0[0], x, fma(p->row0[1], y, p->row0[2] * z));
    const skg_real down = p->offset_y + fma(p->row1[0], x, fma(p->row1[1], y, p->row1[2] * z));
    const skg_real t = p->reference + r;
#if SKG_PARALLEL
    const skg_real4 seen = (skg_real4)(p->anchor_x + across, p->anchor_y + down, r, t);
#else
    const skg_real4 seen = (skg_real4)(p->anchor_x + across / t, p->anchor_y + down / t, r / t, t);
#endif
    /* 0 * x is 0 only for finite x. A vertex that is not finite is put where it does no harm. */
    const skg_real zero = 0 * (across + down + r) + 0 * (x + y + z);
    *finite = zero == 0;
#if SKG_CURVED
    skg_real high = fabs(seen.y) < (skg_real)SKG_FLAT ? 0 : seen.y;
    const skg_real last = skg_rank(lines, (skg_real)p->pixel_j, p->shift, &high);
    return *finite ? (skg_real4)(seen.x, high, seen.z, last) : (skg_real4)(0);
#else
    (void)lines;
    const skg_real high = skg_on_row(seen.y, p->shift);
    const skg_real last = SKG_ROW_RESTS ? seen.y - high : SKG_RESTS ? 0 : seen.w;
    return *finite ? (skg_real4)(seen.x, high, seen.z, last) : (skg_real4)(0, 0, 0, SKG_RESTS + SKG_ROW_RESTS == 0);
#endif
}

/* Vertices from this number on. projected: the place of the first of them. */
SKG_APART void skg_project_run(int number, const skg_raster_layout *layout, __global const skg_part_entry *parts,
                               __global const int *blocks, __global const skg_real *vertices,
                               __global skg_real4 *projected, __global int *bad_vertex) {
    const int first = number, end = min(number + SKG_RUN, layout->vertices), all_parts = layout->parts;
    if (number >= end) return;
    int part = skg_part_of_vertex(parts, all_parts, blocks, number);
    while (number < end && part < all_parts) {
        __global const skg_real *lines = SKG_CURVED ? (__global const skg_real *)(parts + part) + parts[part].lines : 0;
        const skg_part_entry p = parts[part++];
        number = max(number, p.first_vertex);
        const int last = min(end, p.first_vertex + p.vertices);
        __global const skg_real *restrict v = vertices + 3 * (p.mesh_vertex + number - p.first_vertex);
        __global skg_real4 *restrict out = projected + (number - first);
        const int count = last - number;
        int all = 1;
#if SKG_RESTS
        for (int k = 0; k < (p.fine ? count : 0); k++) {
            int finite;
            out[k] = skg_project_fine(v + 3 * k, v + 3 * (p.vertices + k), &p, &finite);
            all &= finite;
        }
        for (int k = 0; k < (p.fine ? 0 : count); k++) {
#else
        for (int k = 0; k < count; k++) {
#endif
            int finite;
            out[k] = skg_project_one(v[3 * k], v[3 * k + 1], v[3 * k + 2], &p, lines, &finite);
            all &= finite;
        }
        for (int k = 0; k < count && !all; k++) { /* rare: find which one */
            int finite;
            skg_project_one(v[3 * k], v[3 * k + 1], v[3 * k + 2], &p, lines, &finite);
            if (!finite) atomic_min(bad_vertex, number + k);
        }
        number = max(number, last);
    }
}

/* bad_vertex: of each frame of a job; frame: which one this is. */
__kernel void skg_project(skg_raster_layout layout, __global const skg_part_entry *parts, __global const int *blocks,
                          __global const skg_real *vertices, __global skg_real4 *projected,
                          __global int *bad_vertex, int frame) {
    const int first = SKG_RUN * (int)get_global_id(0);
    skg_project_run(first, &layout, parts, blocks, vertices, projected + first, bad_vertex + frame);
}
