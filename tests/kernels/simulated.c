/* Scenes small enough for a simulator (Oclgrind: races, bounds), a group of kernels each: simulated GROUP. Exit
 * status 0: every call succeeded, and every pixel lies between nothing and the open beam. */
#include "device/device.h"
#include "support/doubles.h"
#include "support/shapes.h"

#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 20, ROWS = 12, PIXELS = COLUMNS * ROWS };

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((call) != SKG_OK) {                                                                              \
            fprintf(stderr, "%s: %s\n", #call, skg_last_error());                                            \
            exit(EXIT_FAILURE);                                                                              \
        }                                                                                                    \
    } while (0)

/* Settings of a group; 0 or NULL: not used. */
typedef struct {
    const char *name;
    int32_t precision, strategy, quantity, repair, falloff, supersampling;
    int32_t leaky;    /* the box lacks a triangle */
    int32_t priority; /* the octahedron's, which overlaps the box */
    int32_t inside;   /* the source stands in the box */
    int32_t parallel, colours, world, bands, noise, dqe, blur;
    int32_t spot;   /* samples of the source; with strategy copies, for each worker */
    int32_t shades; /* heel, bow-tie, grid and an oblique scintillator; 2: the first two */
    double electronic, step, tolerance;
    int32_t picture;  /* draws the 3D view instead of an image */
    int32_t scatter;  /* histories */
    int32_t gradient; /* makes the gradient of an image, too */
    int32_t cpu;      /* with the kernels of processors; the simulator calls itself a GPU */
    int32_t placed;   /* the positions of the ball are taken from device memory */
    int32_t variance; /* of the noise, instead of the image */
    int32_t volume;   /* cells instead of the box, which the octahedron displaces */
    int32_t counting; /* the detector counts, with this pile-up beyond 1 */
    int32_t curved;   /* the detector is a cylinder */
} group;

enum { BLUR_LINES = 1, BLUR_POINT = 2 };

static const group groups[] = {
    {.name = "copies", .strategy = SKG_STRATEGY_COPIES},
    {.name = "passes", .strategy = SKG_STRATEGY_COPIES, .colours = 1, .spot = 4},
    {.name = "double_passes", .precision = SKG_PRECISION_DOUBLE, .strategy = SKG_STRATEGY_COPIES, .spot = 4},
    {.name = "tiles", .strategy = SKG_STRATEGY_TILES},
    {.name = "atomics", .strategy = SKG_STRATEGY_ATOMICS},
    {.name = "parallel", .parallel = 1},
    {.name = "attenuate", .colours = 1, .world = 1, .falloff = 1, .supersampling = 2, .spot = 1},
    {.name = "fine_noise", .supersampling = 3, .noise = 1, .dqe = 1, .tolerance = 1e-3},
    {.name = "fine_half", .precision = SKG_PRECISION_HALF, .supersampling = 2},
    {.name = "double_fine", .precision = SKG_PRECISION_DOUBLE, .supersampling = 2, .spot = 1},
    {.name = "logarithm", .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION, .world = 1, .spot = 1},
    {.name = "shades", .colours = 1, .shades = 1, .noise = 1},
    {.name = "double_shades", .precision = SKG_PRECISION_DOUBLE, .colours = 1, .shades = 1},
    {.name = "bands", .colours = 1, .bands = 2, .tolerance = 1e-3},
    {.name = "double", .precision = SKG_PRECISION_DOUBLE, .colours = 1, .world = 1},
    {.name = "double_atomics", .precision = SKG_PRECISION_DOUBLE, .strategy = SKG_STRATEGY_ATOMICS},
    {.name = "double_tiles", .precision = SKG_PRECISION_DOUBLE, .strategy = SKG_STRATEGY_TILES},
    {.name = "double_noise",
     .precision = SKG_PRECISION_DOUBLE,
     .noise = 1,
     .electronic = 2,
     .blur = BLUR_LINES},
    {.name = "half", .precision = SKG_PRECISION_HALF},
    {.name = "hits", .priority = 2},
    {.name = "double_hits", .precision = SKG_PRECISION_DOUBLE, .priority = 2},
    {.name = "volume", .volume = 1, .gradient = 1},
    {.name = "double_volume", .precision = SKG_PRECISION_DOUBLE, .volume = 1, .parallel = 1, .colours = 1},
    {.name = "hits_source_plane", .priority = 2, .inside = 1},
    {.name = "leaky", .leaky = 1, .repair = SKG_REPAIR_NEIGHBOURS},
    {.name = "leaky_exact", .leaky = 1, .repair = SKG_REPAIR_EXACT},
    {.name = "double_leaky", .precision = SKG_PRECISION_DOUBLE, .leaky = 1, .repair = SKG_REPAIR_NEIGHBOURS},
    {.name = "source_plane", .inside = 1},
    {.name = "double_source_plane", .precision = SKG_PRECISION_DOUBLE, .inside = 1},
    {.name = "blur", .blur = BLUR_LINES},
    {.name = "noise_apart", .noise = 1, .dqe = 1, .colours = 1, .blur = BLUR_LINES},
    {.name = "blur_point", .blur = BLUR_POINT},
    {.name = "noise", .noise = 1, .colours = 1},
    {.name = "detector", .electronic = 2, .step = 0.5, .noise = 1},
    {.name = "scatter", .scatter = 32, .colours = 1, .noise = 1},
    {.name = "scatter_bands", .scatter = 32, .colours = 1, .noise = 1, .shades = 1, .bands = 2},
    {.name = "scatter_world", .scatter = 32, .colours = 1, .noise = 1, .world = 1, .dqe = 1},
    {.name = "double_scatter", .precision = SKG_PRECISION_DOUBLE, .scatter = 32, .parallel = 1},
    {.name = "gradient", .priority = 2, .colours = 1, .gradient = 1},
    {.name = "gradient_batches", .priority = 2, .colours = 1, .gradient = 1, .cpu = 1},
    {.name = "double_gradient",
     .precision = SKG_PRECISION_DOUBLE,
     .gradient = 1,
     .parallel = 1,
     .supersampling = 2},
    {.name = "variance", .noise = 1, .electronic = 2, .blur = BLUR_POINT, .variance = 1},
    {.name = "double_variance",
     .precision = SKG_PRECISION_DOUBLE,
     .quantity = SKG_QUANTITY_ATTENUATION,
     .noise = 1,
     .falloff = SKG_FALLOFF_ON,
     .blur = BLUR_LINES,
     .scatter = 32,
     .variance = 1},
    {.name = "counting", .counting = 1 + SKG_PILE_UP_PARALYSABLE, .noise = 1, .colours = 1},
    {.name = "double_counting",
     .precision = SKG_PRECISION_DOUBLE,
     .quantity = SKG_QUANTITY_ATTENUATION,
     .counting = 1 + SKG_PILE_UP_NONPARALYSABLE,
     .noise = 1,
     .colours = 1},
    {.name = "counting_variance", .counting = 1, .noise = 1, .variance = 1},
    {.name = "curved",
     .curved = 1,
     .colours = 1,
     .world = 1,
     .falloff = 1,
     .shades = 2,
     .noise = 1,
     .spot = 1},
    {.name = "curved_tiles", .curved = 1, .strategy = SKG_STRATEGY_TILES, .priority = 2},
    {.name = "double_curved",
     .precision = SKG_PRECISION_DOUBLE,
     .curved = 1,
     .parallel = 1,
     .strategy = SKG_STRATEGY_ATOMICS},
    {.name = "curved_volume", .curved = 1, .volume = 1},
    {.name = "show", .picture = 1},
    {.name = "place", .placed = 1},
    {.name = "double_place", .precision = SKG_PRECISION_DOUBLE, .placed = 1}};

static const group *find(const char *name) {
    for (size_t n = 0; n < sizeof groups / sizeof *groups; n++)
        if (strcmp(groups[n].name, name) == 0) return &groups[n];
    fprintf(stderr, "no group %s\n", name);
    exit(EXIT_FAILURE);
}

static void add(skg_context *context, skg_scene *scene, const char *label, solid s, const char *material,
                int32_t priority) {
    skg_part part;
    skg_part_init(&part);
    TRY(skg_mesh_create(context, label,
                        &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                           .vertices = s.vertices,
                                           .positions = s.positions,
                                           .triangles = s.triangles,
                                           .corners = s.corners,
                                           .unit_mm = 1},
                        &part.mesh));
    TRY(skg_material_create_named(material, &part.material));
    part.label = label;
    part.priority = priority;
    TRY(skg_scene_part_add(scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
    solid_free(&s);
}

/* A volume, with the ball inside. */
static void add_volume(skg_scene *scene, const group *g) {
    static const int16_t cells[12] = {0, 40, -1000, 60, 300, 20, 10, 1200, -500, 0, 80, 2000};
    skg_part part;
    skg_volume_source source;
    skg_part_init(&part);
    skg_volume_source_init(&source);
    source.columns = 3, source.rows = source.slices = 2, source.cells = cells;
    for (int k = 0; k < 3; k++) source.affine[5 * k] = 20, source.affine[4 * k + 3] = -10;
    TRY(skg_volume_create(&source, &part.volume));
    part.label = "volume", part.priority = g->priority;
    TRY(skg_scene_part_add(scene, &part, NULL));
    skg_volume_release(&part.volume);
}

static skg_scene *make_scene(skg_context *context, const group *g) {
    skg_scene *scene = NULL;
    solid box = g->inside ? solid_box(60, 40, 500) : solid_box(60, 40, 20);
    solid ball = solid_sphere(12, 6, 4);
    if (g->inside) solid_shift(&box, 0, 0, -600); /* around the source, at z = -600 */
    if (g->leaky) box.triangles--;
    solid_shift(&ball, 22, 5, !g->priority ? 60 : g->inside ? -352 : 4); /* with a priority: cuts the box */
    TRY(skg_scene_create(context, &scene));
    if (g->volume) {
        solid_free(&box);
        solid_shift(&ball, 0, 0, -50);
        add_volume(scene, g);
        add(context, scene, "ball", ball, "Al", 1);
        return scene;
    }
    add(context, scene, "box", box, "Water", 0);
    add(context, scene, "ball", ball, "Al", g->priority);
    return scene;
}

static skg_view make_view(const group *g) {
    skg_view view;
    skg_view_init(&view);
    view.columns = COLUMNS, view.rows = ROWS;
    view.source[2] = g->inside ? -600 : -1000;
    view.centre[2] = 200;
    view.column_step[0] = view.row_step[1] = 6;
    if (g->parallel) view.projection = SKG_PROJECTION_PARALLEL;
    if (g->curved) view.radius = 1000;
    return view;
}

/* Structs to which options point while a plan is made. */
typedef struct {
    skg_heel heel;
    skg_bowtie bowtie;
    skg_grid grid;
    skg_collimation jaws;
} shades;

static void add_shades(int32_t which, shades *s, skg_plan_options *options) {
    static const double angles[3] = {-20, 1, 20}, paths[3] = {10, 1, 12};
    skg_material *csi = NULL;
    skg_heel_init(&s->heel);
    skg_bowtie_init(&s->bowtie);
    skg_grid_init(&s->grid);
    skg_collimation_init(&s->jaws);
    s->heel.kvp = 100, s->heel.direction[1] = 1;
    s->bowtie.count = 3, s->bowtie.angle_deg = angles, s->bowtie.path_mm = paths;
    s->grid.ratio = 8, s->grid.lines_per_cm = 40, s->grid.strip_mm = 0.05, s->grid.focus_mm = 1000;
    TRY(skg_material_create_named("Al", &s->bowtie.material));
    TRY(skg_material_create_named("CsI", &csi));
    TRY(skg_response_create_scintillator(csi, 0.6, 0.8, &options->response));
    skg_material_release(&csi);
    options->heel = &s->heel, options->bowtie = &s->bowtie;
    if (which == 2) return;
    options->grid = &s->grid, options->oblique = 1;
    s->jaws.kind = SKG_COLLIMATION_DETECTOR, s->jaws.margin_mm = -20;
    options->collimation = &s->jaws;
}

static void add_counter(const group *g, const skg_view *view, skg_plan_options *options) {
    static const double thresholds[2] = {20, 50};
    skg_counting counting;
    skg_counting_init(&counting);
    counting.thickness_mm = 1, counting.cloud_mm = 0.1, counting.count = 2;
    counting.threshold_kev = thresholds;
    counting.pixel_mm[0] = view->column_step[0];
    counting.pixel_mm[1] = view->row_step[1];
    counting.pile_up = g->counting - 1;
    if (counting.pile_up) counting.dead_time_ns = 100, counting.exposure_s = 1e-4;
    TRY(skg_material_create_named("CdTe", &counting.material));
    TRY(skg_counter_create(&counting, &options->counter));
    skg_material_release(&counting.material);
    if (g->quantity == SKG_QUANTITY_ENERGY) options->quantity = SKG_QUANTITY_PHOTONS;
}

static skg_plan *make_plan(skg_context *context, skg_scene *scene, const skg_view *view, const group *g) {
    static const double energies[3] = {40, 60, 90}, photons[3] = {50, 80, 30}, edges[3] = {10, 55, 100};
    static const double line[3] = {0.2, 1, 0.3}, point[9] = {0, 1, 0, 1, 4, 2, 0, 1, 0};
    skg_plan_options options;
    static const double frequencies[2] = {0, 1}, efficiencies[2] = {0.6, 0.5};
    skg_detector_blur blur;
    skg_dqe dqe;
    skg_spot spot;
    shades more = {0};
    skg_scatter scatter;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    skg_detector_blur_init(&blur);
    skg_spot_init(&spot);
    options.precision = g->precision, options.strategy = g->strategy, options.quantity = g->quantity;
    options.repair = g->repair, options.falloff = g->falloff, options.overlaps = 0;
    if (g->supersampling) options.supersampling = g->supersampling;
    if (g->world) TRY(skg_material_create_named("Air", &options.world));
    options.bands = g->bands, options.band_kev = edges, options.tolerance = g->tolerance;
    options.noise = g->noise, options.electronic_kev = g->electronic, options.quantum_step_kev = g->step;
    blur.columns = blur.rows = 3, blur.along_row = blur.along_column = line;
    if (g->blur == BLUR_POINT) blur.along_row = blur.along_column = NULL, blur.point = point;
    if (g->blur) options.blur = &blur;
    skg_dqe_init(&dqe);
    dqe.count = 2, dqe.per_mm = frequencies, dqe.dqe = efficiencies;
    if (g->dqe) options.dqe = &dqe;
    spot.shape = SKG_SPOT_RECTANGLE, spot.extent[0] = spot.extent[1] = 1, spot.samples = 2;
    if (g->strategy == SKG_STRATEGY_COPIES) spot.samples = g->spot * context->device->info.compute_units;
    if (g->spot) options.spot = &spot;
    if (g->shades) add_shades(g->shades, &more, &options);
    if (g->counting) add_counter(g, view, &options);
    skg_scatter_init(&scatter);
    scatter.histories = g->scatter;
    if (g->scatter) options.scatter = &scatter;
    TRY(skg_spectrum_create_bins(g->colours ? 3 : 1, energies, photons, &beam));
    TRY(skg_plan_create(context, scene, view, beam, &options, &plan));
    skg_spectrum_release(&beam);
    skg_material_release(&options.world);
    skg_material_release(&more.bowtie.material);
    skg_response_release(&options.response);
    skg_counter_release(&options.counter);
    return plan;
}

static int lies_between(const float *values, int64_t count, double least, double most) {
    for (int64_t p = 0; p < count; p++)
        if (!((double)values[p] >= least && (double)values[p] <= most)) {
            fprintf(stderr, "pixel %lld: %g\n", (long long)p, (double)values[p]);
            return 0;
        }
    return 1;
}

/* Gives the plan the positions that the second part has already, by device memory. */
static void place_ball(skg_context *context, const skg_scene *scene, skg_plan *plan) {
    skg_part part;
    int64_t vertices, triangles;
    float *offsets = NULL, lowest[3] = {-50, -50, -50}, highest[3] = {50, 50, 50};
    const double *origin;
    cl_int code;
    skg_part_init(&part);
    TRY(skg_scene_part_get(scene, 1, &part));
    TRY(skg_mesh_count(part.mesh, &vertices, &triangles));
    TRY(skg_mesh_offsets_get(part.mesh, &offsets, &origin));
    cl_mem buffer = clCreateBuffer(context->device->cl, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                   (size_t)(3 * vertices) * sizeof *offsets, offsets, &code);
    if (code != CL_SUCCESS) exit(EXIT_FAILURE);
    TRY(skg_plan_positions_set_cl(plan, 1, buffer, 0, lowest, highest, 0, NULL, NULL));
    clReleaseMemObject(buffer);
}

/* The 3D view; one part is translucent, and the detector shows an image. */
static int draw_picture(skg_context *context, const skg_scene *scene, const skg_view *view) {
    static uint8_t rgba[4 * PIXELS], image[PIXELS];
    const uint8_t colours[8] = {200, 100, 50, 90, 50, 100, 200, 255};
    skg_look look;
    skg_look_init(&look);
    look.columns = COLUMNS, look.rows = ROWS;
    look.colours = colours;
    look.image = image;
    TRY(skg_scene_picture(context, scene, view, &look, rgba));
    for (int p = 0; p < PIXELS; p++)
        if (rgba[4 * p + 3] != 255) return 0;
    return 1;
}

/* The adjoint of the sum of an image. */
static skg_adjoint sum_of_pixels(void) {
    static double adjoint[PIXELS];
    skg_adjoint given;
    skg_adjoint_init(&given);
    for (int p = 0; p < PIXELS; p++) adjoint[p] = 1;
    given.channels = 1, given.rows = ROWS, given.columns = COLUMNS, given.data = adjoint;
    return given;
}

/* The gradient of the sum of an image: whatever moves with everything else changes nothing. */
static int makes_gradient(skg_plan *plan) {
    double poses[12], source[3], detector[6], densities[2];
    const skg_adjoint given = sum_of_pixels();
    skg_gradient gradient;
    skg_gradient_init(&gradient);
    gradient.poses = poses, gradient.source = source, gradient.detector = detector;
    gradient.densities = densities;
    TRY(skg_plan_gradient(plan, NULL, &given, &gradient));
    double along[PIXELS], twists[12] = {1}, sum = 0;
    skg_direction direction;
    skg_direction_init(&direction);
    direction.poses = twists;
    TRY(skg_plan_derivatives(plan, NULL, 1, &direction, DOUBLES(along), NULL));
    for (int p = 0; p < PIXELS; p++) sum += along[p];
    /* Hits are those of the gradient, added up in another order in single precision. */
    const double error = 1e-4 * (fabs(sum) + fabs(source[0]));
    if (!(fabs(sum - poses[0]) <= error)) return 0;
    for (int k = 0; k < 3; k++) {
        const double size = fabs(poses[k]) + fabs(poses[6 + k]) + fabs(source[k]) + fabs(detector[k]);
        /* Single precision: each of some dozen faces is known to 1e-6 of its place in the picture. */
        if (!(fabs(poses[k] + poses[6 + k] + source[k] + detector[k]) <= 1e-4 * size + 1e-9)) return 0;
    }
    return densities[0] < 0 && densities[1] < 0;
}

/* The gradient by the places of parts beside or in a volume, which has none of its own: that of the mesh is finite. */
static int makes_poses(skg_plan *plan) {
    double poses[12];
    const skg_adjoint given = sum_of_pixels();
    skg_gradient gradient;
    skg_gradient_init(&gradient);
    gradient.poses = poses;
    TRY(skg_plan_gradient(plan, NULL, &given, &gradient));
    int finite = 0;
    for (int part = 0; part < 2; part++) {
        int all = 1;
        for (int k = 0; k < 6; k++) all &= isfinite(poses[6 * part + k]) != 0;
        finite += all;
    }
    return finite == 1;
}

int main(int count, char **words) {
    static float image[2 * PIXELS];
    const group *g = find(count == 2 ? words[1] : "");
    skg_context *context = NULL;
    skg_output output;
    TRY(skg_context_create(NULL, &context));
    if (g->cpu) context->device->info.gpu = 0;
    skg_scene *scene = make_scene(context, g);
    const skg_view view = make_view(g);
    if (g->picture) {
        const int drawn = draw_picture(context, scene, &view);
        skg_scene_release(&scene);
        skg_context_release(&context);
        return drawn ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    skg_plan *plan = make_plan(context, scene, &view, g);
    skg_output_init(&output);
    output.data = image;
    if (g->variance) output.kind = SKG_OUTPUT_VARIANCE;
    if (g->placed) place_ball(context, scene, plan);
    TRY(skg_plan_image(plan, &output));
    /* 10,500 keV is the open beam; noise widens it, the logarithm of the range of a float is below 104. The variance of photons of
     * 40 keV is 40 times their energy. */
    const double most = g->quantity == SKG_QUANTITY_ATTENUATION ? 104 : 2 * 10500 * (g->variance ? 40 : 1);
    const int good =
        lies_between(image, g->bands ? g->bands * PIXELS : PIXELS, g->noise ? -100 : -1e-3, most);
    const int also_good = !g->gradient || (g->volume ? makes_poses(plan) : makes_gradient(plan));
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_context_release(&context);
    return good && also_good ? EXIT_SUCCESS : EXIT_FAILURE;
}
