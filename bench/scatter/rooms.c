/* Rooms of tests/scatter, as scenes of the library and as their truth. */
#include "scatter/rooms.h"

#include "../tests/scatter/rooms.h"
#include "../tests/scatter/rooms_truth.h"
#include "scatter/subject.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Pixels of a block; segments of a round body; the random rooms and their seeds, which begin after these; runs of a room; histories of
 * the long run over those of the first. */
enum { BLOCK_PIXELS = 16, ROUND = 256, DRAWN = 20, DRAWN_AFTER = 100, RUNS = 3, LONGER = 4 };

static skg_mesh *mesh_of(const room_body *b) {
    skg_mesh *mesh = NULL;
    if (b->shape == ROOM_BOX)
        bench_try(skg_mesh_create_cuboid(b->size[0], b->size[1], b->size[2], &mesh), "box");
    else if (b->shape == ROOM_BALL)
        bench_try(skg_mesh_create_sphere(b->size[0], ROUND, &mesh), "ball");
    else
        bench_try(skg_mesh_create_cylinder(b->size[0], b->size[1], ROUND, &mesh), "rod");
    return mesh;
}

static skg_material *material_of(const char *name, double density) {
    skg_material *material = NULL, *dense = NULL;
    bench_try(skg_material_create_named(name, &material), name);
    if (!(density > 0)) return material;
    bench_try(skg_material_create_at_density(material, density, &dense), name);
    skg_material_release(&material);
    return dense;
}

static void add_body(const subject *s, const room_body *b, int number) {
    skg_part part;
    char label[32];
    skg_part_init(&part);
    snprintf(label, sizeof label, "body %d", number);
    part.label = label;
    part.mesh = mesh_of(b);
    part.material = material_of(b->material, b->density);
    part.inside = b->inside - 1;
    for (int i = 0; i < 3 && b->shape == ROOM_ROD;
         i++) /* axes change places, so that the mesh's z becomes the rod's axis */
        for (int k = 0; k < 3; k++) part.pose[4 * i + k] = i == (k + (int)b->size[2] + 1) % 3 ? 1 : 0;
    for (int k = 0; k < 3; k++) part.pose[4 * k + 3] = b->at[k];
    bench_try(skg_scene_part_add(s->scene, &part, NULL), label);
    skg_mesh_release(&part.mesh);
    skg_material_release(&part.material);
}

static subject open_room(skg_context *context, const room *r) {
    /* The truth has no lines. */
    subject s = {.name = r->name, .context = context, .rays = 2, .fluorescence = SKG_FLUORESCENCE_OFF};
    skg_view_init(&s.view);
    s.view.source[2] = r->source, s.view.centre[2] = r->plane;
    s.view.columns = s.view.rows = ROOM_SIDE * BLOCK_PIXELS;
    s.view.column_step[0] = r->side[0] / (double)s.view.columns;
    s.view.row_step[1] = r->side[1] / (double)s.view.rows;
    bench_try(skg_scene_create(context, &s.scene), r->name);
    for (int b = 0; b < r->count; b++) add_body(&s, &r->bodies[b], b);
    bench_try(skg_spectrum_create_bins(r->bins, r->kev, r->photons, &s.beam), r->name);
    if (r->world) s.world = material_of(r->world, 0);
    return s;
}

/* Means of an image over blocks, over the energy of the open beam. */
static void take_blocks(const room *r, const subject *s, const double *image, double blocks[ROOM_BLOCKS]) {
    double kev = 0;
    for (int b = 0; b < r->bins; b++) kev += r->photons[b] * r->kev[b];
    for (int k = 0; k < ROOM_BLOCKS; k++) blocks[k] = 0;
    for (int64_t i = 0; i < s->view.rows * s->view.columns; i++)
        blocks[i / s->view.columns / BLOCK_PIXELS * ROOM_SIDE + i % s->view.columns / BLOCK_PIXELS] +=
            image[i] / kev / (BLOCK_PIXELS * BLOCK_PIXELS);
}

/* Errors of a room, over the mean. */
typedef struct {
    double off, blocks, worst; /* of the sum; root mean square over the blocks; of a block */
    /* root mean square over the pixels; the part of it that stays in a long run; as stated */
    double found, still, stated;
} finding;

/* The square of the root mean square of a run's blocks beside the truth's, less what the truth's own noise explains. */
static double square_of_blocks(const room *r, const room_truth *truth, const subject *s, const taken *t,
                               finding *f) {
    double ours[ROOM_BLOCKS], sum[2] = {0}, square = 0;
    take_blocks(r, s, t->scatter, ours);
    f->worst = 0;
    for (int k = 0; k < ROOM_BLOCKS; k++) {
        const double off = ours[k] - truth->scatter[k];
        sum[0] += ours[k], sum[1] += truth->scatter[k];
        square += off * off - truth->sigma[k] * truth->sigma[k];
        if (fabs(off / truth->scatter[k]) > fabs(f->worst)) f->worst = off / truth->scatter[k];
    }
    f->off = sum[0] / sum[1] - 1;
    return square * ROOM_BLOCKS / (sum[1] * sum[1]);
}

/* Of pixels, as the stated error is meant: what runs differ by from one of many more histories, less its own noise, and what that one's
 * blocks are off by from the truth beyond the noise of both. */
static finding compare(const room *r, const room_truth *truth, const subject *s, double tolerance) {
    finding f = {0};
    taken first = subject_take(s, tolerance, 0, 1);
    taken best = subject_take(s, 0, first.report.histories * LONGER, RUNS + 1);
    const double own = pow(best.report.sigma / best.report.mean, 2);
    f.still = sqrt(fmax(square_of_blocks(r, truth, s, &best, &f) - own, 0));
    f.blocks = sqrt(fmax(square_of_blocks(r, truth, s, &first, &f), 0));
    for (int run = 1; run <= RUNS; run++) {
        taken t = run == 1 ? first : subject_take(s, tolerance, 0, run);
        double square = 0;
        for (int64_t i = 0; i < t.count; i++)
            square += pow((t.scatter[i] - best.scatter[i]) / best.report.mean, 2) / (double)t.count;
        f.found += (square - own) / RUNS;
        f.stated += pow(t.report.sigma / t.report.mean, 2) / RUNS;
        taken_free(&t);
    }
    f.found = hypot(sqrt(fmax(f.found, 0)), f.still);
    f.stated = sqrt(f.stated);
    taken_free(&best);
    return f;
}

static int is_chosen(const char *name, const char *only) {
    return !only || strstr(name, only);
}

static void compare_room(skg_context *context, const room *r, const room_truth *truth, double tolerance,
                         FILE *csv) {
    subject s = open_room(context, r);
    const finding f = compare(r, truth, &s, tolerance);
    printf("| %s | %.4g +- %.1f %% | %+.1f %% | %.1f %% | %+.0f %% | %.2f %% | %.2f %% | %.2f %% | %.2f |\n",
           r->name, truth->ratio, 100 * truth->ratio_sigma / truth->ratio, 100 * f.off, 100 * f.blocks,
           100 * f.worst, 100 * f.still, 100 * f.found, 100 * f.stated, f.found / f.stated);
    fflush(stdout);
    if (csv)
        fprintf(csv, "%s,found over stated,%.9g,%.3g,%.3g,%d,0\n", r->name, f.found / f.stated, 100 * f.found,
                f.worst, ROOM_BLOCKS);
    subject_close(&s);
}

void rooms_compare(skg_context *context, const char *only, FILE *csv) {
    char name[32];
    printf(
        "Scatter over primary as photons have it that are followed from surface to surface; ours to 1 %%, of random rooms to 2 %%: the sum over the detector, the "
        "root mean square over its %d blocks, the worst block; what the blocks of a long run (%d times the histories) are off by beyond "
        "the noise of both; the root mean square over the pixels of %d runs, which contains that; the error stated.\n\n"
        "| room | scatter over primary | sum off by | blocks off by | worst | in a long run | pixels off by | stated | found / stated |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        ROOM_BLOCKS, LONGER, RUNS);
    for (int i = 0; i < rooms_count; i++)
        if (is_chosen(rooms[i].name, only)) compare_room(context, &rooms[i], &rooms_truths[i], 0.01, csv);
    for (int i = 0; i < DRAWN; i++) {
        const room r = room_draw((uint64_t)(DRAWN_AFTER + i), name);
        if (is_chosen(name, only)) compare_room(context, &r, &rooms_truths[rooms_count + i], 0.02, csv);
    }
}

static void print_numbers(const char *name, const double *numbers) {
    printf("     .%s = {", name);
    for (int k = 0; k < ROOM_BLOCKS; k++) printf("%s%.6g", k ? ", " : "", numbers[k]);
    printf("},\n");
}

static void make_truth(const room *r, int64_t histories) {
    const room_truth t = room_follow(r, ROOM_EXPECTED, histories, 1);
    printf("    /* %s */\n    {\n", r->name);
    print_numbers("primary", t.primary);
    print_numbers("scatter", t.scatter);
    print_numbers("sigma", t.sigma);
    printf("     .ratio = %.6g, .ratio_sigma = %.3g, .histories = %.0f},\n", t.ratio, t.ratio_sigma,
           t.histories);
    fflush(stdout);
}

void rooms_make_truth(const char *only, int64_t histories) {
    char name[32];
    for (int i = 0; i < rooms_count; i++)
        if (is_chosen(rooms[i].name, only)) make_truth(&rooms[i], histories);
    for (int i = 0; i < DRAWN; i++) {
        const room r = room_draw((uint64_t)(DRAWN_AFTER + i), name);
        if (is_chosen(name, only)) make_truth(&r, histories);
    }
}
