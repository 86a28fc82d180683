/* Strategy `copies`: each work-group (one work-item, wide vectors) has a private copy of the whole detector and claims runs
 * of triangles until none are left. used[copy]: 1 if the copy has been zeroed and counts, SKG_TO_ZERO if it counts even without
 * a triangle; used[copies]: the triangle that the next claim begins with; then the extents (skg_shared.h). */

SKG_APART void skg_draw_copy(int copy, const skg_raster_layout *layout, __global const int *corners,
                             __global const skg_real4 *projected, __global const skg_part_entry *parts,
                             __global const skg_contribution *contributions, __global const int *blocks,
                             __global skg_sum *copies, __global int *used) {
    const int size = layout->planes * layout->plane;
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
    if (used[copy] == SKG_TO_ZERO) {
        skg_zero(&target, used + SKG_EXTENT(layout->copies, 0), layout->planes, 0, layout->rows);
        used[copy] = 1;
    }
    for (;;) {
        const int triangle = atomic_add(&used[layout->copies], layout->claim);
        if (triangle >= layout->triangles) break;
        const int end = min(triangle + layout->claim, layout->triangles);
        if (!used[copy]) {
            skg_zero(&target, used + SKG_EXTENT(layout->copies, 0), layout->planes, 0, layout->rows);
            used[copy] = 1;
        }
        skg_draw_triangles(&target, &batch, blocks, triangle, end);
    }
    skg_flush(&target, &batch);
}

__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void
skg_raster_copies(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                  __global const skg_part_entry *parts, __global const skg_contribution *contributions, __global const int *blocks,
                  __global skg_sum *copies, __global int *used) {
    skg_draw_copy((int)get_group_id(0), &layout, corners, projected, parts, contributions, blocks, copies, used);
}
