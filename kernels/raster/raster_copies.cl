/* Strategy `copies`: each work-group (one work-item, wide vectors) has a private copy of the whole detector. Triangles are divided
 * into a segment for each worker, who claims runs of its own until none are left, and then of the others'. So workers draw
 * different parts, and a copy is zeroed and read only in the planes of the parts that were drawn there: used[copy] is the set of
 * these planes; used[copies + segment]: the triangle of the segment that the next claim begins with; then the extents
 * (skg_shared.h). */

/* Zeroes the planes of the parts of triangles `triangle` to `end` - 1, but those of the set, and adds them to it. */
static void skg_zero_new(const skg_target *target, const skg_raster_layout *layout, __global const int *blocks,
                         __global const int *extents, int triangle, int end, uint *set) {
    int part = skg_part_of_triangle(target->parts, blocks, triangle);
    for (; part < layout->parts && target->parts[part].first_triangle < end; part++) {
        const int first = target->parts[part].first_contribution;
        for (int w = first; w < first + target->parts[part].contributions; w++) {
            const int plane = target->contributions[w].plane;
            if (SKG_COUNTS(*set, plane)) continue;
            *set |= SKG_PLANE_BIT(plane);
            for (int p = plane & 31; p < layout->planes; p += 32)
                skg_zero_plane(target, extents, p, 0, layout->rows);
        }
    }
}

SKG_APART void skg_draw_copy(int copy, const skg_raster_layout *layout, __global const int *corners,
                             __global const skg_real4 *projected, __global const skg_part_entry *parts,
                             __global const skg_contribution *contributions, __global const int *blocks,
                             __global skg_sum *copies, __global int *used) {
    const int size = layout->planes * layout->plane;
    __global const int *extents = used + SKG_EXTENT(layout->copies, 0);
    uint set = 0;
    skg_target target;
    target.image = copies + (size_t)copy * (size_t)size;
    target.stride = layout->stride;
    target.plane = layout->plane;
    target.columns = layout->columns;
    target.first_row = 0;
    target.last_row = layout->rows;
    target.corners = corners;
    target.projected = projected;
    target.parts = parts;
    target.contributions = contributions;
    skg_batch batch;
    skg_begin(&batch);
    if (copy == 0 && layout->whole_first) {
        skg_zero(&target, extents, layout->planes, 0, layout->rows);
        set = ~0u;
    }
    const int segments = max(layout->copies - 1, 1), length = (layout->triangles + segments - 1) / segments;
    for (int k = 0; k < segments; k++) {
        const int segment = (copy + k) % segments, end = min((segment + 1) * length, layout->triangles);
        for (;;) {
            const int triangle = segment * length + atomic_add(&used[layout->copies + segment], layout->claim);
            if (triangle >= end) break;
            const int last = min(triangle + layout->claim, end);
            skg_zero_new(&target, layout, blocks, extents, triangle, last, &set);
            skg_draw_triangles(&target, &batch, blocks, triangle, last);
        }
    }
    skg_flush(&target, &batch);
    used[copy] = (int)set;
}

__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_raster_copies(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                  __global const skg_part_entry *parts, __global const skg_contribution *contributions, __global const int *blocks,
                  __global skg_sum *copies, __global int *used) {
    skg_draw_copy((int)get_group_id(0), &layout, corners, projected, parts, contributions, blocks, copies, used);
}
