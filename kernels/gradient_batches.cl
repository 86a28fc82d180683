/* The gather of gradient.cl for processors: the same moments, from the loops of draw.clh (gather.clh). */

#if SKG_LISTED
/* What a hit of one lane is weighed by. */
static skg_real skg_weight_of_lane(const skg_target *target, const skg_batch *batch, int k, int place) {
    skg_real weight = 0;
    for (int w = batch->first_contribution[k]; w < batch->last_contribution[k]; w++) {
        __global const skg_contribution *contribution = &target->contributions[w];
        weight = fma(contribution->weight, target->weights[place + contribution->plane * target->plane], weight);
    }
    return weight;
}
#endif

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

/* Boxes of at most 2 by 2 pixels, one triangle per lane. */
static void skg_draw_tiny(const skg_target *target, const skg_batch *batch) {
    for (int k = 0; k < batch->count; k += SKG_WIDE) {
        const skg_intv tiny = SKG_LOAD_V(intv, batch->class + k) == SKG_TINY;
        if (!skg_any(tiny)) continue;
        skg_face_v f;
        skg_lanes(batch, k, &f);
        const skg_intv i0 = SKG_LOAD_V(intv, batch->i0 + k), j0 = SKG_LOAD_V(intv, batch->j0 + k);
        const skg_realv right = SKG_TO_REAL_V(SKG_LOAD_V(intv, batch->i1 + k));
        const skg_realv bottom = SKG_TO_REAL_V(tiny ? SKG_LOAD_V(intv, batch->j1 + k) : j0);
        const skg_realv limit = SKG_LOAD_V(realv, batch->limit + k);
        int place[SKG_WIDE];
        SKG_STORE_V(intv, tiny ? SKG_LOAD_V(intv, batch->origin + k) + j0 * target->stride + i0 : 0, place);
        skg_realv sum = (skg_realv)(0), columns = (skg_realv)(0), rows = (skg_realv)(0), around = (skg_realv)(0);
        for (int step = 0; step < 4; step++) {
            const skg_realv i = SKG_TO_REAL_V(i0 + (step & 1)), j = SKG_TO_REAL_V(j0 + (step >> 1));
            skg_line_v line;
            skg_row_v(&f, j, &line);
            const skg_maskv inside = skg_hit_v(&line, i) & (i < right) & (j < bottom);
            if (!skg_any(SKG_TO_INT_V(inside))) continue;
            const skg_realv q = skg_depth_v(&f, &line, i), deep = 1 + q, one = 1;
            const skg_realv sign = skg_negative_v(&f, &line) ? -one : one;
            skg_real weights[SKG_WIDE];
            const int offset = (step & 1) + (step >> 1) * target->stride;
#if SKG_LISTED || SKG_AROUND
            int hits[SKG_WIDE];
            SKG_STORE_V(intv, SKG_TO_INT_V(inside), hits);
#endif
            for (int lane = 0; lane < SKG_WIDE; lane++) {
#if SKG_LISTED
                weights[lane] = hits[lane] ? skg_weight_of_lane(target, batch, k + lane, place[lane] + offset) : 0;
#else
                weights[lane] = target->weights[place[lane] + offset]; /* of lanes that are not hit whatever stands there */
#endif
            }
            skg_realv value = SKG_LOAD_V(realv, weights);
#if !SKG_LISTED
            const skg_realv factor = sign * SKG_LOAD_V(realv, batch->weight + k);
#else
            const skg_realv factor = sign;
#endif
            value *= factor;
            if (!SKG_PARALLEL) value *= deep * deep;
            const skg_realv zero = 0, worth = inside & (q < limit) ? value : zero;
            sum += worth;
            columns += step & 1 ? worth : zero;
            rows += step >> 1 ? worth : zero;
#if SKG_AROUND
            for (int lane = 0; lane < SKG_WIDE; lane++)
                weights[lane] = hits[lane] ? skg_around_lane(target, batch, k + lane, place[lane] + offset) : 0;
            around += inside ? SKG_LOAD_V(realv, weights) * factor * q : zero;
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
