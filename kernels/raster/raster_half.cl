/* Precision `half`, for comparison with Vidal and Villard 2016, sections 3.2.3 and 4.3. The distance from the source to each
 * hit, in metres, is rounded once to binary16; its exact value, a multiple of 2^-24 m, is summed. One work-item per triangle.
 * Planes have no weights: of a contribution only the plane and the sign matter. */

/* metres as a multiple of 2^-24, after rounding to binary16. */
static int skg_half_units(float metres) {
    return convert_int_rte(skg_to_half(metres) * 0x1p24f);
}

static float skg_ray_length(const skg_ray_args *ray, int column, int row) {
    const float i = (float)column - ray->middle_i, j = (float)row - ray->middle_j;
    const float x = fma(ray->column[0], i, fma(ray->row[0], j, ray->centre[0]));
    const float y = fma(ray->column[1], i, fma(ray->row[1], j, ray->centre[1]));
    const float z = fma(ray->column[2], i, fma(ray->row[2], j, ray->centre[2]));
    return sqrt(fma(x, x, fma(y, y, z * z)));
}

__kernel void skg_raster_half(skg_raster_layout layout, __global const int *corners, __global const skg_real4 *projected,
                              __global const skg_part_entry *parts, __global const skg_contribution *contributions,
                              __global const int *blocks, __global skg_sum *sums, skg_ray_args ray) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= layout.triangles) return;
    const int part = skg_part_of_triangle(parts, blocks, triangle);
    const float reference = parts[part].reference;
    skg_range range;
    skg_range_of(parts, part, &range);
    skg_real4 a, b, c;
    skg_box box;
    skg_corners(corners, projected, &range, triangle, &a, &b, &c);
    if (range.contributions == 0 || !skg_bounds(&range, a, b, c, skg_window(&range, 0, 0, layout.columns, layout.rows), &box)) return;
    skg_face f;
    skg_face_of(&range, a, b, c, &f);
    for (int row = box.j0; row < box.j1; row++) {
        skg_line line;
        skg_row(&f, (skg_real)row, &line);
        const int sign = skg_negative(&f, &line) ? -1 : 1;
        for (int column = box.i0; column < box.i1; column++) {
            if (!skg_hit(&line, (skg_real)column)) continue;
            const int i = range.pixel_i + column, j = range.pixel_j + row;
            const float t = fma(skg_depth(&f, &line, (skg_real)column), reference, reference);
            const int units = sign * skg_half_units(t * skg_ray_length(&ray, i, j) * 1e-3f);
            for (int w = 0; w < range.contributions; w++) {
                __global const skg_contribution *contribution = &contributions[range.first_contribution + w];
                skg_add_global(sums + contribution->plane * layout.plane + j * layout.stride + i,
                               (skg_sum)(contribution->weight < 0 ? -units : units));
            }
        }
    }
}
