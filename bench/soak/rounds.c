/* Rounds in this process. However the projections of a case are made, their bits are the same. */
#include "soak.h"

#include "support/random.h"

#include <skiagraph/scanning.h>

#include <stdlib.h>
#include <string.h>

void soak_same(soak *s, int64_t number, uint64_t hash, const char *what) {
    if (!s->images[number]) s->images[number] = hash;
    if (s->images[number] != hash)
        bench_die(
            "%s: the projections of case %lld are not those of before (hash %016llx instead of %016llx)",
            what, (long long)number, (unsigned long long)hash, (unsigned long long)s->images[number]);
    s->frames += SOAK_PROJECTIONS;
}

static size_t bytes_of(const soak_case *c) {
    return (size_t)(SOAK_PROJECTIONS * c->pixels) * sizeof(float);
}

/* The frames of the views from `from` on. */
static void set_frames(const soak_case *c, int64_t from, int64_t count, skg_frame *frames) {
    for (int64_t k = 0; k < count; k++) {
        skg_frame_init(&frames[k]);
        frames[k].view = &c->views[from + k];
        frames[k].index = from + k;
    }
}

void soak_frames(soak *s, int64_t number) {
    soak_case c;
    skg_frame frames[SOAK_PROJECTIONS];
    skg_output output;
    skg_job *job = NULL;
    soak_case_make(s, number, s->contexts[0], &c);
    skg_plan *plan = soak_case_plan(&c, s->contexts[0]);
    skg_output_init(&output);
    output.data = bench_alloc(bytes_of(&c), 1);
    set_frames(&c, 0, SOAK_PROJECTIONS, frames);
    bench_try(skg_plan_submit(plan, SOAK_PROJECTIONS, frames, 1, &output, &job), "frames");
    bench_try(skg_job_wait(&job), "frames");
    if (s->fault == FAULT_BITS)
        ((unsigned char *)output.data)[draw_below(&s->state, (int64_t)bytes_of(&c))] ^= 1;
    soak_same(s, number, soak_hash(output.data, bytes_of(&c)), "images");
    free(output.data);
    skg_plan_release(&plan);
    soak_case_free(&c);
}

/* A job for each view, waited for in another order; plan and scene are released before. */
void soak_jobs(soak *s, int64_t number) {
    soak_case c;
    skg_job *jobs[SOAK_PROJECTIONS] = {0};
    soak_case_make(s, number, s->contexts[0], &c);
    const size_t bytes = bytes_of(&c);
    float *images = bench_alloc(bytes, 1);
    skg_plan *plan = soak_case_plan(&c, s->contexts[0]);
    for (int64_t k = 0; k < SOAK_PROJECTIONS; k++) {
        skg_frame frame;
        skg_output output;
        set_frames(&c, k, 1, &frame);
        skg_output_init(&output);
        output.data = images + k * c.pixels;
        bench_try(skg_plan_submit(plan, 1, &frame, 1, &output, &jobs[k]), "job");
    }
    skg_plan_release(&plan);
    soak_case_free(&c);
    const int64_t first = draw_below(&s->state, SOAK_PROJECTIONS);
    for (int64_t k = 0; k < SOAK_PROJECTIONS; k++)
        bench_try(skg_job_wait(&jobs[(first + k) % SOAK_PROJECTIONS]), "job");
    soak_same(s, number, soak_hash(images, bytes), "jobs");
    free(images);
}

typedef struct {
    float *images;
    int64_t pixels;
} gathered;

static skg_status gather(const skg_scan_batch *batch, void *user) {
    const gathered *to = user;
    for (int64_t k = 0; k < batch->count; k++)
        memcpy(to->images + batch->indices[k] * to->pixels, (const float *)batch->images + k * to->pixels,
               (size_t)to->pixels * sizeof(float));
    return SKG_OK;
}

void soak_scan(soak *s, int64_t number) {
    soak_case c;
    skg_scan_run_options run;
    soak_case_make(s, number, s->contexts[0], &c);
    skg_plan *plan = soak_case_plan(&c, s->contexts[0]);
    gathered all = {bench_alloc(bytes_of(&c), 1), c.pixels};
    skg_scan_run_options_init(&run);
    run.batch = 1 + draw_below(&s->state, SOAK_PROJECTIONS);
    bench_try(skg_scan_run_each(plan, c.scan, &run, gather, &all), "scan");
    soak_same(s, number, soak_hash(all.images, bytes_of(&c)), "scan");
    free(all.images);
    skg_plan_release(&plan);
    soak_case_free(&c);
}

static skg_status keep(const skg_scan_batch *batch, void *user) {
    return skg_scan_file_write(user, batch->count, batch->indices, batch->images, batch->phases);
}

/* Writes the projections before `to` that the file has not yet. */
static void write_to(const char *path, const soak_case *c, skg_plan *plan, int64_t to) {
    skg_scan_file_options options;
    skg_scan_run_options run;
    skg_scan_file *file = NULL;
    char hash[65];
    memset(hash, 'a', 64), hash[64] = '\0';
    skg_scan_file_options_init(&options);
    skg_scan_run_options_init(&run);
    options.scan = c->scan, options.hash = hash, options.samples = 1;
    bench_try(skg_scan_file_open(path, &options, &file), path);
    run.file = file, run.to = to;
    bench_try(skg_scan_run_each(plan, c->scan, &run, keep, file), path);
    bench_try(skg_scan_file_finish(file), path);
    skg_scan_file_release(&file);
}

/* The projections are the last bytes of a MetaImage. */
static uint64_t hash_end(const char *path, size_t bytes) {
    FILE *file = fopen(path, "rb");
    char *end = bench_alloc(bytes, 1);
    if (!file || fseek(file, -(long)bytes, SEEK_END) != 0 || fread(end, 1, bytes, file) != bytes)
        bench_die("%s is too short", path);
    fclose(file);
    const uint64_t hash = soak_hash(end, bytes);
    free(end);
    return hash;
}

void soak_file(soak *s, int64_t number) {
    soak_case c;
    char path[SOAK_PATH + 16];
    soak_case_make(s, number, s->contexts[0], &c);
    skg_plan *plan = soak_case_plan(&c, s->contexts[0]);
    snprintf(path, sizeof path, "%s/scan.mha", s->folder);
    write_to(path, &c, plan, 1 + draw_below(&s->state, SOAK_PROJECTIONS - 1));
    write_to(path, &c, plan, SOAK_PROJECTIONS);
    soak_folder_check(s, "scan.mha", "file");
    soak_same(s, number, hash_end(path, bytes_of(&c)), "file");
    soak_folder_clear(s);
    skg_plan_release(&plan);
    soak_case_free(&c);
}

void soak_new_contexts(soak *s, int64_t number) {
    for (int k = 0; k < 2; k++) skg_context_release(&s->contexts[k]);
    for (int k = 0; k < 2; k++) bench_try(skg_context_create(s->device, &s->contexts[k]), "context");
    soak_frames(s, number);
}
