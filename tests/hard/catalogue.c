/* The catalogue of hard cases: each a small scene, the reason why it is hard, and its bar. */
#include "hard/catalogue.h"

#include "hard/scenes.h"
#include "suite.h"
#include "support/verdict.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const run_choice hard_ways[HARD_WAYS] = {{.strategy = SKG_STRATEGY_AUTO},
                                         {.strategy = SKG_STRATEGY_COPIES},
                                         {.strategy = SKG_STRATEGY_TILES},
                                         {.strategy = SKG_STRATEGY_ATOMICS}};

void hard_fault(hard_outcome *o, const char *format, ...) {
    va_list arguments;
    if (*o->fault) return;
    va_start(arguments, format);
    vsnprintf(o->fault, sizeof o->fault, format, arguments);
    va_end(arguments);
}

void hard_same_bits(hard_outcome *o, int way, const double *image, int64_t count, uint64_t *first) {
    const uint64_t hash = run_hash(image, count * (int64_t)sizeof *image);
    if (way == 0) *first = hash;
    if (hash != *first) hard_fault(o, "strategy %d gives other bits", (int)hard_ways[way].strategy);
}

void hard_check_values(hard_outcome *o, const double *image, int64_t count, double least) {
    for (int64_t p = 0; p < count; p++)
        if (!isfinite(image[p]) || image[p] < least) {
            hard_fault(o, "%g at pixel %lld", image[p], (long long)p);
            return;
        }
}

/* --- solids judged by the caster ------------------------------------------------------------------------ */

/* As many rays as take the caster a tenth of a second, but enough of them. */
static int64_t rays_for(const hard_solid *s) {
    const int64_t rays = 2000000 / (s->body.vertices * (s->wobble > 0 ? 5 : 1));
    return rays < 80 ? 80 : rays < 4225 ? rays : 4225;
}

static void judge_lengths(const hard_solid *s, int32_t precision, const double *got, hard_outcome *o) {
    caster *c = caster_create(&s->body, s->pose);
    verdict v = {.single = precision == SKG_PRECISION_SINGLE};
    uint64_t seed = 5;
    int64_t below = 0;
    const int64_t pixels = s->view.rows * s->view.columns;
    verdict_cast(&v, c, &s->view, got, window_of(&s->body, s->pose, &s->view), rays_for(s), s->wobble, &seed);
    const double by = s->size > 0 ? v.longest / s->size : 1, worst = by * verdict_worst(&v),
                 rms = by * verdict_rms(&v), most = s->sliver ? 3.2e-6 : 3e-7;
    o->worst[precision] = worst;
    o->bar[precision] = precision == SKG_PRECISION_SINGLE ? 3e-5 : s->double_bar > 0 ? s->double_bar : 1e-11;
    if (!(worst <= o->bar[precision])) hard_fault(o, "worst %.3g", worst);
    if (precision == SKG_PRECISION_SINGLE && !(rms <= most)) hard_fault(o, "rms %.3g above %.3g", rms, most);
    const double longest = s->size > 0 ? s->size : v.longest;
    hard_check_values(o, got, pixels, -longest);
    for (int64_t p = 0; p < pixels; p++) below += got[p] < -o->bar[precision] * longest;
    if ((double)below > s->turned * (double)pixels) hard_fault(o, "%lld pixels below 0", (long long)below);
    verdict_free(&v);
    caster_free(c);
}

static void run_body(const hard_solid *s, hard_outcome *o) {
    const int64_t pixels = s->view.rows * s->view.columns;
    skg_scene *scene = run_scene(&s->body, s->pose);
    o->unit = s->size > 0 ? "of its depth" : "of the longest path";
    for (int32_t precision = 0; precision <= run_has_double(); precision++) {
        uint64_t first = 0;
        for (int way = 0; way < HARD_WAYS; way++) {
            run_choice choice = hard_ways[way];
            choice.precision = precision;
            skg_plan *plan = run_plan(scene, &s->view, choice);
            double *got = run_lengths(plan, &s->view);
            hard_same_bits(o, way, got, pixels, &first);
            if (way == 0) judge_lengths(s, precision, got, o);
            if (way == 0 && precision == SKG_PRECISION_SINGLE) hard_compare_time(o, scene, plan, &s->view);
            free(got);
            skg_plan_release(&plan);
        }
    }
    skg_scene_release(&scene);
}

/* --- the table ------------------------------------------------------------------------------------------ */

static const char *const dangers[HARD_SCENES] = {
    [HARD_OCTAHEDRA] = "a ray through a corner is counted twice or never",
    [HARD_OCTAHEDRA_EDGES] = "an edge along the ray changes sides by rounding",
    [HARD_OCTAHEDRA_PARALLEL] = "corners exactly on parallel rays",
    [HARD_CUBE_ON_CENTRES] = "sides lie in the planes of rays: the length jumps there",
    [HARD_CUBES_ON_CENTRES] = "edges on centres, neighbours touching",
    [HARD_SLIVERS] = "edges nearly parallel: their crossings are ill-conditioned",
    [HARD_SLIVERS_OBLIQUE] = "edge-on to many rays: depth is steep across a pixel",
    [HARD_SOURCE_INSIDE] = "parts of it are behind the source: projection turns inside out",
    [HARD_CUT_BY_DETECTOR] = "paths end at the pixel, within the mesh",
    [HARD_SOURCE_AND_DETECTOR] = "both ends of the path within the mesh",
    [HARD_LONG] = "depths are a hundred times the paths",
    [HARD_MOSTLY_BEHIND] = "most of its depth is on no path",
    [HARD_MOSTLY_BEHIND_PARALLEL] = "most of its depth is on no path",
    [HARD_WIDE] = "its bounds hold the source, itself does not",
    [HARD_DUST] = "most triangles hold no pixel's centre",
    [HARD_SPECK] = "ten thousand triangles a pixel: rounding adds up",
    [HARD_LAYERS] = "twenty surfaces at the same depth",
    [HARD_GIANT] = "pixel numbers far beyond the detector"};

static void from_scene(int which, hard_solid *s) {
    hard_scene h = hard_make(which);
    *s = (hard_solid){.name = h.name,
                      .danger = dangers[which],
                      .body = h.body,
                      .view = h.view,
                      .wobble = h.wobble,
                      .turned = h.turned,
                      .sliver = h.sliver};
    memcpy(s->pose, h.pose, sizeof s->pose);
}

enum { TABLES = 6 };
static const hard_function *const tables[TABLES] = {hard_images, hard_meshes, hard_bodies,
                                                    hard_bounds, hard_cuts,   hard_gradients};

static hard_function find(int which) {
    for (int t = 0; t < TABLES; t++)
        for (int n = 0; tables[t][n]; n++)
            if (which-- == 0) return tables[t][n];
    return NULL;
}

int hard_case_count(void) {
    int count = HARD_SCENES + HARD_SOLIDS;
    while (find(count - HARD_SCENES - HARD_SOLIDS)) count++;
    return count;
}

void hard_case_run(int which, hard_outcome *o) {
    *o = (hard_outcome){.worst = {-1, -1}, .unit = ""};
    if (which >= HARD_SCENES + HARD_SOLIDS) {
        find(which - HARD_SCENES - HARD_SOLIDS)(o);
        return;
    }
    hard_solid s = {0};
    if (which < HARD_SCENES)
        from_scene(which, &s);
    else
        hard_solid_make(which - HARD_SCENES, &s);
    o->name = s.name;
    o->danger = s.danger;
    run_body(&s, o);
    solid_free(&s.body);
}
