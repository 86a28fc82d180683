/* The arguments of every kernel, named once in the order of the kernel's signature. The host sets arguments by these
 * names alone (lib/stage); a test compares each list with the names that the OpenCL compiler reports for the kernel.
 *
 * SKG_ARGUMENTS_<KERNEL>(X) is X(KERNEL, name) for each argument. Scalars stand in a struct of skg_shared.h, the first
 * argument; a kernel with few arguments may have a scalar or two more. Every buffer is an argument of its own, because OpenCL 1.2 has
 * no pointers in such structs. The lists do not depend on -D names: a buffer that a program does not use is NULL. Host only. */
#ifndef SKG_ARGUMENTS_H
#define SKG_ARGUMENTS_H

/* clang-format off */
#define SKG_ARGUMENTS_PROJECT(X) \
    X(PROJECT, layout) X(PROJECT, parts) X(PROJECT, blocks) X(PROJECT, vertices) X(PROJECT, projected) \
    X(PROJECT, bad_vertex) X(PROJECT, frame)

#define SKG_ARGUMENTS_PLACE(X) \
    X(PLACE, args) X(PLACE, given) X(PLACE, first) X(PLACE, taken) X(PLACE, vertices) X(PLACE, outside)

#define SKG_ARGUMENTS_RASTER_COPIES(X) \
    X(RASTER_COPIES, layout) X(RASTER_COPIES, corners) X(RASTER_COPIES, projected) X(RASTER_COPIES, parts) \
    X(RASTER_COPIES, contributions) X(RASTER_COPIES, blocks) X(RASTER_COPIES, copies) X(RASTER_COPIES, used)

#define SKG_ARGUMENTS_RASTER_PASSES(X) \
    X(RASTER_PASSES, layout) X(RASTER_PASSES, corners) X(RASTER_PASSES, vertices) X(RASTER_PASSES, tables) \
    X(RASTER_PASSES, contributions) X(RASTER_PASSES, blocks) X(RASTER_PASSES, vertex_blocks) \
    X(RASTER_PASSES, projected) X(RASTER_PASSES, sums) X(RASTER_PASSES, used) X(RASTER_PASSES, bad_vertex) \
    X(RASTER_PASSES, frame) X(RASTER_PASSES, each)

#define SKG_ARGUMENTS_RASTER_ATOMICS(X) \
    X(RASTER_ATOMICS, layout) X(RASTER_ATOMICS, corners) X(RASTER_ATOMICS, projected) X(RASTER_ATOMICS, parts) \
    X(RASTER_ATOMICS, contributions) X(RASTER_ATOMICS, blocks) X(RASTER_ATOMICS, sums) X(RASTER_ATOMICS, queue)

#define SKG_ARGUMENTS_RASTER_QUEUE(X) \
    X(RASTER_QUEUE, layout) X(RASTER_QUEUE, corners) X(RASTER_QUEUE, projected) X(RASTER_QUEUE, parts) \
    X(RASTER_QUEUE, contributions) X(RASTER_QUEUE, blocks) X(RASTER_QUEUE, sums) X(RASTER_QUEUE, queue)

#define SKG_ARGUMENTS_TILES_COUNT(X) \
    X(TILES_COUNT, layout) X(TILES_COUNT, corners) X(TILES_COUNT, projected) X(TILES_COUNT, parts) \
    X(TILES_COUNT, blocks) X(TILES_COUNT, counts)

#define SKG_ARGUMENTS_TILES_SCAN(X) X(TILES_SCAN, layout) X(TILES_SCAN, counts) X(TILES_SCAN, starts)

#define SKG_ARGUMENTS_TILES_FILL(X) \
    X(TILES_FILL, layout) X(TILES_FILL, corners) X(TILES_FILL, projected) X(TILES_FILL, parts) \
    X(TILES_FILL, blocks) X(TILES_FILL, counts) X(TILES_FILL, starts) X(TILES_FILL, list) X(TILES_FILL, for_all)

#define SKG_ARGUMENTS_RASTER_SQUARES(X) \
    X(RASTER_SQUARES, layout) X(RASTER_SQUARES, corners) X(RASTER_SQUARES, projected) X(RASTER_SQUARES, parts) \
    X(RASTER_SQUARES, contributions) X(RASTER_SQUARES, blocks) X(RASTER_SQUARES, starts) X(RASTER_SQUARES, list) \
    X(RASTER_SQUARES, for_all) X(RASTER_SQUARES, sums) X(RASTER_SQUARES, local_sums)

#define SKG_ARGUMENTS_BANDS_SORT(X) \
    X(BANDS_SORT, layout) X(BANDS_SORT, corners) X(BANDS_SORT, projected) X(BANDS_SORT, parts) \
    X(BANDS_SORT, blocks) X(BANDS_SORT, counters) X(BANDS_SORT, pieces) X(BANDS_SORT, pool) X(BANDS_SORT, for_all)

#define SKG_ARGUMENTS_RASTER_BANDS(X) \
    X(RASTER_BANDS, layout) X(RASTER_BANDS, corners) X(RASTER_BANDS, projected) X(RASTER_BANDS, parts) \
    X(RASTER_BANDS, contributions) X(RASTER_BANDS, blocks) X(RASTER_BANDS, counters) X(RASTER_BANDS, pieces) \
    X(RASTER_BANDS, pool) X(RASTER_BANDS, for_all) X(RASTER_BANDS, sums) X(RASTER_BANDS, scratch) \
    X(RASTER_BANDS, used)

#define SKG_ARGUMENTS_RASTER_HALF(X) \
    X(RASTER_HALF, layout) X(RASTER_HALF, corners) X(RASTER_HALF, projected) X(RASTER_HALF, parts) \
    X(RASTER_HALF, contributions) X(RASTER_HALF, blocks) X(RASTER_HALF, sums) X(RASTER_HALF, ray)

#define SKG_ARGUMENTS_SOURCE_PLANE(X) \
    X(SOURCE_PLANE, layout) X(SOURCE_PLANE, corners) X(SOURCE_PLANE, projected) X(SOURCE_PLANE, parts) \
    X(SOURCE_PLANE, blocks) X(SOURCE_PLANE, vertices) X(SOURCE_PLANE, contributions) X(SOURCE_PLANE, sums)

#define SKG_ARGUMENTS_HITS_CLEAR(X) \
    X(HITS_CLEAR, args) X(HITS_CLEAR, spans) X(HITS_CLEAR, counts) X(HITS_CLEAR, starts) X(HITS_CLEAR, total)

#define SKG_ARGUMENTS_HITS_LIST(X) \
    X(HITS_LIST, args) X(HITS_LIST, corners) X(HITS_LIST, projected) X(HITS_LIST, parts) X(HITS_LIST, runs) \
    X(HITS_LIST, spans) X(HITS_LIST, slots) X(HITS_LIST, shifts) X(HITS_LIST, counts) X(HITS_LIST, starts) \
    X(HITS_LIST, hits)

#define SKG_ARGUMENTS_HITS_SOURCE_PLANE(X) \
    X(HITS_SOURCE_PLANE, args) X(HITS_SOURCE_PLANE, corners) X(HITS_SOURCE_PLANE, projected) \
    X(HITS_SOURCE_PLANE, parts) X(HITS_SOURCE_PLANE, blocks) X(HITS_SOURCE_PLANE, vertices) \
    X(HITS_SOURCE_PLANE, slots) X(HITS_SOURCE_PLANE, shifts) X(HITS_SOURCE_PLANE, counts) \
    X(HITS_SOURCE_PLANE, starts) X(HITS_SOURCE_PLANE, hits)

#define SKG_ARGUMENTS_HITS_PLACE(X) \
    X(HITS_PLACE, args) X(HITS_PLACE, counts) X(HITS_PLACE, starts) X(HITS_PLACE, total)

#define SKG_ARGUMENTS_HITS_SETTLE(X) \
    X(HITS_SETTLE, args) X(HITS_SETTLE, parts) X(HITS_SETTLE, contributions) X(HITS_SETTLE, counts) \
    X(HITS_SETTLE, starts) X(HITS_SETTLE, hits) X(HITS_SETTLE, table) X(HITS_SETTLE, used) \
    X(HITS_SETTLE, sums)

#define SKG_ARGUMENTS_HITS_SLOPES(X) \
    X(HITS_SLOPES, args) X(HITS_SLOPES, touch) X(HITS_SLOPES, parts) X(HITS_SLOPES, contributions) X(HITS_SLOPES, counts) \
    X(HITS_SLOPES, starts) X(HITS_SLOPES, hits) X(HITS_SLOPES, table) X(HITS_SLOPES, weights) X(HITS_SLOPES, slopes)

#define SKG_ARGUMENTS_VOLUME_ADD(X) \
    X(VOLUME_ADD, args) X(VOLUME_ADD, cells) X(VOLUME_ADD, weights) X(VOLUME_ADD, counts) X(VOLUME_ADD, starts) \
    X(VOLUME_ADD, hits) X(VOLUME_ADD, table) X(VOLUME_ADD, displacing) X(VOLUME_ADD, lines) \
    X(VOLUME_ADD, sums)

#define SKG_ARGUMENTS_VOLUME_SLOPES(X) \
    X(VOLUME_SLOPES, args) X(VOLUME_SLOPES, of) X(VOLUME_SLOPES, cells) X(VOLUME_SLOPES, weights) X(VOLUME_SLOPES, counts) \
    X(VOLUME_SLOPES, starts) X(VOLUME_SLOPES, hits) X(VOLUME_SLOPES, table) X(VOLUME_SLOPES, displacing) \
    X(VOLUME_SLOPES, losses) X(VOLUME_SLOPES, slopes)

#define SKG_ARGUMENTS_GRADIENT_FACES(X) \
    X(GRADIENT_FACES, args) X(GRADIENT_FACES, corners) X(GRADIENT_FACES, projected) X(GRADIENT_FACES, parts) \
    X(GRADIENT_FACES, blocks) X(GRADIENT_FACES, contributions) X(GRADIENT_FACES, weights) X(GRADIENT_FACES, scales) \
    X(GRADIENT_FACES, first_around) X(GRADIENT_FACES, around) \
    X(GRADIENT_FACES, moments) X(GRADIENT_FACES, slots) X(GRADIENT_FACES, shifts) X(GRADIENT_FACES, counts) \
    X(GRADIENT_FACES, starts) X(GRADIENT_FACES, hits) X(GRADIENT_FACES, slopes) \
    X(GRADIENT_FACES, face_slopes) X(GRADIENT_FACES, lines)

#define SKG_ARGUMENTS_GRADIENT_BATCHES(X) \
    X(GRADIENT_BATCHES, args) X(GRADIENT_BATCHES, corners) X(GRADIENT_BATCHES, projected) X(GRADIENT_BATCHES, parts) \
    X(GRADIENT_BATCHES, blocks) X(GRADIENT_BATCHES, contributions) X(GRADIENT_BATCHES, weights) \
    X(GRADIENT_BATCHES, scales) X(GRADIENT_BATCHES, first_around) X(GRADIENT_BATCHES, around) \
    X(GRADIENT_BATCHES, face_slopes) X(GRADIENT_BATCHES, lines) X(GRADIENT_BATCHES, moments)

#define SKG_ARGUMENTS_COUNT_BAD_ROWS(X) \
    X(COUNT_BAD_ROWS, layout) X(COUNT_BAD_ROWS, copies) X(COUNT_BAD_ROWS, used) X(COUNT_BAD_ROWS, planes) \
    X(COUNT_BAD_ROWS, rows_bad)

#define SKG_ARGUMENTS_COUNT_BAD(X) \
    X(COUNT_BAD, layout) X(COUNT_BAD, copies) X(COUNT_BAD, used) X(COUNT_BAD, planes) X(COUNT_BAD, rows_bad) \
    X(COUNT_BAD, first) X(COUNT_BAD, verdicts)

/* All kernels of leaky.cl begin with the arguments of LEAKY_BATCH. */
#define SKG_ARGUMENTS_LEAKY_BATCH(X) \
    X(LEAKY_BATCH, args) X(LEAKY_BATCH, copies) X(LEAKY_BATCH, used) X(LEAKY_BATCH, table)

#define SKG_ARGUMENTS_LEAKY_ADD(X) \
    X(LEAKY_ADD, args) X(LEAKY_ADD, copies) X(LEAKY_ADD, used) X(LEAKY_ADD, table) X(LEAKY_ADD, shared)

#define SKG_ARGUMENTS_LEAKY_GAPS(X) \
    X(LEAKY_GAPS, args) X(LEAKY_GAPS, copies) X(LEAKY_GAPS, used) X(LEAKY_GAPS, table) X(LEAKY_GAPS, rows_bad) \
    X(LEAKY_GAPS, gaps)

#define SKG_ARGUMENTS_LEAKY_REPAIR(X) \
    X(LEAKY_REPAIR, args) X(LEAKY_REPAIR, copies) X(LEAKY_REPAIR, used) X(LEAKY_REPAIR, table) \
    X(LEAKY_REPAIR, rows_bad) X(LEAKY_REPAIR, gaps) X(LEAKY_REPAIR, shared)

#define SKG_ARGUMENTS_LEAKY_PUT(X) \
    X(LEAKY_PUT, args) X(LEAKY_PUT, copies) X(LEAKY_PUT, used) X(LEAKY_PUT, table) X(LEAKY_PUT, pixels) \
    X(LEAKY_PUT, values) X(LEAKY_PUT, shared)

#define SKG_ARGUMENTS_ATTENUATE(X) \
    X(ATTENUATE, args) X(ATTENUATE, copies) X(ATTENUATE, used) X(ATTENUATE, coefficients) X(ATTENUATE, weights) \
    X(ATTENUATE, variances) X(ATTENUATE, lists) X(ATTENUATE, range) X(ATTENUATE, polynomials) \
    X(ATTENUATE, tables) X(ATTENUATE, negative) X(ATTENUATE, output)

#define SKG_ARGUMENTS_WEIGHTS(X) \
    X(WEIGHTS, args) X(WEIGHTS, copies) X(WEIGHTS, used) X(WEIGHTS, coefficients) X(WEIGHTS, weights_of_nodes) \
    X(WEIGHTS, lists) X(WEIGHTS, polynomials) X(WEIGHTS, tables) X(WEIGHTS, adjoint) X(WEIGHTS, channel) X(WEIGHTS, wanted) \
    X(WEIGHTS, rays) X(WEIGHTS, of_planes) X(WEIGHTS, relative) X(WEIGHTS, weights) X(WEIGHTS, most) X(WEIGHTS, of_rays)

#define SKG_ARGUMENTS_LOGARITHM(X) X(LOGARITHM, image) X(LOGARITHM, output)

#define SKG_ARGUMENTS_BLUR_DOWN(X) \
    X(BLUR_DOWN, args) X(BLUR_DOWN, image) X(BLUR_DOWN, weights) X(BLUR_DOWN, workspace)

#define SKG_ARGUMENTS_BLUR_ACROSS(X) \
    X(BLUR_ACROSS, args) X(BLUR_ACROSS, workspace) X(BLUR_ACROSS, weights) X(BLUR_ACROSS, image)

#define SKG_ARGUMENTS_BLUR_VARIANCE(X) \
    X(BLUR_VARIANCE, args) X(BLUR_VARIANCE, from) X(BLUR_VARIANCE, weights) X(BLUR_VARIANCE, to)

#define SKG_ARGUMENTS_PULSES(X) X(PULSES, args) X(PULSES, from) X(PULSES, weights) X(PULSES, to)

#define SKG_ARGUMENTS_PULSES_VARIANCE(X) \
    X(PULSES_VARIANCE, args) X(PULSES_VARIANCE, from) X(PULSES_VARIANCE, weights) X(PULSES_VARIANCE, to)

#define SKG_ARGUMENTS_DETECT(X) X(DETECT, args) X(DETECT, factor) X(DETECT, flat_field) X(DETECT, image)

#define SKG_ARGUMENTS_DETECT_VARIANCE(X) \
    X(DETECT_VARIANCE, args) X(DETECT_VARIANCE, factor) X(DETECT_VARIANCE, flat_field) X(DETECT_VARIANCE, mean) \
    X(DETECT_VARIANCE, variance)

#define SKG_ARGUMENTS_SCATTER(X) \
    X(SCATTER, args) X(SCATTER, media) X(SCATTER, tree) X(SCATTER, faces) X(SCATTER, energies) X(SCATTER, momenta) X(SCATTER, angles) X(SCATTER, beam) \
    X(SCATTER, profiles) X(SCATTER, spots) X(SCATTER, lattice) X(SCATTER, detector) X(SCATTER, sums)

#define SKG_ARGUMENTS_SCATTERED(X) \
    X(SCATTERED, args) X(SCATTERED, mean) X(SCATTERED, variance) X(SCATTERED, image)

#define SKG_ARGUMENTS_SHOW_COUNT(X) \
    X(SHOW_COUNT, args) X(SHOW_COUNT, vertices) X(SHOW_COUNT, corners) X(SHOW_COUNT, normals) \
    X(SHOW_COUNT, colours) X(SHOW_COUNT, faces) X(SHOW_COUNT, counts)

#define SKG_ARGUMENTS_SHOW_FILL(X) \
    X(SHOW_FILL, args) X(SHOW_FILL, faces) X(SHOW_FILL, cursors) X(SHOW_FILL, entries)

#define SKG_ARGUMENTS_SHOW_DRAW(X) \
    X(SHOW_DRAW, args) X(SHOW_DRAW, faces) X(SHOW_DRAW, starts) X(SHOW_DRAW, entries) X(SHOW_DRAW, image) \
    X(SHOW_DRAW, rgba)

/* X(KERNEL, function) for each kernel. */
#define SKG_KERNELS(X) \
    X(PROJECT, skg_project) X(PLACE, skg_place) X(RASTER_COPIES, skg_raster_copies) \
    X(RASTER_PASSES, skg_raster_passes) X(RASTER_ATOMICS, skg_raster_atomics) \
    X(RASTER_QUEUE, skg_raster_queue) X(TILES_COUNT, skg_tiles_count) X(TILES_SCAN, skg_tiles_scan) \
    X(TILES_FILL, skg_tiles_fill) X(RASTER_SQUARES, skg_raster_squares) X(BANDS_SORT, skg_bands_sort) \
    X(RASTER_BANDS, skg_raster_bands) X(RASTER_HALF, skg_raster_half) X(SOURCE_PLANE, skg_source_plane) \
    X(HITS_CLEAR, skg_hits_clear) X(HITS_LIST, skg_hits_list) X(HITS_SOURCE_PLANE, skg_hits_source_plane) X(HITS_PLACE, skg_hits_place) \
    X(HITS_SETTLE, skg_hits_settle) X(HITS_SLOPES, skg_hits_slopes) X(VOLUME_ADD, skg_volume_add) \
    X(VOLUME_SLOPES, skg_volume_slopes) X(GRADIENT_FACES, skg_gradient_faces) X(GRADIENT_BATCHES, skg_gradient_batches) \
    X(COUNT_BAD_ROWS, skg_count_bad_rows) X(COUNT_BAD, skg_count_bad) \
    X(LEAKY_ADD, skg_leaky_add) X(LEAKY_GAPS, skg_leaky_gaps) X(LEAKY_REPAIR, skg_leaky_repair) \
    X(LEAKY_PUT, skg_leaky_put) X(ATTENUATE, skg_attenuate) X(WEIGHTS, skg_weights) X(LOGARITHM, skg_logarithm) \
    X(BLUR_DOWN, skg_blur_down) X(BLUR_ACROSS, skg_blur_across) X(BLUR_VARIANCE, skg_blur_variance) \
    X(PULSES, skg_pulses) X(PULSES_VARIANCE, skg_pulses_variance) X(DETECT, skg_detect) \
    X(DETECT_VARIANCE, skg_detect_variance) X(SCATTER, skg_scatter) X(SCATTERED, skg_scattered) \
    X(SHOW_COUNT, skg_show_count) X(SHOW_FILL, skg_show_fill) X(SHOW_DRAW, skg_show_draw)
/* clang-format on */

/* SKG_<KERNEL>_<name>: the argument's position; SKG_<KERNEL>_ARGUMENTS: how many there are. */
#define SKG_ARGUMENT_POSITION(kernel, name) SKG_##kernel##_##name,
#define SKG_ARGUMENT_POSITIONS(kernel, function)                                                             \
    enum { SKG_ARGUMENTS_##kernel(SKG_ARGUMENT_POSITION) SKG_##kernel##_ARGUMENTS };
SKG_KERNELS(SKG_ARGUMENT_POSITIONS)
SKG_ARGUMENT_POSITIONS(LEAKY_BATCH, )

#endif
