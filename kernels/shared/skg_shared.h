/* Structs that kernels and host share: scalars only, every gap explicit, the same layout on both sides. */
#ifndef SKG_SHARED_H
#define SKG_SHARED_H

#ifdef __OPENCL_C_VERSION__
#define SKG_INT int
#define SKG_UINT uint
#define SKG_LONG long
#else
#include <stdint.h>
#define SKG_INT int32_t
#define SKG_UINT uint32_t
#define SKG_LONG int64_t
#endif

/* Items (triangles or projected vertices) per entry of a block table. */
#define SKG_BLOCK 64

/* Vertices that a work-item of a CPU projects; on a GPU it takes one. */
#define SKG_CPU_RUN 256

/* Triangles with a vertex whose path parameter is not above this are drawn by the kernel for the source's plane. */
#define SKG_NEAR 0x1p-10f

/* Accumulators have spare columns and rows, to which blocks of lanes may add zeros. */
#define SKG_SPARE_COLUMNS 16
#define SKG_SPARE_ROWS 4

/* The most tiles that a triangle may meet and be listed in each. Triangles that meet more are in one list for all tiles. */
#define SKG_TILES_MAX 8

/* Bands of a CPU: the most of them, and how many triangles are sorted at once. */
#define SKG_BANDS_MAX 512
#define SKG_CHUNK 1024

/* Rows that the kernel of the source plane draws or skips together. */
#define SKG_SOURCE_ROWS 32

/* The table `used` of a raster: for each copy a set of bits, the planes of which it counts (SKG_COUNTS); `copies` counters of
 * claims; then for each plane the extent that has sums: first row, end row, first column, end column, the columns multiples of SKG_EXTENT_COLUMNS or the row's
 * end. Outside its extent the sums of a plane are 0, and memory is neither zeroed nor read. */
#define SKG_EXTENT(copies, plane) (2 * (copies) + 4 * (plane))
#define SKG_EXTENT_COLUMNS 32

/* The bit of a plane in the set of a copy, which planes 32 apart share, and whether a copy counts for a plane. */
#define SKG_PLANE_BIT(plane) (1u << ((plane)&31))
#define SKG_COUNTS(set, plane) (((SKG_UINT)(set)&SKG_PLANE_BIT(plane)) != 0)

/* How many bad pixels of a leaky mesh are listed. */
#define SKG_FIRST_BAD 8

/* One part in one frame. Pixels are relative to the part's own pixel (pixel_i, pixel_j), depths to
 * `reference`, so that neither loses digits to its distance. With V a vertex of the mesh, r = offset_r +
 * row2.V is the path parameter (0 at the source, 1 at the pixel) less `reference`, t = reference + r, and the
 * vertex is seen at x = anchor_x + (offset_x + row0.V) / t, y alike; with a parallel beam without the
 * division. */
#define SKG_PART_MEMBERS(real)                                                                               \
    real row0[3], offset_x;                                                                                  \
    real row1[3], offset_y;                                                                                  \
    real row2[3], offset_r;                                                                                  \
    real anchor_x, anchor_y, reference;                                                                      \
    real low0[3], low_x, low1[3], low_y, low2[3], low_r; /* what rounding these to floats has lost */        \
    real low_anchor_x, low_anchor_y, low_reference;                                                          \
    real highest;  /* of r: where the ray ends, at the pixel */                                              \
    real start[3]; /* parallel: paths start at r = start[0] + start[1] i + start[2] j */                     \
    real steepest; /* gradient of z (per pixel) times a coordinate above which a face is steep */            \
    real shift;    /* pixels by which upright edges are moved for coverage, with SKG_SEAMS */                \
    SKG_INT pixel_i, pixel_j;                                                                                \
    SKG_INT mesh_vertex;  /* first of the mesh in the vertex buffer */                                       \
    SKG_INT first_vertex; /* of the part, in the numbering over all parts */                                 \
    SKG_INT vertices;                                                                                        \
    SKG_INT mesh_triangle;  /* first of the mesh in the corner table */                                      \
    SKG_INT first_triangle; /* of the part, in the numbering over all parts */                               \
    SKG_INT triangles;                                                                                       \
    SKG_INT turned; /* 0, or -1: handedness of the projection, of the pose and of the mesh together */       \
    SKG_INT first_contribution, contributions;                                                               \
    SKG_INT                                                                                                  \
    fine; /* 1: behind the mesh's vertices stands what rounding them to floats has lost, and it counts */    \
    SKG_INT lines;    /* curved: reals from this entry to the table of lines (SKG_LINES_...) */              \
    SKG_INT reserved; /* 0 */

/* A curved detector (lib/geometry/curve.c). Rows of the raster are its columns, and columns of the raster its rows. On the plane that
 * touches its middle, row k is the line y = y_high + y_low, on which column i stands at x = i + more (i - middle) + moved. A ray ends
 * at path parameter t. The table begins with the number of rows, the row before which `more` and `moved` turn, and the two parts of
 * `middle`; then each row has y_high, which is a whole number, y_low, more, moved, 1 / t (parallel: t - 1), what intensities fall by
 * (the cube of fall / |ray|), t, and 0. */
#define SKG_LINES_HEAD 4
#define SKG_LINES_ROW 8
#define SKG_LINES_SIZE(rows) (SKG_LINES_HEAD + SKG_LINES_ROW * (rows))

/* Contribution of a hit of a part to one plane: round(q * weight + bias), where q = r / reference (parallel beam: r). A count plane has
 * weight 0 and bias 1. */
#define SKG_CONTRIBUTION_MEMBERS(real)                                                                       \
    real weight, bias;                                                                                       \
    SKG_INT plane, reserved;

/* How a raster lays out its accumulators and tiles, and the sizes of the scene that its launches need. The accumulator of pixel (row, column) of a plane of a copy is number
 * copy * planes * plane + (number of the plane) * plane + row * stride + column. */
typedef struct {
    SKG_INT parts, vertices, triangles;
    SKG_INT columns, rows;
    SKG_INT stride, plane, planes, copies; /* elements per row, per plane; planes of a pass; copies */
    SKG_INT claim;                         /* items that a work-group claims at once */
    SKG_INT tile_columns, tile_rows;       /* shape of a tile */
    SKG_INT tiles_across, tiles_down;
    SKG_INT queue;       /* entries of the queue of large triangles */
    SKG_INT first_plane; /* that a pass has, of those of several passes */
    SKG_INT passes;      /* that are drawn together */
    SKG_INT whole_first; /* of copies: 1: other kernels add to the first one, which counts for all planes */
} skg_raster_layout;

/* Positions of a mesh from the caller's memory, and their bounds, mm from the mesh's origin. */
typedef struct {
    SKG_INT vertices, mesh, mesh_vertex; /* number of the mesh; its first vertex in the vertex buffer */
    float lowest[3], highest[3];
    SKG_INT reserved;
} skg_place_args;

/* The key of a frame's noise (random.clh). sample: of the source; each sample has draws of its own. parts: the frame is one
 * of this number whose mean is an exposure; each has its share of the photons. */
typedef struct {
    SKG_INT seed[2], frame[2]; /* low word first */
    SKG_INT sample;
    SKG_INT parts;
} skg_noise_args;

/* How many hits a frame lists: low + 2^32 high. A struct, so that no 32-bit integer can take its place: on the host
 * skg_hits_bytes (stage/hits.h) alone reads it. Starts of the pixels' lists are 32 bits: more hits are refused. */
typedef struct {
    SKG_UINT low, high;
} skg_hit_count;
#define SKG_HITS_MAX 0xffffffffu

/* Of the kernels of hits.cl. window: columns from, rows from, columns to, rows to; nothing is listed outside. chosen: of
 * skg_hits_list, the first of the runs of triangles that are listed, and the end of these; winners: how many runs are of parts that
 * win over others. task: SKG_HITS_... below. */
typedef struct {
    skg_raster_layout layout;
    SKG_INT window[4], chosen[2];
    SKG_INT task, winners;
} skg_hits_args;

/* Weights of the cells of a volume are below two to the power of this, so that their rounded sum in a slice is an int. */
#define SKG_VOLUME_WEIGHT_BITS 30

/* Planes that a launch of skg_volume_add adds to, at most. */
#define SKG_VOLUME_PLANES_MAX 8

/* Of skg_volume_add. Places are in cells along the axes of the volume, in fixed point with `bits` bits behind the point: with t the path
 * parameter, 0 where it is `base` and 1 at the pixel, pixel (i, j) sees base + i base_column + j base_row + t (way + i way_column +
 * j way_row). */
typedef struct {
    SKG_LONG base[3], base_column[3], base_row[3];
    SKG_LONG way[3], way_column[3], way_row[3];
    SKG_LONG common; /* 2^40 times the path parameter where depths of hits are 0 */
    skg_raster_layout layout;
    SKG_INT window[4]; /* columns from, rows from, columns to, rows to */
    SKG_INT cells[3];  /* along each axis */
    SKG_INT bits;
    SKG_INT planes[SKG_VOLUME_PLANES_MAX];
    SKG_INT plane_count;
    SKG_INT lists[4];     /* the window in which hits are listed */
    SKG_INT whole;        /* 1: paths have no start */
    SKG_INT slot;         /* of the volume among the competitors; -1: nothing displaces it */
    float unit;           /* of sums, a power of two */
    float start[3];       /* parallel: paths start at t = start[0] + start[1] i + start[2] j */
    SKG_INT first_weight; /* of the launch's planes */
} skg_volume_args;

/* A row of the raster of a curved detector, whose pixel i sees base + i base_column + t (way + i way_column), in places as above, as far as
 * t is `end`, in 2^-40. Paths of a parallel beam start where t is start + i start_column, in 2^-40. */
typedef struct {
    SKG_LONG base[3], base_column[3];
    SKG_LONG way[3], way_column[3];
    SKG_LONG end, start, start_column;
} skg_cell_line;

/* Of the kernels of leaky.cl. parts: of the batch; part and count: of skg_leaky_put, one of these and how many of its pixels
 * get new sums. */
typedef struct {
    skg_raster_layout layout;
    SKG_INT parts, part, count, reserved;
} skg_leaky_args;

/* Of skg_gradient_faces, skg_gradient_batches and skg_hits_slopes. Weights have rows of `stride` elements, and planes of `plane`.
 * window: as in skg_hits_args. */
typedef struct {
    skg_raster_layout layout;
    SKG_INT window[4];
    SKG_INT stride, plane, planes, reserved;
} skg_gradient_args;

/* The first moment of a face that is seen as a line (kernels/gradient/gradient.cl). */
#define SKG_EDGE_ON ((SKG_LONG)1 << 62)

/* Faces that are narrower in the picture are seen as lines, in pixels. */
#define SKG_LINE 1e-4f
/* Likewise, in last places of the farthest coordinate of their corners. */
#define SKG_LINE_PLACES 16

/* Results of skg_weights for the rays: none, two planes, or SKG_RAY_SUMS sums. */
#define SKG_RAYS_NONE 0
#define SKG_RAYS_PLANES 1
#define SKG_RAYS_SUMS 2
#define SKG_RAY_SUMS 4

/* Added to the slot of a competitor that wins over none. Its hits matter only in pixels that a winner has hit. */
#define SKG_HITS_BACKGROUND 0x10000

/* Added to the part of a competitor that counts once where its winding number is above 0. */
#define SKG_HITS_UNITED 0x40000000

/* Modes of a launch over hits: count those of winners, count those of background parts, list all. */
#define SKG_HITS_COUNT 0
#define SKG_HITS_COUNT_BACKGROUND 1
#define SKG_HITS_LIST 2

/* Triangles of competitors that a work-item of a CPU lists. */
#define SKG_HITS_TRIANGLES 64

/* The length of the ray to pixel (i, j) is |centre + i column + j row| mm; with a parallel beam |centre|. i and j count from
 * the pixel of `centre`. */
#define SKG_RAY_MEMBERS(real)                                                                                \
    real centre[3], column[3], row[3];                                                                       \
    real middle_i, middle_j; /* the pixel of `centre` */                                                     \
    real unit;               /* 1 / scale of the plane */

/* How the amounts of shades follow from a ray (lib/spectral/shading.h). "Along the ray" means (a[0] + a[1] i + a[2] j) for pixel
 * (i, j), with the ray's length |ray| as above. */
#define SKG_SHADE_MEMBERS(real)                                                                              \
    real heel[4];    /* z is heel[0..2] along the ray / |ray| + heel[3] */                                   \
    real oblique[2]; /* z is oblique[0] / |ray| + oblique[1] */                                              \
    real fan[6];   /* across and along the central ray, whose quotient is the tangent of the fan's angle */  \
    real tilt[4];  /* of the ray against the strips: tilt[0..2]; tilt[3]: cells of the table for 1 */        \
    real path[4];  /* mm through the grid / |ray|; obliquity / |ray|; the least of the table; cells for 1 */ \
    SKG_INT rows;  /* of the bow-tie, whose table is the first; 0: there is none */                          \
    SKG_INT table; /* where that of the grid begins */                                                       \
    SKG_INT count; /* of shades */                                                                           \
    SKG_INT heels, obliques,                                                                                 \
        grids; /* how many of them are of the heel effect, an oblique scintillator, a grid */

/* An image in its buffer: the place of its first pixel and its strides, in elements, and its size. */
typedef struct {
    SKG_LONG offset, row_stride, channel_stride;
    SKG_INT columns, rows, channels, reserved;
} skg_image_args;

/* Of the kernels of blur.cl. The workspace has rows of `stride` elements, and `high` of them for each channel; its pixel
 * (0, 0) is pixel (-left, -above) of the image. */
typedef struct {
    skg_image_args image;
    SKG_INT stride, high, left, above;
    SKG_INT taps;         /* samples of the first pass, an odd number */
    SKG_INT down, across; /* samples of the second pass along either direction */
    SKG_INT add;          /* 1: the result is added to the image */
} skg_blur_args;

/* Of skg_blur_variance: samples along either direction, an odd number; the first weight. add: 1: the result is added. */
typedef struct {
    skg_image_args from, to;
    SKG_INT down, across, first, add;
} skg_blur_variance_args;

/* A detector that counts (pulses.cl): the most thresholds, and what ends the dead time of a pixel, as in enum skg_pile_up. */
#define SKG_CHANNELS_COUNTED 8
#define SKG_PILE_UP_PULSES_END                                                                               \
    2 /* the last pulse, whether it counted or not; 1: the last one that counted; 0: there is none */

/* Of its kernels: weights are squares of 2 reach + 1 pixels. noise: 1: deviations lie behind the means. first: the lowest step of the
 * heights of pulses, and key: of the noise of those that are moved, if pulses that overlap are (SKG_MOVES). */
typedef struct {
    skg_image_args from, to;
    SKG_INT reach, noise, pile_up, first;
    skg_noise_args key;
} skg_pulses_args;

/* Of skg_attenuate (attenuate.cl). In such a struct the reals come first and the members of one size for both precisions
 * behind them, so that the host rounds all reals at once (lib/stage/kernels.h). What a program does not use is 0. */
#define SKG_ATTENUATE_MEMBERS(real, suffix)                                                                  \
    skg_ray_##suffix ray;                                                                                    \
    real factor;               /* of intensities */                                                          \
    real limit;                /* exponents below -limit are counted */                                      \
    real foot;                 /* mm from the source to the foot of its perpendicular on the detector; */    \
                               /* with falloff, intensities are multiplied by the cube of foot / |ray| */    \
    real photons;              /* if fewer are detected in a pixel they are drawn one by one; */             \
                               /* mean^2 / variance, never more than their number, decides */                \
    real world[4];             /* world[0] is added to world_plane for each mm of path, which is */          \
                               /* |ray| (world[1] + world[2] i + world[3] j) */                              \
    skg_shade_##suffix shades; /* last of the reals, because it ends in integers */                          \
    skg_raster_layout layout;                                                                                \
    skg_noise_args key;                                                                                      \
    SKG_INT planes; /* shades included */                                                                    \
    SKG_INT sums;   /* accumulators that planes are mixed from; 0: accumulators are planes */                \
    SKG_INT nodes;                                                                                           \
    SKG_INT world_plane; /* that the world's path adds to; -1: vacuum */                                     \
    SKG_INT shown;       /* SKG_SHOW_... */                                                                  \
    SKG_INT ratio;       /* 1: divided by a flat field that differs from pixel to pixel */                   \
    SKG_INT falloff;     /* 1: intensities fall with the distance from the source */                         \
    SKG_INT energies;    /* 1: shows energies, which SKG_HALF rounds in MeV */                               \
    SKG_INT add;         /* 1: values are added to those of earlier passes */                                \
    SKG_INT ranged;      /* 1: pixels are counted whose planes leave a range */                              \
    SKG_INT noise;       /* 0: none; SKG_NOISE_... */                                                        \
    SKG_INT collimated;  /* 1: rays outside the window of pixels are stopped by jaws */                      \
    SKG_INT window[4];   /* columns from, to, rows from, to */                                               \
    skg_image_args image;

/* Quantity that skg_attenuate shows: the sum of weight * exp(-exponent); -ln of that; the exponent of the only node, which is a path length
 * or an attenuation of one energy. */
#define SKG_SHOW_INTENSITY 0
#define SKG_SHOW_LOGARITHM 1
#define SKG_SHOW_EXPONENT 2

/* Quantum noise is drawn in the image, or its deviations from the mean have channels of their own. */
#define SKG_NOISE_DRAWN 1
#define SKG_NOISE_APART 2

/* Up to this number of planes, and without shades and noise, a program of skg_attenuate is made for their number. Else it is a
 * general one for up to a multiple of SKG_PLANES_STEP planes. */
#define SKG_FEW_PLANES 6
#define SKG_PLANES_STEP 16

/* The most shades of a plan. */
#define SKG_SHADES_MAX 14

/* Of skg_detect (detect.cl). */
#define SKG_DETECT_MEMBERS(real)                                                                             \
    real electronic; /* standard deviation of the electronic noise, keV per pixel */                         \
    real spacing;    /* of the levels of quantisation, keV per pixel */                                      \
    real scale;      /* of what is shown */                                                                  \
    real unused;     /* 0: what follows begins at a multiple of 8 bytes */                                   \
    skg_noise_args key;                                                                                      \
    skg_image_args image;

/* Scattered photons (scatter.cl). */
/* An interaction contributes to a place in each of side x side pieces of the detector. Lines through rough cells take less time, so
 * that more of them pay. */
#define SKG_SCATTER_SIDE(is_rough) ((is_rough) ? 3 : 2)
#define SKG_SCATTER_ANGLES 256    /* equally likely ranges of the angle of scattering */
#define SKG_SCATTER_DIMENSIONS 16 /* of a history's point of the lattice */
#define SKG_SCATTER_KINDS                                                                                    \
    6 /* planes of sums: orders 1, 2, higher of Rayleigh scattering alone, then with Compton or fluorescence */
#define SKG_SCATTER_PLANES (SKG_SCATTER_KINDS + 1) /* the last: what adds to the variance */
#define SKG_SCATTER_COLUMNS 6                      /* of the table by energy */
#define SKG_SCATTER_LINES 12                       /* of a shell that emits, at most */
#define SKG_SCATTER_ORDERS 64                      /* interactions after which a photon is given up */
#define SKG_SCATTER_EVEN 0.5f  /* share of interactions whose place is even in the optical depth */
#define SKG_SCATTER_LEAST 0.2f /* weights below this play roulette */
#define SKG_SCATTER_FAR 1e6f   /* mm */

/* Words of cells (walk.clh): a kind, and from bit 0 on a medium with its leap above, or the place of a brick or of a list of faces. */
#define SKG_CELL_MEDIUM 0u
#define SKG_CELL_FACES 1u
#define SKG_CELL_BRICK 2u
#define SKG_CELL_KIND(word) ((word) >> 30)
#define SKG_CELL_PLACE(word) ((word)&0x3fffffffu)
#define SKG_CELL_MEDIUM_OF(word) ((word)&0xffffffu)
#define SKG_CELL_LEAP_MAX 63
#define SKG_CELL_ROUGH 4   /* cells along each side of a rough one */
#define SKG_ROUGH_STEPS 12 /* through rough cells */
#define SKG_LIST_HEAD                                                                                        \
    5 /* of a list of faces: a medium, how many faces, a place with this medium; then their numbers */
#define SKG_CELL_NUDGE 2e-5f  /* coarse cells: a line is looked up so far behind a boundary */
#define SKG_CELL_MARGIN 4e-5f /* a face that is so near a boundary and along it is on it */

/* Of skg_scatter. Places and vectors are in mm from the lowest corner of the cells. */
typedef struct {
    float size[3], per_mm[3];               /* of the box of the cells; cells per mm */
    float corner[3];                        /* of the detector */
    float normal[3], area;                  /* away from the source; mm2 */
    float side_u, side_v;                   /* mm */
    float to_u[3], to_v[3];                 /* from a place relative to `corner` to shares of the sides */
    float field[3], field_u[3], field_v[3]; /* the field of the beam: its first corner, its sides */
    /* mm from the source to the middle of the field; of a parallel beam: back to before the object */
    float far;
    float log_low, per_log; /* of the table by energy */
    float per_momentum, per_log_momentum;
    float angle_rows;     /* rows of the table of angles for one of that by energy */
    float min_kev, scale; /* photons below are given up; of sums */
    /* with a grid: across the strips; 1 / mm to the line where their planes meet, or 0 */
    float strips[3], focus;
    float strips_u, strips_v;    /* mm across the strips along the sides of the detector */
    float period, strip, height; /* of the strips, mm */
    float anode[3], heel_low,
        heel_per; /* heel_rows > 0: across its face; cosine of the first row of the table, rows for a cosine of 1 */
    float around_low[3], around_high[3]; /* world_around: of the box in which the world scatters */
    float world_start;        /* world_around: of a parallel beam where the world begins, mm along it */
    float central[3], fan[3]; /* fan_rows > 0: to the detector's middle; where the angles of the fan grow */
    SKG_INT cells[3], energies, momenta, angle_last, bins, spots, columns, rows;
    SKG_INT heel_rows, fan_rows; /* of the table of the heel effect and of the filter's; 0: none */
    SKG_INT bands, edges,
        cosines;          /* channels of the image; numbers before the table of layers; its cosines, or 0 */
    SKG_INT layers;       /* of the scintillator, each of which has an image of scattered photons */
    SKG_INT grid, noise;  /* 1: there is an anti-scatter grid; the variance of the signal is added up, too */
    SKG_INT world_around; /* 1: the cells stand in a material */
    SKG_INT shells;       /* that emit fluorescence */
    SKG_INT rough;        /* the first medium of rough cells; 0: there are none */
    SKG_INT first, end, each; /* histories of a batch; of a work-item */
    SKG_INT alone;            /* 1: a work-item has all of its batch, and nobody else adds to the sums */
    SKG_INT seed[2];          /* low word first */
} skg_scatter_args;

/* Of skg_scattered. add: 1: to what the image holds; 0: replaces it. */
typedef struct {
    skg_noise_args key;
    skg_image_args image;
    SKG_INT add;
    float scale;             /* of what is added */
    SKG_INT noise, reserved; /* 0: none; SKG_NOISE_... */
} skg_scattered_args;

/* The structs whose reals have the precision of the program. The kernels' have the suffix `args`. */
#define SKG_STRUCTS_WITH(real, suffix)                                                                       \
    typedef struct {                                                                                         \
        SKG_RAY_MEMBERS(real)                                                                                \
    } skg_ray_##suffix;                                                                                      \
    typedef struct {                                                                                         \
        SKG_SHADE_MEMBERS(real)                                                                              \
    } skg_shade_##suffix;                                                                                    \
    typedef struct {                                                                                         \
        SKG_ATTENUATE_MEMBERS(real, suffix)                                                                  \
    } skg_attenuate_##suffix;                                                                                \
    typedef struct {                                                                                         \
        SKG_DETECT_MEMBERS(real)                                                                             \
    } skg_detect_##suffix;

#ifdef __OPENCL_C_VERSION__
SKG_STRUCTS_WITH(skg_real, args)
typedef struct {
    SKG_PART_MEMBERS(skg_real)
} skg_part_entry;
typedef struct {
    SKG_CONTRIBUTION_MEMBERS(skg_real)
} skg_contribution;
#else
SKG_STRUCTS_WITH(float, float)
SKG_STRUCTS_WITH(double, double)
typedef struct {
    SKG_PART_MEMBERS(float)
} skg_part_float;
typedef struct {
    SKG_PART_MEMBERS(double)
} skg_part_double;
typedef struct {
    SKG_CONTRIBUTION_MEMBERS(float)
} skg_contribution_float;
typedef struct {
    SKG_CONTRIBUTION_MEMBERS(double)
} skg_contribution_double;
_Static_assert(sizeof(skg_part_float) == 36 * 4 + 14 * 4, "layout of a part, single");
_Static_assert(sizeof(skg_part_double) == 36 * 8 + 14 * 4, "layout of a part, double");
_Static_assert(sizeof(skg_contribution_float) == 16 && sizeof(skg_contribution_double) == 24,
               "layout of a contribution");
_Static_assert(sizeof(skg_ray_float) == 12 * 4 && sizeof(skg_ray_double) == 12 * 8, "layout of a ray");
_Static_assert(sizeof(skg_shade_float) == 26 * 4 && sizeof(skg_shade_double) == 23 * 8, "layout of shades");
_Static_assert(sizeof(skg_attenuate_float) == 40 * 4 + 224 && sizeof(skg_attenuate_double) == 40 * 8 + 224,
               "layout of the arguments of skg_attenuate");
_Static_assert(sizeof(skg_detect_float) == 4 * 4 + 64 && sizeof(skg_detect_double) == 4 * 8 + 64,
               "layout of the arguments of skg_detect");
_Static_assert(sizeof(skg_image_args) == 40 && sizeof(skg_blur_args) == 72 &&
                   sizeof(skg_blur_variance_args) == 96 && sizeof(skg_pulses_args) == 120,
               "layout of images");
_Static_assert(sizeof(skg_hits_args) == 104 && sizeof(skg_leaky_args) == 88, "layout of arguments");
_Static_assert(sizeof(skg_volume_args) == 19 * 8 + 72 + 28 * 4, "layout of the arguments of skg_volume_add");
_Static_assert(sizeof(skg_gradient_args) == 104, "layout of the arguments of gradients");
_Static_assert(sizeof(skg_raster_layout) == 72, "layout of a raster");
_Static_assert(sizeof(skg_place_args) == 40, "layout of a placement");
_Static_assert(sizeof(skg_noise_args) == 24, "layout of a noise key");
_Static_assert(sizeof(skg_hit_count) == 8, "layout of a count of hits");
_Static_assert(sizeof(skg_scatter_args) == 65 * 4 + 27 * 4 && sizeof(skg_scattered_args) == 80,
               "layout of scatter");
#endif
#endif
