/* OpenCL objects of the caller: path lengths in its buffers, and two contexts in two threads. */
#include "caller.h"
#include "suite.h"

#include <pthread.h>
#include <string.h>

enum { FRAMES = 6 };

/* The lengths in a buffer are those in host memory, behind an offset, after the caller's event. */
START_TEST(lengths_in_device_memory) {
    enum { OFFSET = 32 };
    static float expected[PIXELS], got[OFFSET / 4 + PIXELS];
    caller c;
    open_caller(&c, sizeof got, NULL);
    cl_int code = CL_SUCCESS, state = CL_QUEUED;
    cl_event start = clCreateUserEvent(c.cl, &code), done = NULL;
    skg_job *job = NULL;
    skg_output output = output_of(expected);
    for (int32_t kind = SKG_LENGTHS_NET; kind <= SKG_LENGTHS_SURFACE; kind++) {
        output = output_of(expected);
        output.kind = SKG_OUTPUT_LENGTHS;
        output.lengths = kind;
        ck_skg(skg_plan_submit(c.plan, 1, NULL, 1, &output, &job));
        ck_skg(skg_job_wait(&job));
        output.data = NULL;
        output.buffer = c.buffer;
        output.offset = OFFSET;
        ck_skg(skg_plan_submit_cl(c.plan, 1, NULL, 1, &output, 1, &start, &done, &job));
        if (kind == SKG_LENGTHS_NET) { /* nothing was waited for: the event is still open */
            ck_assert_int_eq(
                clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, NULL),
                CL_SUCCESS);
            ck_assert_int_gt(state, CL_COMPLETE);
            ck_assert_int_eq(clSetUserEventStatus(start, CL_COMPLETE), CL_SUCCESS);
        }
        ck_assert_int_eq(clEnqueueReadBuffer(c.queue, c.buffer, CL_TRUE, 0, sizeof got, got, 1, &done, NULL),
                         CL_SUCCESS);
        ck_assert_mem_eq(got + OFFSET / 4, expected, sizeof expected);
        ck_assert(expected[PIXELS / 2 + SIDE / 2] > 0);
        ck_skg(skg_job_wait(&job));
        clReleaseEvent(done);
    }
    clReleaseEvent(start);
    const skg_output good = output;
    output.part = 2;
    ck_skg_fails(skg_plan_submit_cl(c.plan, 1, NULL, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "skg_plan_submit_cl: part 2 of 2");
    output = good, output.lengths = 7;
    ck_skg_fails(skg_plan_submit_cl(c.plan, 1, NULL, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "kind 7");
    output = good, output.buffer = NULL;
    ck_skg_fails(skg_plan_submit_cl(c.plan, 1, NULL, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "no memory");
    ck_skg_fails(skg_plan_submit_cl(c.plan, 1, NULL, 1, &good, 1, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "no list");
    output = good, output.offset += 4;
    ck_skg_fails(skg_plan_submit_cl(c.plan, 1, NULL, 1, &output, 0, NULL, NULL, &job), SKG_ERR_ARGUMENT,
                 "the buffer at");
    close_caller(&c);
}
END_TEST

typedef struct {
    double shift;
    float images[FRAMES][PIXELS];
} worker;

/* Images of a moving source, each in the caller's buffer. Runs in a thread. */
static void *work(void *user) {
    worker *w = user;
    caller c;
    open_caller(&c, sizeof w->images, NULL);
    skg_view views[FRAMES];
    skg_frame frames[FRAMES];
    skg_job *job = NULL;
    skg_output output = output_of(NULL);
    output.buffer = c.buffer;
    for (int n = 0; n < FRAMES; n++) {
        views[n] = c.view;
        views[n].source[0] = w->shift + 10 * n;
        skg_frame_init(&frames[n]);
        frames[n].view = &views[n];
    }
    ck_skg(skg_plan_submit_cl(c.plan, FRAMES, frames, 1, &output, 0, NULL, NULL, &job));
    ck_assert_int_eq(
        clEnqueueReadBuffer(c.queue, c.buffer, CL_TRUE, 0, sizeof w->images, w->images, 0, NULL, NULL),
        CL_SUCCESS);
    ck_skg(skg_job_wait(&job));
    close_caller(&c);
    return NULL;
}

START_TEST(two_contexts_in_two_threads) {
    static worker alone[2] = {{.shift = 0}, {.shift = 25}}, together[2] = {{.shift = 0}, {.shift = 25}};
    pthread_t threads[2];
    for (int k = 0; k < 2; k++) work(&alone[k]);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_create(&threads[k], NULL, work, &together[k]), 0);
    for (int k = 0; k < 2; k++) ck_assert_int_eq(pthread_join(threads[k], NULL), 0);
    for (int k = 0; k < 2; k++) ck_assert_mem_eq(alone[k].images, together[k].images, sizeof alone[k].images);
    ck_assert(memcmp(alone[0].images, alone[1].images, sizeof alone[0].images) != 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, lengths_in_device_memory);
    tcase_add_test(tests, two_contexts_in_two_threads);
}

SKG_SUITE_MAIN("buffers", add_tests)
