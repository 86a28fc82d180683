/* Strategy `atomics`: each work-item draws a triangle into the only image. Boxes of many pixels are put into a queue as
 * strips of rows; a second launch draws each strip with a work-group. */

/* The most pixels of a box that one work-item draws, and of a strip that one work-group draws. */
#define SKG_LARGE 512

static int skg_strip_rows(const skg_box *box) {
    return max(1, SKG_LARGE / (box->i1 - box->i0));
}

/* queue: the number of strips, an unused int, then pairs (triangle, strip). Strips that do not fit into the queue are drawn
 * here. */
__kernel void skg_raster_atomics(skg_raster_layout layout, __global const int *corners,
                                 __global const skg_real4 *projected, __global const skg_part_entry *parts,
                                 __global const skg_contribution *contributions, __global const int *blocks,
                                 __global skg_sum *sums, __global int *queue) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= layout.triangles) return;
    skg_range range;
    skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
    skg_real4 a, b, c;
    skg_box box;
    skg_corners(corners, projected, &range, triangle, &a, &b, &c);
    if (range.contributions == 0 || !skg_bounds(&range, a, b, c, skg_window(&range, 0, 0, layout.columns, layout.rows), &box)) return;
    if ((box.i1 - box.i0) * (box.j1 - box.j0) > SKG_LARGE) {
        const int rows = skg_strip_rows(&box), strips = (box.j1 - box.j0 + rows - 1) / rows;
        const int first = atomic_add(&queue[0], strips), kept = clamp(layout.queue - first, 0, strips);
        for (int s = 0; s < kept; s++) {
            queue[2 * (first + s) + 2] = triangle;
            queue[2 * (first + s) + 3] = s;
        }
        box.j0 += kept * rows;
    }
    skg_face f;
    skg_face_of(&range, a, b, c, &f);
    skg_draw_global(sums, layout.stride, layout.plane, range.pixel_j * layout.stride + range.pixel_i, contributions, &range, &f,
                    &box);
}

__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void
skg_raster_queue(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                 __global const skg_part_entry *parts, __global const skg_contribution *contributions, __global const int *blocks,
                 __global skg_sum *sums, __global const int *queue) {
    const int entries = min(queue[0], layout.queue);
    for (int e = (int)get_group_id(0); e < entries; e += (int)get_num_groups(0)) {
        const int triangle = queue[2 * e + 2], strip = queue[2 * e + 3];
        skg_range range;
        skg_range_of(parts, skg_part_of_triangle(parts, blocks, triangle), &range);
        skg_real4 a, b, c;
        skg_box box;
        skg_corners(corners, projected, &range, triangle, &a, &b, &c);
        if (!skg_bounds(&range, a, b, c, skg_window(&range, 0, 0, layout.columns, layout.rows), &box)) continue;
        const int rows = skg_strip_rows(&box), columns = box.i1 - box.i0;
        box.j0 += strip * rows;
        box.j1 = min(box.j1, box.j0 + rows);
        skg_face f;
        skg_face_of(&range, a, b, c, &f);
        const int pixels = columns * (box.j1 - box.j0);
        for (int p = (int)get_local_id(0); p < pixels; p += 64) {
            const int row = box.j0 + p / columns, column = box.i0 + p % columns;
            skg_line line;
            skg_row(&f, (skg_real)row, &line);
            if (skg_hit(&line, (skg_real)column))
                skg_deposit_global(sums + ((range.pixel_j + row) * layout.stride + range.pixel_i + column),
                                   layout.plane, contributions, &range, skg_depth(&f, &line, (skg_real)column),
                                   skg_negative(&f, &line) ? -1 : 1);
        }
    }
}
