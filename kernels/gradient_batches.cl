/* The gather of gradient.cl for processors: the same moments, from the loops of draw.clh (gather.clh). */

#if SKG_AROUND
/* The same by what stands around the part. */
static skg_real skg_around_lane(const skg_target *target, const skg_batch *batch, int k, int place) {
    skg_real weight = 0;
    for (int w = batch->first_around[k]; w < batch->last_around[k]; w++) {
        __global const skg_contribution *contribution = &target->around[w];
        weight = fma(contribution->weight,
                     target->weights[place - batch->own_plane[k] + contribution->plane * target->plane], weight);
    }
    return weight;
}
#endif

/* Writes the moments of the tiny ones among faces k to k + SKG_WIDE - 1, one a lane. */
static void skg_put_tiny(const skg_target *target, const skg_batch *batch, int k, skg_realv sum, skg_realv columns, skg_realv rows,
                         skg_realv around) {
    const skg_realv scale = SKG_LOAD_V(realv, batch->scale + k);
    skg_real sums[SKG_WIDE], of_columns[SKG_WIDE], of_rows[SKG_WIDE], arounds[SKG_WIDE];
    SKG_STORE_V(realv, sum * scale, sums);
    SKG_STORE_V(realv, columns * scale, of_columns);
    SKG_STORE_V(realv, rows * scale, of_rows);
#if SKG_AROUND
    around *= SKG_LOAD_V(realv, batch->around_scale + k);
#endif
    SKG_STORE_V(realv, around, arounds);
    for (int lane = 0; lane < SKG_WIDE; lane++) {
        if (batch->class[k + lane] != SKG_TINY) continue;
        const SKG_REALS(4) all = {sums[lane], of_columns[lane], of_rows[lane], arounds[lane]};
        skg_put_moments(target, batch, k + lane, convert_long4(all));
    }
}

static void skg_draw_tiny(const skg_target *target, const skg_batch *batch) {
    const skg_realv zero = 0;
    for (int k = 0; k < batch->count; k += SKG_WIDE) {
        skg_tiny tiny;
        if (!skg_take_tiny(target, batch, k, &tiny)) continue;
        skg_realv sum = zero, columns = zero, rows = zero, around = zero;
        for (int step = 0; step < 4; step++) {
            skg_tiny_hits hits;
            if (!skg_hit_tiny(target, batch, k, &tiny, step, &hits)) continue;
            sum += hits.worth;
            columns += step & 1 ? hits.worth : zero;
            rows += step >> 1 ? hits.worth : zero;
#if SKG_AROUND
            int inside[SKG_WIDE];
            skg_real weights[SKG_WIDE];
            SKG_STORE_V(intv, SKG_TO_INT_V(hits.inside), inside);
            for (int lane = 0; lane < SKG_WIDE; lane++)
                weights[lane] = inside[lane] ? skg_around_lane(target, batch, k + lane, tiny.place[lane] + hits.offset) : 0;
            around += hits.inside ? SKG_LOAD_V(realv, weights) * hits.factor * hits.q : zero;
#endif
        }
        skg_put_tiny(target, batch, k, sum, columns, rows, around);
    }
}

SKG_APART void skg_gather_triangles(const skg_gradient_args *args, __global const int *corners,
                                    __global const skg_real4 *projected, __global const skg_part_entry *parts,
                                    __global const int *blocks, __global const skg_contribution *contributions,
                                    __global const skg_real *weights, __global const skg_real *scales,
                                    __global const int *first_around, __global const skg_contribution *around,
                                    __global long *moments, int triangle, int end) {
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
    target.parts_count = args->layout.parts;
    target.triangles = args->layout.triangles;
    target.moments = moments;
    skg_batch batch;
    skg_begin(&batch);
    skg_draw_triangles(&target, &batch, blocks, triangle, end);
    skg_flush(&target, &batch);
}

/* As skg_gradient_faces without priorities: each work-item takes args.layout.claim triangles. */
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_gradient_batches(skg_gradient_args args, __global const int *corners, __global const skg_real4 *projected,
                     __global const skg_part_entry *parts, __global const int *blocks,
                     __global const skg_contribution *contributions, __global const skg_real *weights,
                     __global const skg_real *scales, __global const int *first_around,
                     __global const skg_contribution *around, __global long *moments) {
    const int triangle = (int)get_global_id(0) * args.layout.claim;
    skg_gather_triangles(&args, corners, projected, parts, blocks, contributions, weights, scales, first_around, around, moments, triangle,
                         min(triangle + args.layout.claim, args.layout.triangles));
}
