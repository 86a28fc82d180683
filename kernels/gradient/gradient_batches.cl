/* The gather of gradient.cl for processors, from the loops of draw.clh: the same moments (gather.clh), or sums of pixels (spread.clh). */

#define SKG_BATCHES_PARAMETERS                                                                                  \
    __global const int *corners, __global const skg_real4 *projected, __global const skg_part_entry *parts,      \
        __global const int *blocks, __global const skg_contribution *contributions,                              \
        __global const skg_real *weights, __global const skg_real *scales, __global const int *first_around,     \
        __global const skg_contribution *around, __global const skg_real *face_slopes, __global uchar *lines,    \
        __global long *moments
#define SKG_BATCHES_ARGUMENTS \
    corners, projected, parts, blocks, contributions, weights, scales, first_around, around, face_slopes, lines, moments

/* Draws runs of args->layout.claim triangles: run number `run`; of pixels every `step`-th run of each part that moves. */
SKG_APART void skg_gather_runs(const skg_gradient_args *args, SKG_BATCHES_PARAMETERS, int run, int step) {
    const int claim = args->layout.claim;
    skg_target target;
    target.stride = args->stride;
    target.plane = args->plane;
    target.columns = args->layout.columns;
    target.first_row = 0;
    target.last_row = args->layout.rows;
    target.corners = corners;
    target.projected = projected;
    target.parts = parts;
    target.contributions = contributions;
    target.weights = weights;
    target.scales = scales;
    target.first_around = first_around;
    target.around = around;
    target.face_slopes = face_slopes;
    target.lines = lines;
    target.parts_count = args->layout.parts;
    target.triangles = args->layout.triangles;
    target.moments = moments;
    skg_batch batch;
    skg_begin(&batch);
#if SKG_FORWARD
    for (int part = 0; part < args->layout.parts; part++) {
        skg_range range;
        if (scales[part] == 0) continue;
        skg_range_of(parts, part, &range);
        if (range.contributions == 0) continue;
        for (int triangle = parts[part].first_triangle + run * claim; triangle < range.end; triangle += step * claim)
            skg_submit(&target, &batch, &range, triangle, min(triangle + claim, range.end));
    }
#else
    skg_draw_triangles(&target, &batch, blocks, run * claim, min(run * claim + claim, args->layout.triangles));
#endif
    skg_flush(&target, &batch);
}

/* As skg_gradient_faces without priorities: its arguments, of which either those around or the slopes and lines are NULL.
 *
 * moments  of faces; with SKG_FORWARD [work-items][plane and what stands behind it] in the layout of weights: sums of its own for each
 *          work-item, which zeroes them */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void skg_gradient_batches(skg_gradient_args args, SKG_BATCHES_PARAMETERS) {
#if SKG_FORWARD
    const long size = args.plane + SKG_SPARE_ROWS * args.stride + SKG_SPARE_COLUMNS;
    moments += (long)get_global_id(0) * size;
    for (long k = 0; k < size; k++) moments[k] = 0;
#endif
    skg_gather_runs(&args, SKG_BATCHES_ARGUMENTS, (int)get_global_id(0), (int)get_global_size(0));
}
