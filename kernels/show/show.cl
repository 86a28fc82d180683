/* The 3D view: triangles are set up and counted for the tiles that they meet (skg_show_count), listed there
 * (skg_show_fill) and drawn tile by tile (skg_show_draw). The order within a list is arbitrary: of surfaces at the same
 * depth, the one with the lower number is in front. */

typedef SKG_CAT(float, SKG_WIDE) skg_floatv;
typedef SKG_CAT(uint, SKG_WIDE) skg_uintv;
typedef skg_uintv skg_loose_uintv __attribute__((aligned(sizeof(uint))));
#define SKG_AS_INT_V SKG_CAT(as_int, SKG_WIDE)
#define SKG_TO_UINT_V SKG_CAT(convert_uint, SKG_WIDE)
#define SKG_TO_FLOAT_V SKG_CAT(convert_float, SKG_WIDE)

/* Pixels of a row of samples. */
#if SKG_WIDE == 4
#define SKG_SHOW_PIXELS 2
#elif SKG_WIDE == 8
#define SKG_SHOW_PIXELS 4
#else
#define SKG_SHOW_PIXELS 8
#endif

typedef SKG_CAT(uint, SKG_SHOW_PIXELS) skg_pixels;
#define SKG_TO_PIXELS SKG_CAT(convert_uint, SKG_SHOW_PIXELS)
#define SKG_STORE_PIXELS SKG_CAT(vstore, SKG_SHOW_PIXELS)

/* The number of no triangle. */
#define SKG_SHOW_NONE INT_MAX

/* The plane through values at three points. b, c: of the second and third point from the first, a; inverse: 1 over twice the
 * area. */
static void skg_show_plane(__global float *plane, float2 b, float2 c, float inverse, float at_a, float at_b, float at_c,
                           float2 a) {
    const float over_b = at_b - at_a, over_c = at_c - at_a;
    plane[0] = (over_b * c.y - over_c * b.y) * inverse;
    plane[1] = (over_c * b.x - over_b * c.x) * inverse;
    plane[2] = at_a - plane[0] * a.x - plane[1] * a.y;
}

/* The edge between p and q, from whichever comes first. Both triangles of an edge then compute the same bits for a sample,
 * which belongs to exactly one of them. opposite: the third corner. Returns 1 if it lies where the normal points to. */
static int skg_show_edge(__global float *edge, float2 p, float2 q, float2 opposite) {
    const int swap = q.x < p.x || (q.x == p.x && q.y < p.y);
    const float2 first = swap ? q : p, d = swap ? p - q : q - p;
    edge[0] = -d.y, edge[1] = d.x;
    edge[2] = first.x, edge[3] = first.y;
    return d.x * (opposite.y - first.y) - d.y * (opposite.x - first.x) >= 0.0f;
}

static float4 skg_show_clip(skg_show_args args, __global const float *v) {
    float4 clip;
    clip.x = args.matrix[0] * v[0] + args.matrix[4] * v[1] + args.matrix[8] * v[2] + args.matrix[12];
    clip.y = args.matrix[1] * v[0] + args.matrix[5] * v[1] + args.matrix[9] * v[2] + args.matrix[13];
    clip.z = args.matrix[2] * v[0] + args.matrix[6] * v[1] + args.matrix[10] * v[2] + args.matrix[14];
    clip.w = args.matrix[3] * v[0] + args.matrix[7] * v[1] + args.matrix[11] * v[2] + args.matrix[15];
    return clip;
}

/* Samples from clip coordinates: sample (0, 0) has its centre at (0, 0). The whole scene is in front of the eye. */
static float3 skg_show_place(skg_show_args args, float4 clip) {
    return (float3)((float)args.columns * (1.0f + clip.x / clip.w) - 0.5f,
                    (float)args.rows * (1.0f - clip.y / clip.w) - 0.5f, clip.z / clip.w);
}

/* A component of a corner's normal in the eye's axes. */
static float skg_show_turned(skg_show_args args, short4 normal, int axis) {
    return (args.turn[axis] * (float)normal.x + args.turn[3 + axis] * (float)normal.y +
            args.turn[6 + axis] * (float)normal.z) *
           (1.0f / 32767.0f);
}

/* The tiles of a box: first column, first row, end column, end row. */
static int4 skg_show_tiles(__global const skg_show_face *face) {
    return (int4)(face->box[0] / SKG_SHOW_TILE, face->box[1] / SKG_SHOW_TILE, face->box[2] / SKG_SHOW_TILE + 1,
                  face->box[3] / SKG_SHOW_TILE + 1);
}

/* Which side of edge k the sample at x, r lies on; r: rows from `row`, where a tile begins. Rounding keeps it monotonic in x
 * and in r. */
static float skg_show_side(__global const float *edge, float x, float row, float r) {
    return fma(r, edge[1], fma(x - edge[2], edge[0], edge[1] * (row - edge[3])));
}

/* Whether a triangle covers no sample of `width` columns of a tile: all are outside of one edge, since the one that lies
 * farthest inside is. */
static int skg_show_apart(__global const skg_show_face *face, int column, int width, int row) {
    int apart = 0;
    for (int k = 0; k < 3; k++) {
        __global const float *edge = face->edges + 4 * k;
        const int inside = face->sides >> k & 1;
        const float x = (float)((edge[0] > 0.0f) == inside ? column + width - 1 : column);
        const float r = (edge[1] > 0.0f) == inside ? SKG_SHOW_TILE - 1 : 0;
        apart |= signbit(skg_show_side(edge, x, (float)row, r)) == inside;
    }
    return apart;
}

/* counts: [list][tile] triangles */
__kernel void skg_show_count(skg_show_args args, __global const float *vertices, __global const int *corners,
                             __global const short4 *normals, __global const uint *colours,
                             __global skg_show_face *faces, __global int *counts) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= args.triangles) return;
    __global skg_show_face *face = faces + triangle;
    __global const int *corner = corners + 3 * triangle;
    face->box[0] = 0, face->box[1] = 0, face->box[2] = -1, face->box[3] = -1;
    face->surface = triangle >= args.triangles - args.images ? SKG_SHOW_IMAGE : SKG_SHOW_LIT;
    const uint colour = colours[triangle];
    for (int k = 0; k < 4; k++) face->colour[k] = (float)(colour >> 8 * k & 0xff) / 255.0f;
    const float4 clip_a = skg_show_clip(args, vertices + 3 * corner[0]);
    const float4 clip_b = skg_show_clip(args, vertices + 3 * corner[1]);
    const float4 clip_c = skg_show_clip(args, vertices + 3 * corner[2]);
    float3 a = skg_show_place(args, clip_a), b = skg_show_place(args, clip_b), c = skg_show_place(args, clip_c);
    const float2 low = fmin(a.xy, fmin(b.xy, c.xy)), high = fmax(a.xy, fmax(b.xy, c.xy));
    const int4 box = (int4)(max(convert_int2_rtp(low), 0),
                            min(convert_int2_rtn(high), (int2)(2 * args.columns - 1, 2 * args.rows - 1)));
    const float2 ab = b.xy - a.xy, ac = c.xy - a.xy;
    const float area = ab.x * ac.y - ac.x * ab.y;
    if (box.x > box.z || box.y > box.w || !(fabs(area) > 1e-6f) || colour >> 24 == 0) return;
    face->sides = skg_show_edge(face->edges, a.xy, b.xy, c.xy) | skg_show_edge(face->edges + 4, b.xy, c.xy, a.xy) << 1 |
                  skg_show_edge(face->edges + 8, c.xy, a.xy, b.xy) << 2;
    face->list = colour >> 24 < 255 ? SKG_SHOW_CLEAR : area < 0.0f ? SKG_SHOW_FACING : SKG_SHOW_AWAY;
    face->nearest = fmin(a.z, fmin(b.z, c.z));
    a.xy -= convert_float2(box.xy);
    const float inverse = 1.0f / area;
    skg_show_plane(face->depth, ab, ac, inverse, a.z, b.z, c.z, a.xy);
    if (area >= 0.0f && triangle < args.sections) face->surface = SKG_SHOW_PLAIN;
    if (face->surface == SKG_SHOW_IMAGE) { /* places in the image take the room of normals */
        __global const short4 *at = normals + 3 * triangle;
        const float3 u = (float3)((float)at[0].x, (float)at[1].x, (float)at[2].x) * (1.0f / 16384.0f);
        const float3 v = (float3)((float)at[0].y, (float)at[1].y, (float)at[2].y) * (1.0f / 16384.0f);
        skg_show_plane(face->values, ab, ac, inverse, u.x / clip_a.w, u.y / clip_b.w, u.z / clip_c.w, a.xy);
        skg_show_plane(face->values + 3, ab, ac, inverse, v.x / clip_a.w, v.y / clip_b.w, v.z / clip_c.w, a.xy);
        skg_show_plane(face->values + 6, ab, ac, inverse, 1 / clip_a.w, 1 / clip_b.w, 1 / clip_c.w, a.xy);
    } else {
        for (int axis = 0; axis < 3; axis++)
            skg_show_plane(face->values + 3 * axis, ab, ac, inverse, skg_show_turned(args, normals[3 * triangle], axis),
                           skg_show_turned(args, normals[3 * triangle + 1], axis),
                           skg_show_turned(args, normals[3 * triangle + 2], axis), a.xy);
    }
    face->box[0] = box.x, face->box[1] = box.y, face->box[2] = box.z, face->box[3] = box.w;
    const int4 tiles = skg_show_tiles(face);
    const int first = face->list * args.across * args.down;
    for (int y = tiles.y; y < tiles.w; y++)
        for (int x = tiles.x; x < tiles.z; x++)
            if (!skg_show_apart(face, x * SKG_SHOW_TILE, SKG_SHOW_TILE, y * SKG_SHOW_TILE))
                atomic_inc(&counts[first + y * args.across + x]);
}

/* cursors: [list][tile] where the next entry of each list stands; afterwards the ends of the lists */
__kernel void skg_show_fill(skg_show_args args, __global const skg_show_face *faces, __global int *cursors,
                            __global int *entries) {
    const int triangle = (int)get_global_id(0);
    if (triangle >= args.triangles) return;
    __global const skg_show_face *face = faces + triangle;
    if (face->box[0] > face->box[2] || face->box[1] > face->box[3]) return;
    const int4 tiles = skg_show_tiles(face);
    const int first = face->list * args.across * args.down;
    for (int y = tiles.y; y < tiles.w; y++)
        for (int x = tiles.x; x < tiles.z; x++)
            if (!skg_show_apart(face, x * SKG_SHOW_TILE, SKG_SHOW_TILE, y * SKG_SHOW_TILE))
                entries[atomic_inc(&cursors[first + y * args.across + x])] = triangle;
}

/* Red, green, blue and opacity as bytes of an integer. */
static skg_uintv skg_show_pack(skg_floatv red, skg_floatv green, skg_floatv blue, skg_floatv opacity) {
    return SKG_TO_UINT_V(fma(red, 255.0f, 0.5f)) | SKG_TO_UINT_V(fma(green, 255.0f, 0.5f)) << 8 |
           SKG_TO_UINT_V(fma(blue, 255.0f, 0.5f)) << 16 | SKG_TO_UINT_V(fma(opacity, 255.0f, 0.5f)) << 24;
}
static skg_floatv skg_show_byte(skg_uintv colour, int shift) {
    return SKG_TO_FLOAT_V(colour >> (uint)shift & 0xffu) * (1.0f / 255.0f);
}

static skg_floatv skg_show_value(__global const float *plane, skg_floatv x, float y) {
    return fma(x, plane[0], fma(y, plane[1], plane[2]));
}

/* The detector's image at the samples of the mask. */
static skg_uintv skg_show_image(skg_show_args args, __global const skg_show_face *face, __global const uchar *image, skg_floatv x,
                                float y, skg_intv mask) {
    const skg_floatv w = 1.0f / skg_show_value(face->values + 6, x, y);
    const skg_floatv column = clamp(skg_show_value(face->values, x, y) * w * (float)args.image_columns, 0.0f,
                                    (float)args.image_columns - 0.5f);
    const skg_floatv row = clamp(skg_show_value(face->values + 3, x, y) * w * (float)args.image_rows, 0.0f,
                                 (float)args.image_rows - 0.5f);
    int at[SKG_WIDE], covered[SKG_WIDE];
    uint grey[SKG_WIDE];
    SKG_STORE_V(intv, SKG_TO_INT_V(row) * args.image_columns + SKG_TO_INT_V(column), at);
    SKG_STORE_V(intv, mask, covered);
    for (int k = 0; k < SKG_WIDE; k++) grey[k] = covered[k] ? image[at[k]] * 0x010101u | 0xff000000u : 0u;
    return SKG_LOAD_V(uintv, grey);
}

/* A surface as it looks: lit from beside the eye, darker where it turns away, and there also less translucent. */
static skg_uintv skg_show_shade(skg_show_args args, __global const skg_show_face *face, skg_floatv x, float y) {
    skg_floatv across = skg_show_value(face->values, x, y), up = skg_show_value(face->values + 3, x, y);
    skg_floatv near = skg_show_value(face->values + 6, x, y);
    const skg_floatv length = rsqrt(fma(across, across, fma(up, up, fma(near, near, 1e-12f))));
    const skg_floatv turned = select((skg_floatv)(1.0f), (skg_floatv)(-1.0f), near < 0.0f) * length; /* both sides */
    across *= turned, up *= turned, near *= turned;
    const skg_floatv lit = fmax(fma(across, args.light[0], fma(up, args.light[1], near * args.light[2])), 0.0f);
    const skg_floatv away = 1.0f - fmin(near, 1.0f), edge = away * away * away;
    const skg_floatv shade = fma(lit, 0.62f, 0.40f) * fma(edge, -0.75f, 1.0f);
    const skg_floatv gleam = lit * lit * lit * lit * 0.08f;
    const float opacity = face->colour[3];
    return skg_show_pack(fmin(fma(shade, face->colour[0], gleam), 1.0f), fmin(fma(shade, face->colour[1], gleam), 1.0f),
                         fmin(fma(shade, face->colour[2], gleam), 1.0f), fma(edge, 0.75f * (1.0f - opacity), opacity));
}

/* The inside of a part that is cut: darker, and without shading, so that it looks like a section. */
static skg_uintv skg_show_inside(__global const skg_show_face *face) {
    return skg_show_pack((skg_floatv)(0.7f * face->colour[0]), (skg_floatv)(0.7f * face->colour[1]),
                         (skg_floatv)(0.7f * face->colour[2]), (skg_floatv)(face->colour[3]));
}

/* One strip of SKG_WIDE columns of a tile. */
typedef struct {
    skg_floatv depth[SKG_SHOW_TILE];  /* of the nearest opaque surface */
    skg_intv number[SKG_SHOW_TILE];   /* its triangle */
    skg_floatv passed[SKG_SHOW_TILE]; /* depth of the translucent surface that was drawn last */
    skg_intv passed_number[SKG_SHOW_TILE];
    skg_floatv next[SKG_SHOW_TILE];   /* the nearest translucent surface behind it, so far */
    skg_intv next_number[SKG_SHOW_TILE];
    skg_floatv through[SKG_SHOW_TILE], red[SKG_SHOW_TILE], green[SKG_SHOW_TILE], blue[SKG_SHOW_TILE];
} skg_show_strip;

/* Values common to all rows of a triangle in a strip. */
typedef struct {
    skg_floatv sides[3], depth; /* at the strip's first row */
    float down[3], depth_down;  /* more in each further row */
    skg_intv flips[3];          /* negative where a sample on the edge's negative side belongs to the triangle */
    float nearest;
    int first_row, last_row; /* in the tile */
} skg_show_rows;

static skg_show_rows skg_show_rows_of(__global const skg_show_face *face, int column, int row) {
    skg_show_rows rows;
    const skg_floatv x = SKG_LANES + (float)column;
    for (int k = 0; k < 3; k++) {
        __global const float *edge = face->edges + 4 * k;
        rows.sides[k] = fma(x - edge[2], edge[0], edge[1] * ((float)row - edge[3])); /* as in skg_show_side */
        rows.down[k] = edge[1];
        rows.flips[k] = face->sides >> k & 1 ? 0 : INT_MIN;
    }
    rows.depth = fma(x - (float)face->box[0], face->depth[0],
                     fma((float)(row - face->box[1]), face->depth[1], face->depth[2]));
    rows.depth_down = face->depth[1];
    rows.nearest = face->nearest;
    rows.first_row = max(face->box[1] - row, 0);
    rows.last_row = min(face->box[3] - row, SKG_SHOW_TILE - 1);
    return rows;
}

/* Negative where a sample of row r lies outside of edge k: both triangles of an edge compute the same bits, of which the
 * sign decides. */
static skg_intv skg_show_outside(const skg_show_rows *rows, int k, skg_floatv r) {
    return SKG_AS_INT_V(fma(r, rows->down[k], rows->sides[k])) ^ rows->flips[k];
}

/* Which samples of row r a triangle covers (negative: covered), and their depth: on its plane, but not nearer than its
 * corners, where the plane of a triangle seen edge-on would be anywhere. */
static skg_intv skg_show_covered(const skg_show_rows *rows, float r, skg_floatv *depth) {
    *depth = max(fma((skg_floatv)(r), rows->depth_down, rows->depth), rows->nearest);
    return ~(skg_show_outside(rows, 0, r) | skg_show_outside(rows, 1, r) | skg_show_outside(rows, 2, r));
}

/* Colours of a row of samples whose triangles are known; `none` where the number is SKG_SHOW_NONE. Shading each triangle
 * once for all of its samples in the row, after it is known to be seen, costs least. */
static skg_uintv skg_show_colours(skg_show_args args, __global const skg_show_face *faces, __global const uchar *image,
                                  skg_intv numbers, int column, int row, skg_uintv none) {
    int number[SKG_WIDE];
    skg_uintv colours = none;
    if (!skg_any(numbers != SKG_SHOW_NONE)) return none;
    SKG_STORE_V(intv, numbers, number);
    for (int k = 0; k < SKG_WIDE; k++) {
        if (number[k] == SKG_SHOW_NONE || (k > 0 && number[k] == number[k - 1])) continue;
        __global const skg_show_face *face = faces + number[k];
        const skg_intv mask = numbers == number[k];
        const skg_floatv x = SKG_LANES + (float)(column - face->box[0]);
        const float y = (float)(row - face->box[1]);
        const skg_uintv colour = face->surface == SKG_SHOW_IMAGE   ? skg_show_image(args, face, image, x, y, mask)
                                 : face->surface == SKG_SHOW_PLAIN ? skg_show_inside(face)
                                                                   : skg_show_shade(args, face, x, y);
        colours = select(colours, colour, mask);
    }
    return colours;
}

/* Whether a triangle may be seen in a strip: it covers samples there, and not all samples of its box are nearer than it. Most
 * triangles are hidden, and this costs a fraction of drawing them. */
static int skg_show_seen(const skg_show_strip *strip, __global const skg_show_face *face, int column, int row) {
    if (skg_show_apart(face, column, SKG_WIDE, row)) return 0;
    const int last = min(face->box[3] - row, SKG_SHOW_TILE - 1);
    skg_floatv farthest = -INFINITY;
    for (int r = max(face->box[1] - row, 0); r <= last; r++) farthest = max(farthest, strip->depth[r]);
    const skg_intv x = SKG_TO_INT_V(SKG_LANES) + column;
    return skg_any((farthest >= face->nearest) & (x >= face->box[0]) & (x <= face->box[2]));
}

/* Keeps the nearest opaque surface. */
static void skg_show_opaque(skg_show_strip *strip, __global const skg_show_face *face, int triangle, int column, int row) {
    const skg_show_rows rows = skg_show_rows_of(face, column, row);
    for (int r = rows.first_row; r <= rows.last_row; r++) {
        skg_floatv depth;
        const skg_intv mask =
            skg_show_covered(&rows, (float)r, &depth) &
            ((depth < strip->depth[r]) | ((depth == strip->depth[r]) & (triangle < strip->number[r])));
        strip->depth[r] = select(strip->depth[r], depth, mask);
        strip->number[r] = select(strip->number[r], (skg_intv)(triangle), mask);
    }
}

/* Keeps the nearest translucent surface between the one that was drawn last and the opaque one. Returns whether this is
 * one; *more is set where there is yet another behind it. */
static int skg_show_next(skg_show_strip *strip, __global const skg_show_face *face, int triangle, int column, int row,
                         skg_intv *more) {
    const skg_show_rows rows = skg_show_rows_of(face, column, row);
    skg_intv found = 0;
    for (int r = rows.first_row; r <= rows.last_row; r++) {
        skg_floatv depth;
        const skg_intv behind =
            skg_show_covered(&rows, (float)r, &depth) & (depth < strip->depth[r]) &
            ((depth > strip->passed[r]) | ((depth == strip->passed[r]) & (triangle > strip->passed_number[r])));
        const skg_intv nearer =
            behind &
            ((depth < strip->next[r]) | ((depth == strip->next[r]) & (triangle < strip->next_number[r])));
        *more |= behind & (strip->next_number[r] != SKG_SHOW_NONE);
        strip->next[r] = select(strip->next[r], depth, nearer);
        strip->next_number[r] = select(strip->next_number[r], (skg_intv)(triangle), nearer);
        found |= nearer;
    }
    return skg_any(found);
}

/* Adds the layer that was found, seen through those before it. */
static void skg_show_layer(skg_show_args args, skg_show_strip *strip, __global const skg_show_face *faces,
                           __global const uchar *image, int column, int row) {
    for (int r = 0; r < SKG_SHOW_TILE; r++) {
        if (!skg_any(strip->next_number[r] != SKG_SHOW_NONE)) continue;
        const skg_uintv colour = skg_show_colours(args, faces, image, strip->next_number[r], column, row + r, 0);
        const skg_floatv share = strip->through[r] * skg_show_byte(colour, 24);
        strip->red[r] = fma(share, skg_show_byte(colour, 0), strip->red[r]);
        strip->green[r] = fma(share, skg_show_byte(colour, 8), strip->green[r]);
        strip->blue[r] = fma(share, skg_show_byte(colour, 16), strip->blue[r]);
        strip->through[r] -= share;
        strip->passed[r] = strip->next[r];
        strip->passed_number[r] = strip->next_number[r];
        strip->next[r] = INFINITY, strip->next_number[r] = SKG_SHOW_NONE;
    }
}

/* Two rows of samples, added, as a row of pixels: red, green, blue of the mean of 2 x 2 samples, and 255. */
static skg_pixels skg_show_mean(skg_floatv red, skg_floatv green, skg_floatv blue) {
    return SKG_TO_PIXELS(fma(red.even + red.odd, 63.75f, 0.5f)) |
           SKG_TO_PIXELS(fma(green.even + green.odd, 63.75f, 0.5f)) << 8 |
           SKG_TO_PIXELS(fma(blue.even + blue.odd, 63.75f, 0.5f)) << 16 | 0xff000000u;
}

/* Writes a row of pixels, as far as it lies in the picture. */
static void skg_show_write(skg_show_args args, skg_pixels pixels, __global uint *rgba, int column, int row) {
    uint pixel[SKG_WIDE / 2];
    SKG_STORE_PIXELS(pixels, 0, pixel);
    const int count = row < args.rows ? min(args.columns - column, SKG_WIDE / 2) : 0;
    for (int k = 0; k < count; k++) rgba[row * args.columns + column + k] = pixel[k];
}

static void skg_show_store(skg_show_args args, const skg_show_strip *strip, __global const skg_show_face *faces,
                           __global const uchar *image, skg_uintv none, __global uint *rgba, int column, int row) {
    for (int r = 0; r < SKG_SHOW_TILE; r += 2) {
        const skg_uintv above = skg_show_colours(args, faces, image, strip->number[r], column, row + r, none);
        const skg_uintv below = skg_show_colours(args, faces, image, strip->number[r + 1], column, row + r + 1, none);
        const skg_pixels pixels =
            skg_show_mean(fma(strip->through[r], skg_show_byte(above, 0), strip->red[r]) +
                              fma(strip->through[r + 1], skg_show_byte(below, 0), strip->red[r + 1]),
                          fma(strip->through[r], skg_show_byte(above, 8), strip->green[r]) +
                              fma(strip->through[r + 1], skg_show_byte(below, 8), strip->green[r + 1]),
                          fma(strip->through[r], skg_show_byte(above, 16), strip->blue[r]) +
                              fma(strip->through[r + 1], skg_show_byte(below, 16), strip->blue[r + 1]));
        skg_show_write(args, pixels, rgba, column / 2, (row + r) / 2);
    }
}

/* starts: [SKG_SHOW_LISTS * tiles + 1] of the lists, in entries. One work-item draws a strip. */
__kernel void skg_show_draw(skg_show_args args, __global const skg_show_face *faces, __global const int *starts,
                            __global const int *entries, __global const uchar *image, __global uint *rgba) {
    const int strips = SKG_SHOW_TILE / SKG_WIDE, item = (int)get_global_id(0);
    const int tile = item / strips, tiles = args.across * args.down;
    if (tile >= tiles) return;
    const int column = tile % args.across * SKG_SHOW_TILE + item % strips * SKG_WIDE;
    const int row = tile / args.across * SKG_SHOW_TILE;
    const skg_uintv none = skg_show_pack((skg_floatv)(args.background[0]), (skg_floatv)(args.background[1]),
                                         (skg_floatv)(args.background[2]), (skg_floatv)(1.0f));
    int count = 0;
    for (int list = 0; list < SKG_SHOW_LISTS; list++)
        count += starts[list * tiles + tile + 1] - starts[list * tiles + tile];
    if (count == 0) {
        for (int r = 0; r < SKG_SHOW_TILE; r += 2) skg_show_write(args, none.even, rgba, column / 2, (row + r) / 2);
        return;
    }
    skg_show_strip strip;
    for (int r = 0; r < SKG_SHOW_TILE; r++) {
        strip.depth[r] = INFINITY, strip.number[r] = SKG_SHOW_NONE;
        strip.passed[r] = -INFINITY, strip.passed_number[r] = -1;
        strip.next[r] = INFINITY, strip.next_number[r] = SKG_SHOW_NONE;
        strip.through[r] = 1.0f, strip.red[r] = 0.0f, strip.green[r] = 0.0f, strip.blue[r] = 0.0f;
    }
    for (int list = SKG_SHOW_FACING; list <= SKG_SHOW_AWAY; list++)
        for (int k = starts[list * tiles + tile]; k < starts[list * tiles + tile + 1]; k++)
            if (skg_show_seen(&strip, faces + entries[k], column, row))
                skg_show_opaque(&strip, faces + entries[k], entries[k], column, row);
    __global const int *clear = starts + SKG_SHOW_CLEAR * tiles + tile;
    int left = clear[0] < clear[1];
    for (int layer = 0; layer < SKG_SHOW_LAYERS && left; layer++) {
        skg_intv more = 0;
        int found = 0;
        for (int k = clear[0]; k < clear[1]; k++) {
            if (skg_show_seen(&strip, faces + entries[k], column, row))
                found |= skg_show_next(&strip, faces + entries[k], entries[k], column, row, &more);
        }
        if (found) skg_show_layer(args, &strip, faces, image, column, row);
        left = skg_any(more);
    }
    skg_show_store(args, &strip, faces, image, none, rgba, column, row);
}
