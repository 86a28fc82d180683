/* One contender: a scene, its plan, and the frames that it is asked for. Calls only what builds of earlier dates have. */
#include "contender.h"

#include "common/scenes.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct {
    bench_scene scene;
    skg_plan *plan;
    int64_t parts, pixels;
    skg_mesh **meshes; /* [parts] */
    float **rest;      /* [parts] offsets as they were at first */
    int64_t *vertices; /* [parts] */
    long views, moves;
    skg_view *turned;
    skg_frame *frames;
    skg_output output;
} contender;

static void send(const void *what, size_t bytes) {
    if (write(STDOUT_FILENO, what, bytes) != (ssize_t)bytes) bench_die("the parent has gone");
}

static void warm(contender *self) {
    bench_try(skg_plan_image(self->plan, &self->output), "image");
}

/* Moves every vertex to and fro along z by an eighth of a mm. */
static void moving(contender *self) {
    const float step = ++self->moves % 2 ? 0.125F : 0;
    for (int64_t p = 0; p < self->parts; p++) {
        float *offsets = NULL;
        const float *rest = self->rest[p];
        bench_try(skg_mesh_offsets_get(self->meshes[p], &offsets, NULL), "offsets");
        for (int64_t v = 0; v < self->vertices[p]; v++) offsets[3 * v + 2] = rest[3 * v + 2] + step;
        bench_try(skg_mesh_offsets_moved(self->meshes[p]), "moved");
    }
    warm(self);
}

/* Builds of earlier dates have a skg_plan_submit of one output, and another call, of this type, that takes a list. */
static skg_status submit(const contender *self, skg_job **job) {
    skg_status (*call)(skg_plan *, int64_t, const skg_frame *, int64_t, const skg_output *, skg_job **);
    void *program = dlopen(NULL, RTLD_NOW), *earlier = dlsym(program, "skg_plan_outputs_submit");
    memcpy(&call, &earlier, sizeof call);
    const skg_status status =
        (earlier ? call : skg_plan_submit)(self->plan, self->views, self->frames, 1, &self->output, job);
    dlclose(program);
    return status;
}

static void all_views(contender *self) {
    skg_job *job = NULL;
    bench_try(submit(self, &job), "batch");
    bench_try(skg_job_wait(&job), "batch");
}

/* FNV-1a over words of 32 bits. */
static uint64_t hash_images(const contender *self, int64_t images) {
    const float *data = self->output.data;
    uint64_t hash = 0xcbf29ce484222325u;
    for (int64_t i = 0; i < images * self->pixels; i++) {
        uint32_t bits;
        memcpy(&bits, data + i, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3u;
    }
    return hash;
}

static void copy_rest(contender *self, versus_start *start) {
    bench_try(skg_scene_part_count(self->scene.scene, &self->parts), "scene");
    self->meshes = bench_alloc((size_t)self->parts, sizeof *self->meshes);
    self->rest = bench_alloc((size_t)self->parts, sizeof *self->rest);
    self->vertices = bench_alloc((size_t)self->parts, sizeof *self->vertices);
    for (int64_t p = 0; p < self->parts; p++) {
        skg_part part;
        float *offsets = NULL;
        int64_t triangles = 0;
        skg_part_init(&part);
        bench_try(skg_scene_part_get(self->scene.scene, p, &part), "part");
        self->meshes[p] = part.mesh;
        bench_try(skg_mesh_count(part.mesh, &self->vertices[p], &triangles), "mesh");
        bench_try(skg_mesh_offsets_get(part.mesh, &offsets, NULL), "offsets");
        self->rest[p] = bench_alloc((size_t)self->vertices[p] * 3, sizeof **self->rest);
        memcpy(self->rest[p], offsets, (size_t)self->vertices[p] * 3 * sizeof *offsets);
        start->triangles += triangles;
        start->vertices += self->vertices[p];
    }
    start->parts = self->parts;
}

static void prepare_views(contender *self) {
    self->turned = bench_alloc((size_t)self->views, sizeof *self->turned);
    self->frames = bench_alloc((size_t)self->views, sizeof *self->frames);
    for (long k = 0; k < self->views; k++) {
        scene_turn(&self->scene, 360.0 * (double)k / (double)self->views, &self->turned[k]);
        skg_frame_init(&self->frames[k]);
        self->frames[k].view = &self->turned[k];
    }
}

static skg_context *start_up(const versus_settings *set, contender *self, versus_start *start) {
    skg_context *context = NULL;
    int64_t channels = 0;
    double moment[VERSUS_ONCE + 1];
    bench_scene *scene = &self->scene;
    moment[VERSUS_CONTEXT] = bench_now();
    bench_try(skg_context_create(set->device, &context), "context");
    moment[VERSUS_SCENE] = bench_now();
    scene_open_set(context, set->scene, set->size, set->count, set->settings, scene);
    moment[VERSUS_PLAN] = bench_now();
    bench_try(skg_plan_create(context, scene->scene, &scene->view, scene->beam, &scene->options, &self->plan),
              "plan");
    bench_try(skg_plan_channel_count(self->plan, &channels), "plan");
    self->pixels = channels * scene->view.rows * scene->view.columns;
    skg_output_init(&self->output);
    self->output.data = bench_alloc((size_t)(self->views * self->pixels), sizeof(float));
    moment[VERSUS_FIRST] = bench_now();
    warm(self);
    moment[VERSUS_ONCE] = bench_now();
    for (int k = 0; k < VERSUS_ONCE; k++) start->ms[k] = moment[k + 1] - moment[k];
    start->columns = scene->view.columns, start->rows = scene->view.rows;
    return context;
}

static void take_turn(contender *self, int kind, long frames, versus_turn *turn) {
    static void (*const work[VERSUS_COUNT])(contender *) = {
        [VERSUS_WARM] = warm, [VERSUS_MOVING] = moving, [VERSUS_VIEWS] = all_views};
    const long images = kind == VERSUS_VIEWS ? self->views : 1;
    self->moves = 0;
    bench_sleep(5); /* the threads of the other contender go to sleep */
    work[kind](self);
    for (long i = 0; i < frames; i++) {
        const double start = bench_now();
        work[kind](self);
        turn->ms[i] = (bench_now() - start) / (double)images;
    }
    turn->hash = hash_images(self, images);
}

int versus_contend(const versus_settings *set) {
    contender self = {.views = set->views};
    versus_start start = {0};
    versus_turn turn;
    int kind;
    skg_context *context = start_up(set, &self, &start);
    copy_rest(&self, &start);
    prepare_views(&self);
    send(&start, sizeof start);
    while (read(STDIN_FILENO, &kind, sizeof kind) == (ssize_t)sizeof kind) {
        turn = (versus_turn){0};
        take_turn(&self, kind, kind == VERSUS_VIEWS ? 1 : set->frames, &turn);
        send(&turn, sizeof turn);
    }
    for (int64_t p = 0; p < self.parts; p++) free(self.rest[p]);
    free(self.meshes);
    free(self.rest);
    free(self.vertices);
    free(self.turned);
    free(self.frames);
    free(self.output.data);
    skg_plan_release(&self.plan);
    scene_close(&self.scene);
    skg_context_release(&context);
    return 0;
}
