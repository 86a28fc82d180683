/* Meshes that are no solids, and very many of them. */
#include "hard/catalogue.h"
#include "suite.h"
#include "support/caster.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 96, PIXELS = SIDE * SIDE };

/* Lengths of a mesh that may be open: those of what it stands for where its signed hits cancel, finite
 * elsewhere, and as many pixels told as do not cancel. */
static void judge_open(hard_outcome *o, const solid *s, const solid *meant, int64_t min_bad) {
    const skg_view view = run_view(SIDE, 1.7);
    static double truth[PIXELS];
    double longest = 0;
    int64_t bad = 0;
    caster *c = caster_create(meant, NULL);
    for (int p = 0; p < PIXELS; p++) {
        truth[p] = (double)caster_length(c, &view, (long double)(p % SIDE), (long double)(p / SIDE));
        bad += isnan(truth[p]) != 0;
        if (truth[p] > longest) longest = truth[p];
    }
    caster_free(c);
    if (bad < min_bad) hard_fault(o, "the case has %lld open pixels only", (long long)bad);
    o->unit = "of the longest path, where hits cancel";
    skg_scene *scene = run_scene(s, NULL);
    for (int32_t precision = 0; precision <= run_has_double(); precision++) {
        uint64_t first = 0;
        for (int way = 0; way < HARD_WAYS; way++) {
            run_choice choice = hard_ways[way];
            skg_plan_report report;
            choice.precision = precision;
            choice.quantity = SKG_QUANTITY_ATTENUATION;
            skg_plan *plan = run_plan(scene, &view, choice);
            double *got = run_image(plan, &view); /* 1 per cm: a tenth of the length in mm */
            hard_same_bits(o, way, got, PIXELS, &first);
            skg_plan_report_init(&report);
            ck_skg(skg_plan_report_get(plan, &report));
            if (report.leaky_parts == 1 && report.bad_pixels != bad)
                hard_fault(o, "%lld open pixels told, %lld are", (long long)report.bad_pixels,
                           (long long)bad);
            if (report.leaky_parts == 0 && bad) hard_fault(o, "an open mesh was taken for a closed one");
            double worst = 0;
            for (int p = 0; p < PIXELS && way == 0; p++)
                if (!isnan(truth[p])) worst = fmax(worst, fabs(10 * got[p] - truth[p]) / fmax(longest, 1));
            hard_check_values(o, got, PIXELS, -0.2 * fmax(longest, 1));
            if (way == 0) {
                o->worst[precision] = worst;
                o->bar[precision] = precision == SKG_PRECISION_SINGLE ? 1e-3 : 1e-11;
                if (!(worst <= o->bar[precision])) hard_fault(o, "worst %.3g", worst);
                if (precision == SKG_PRECISION_SINGLE) hard_compare_time(o, scene, plan, &view);
            }
            free(got);
            skg_plan_release(&plan);
        }
    }
    skg_scene_release(&scene);
}

static void hole(hard_outcome *o) {
    solid s = solid_blob(50, 40, 20, 3);
    o->name = "a hole of 20 triangles";
    o->danger = "a ray that enters and never leaves";
    s.triangles -= 20;
    judge_open(o, &s, &s, 1);
    solid_free(&s);
}

static void flipped(hard_outcome *o) {
    solid s = solid_blob(50, 40, 20, 3);
    solid meant = solid_blob(50, 40, 20, 3);
    o->name = "30 flipped triangles";
    o->danger = "exits taken for entries";
    for (int n = 300; n < 330; n++) {
        const int32_t corner = s.corners[3 * n];
        s.corners[3 * n] = s.corners[3 * n + 1];
        s.corners[3 * n + 1] = corner;
    }
    judge_open(o, &s, &meant, 0);
    solid_free(&meant);
    solid_free(&s);
}

/* The first triangle is cut at the middle of its first edge; its neighbour is not. */
static void t_junction(hard_outcome *o) {
    solid s = solid_blob(50, 40, 20, 3), cut = {s.vertices + 1, s.triangles + 1, NULL, NULL};
    o->name = "a T-junction";
    o->danger = "a crack along the edge that only one side has cut";
    cut.positions = calloc((size_t)(3 * cut.vertices), sizeof(double));
    cut.corners = calloc((size_t)(3 * cut.triangles), sizeof(int32_t));
    memcpy(cut.positions, s.positions, (size_t)(3 * s.vertices) * sizeof(double));
    memcpy(cut.corners, s.corners, (size_t)(3 * s.triangles) * sizeof(int32_t));
    int32_t *old = cut.corners + 3 * 400, *new = cut.corners + 3 * s.triangles;
    const int32_t middle = (int32_t)s.vertices;
    for (int k = 0; k < 3; k++)
        cut.positions[3 * s.vertices + k] = 0.5 * (s.positions[3 * old[0] + k] + s.positions[3 * old[1] + k]);
    new[0] = middle, new[1] = old[1], new[2] = old[2];
    old[1] = middle;
    judge_open(o, &cut, &cut, 0);
    solid_free(&cut);
    solid_free(&s);
}

static void zero_volume(hard_outcome *o) {
    solid s = solid_blob(50, 40, 20, 3);
    o->name = "a mesh without volume";
    o->danger = "lengths of rounding only, of either sign";
    solid_move(&s, (const double[12]){1, 0, 0, 0, 0, 1, 0, 0, 0.3, 0.1, 0, 0}); /* all in one plane */
    judge_open(o, &s, &s, 0);
    solid_free(&s);
}

static void line(hard_outcome *o) {
    solid s = solid_blob(50, 40, 20, 3);
    o->name = "a mesh without area";
    o->danger = "triangles whose edges lie on each other";
    solid_move(&s, (const double[12]){1, 0, 0, 0, 0.5, 0, 0, 0, 0.3, 0, 0, 0});
    judge_open(o, &s, &s, 0);
    solid_free(&s);
}

/* A million tetrahedra, a part each, in rows and columns of a slab; every part is as any other. */
static void million_parts(hard_outcome *o) {
    enum { ROW = 100, PARTS = ROW * ROW * ROW };
    o->name = "a million parts of four triangles";
    o->danger = "work for every pair of parts; numbers beyond 32 bits; sums that wrap";
    o->unit = "of the mean exponent";
    const skg_view view = run_view(SIDE, 1.2);
    skg_scene *scene = NULL;
    solid one = solid_tetrahedra(1, 2, (const double[3]){0.1, 0.1, 0.1}, 3);
    const double volume = fabs(solid_volume(&one));
    skg_mesh *mesh = run_mesh(&one);
    skg_part part;
    double mean = 0, pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    ck_skg(skg_scene_create(run_context, &scene));
    skg_part_init(&part);
    part.mesh = mesh;
    ck_skg(skg_material_create_mu("m", 0.1, &part.material));
    for (int n = 0; n < PARTS; n++) {
        char label[16];
        pose[3] = n % ROW - 49.5;
        pose[7] = n / ROW % ROW - 49.5;
        pose[11] = n / (ROW * ROW) - 49.5;
        snprintf(label, sizeof label, "%d", n);
        part.label = label;
        memcpy(part.pose, pose, sizeof pose);
        ck_skg(skg_scene_part_add(scene, &part, NULL));
    }
    skg_material_release(&part.material);
    skg_plan *plan = run_plan(scene, &view, (run_choice){.quantity = SKG_QUANTITY_ATTENUATION});
    double *got = run_image(plan, &view);
    hard_check_values(o, got, PIXELS, 0);
    /* 40 x 40 pixels of 1 mm in the middle plane: there are 1 x 1 x 100 mm of parts behind each. */
    for (int p = 0; p < PIXELS; p++)
        if (abs(p % SIDE - 48) < 20 && abs(p / SIDE - 48) < 20) mean += got[p] / (39.0 * 39.0);
    o->worst[0] = fabs(mean / (0.01 * 100 * volume) - 1);
    o->bar[0] =
        0.02; /* of a mean over parts that pixels meet or miss; and rays that are longer off the middle */
    if (!(o->worst[0] <= o->bar[0])) hard_fault(o, "worst %.3g", o->worst[0]);
    hard_compare_time(o, scene, plan, &view);
    free(got);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_mesh_release(&mesh);
    solid_free(&one);
}

const hard_function hard_meshes[] = {hole, flipped, t_junction, zero_volume, line, million_parts, NULL};
