/* The sums of pixels of gradient.cl for processors, from the loops of draw.clh (spread.clh). */

static void skg_draw_tiny(const skg_target *target, const skg_batch *batch) {
    for (int k = 0; k < batch->count; k += SKG_WIDE) {
        skg_tiny tiny;
        if (!skg_take_tiny(target, batch, k, &tiny)) continue;
        const skg_realv first = SKG_LOAD_V(realv, batch->slope + k), scale = SKG_LOAD_V(realv, batch->scale + k);
        const skg_realv across = SKG_LOAD_V(realv, batch->across + k), down = SKG_LOAD_V(realv, batch->down + k);
        const skg_realv slowest = SKG_LOAD_V(realv, batch->slowest + k), fastest = SKG_LOAD_V(realv, batch->fastest + k);
        for (int step = 0; step < 4; step++) {
            skg_tiny_hits hits;
            if (!skg_hit_tiny(target, batch, k, &tiny, step, &hits)) continue;
            const skg_realv slope = first + fma(across, (skg_realv)(step & 1), down * (skg_realv)(step >> 1));
            const skg_realv worth = hits.worth * scale * skg_within(slope, slowest, fastest);
            const skg_longv value = skg_integers_v(hits.inside ? worth : (skg_realv)(0)); /* some lanes may have no face */
            const long *values = (const long *)&value;
            for (int lane = 0; lane < SKG_WIDE; lane++)
                if (values[lane])
                    target->moments[tiny.place[lane] - batch->own_plane[k + lane] + hits.offset] += values[lane];
        }
    }
}

/* Draws every `step`-th run of triangles of the parts that move. */
SKG_APART void skg_spread_triangles(const skg_gradient_args *args, __global const int *corners,
                                    __global const skg_real4 *projected, __global const skg_part_entry *parts,
                                    __global const int *blocks, __global const skg_contribution *contributions,
                                    __global const skg_real *weights, __global const skg_real *scales,
                                    __global const skg_real *face_slopes, __global uchar *lines, __global long *sums, int run,
                                    int step) {
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
    target.face_slopes = face_slopes;
    target.lines = lines;
    target.parts_count = args->layout.parts;
    target.triangles = args->layout.triangles;
    target.moments = sums;
    skg_batch batch;
    skg_begin(&batch);
    for (int part = 0; part < args->layout.parts; part++) {
        skg_range range;
        if (scales[part] == 0) continue;
        skg_range_of(parts, part, &range);
        if (range.contributions == 0) continue;
        const int claim = args->layout.claim, first = parts[part].first_triangle;
        for (int triangle = first + run * claim; triangle < range.end; triangle += step * claim)
            skg_submit(&target, &batch, &range, triangle, min(triangle + claim, range.end));
    }
    skg_flush(&target, &batch);
}

/* As skg_gradient_faces with SKG_FORWARD, without priorities. Each work-item has its own sums, which it zeroes.
 *
 * lines  as of skg_gradient_faces
 * sums   [work-items][plane and what stands behind it] in the layout of weights */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_derivative_batches(skg_gradient_args args, __global const int *corners, __global const skg_real4 *projected,
                       __global const skg_part_entry *parts, __global const int *blocks,
                       __global const skg_contribution *contributions, __global const skg_real *weights,
                       __global const skg_real *scales, __global const skg_real *face_slopes, __global uchar *lines,
                       __global long *sums) {
    const long size = args.plane + SKG_SPARE_ROWS * args.stride + SKG_SPARE_COLUMNS;
    __global long *own = sums + (long)get_global_id(0) * size;
    for (long k = 0; k < size; k++) own[k] = 0;
    skg_spread_triangles(&args, corners, projected, parts, blocks, contributions, weights, scales, face_slopes, lines, own,
                         (int)get_global_id(0), (int)get_global_size(0));
}
