/* The gather of gradient.cl for processors: the same moments, from the loops of draw.clh (gather.clh). */

/* What a hit of one lane is weighed by. */
static skg_real skg_weight_of_lane(const skg_target *target, const skg_batch *batch, int k, int place) {
#if !SKG_LISTED
    (void)batch, (void)k;
    return target->weights[place];
#else
    skg_real weight = 0;
    for (int w = batch->first_contribution[k]; w < batch->last_contribution[k]; w++) {
        __global const skg_contribution *contribution = &target->contributions[w];
        weight = fma(contribution->weight, target->weights[place + contribution->plane * target->plane], weight);
    }
    return weight;
#endif
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
        const skg_realv scale = SKG_LOAD_V(realv, batch->scale + k), highest = SKG_LOAD_V(realv, batch->end + k);
        const skg_realv end = SKG_PARALLEL ? highest : highest / (1 - highest);
        int place[SKG_WIDE];
        SKG_STORE_V(intv, tiny ? SKG_LOAD_V(intv, batch->origin + k) + j0 * target->stride + i0 : 0, place);
        skg_longv sum = (skg_longv)(0), columns = (skg_longv)(0), rows = (skg_longv)(0);
        for (int step = 0; step < 4; step++) {
            const skg_realv i = SKG_TO_REAL_V(i0 + (step & 1)), j = SKG_TO_REAL_V(j0 + (step >> 1));
            skg_line_v line;
            skg_row_v(&f, j, &line);
            const skg_maskv inside = skg_hit_v(&line, i) & (i < right) & (j < bottom);
            if (!skg_any(SKG_TO_INT_V(inside))) continue;
            const skg_realv q = skg_depth_v(&f, &line, i), deep = 1 + q;
            int hits[SKG_WIDE];
            skg_real weights[SKG_WIDE];
            SKG_STORE_V(intv, SKG_TO_INT_V(inside), hits);
            for (int lane = 0; lane < SKG_WIDE; lane++)
                weights[lane] = hits[lane] ? skg_weight_of_lane(target, batch, k + lane,
                                                                place[lane] + (step & 1) + (step >> 1) * target->stride)
                                           : 0;
            skg_realv value = SKG_LOAD_V(realv, weights);
#if !SKG_LISTED
            value *= SKG_LOAD_V(realv, batch->weight + k);
#endif
            value = skg_negative_v(&f, &line) ? -value : value;
            if (!SKG_PARALLEL) value *= deep * deep;
            const skg_longv worth = SKG_TO_LONG_V(inside & (q < end) ? value * scale : (skg_realv)(0));
            sum += worth;
            columns += step & 1 ? worth : (skg_longv)(0);
            rows += step >> 1 ? worth : (skg_longv)(0);
        }
        for (int lane = 0; lane < SKG_WIDE; lane++) {
            if (batch->class[k + lane] != SKG_TINY) continue;
            __global long *moments = target->moments + 3 * (long)batch->face[k + lane];
            const long all = ((const long *)&sum)[lane];
            moments[0] = all;
            moments[1] = ((const long *)&columns)[lane] + all * batch->i0[k + lane];
            moments[2] = ((const long *)&rows)[lane] + all * batch->j0[k + lane];
        }
    }
}

SKG_APART void skg_gather_triangles(const skg_gradient_args *args, __global const int *corners,
                                    __global const skg_real4 *projected, __global const skg_part_entry *parts,
                                    __global const int *blocks, __global const skg_contribution *contributions,
                                    __global const skg_real *weights, __global const skg_real *scales,
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
                     __global const skg_real *scales, __global long *moments) {
    const int triangle = (int)get_global_id(0) * args.layout.claim;
    skg_gather_triangles(&args, corners, projected, parts, blocks, contributions, weights, scales, moments, triangle,
                         min(triangle + args.layout.claim, args.layout.triangles));
}
