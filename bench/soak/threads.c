/* Two threads: with a context each, or with one that they use in turns. */
#include "soak.h"

#include <pthread.h>
#include <stdlib.h>

typedef struct {
    const soak *s;
    skg_context *context;
    pthread_mutex_t *turn; /* NULL: the context is the thread's own */
    int64_t number;
    uint64_t hash;
} worker;

static void lock(const worker *w) {
    if (w->turn) pthread_mutex_lock(w->turn);
}

static void unlock(const worker *w) {
    if (w->turn) pthread_mutex_unlock(w->turn);
}

/* Makes one call, or one image, at each turn; scenes belong to their thread. */
static void *work(void *argument) {
    worker *w = argument;
    soak_case c;
    soak_case_make(w->s, w->number, w->context, &c);
    const size_t count = (size_t)(SOAK_PROJECTIONS * c.pixels);
    float *images = bench_alloc(count, sizeof *images);
    lock(w);
    skg_plan *plan = soak_case_plan(&c, w->context);
    unlock(w);
    for (int64_t k = 0; k < SOAK_PROJECTIONS; k++) {
        skg_frame frame;
        skg_output output;
        skg_job *job = NULL;
        skg_frame_init(&frame);
        frame.view = &c.views[k];
        frame.index = k;
        skg_output_init(&output);
        output.data = images + k * c.pixels;
        lock(w);
        bench_try(skg_plan_submit(plan, 1, &frame, 1, &output, &job), "thread");
        unlock(w);
        lock(w);
        bench_try(skg_job_wait(&job), "thread");
        unlock(w);
    }
    w->hash = soak_hash(images, count * sizeof *images);
    lock(w);
    skg_plan_release(&plan);
    soak_case_free(&c);
    unlock(w);
    free(images);
    return NULL;
}

static void both(soak *s, int64_t number, pthread_mutex_t *turn, const char *what) {
    worker workers[2];
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) {
        workers[k] =
            (worker){.s = s, .context = s->contexts[turn ? 0 : k], .turn = turn, .number = number / (1 + k)};
        if (pthread_create(&threads[k], NULL, work, &workers[k]) != 0) bench_die("a thread cannot be made");
    }
    for (int k = 0; k < 2; k++) pthread_join(threads[k], NULL);
    for (int k = 0; k < 2; k++) soak_same(s, workers[k].number, workers[k].hash, what);
}

void soak_two_contexts(soak *s, int64_t number) {
    both(s, number, NULL, "two threads with two contexts");
}

void soak_one_context(soak *s, int64_t number) {
    pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
    both(s, number, &turn, "two threads with one context");
    pthread_mutex_destroy(&turn);
}
