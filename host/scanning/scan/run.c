/* Batches of projections: which projections, which slots are in flight. */
#include "core/core.h"
#include "core/log.h"
#include "core/maths.h"
#include "core/text.h"
#include "frame/quiet.h"
#include "scan/slot.h"

#include <inttypes.h>
#include <string.h>

enum { SLOTS = 3, BATCH_BYTES = 1 << 24, BATCH_MAX = 32, SUBFRAMES_MAX = 1000 };

struct skg_scan_run {
    skg_scan_work work;
    int64_t *indices; /* [count] what is computed */
    int64_t count, submitted, batch;
    int64_t finished; /* projections of the batches that the caller has finished with */
    skg_scan_slot slots[SLOTS];
    int next; /* the slot whose batch comes next */
};

void skg_scan_run_options_init_sized(void *options, int32_t size) {
    const skg_scan_run_options defaults = {.shards = 1, .subframes = 1};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_scan_batch_init_sized(void *batch, int32_t size) {
    const skg_scan_batch defaults = {0};
    skg_struct_init(batch, size, &defaults, sizeof defaults);
}

static skg_status check_options(const skg_scan_run_options *o, int64_t projections) {
    if (o->type != SKG_TYPE_FLOAT32 && o->type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT, "run: type %" PRId32 " is no SKG_TYPE_ value", o->type);
    if (o->from < 0 || o->from >= o->to || o->to > projections)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "run: projections from %" PRId64 " to before %" PRId64 "; the scan has %" PRId64,
                        o->from, o->to, projections);
    if (o->shards < 1 || o->shard < 0 || o->shard >= o->shards)
        return skg_fail(SKG_ERR_ARGUMENT, "run: shard %" PRId64 " of %" PRId64 "; shards count from 0",
                        o->shard, o->shards);
    if (o->batch < 0) return skg_fail(SKG_ERR_ARGUMENT, "run: batches of %" PRId64 " projections", o->batch);
    if (o->subframes < 1 || o->subframes > SUBFRAMES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "run: %" PRId64 " sub-frames; give 1 to %d", o->subframes,
                        SUBFRAMES_MAX);
    if (o->only_count < 0 || (o->only_count > 0 && !o->only))
        return skg_fail(SKG_ERR_ARGUMENT, "run: `only` has %" PRId64 " numbers, but no array", o->only_count);
    if (o->moving_count < 0 || (o->moving_count > 0 && (!o->moving_parts || !o->moving_poses || o->motion)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "run: %" PRId64 " moving parts; give their numbers and poses, and no motion beside "
                        "them",
                        o->moving_count);
    for (int64_t i = 0; i < o->only_count; i++)
        if (o->only[i] < 0 || o->only[i] >= projections || (i > 0 && o->only[i] <= o->only[i - 1]))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "run: projection %" PRId64 " of `only`: numbers rise, and are 0 to %" PRId64,
                            o->only[i], projections - 1);
    return SKG_OK;
}

/* Adds a projection to the list if the file does not have it. */
static skg_status consider(skg_scan_run *run, const skg_scan_run_options *o, int64_t index) {
    int32_t done = 0;
    if (index < o->from || index >= o->to) return SKG_OK;
    if (o->file) SKG_TRY(skg_scan_file_done_get(o->file, index, &done));
    if (!done) run->indices[run->count++] = index;
    return SKG_OK;
}

static skg_status list_projections(skg_scan_run *run, const skg_scan_run_options *o) {
    const int64_t all = o->only_count > 0 ? o->only_count : o->to - o->from;
    const int64_t first = all * o->shard / o->shards, end = all * (o->shard + 1) / o->shards;
    SKG_TRY(skg_alloc(end - first, sizeof *run->indices, "list of projections", &run->indices));
    for (int64_t i = first; i < end; i++)
        SKG_TRY(consider(run, o, o->only_count > 0 ? o->only[i] : o->from + i));
    return SKG_OK;
}

skg_status skg_scan_run_add(skg_scan_run *run, int64_t count, const int64_t *indices) {
    int64_t projections = 0;
    SKG_NEEDS(run);
    SKG_NEEDS(indices);
    SKG_TRY(skg_scan_projection_count(run->work.scan, &projections));
    for (int64_t i = 0; i < count; i++)
        if (indices[i] < 0 || indices[i] >= projections)
            return skg_fail(SKG_ERR_ARGUMENT, "run: projection %" PRId64 "; numbers are 0 to %" PRId64,
                            indices[i], projections - 1);
    if (count < 1) return SKG_OK;
    SKG_TRY(skg_realloc(run->count + count, sizeof *run->indices, "list of projections", &run->indices));
    for (int64_t i = 0; i < count; i++) SKG_TRY(consider(run, &run->work.options, indices[i]));
    return SKG_OK;
}

static skg_status submit(skg_scan_run *run, skg_scan_slot *slot) {
    const int64_t left = run->count - run->submitted, count = left < run->batch ? left : run->batch;
    if (count == 0) return SKG_OK;
    SKG_TRY(skg_scan_slot_submit(&run->work, slot, run->indices + run->submitted, count));
    run->submitted += count;
    return SKG_OK;
}

/* The last slot belongs to the caller at first. */
static skg_status prepare(skg_scan_run *run, const skg_scan_run_options *o) {
    SKG_TRY(skg_scan_work_init(&run->work));
    SKG_TRY(list_projections(run, o));
    if (run->count > 0) SKG_TRY(skg_scan_work_series(&run->work));
    const int64_t bytes = run->work.image_elements * skg_element_bytes(run->work.options.type) * o->subframes;
    run->batch = BATCH_BYTES / bytes < BATCH_MAX ? BATCH_BYTES / bytes : BATCH_MAX;
    if (run->batch < 1) run->batch = 1;
    if (o->batch > 0) run->batch = o->batch;
    if (run->batch > run->count && run->count > 0) run->batch = run->count;
    for (int s = 0; s < SLOTS; s++) SKG_TRY(skg_scan_slot_init(&run->work, &run->slots[s], run->batch));
    for (int s = 0; s + 1 < SLOTS; s++) SKG_TRY(submit(run, &run->slots[s]));
    return SKG_OK;
}

static skg_status create(skg_plan *plan, skg_scan *scan, const skg_scan_run_options *options,
                         skg_scan_run **result) {
    SKG_PLAIN;
    skg_scan_run *run = NULL;
    skg_scan_run_options ours;
    int64_t projections = 0;
    SKG_NEEDS_OF("skg_scan_run_create", result);
    *result = NULL;
    SKG_NEEDS_OF("skg_scan_run_create", plan);
    SKG_NEEDS_OF("skg_scan_run_create", scan);
    skg_scan_run_options_init(&ours);
    if (options) SKG_TRY(skg_struct_read(options, "skg_scan_run_options", &ours, sizeof ours));
    SKG_TRY(skg_scan_projection_count(scan, &projections));
    if (ours.to == 0) ours.to = projections;
    SKG_TRY(check_options(&ours, projections));
    SKG_TRY(skg_alloc(1, sizeof *run, "run", &run));
    skg_plan_retain(plan);
    skg_scan_retain(scan);
    run->work = (skg_scan_work){.plan = plan, .scan = scan, .options = ours};
    skg_progress_keep(ours.progress);
    const skg_status status = prepare(run, &ours);
    if (status != SKG_OK)
        skg_scan_run_release(&run);
    else
        *result = run;
    return status;
}

skg_status skg_scan_run_create(skg_plan *plan, skg_scan *scan, const skg_scan_run_options *options,
                               skg_scan_run **result) {
    const skg_call begun = skg_plan_call_begin(plan);
    return skg_call_end(begun, create(plan, scan, options, result));
}

void skg_scan_run_release(skg_scan_run **run) {
    if (!run || !*run) return;
    for (int s = 0; s < SLOTS; s++) skg_scan_slot_free(&(*run)->slots[s]);
    skg_scatter_series_release(&(*run)->work.series);
    skg_plan_release(&(*run)->work.plan);
    skg_scan_release(&(*run)->work.scan);
    skg_progress_release(&(*run)->work.options.progress);
    skg_free(&(*run)->indices);
    skg_free(run);
}

skg_status skg_scan_run_projection_count(const skg_scan_run *run, int64_t *count) {
    SKG_NEEDS(run);
    SKG_NEEDS(count);
    *count = run->count;
    return SKG_OK;
}

skg_status skg_scan_run_next(skg_scan_run *run, skg_scan_batch *batch) {
    SKG_PLAIN;
    SKG_NEEDS(run);
    SKG_NEEDS(batch);
    /* The caller has finished with the slot before the next one: it becomes the last of the queue. */
    skg_scan_slot *slot = &run->slots[run->next], *returned = &run->slots[(run->next + SLOTS - 1) % SLOTS];
    run->finished += returned->count;
    returned->count = 0;
    const skg_status cancelled = skg_progress_step(run->work.options.progress, run->finished, run->count);
    if (run->finished < run->count) SKG_TRY(cancelled);
    for (int s = 0; s < SLOTS; s++) { /* those that found nothing to do before skg_scan_run_add, too */
        skg_scan_slot *idle = &run->slots[(run->next + s) % SLOTS];
        if (idle->count == 0) SKG_TRY(submit(run, idle));
    }
    const skg_status status = skg_scan_slot_wait(&run->work, slot);
    if (status != SKG_OK && status != SKG_RANGE) return status;
    const skg_scan_batch ours = {.type = run->work.options.type,
                                 .count = slot->count,
                                 .indices = slot->indices,
                                 .images = slot->images,
                                 .phases = run->work.options.motion ? slot->phases : NULL,
                                 .amplitudes = run->work.options.motion ? slot->amplitudes : NULL};
    SKG_TRY(skg_struct_write(&ours, sizeof ours, "skg_scan_batch", batch));
    run->next = (run->next + 1) % SLOTS;
    return status;
}

skg_status skg_scan_run_each(skg_plan *plan, skg_scan *scan, const skg_scan_run_options *options,
                             skg_scan_function function, void *user) {
    skg_scan_run *run = NULL;
    skg_status status = SKG_OK, range = SKG_OK;
    SKG_NEEDS(function);
    SKG_TRY(skg_scan_run_create(plan, scan, options, &run));
    for (;;) {
        skg_scan_batch batch;
        skg_scan_batch_init(&batch);
        status = skg_scan_run_next(run, &batch);
        if (status == SKG_RANGE) range = status;
        if (SKG_FAILED(status) || batch.count == 0) break;
        status = function(&batch, user);
        if (status != SKG_OK) break;
    }
    skg_scan_run_release(&run);
    return status == SKG_OK ? range : status;
}
