/* Several passes of a frame, or of frames, strategy `copies`: passes differ in their tables of parts and contributions alone. Each
 * work-group (one work-item, wide vectors) claims whole passes until none are left: it projects the vertices into memory of its own, and
 * adds all triangles up in the only copy of the pass's sums. used[0]: all planes; used[1]: the pass that is claimed next; then the extents
 * of the planes of all passes (skg_shared.h). */

/* Projects the vertices of SKG_SIDE passes. bad_vertex: of each of them. Of several, x of a vertex in all passes stand side by side, then
 * y, z and t; behind those of all vertices there is room for a run of each pass. */
static void skg_project_passes(const skg_raster_layout *layout, __global const skg_part_entry *const *parts,
                               __global const int *blocks, __global const skg_real *vertices,
                               __global skg_real4 *projected, __global int *const *bad_vertex) {
    for (int first = 0; first < layout->vertices; first += SKG_RUN) {
#if SKG_SIDE > 1
        __global skg_real4 *run = projected + SKG_SIDE * layout->vertices, *to = projected + SKG_SIDE * first;
        for (int side = 0; side < SKG_SIDE; side++)
            skg_project_run(first, layout, parts[side], blocks, vertices, run + side * SKG_RUN, bad_vertex[side]);
        for (int k = 0; k < min(SKG_RUN, layout->vertices - first); k++) {
            const skg_real4 p = run[k], q = run[k + SKG_RUN], r = run[k + 2 * SKG_RUN], s = run[k + 3 * SKG_RUN];
            to[4 * k] = (skg_real4)(p.x, q.x, r.x, s.x);
            to[4 * k + 1] = (skg_real4)(p.y, q.y, r.y, s.y);
            to[4 * k + 2] = (skg_real4)(p.z, q.z, r.z, s.z);
            to[4 * k + 3] = (skg_real4)(p.w, q.w, r.w, s.w);
        }
#else
        skg_project_run(first, layout, parts[0], blocks, vertices, projected + first, bad_vertex[0]);
#endif
    }
}

SKG_APART void skg_draw_passes(const skg_raster_layout *layout, __global const int *corners,
                               __global const skg_real *vertices, __global const skg_part_entry *tables,
                               __global const skg_contribution *contributions, __global const int *blocks,
                               __global const int *vertex_blocks, __global skg_real4 *projected, __global skg_sum *sums,
                               __global int *used, __global int *bad_vertex, int each) {
    const int planes = layout->planes, passes = layout->passes;
    skg_target target;
    target.stride = layout->stride;
    target.plane = layout->plane;
    target.columns = layout->columns;
    target.first_row = 0;
    target.last_row = layout->rows;
    target.corners = corners;
    target.projected = projected;
    target.contributions = contributions;
#if SKG_SIDE > 1
    target.image_size = planes * layout->plane;
#endif
    skg_batch batch;
    skg_begin(&batch);
    for (;;) {
        const int first = SKG_SIDE * atomic_inc(&used[layout->copies]);
        if (first >= passes) break;
        __global const skg_part_entry *parts[SKG_SIDE];
        __global int *bad[SKG_SIDE];
        for (int side = 0; side < SKG_SIDE; side++) {
            const int pass = min(first + side, passes - 1);
            parts[side] = tables + pass * layout->parts;
            bad[side] = bad_vertex + pass * each;
            target.image = sums + (size_t)((first + side) * planes) * (size_t)layout->plane;
            skg_zero(&target, used + SKG_EXTENT(layout->copies, pass * planes), planes, 0, layout->rows);
        }
        skg_project_passes(layout, parts, vertex_blocks, vertices, projected, bad);
        target.image = sums + (size_t)(first * planes) * (size_t)layout->plane;
        target.parts = parts[0];
#if SKG_SIDE > 1
        for (int side = 0; side < SKG_SIDE; side++) target.tables[side] = parts[side];
#endif
        skg_draw_triangles(&target, &batch, blocks, 0, layout->triangles);
        skg_flush(&target, &batch);
    }
}

/* tables: [passes][parts]; projected: [work-groups][vertices + SKG_RUN][SKG_SIDE]; sums: [passes][planes], passes a multiple of SKG_SIDE;
 * bad_vertex: of each frame of a job; frame: that of the first pass; each: 1: every pass is a frame; 0: all are of that one */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_raster_passes(skg_raster_layout layout, __global const int *corners, __global const skg_real *vertices,
                  __global const skg_part_entry *tables, __global const skg_contribution *contributions,
                  __global const int *blocks, __global const int *vertex_blocks, __global skg_real4 *projected,
                  __global skg_sum *sums, __global int *used, __global int *bad_vertex, int frame, int each) {
    skg_draw_passes(&layout, corners, vertices, tables, contributions, blocks, vertex_blocks,
                    projected + get_group_id(0) * SKG_SIDE * (size_t)(layout.vertices + SKG_RUN), sums, used,
                    bad_vertex + frame, each);
}
