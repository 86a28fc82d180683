/* Jobs that are cancelled: before, while and after they are made, by other threads and signals, within a frame. */
#include "jobs.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>

/* A job goes on by itself, so that it may have come to its end before it is cancelled: so often a test tries again. */
enum { TRIES = 50 };

/* Waits for a job that was cancelled, and returns how many frames are in place; 0 if the job came to its end before. */
static int64_t wait_cancelled(skg_job **job) {
    int made = -1, all = -1;
    const skg_status status = skg_job_wait(job);
    ck_assert_ptr_null(*job);
    if (status == SKG_OK) {
        jobs_check(jobs_frames);
        for (int64_t i = 0; i < jobs_frames * PIXELS; i++) jobs_pixels[i] = UNTOUCHED;
        return 0;
    }
    ck_assert_int_eq(status, SKG_ERR_CANCELLED);
    ck_assert_int_eq(sscanf(skg_last_error(), "the job was cancelled: %d of %d frames", &made, &all), 2);
    ck_assert_int_eq(all, jobs_frames);
    ck_assert(made >= 2 && made < jobs_frames);
    return made;
}

START_TEST(cancelled_at_once) {
    int64_t made = 0;
    if (!jobs_hold_frames()) return;
    for (int k = 0; k < TRIES && made == 0; k++) {
        skg_job *job = jobs_submit();
        int32_t done = -1;
        ck_skg(skg_job_cancel(job));
        ck_skg(skg_job_cancel(job));
        ck_skg(skg_job_test(job, &done));
        made = wait_cancelled(&job);
    }
    ck_assert_int_gt(made, 0);
    jobs_check(made);
    /* later jobs are not touched */
    static float again[PIXELS];
    const skg_output output = jobs_output(again);
    ck_skg(skg_plan_image(jobs_plan, &output));
    ck_assert_mem_eq(again, jobs_reference, sizeof again);
}
END_TEST

static void *cancel(void *job) {
    ck_skg(skg_job_cancel(job));
    return NULL;
}

static skg_job *interrupted;

static void cancel_in_handler(int number) {
    (void)number;
    (void)skg_job_cancel(interrupted);
}

/* Cancels by another thread, or by the handler of a signal. */
static void cancel_from(int handler, skg_job *job) {
    pthread_t thread;
    if (handler) {
        interrupted = job;
        ck_assert(signal(SIGUSR1, cancel_in_handler) != SIG_ERR);
        ck_assert_int_eq(raise(SIGUSR1), 0);
    } else {
        ck_assert_int_eq(pthread_create(&thread, NULL, cancel, job), 0);
        pthread_join(thread, NULL);
    }
}

/* Another job is not touched. */
START_TEST(cancelled_in_the_middle) {
    int64_t made = 0;
    if (!jobs_hold_frames()) return;
    for (int k = 0; k < TRIES && made == 0; k++) {
        skg_job *job = jobs_submit(), *later = NULL;
        int64_t done = 0, total = 0, before = 0;
        int32_t is_done = -1;
        while (done < 3) {
            ck_skg(skg_job_progress(job, &done, &total));
            ck_assert(done >= before && total == jobs_frames);
            before = done;
        }
        ck_skg(skg_job_test(job, &is_done));
        ck_assert(is_done == 0 || is_done == 1);
        cancel_from(_i, job);
        static float again[PIXELS];
        const skg_output output = jobs_output(again);
        ck_skg(skg_plan_submit(jobs_plan, 1, NULL, 1, &output, &later));
        ck_skg(skg_job_wait(&later));
        ck_assert_mem_eq(again, jobs_reference, sizeof again);
        ck_skg(skg_job_progress(job, &done, NULL));
        made = wait_cancelled(&job);
        ck_assert(made == done || (made == 0 && done == total));
    }
    ck_assert_int_gt(made, 0);
    jobs_check(made);
}
END_TEST

START_TEST(cancelled_after_the_end) {
    skg_job *job = jobs_submit();
    int32_t done = 0;
    int64_t count = 0;
    while (!done) ck_skg(skg_job_test(job, &done));
    ck_skg(skg_job_cancel(job));
    ck_skg(skg_job_progress(job, &count, NULL));
    ck_assert_int_eq(count, jobs_frames);
    ck_skg(skg_job_wait(&job));
    jobs_check(jobs_frames);
    ck_skg_fails(skg_job_cancel(NULL), SKG_ERR_ARGUMENT, "job");
    ck_skg_fails(skg_job_progress(NULL, &count, NULL), SKG_ERR_ARGUMENT, "job");
}
END_TEST

/* Thread of a window while another one waits: it holds a reference, so that the job outlives the wait. */
static void *cancel_often(void *user) {
    skg_job *held = user;
    for (int k = 0; k < 2000; k++)
        if (skg_job_cancel(held) != SKG_OK) return user;
    skg_job_release(&held);
    return NULL;
}

START_TEST(another_thread_cancels_while_one_waits) {
    for (int round = 0; round < 5; round++) {
        skg_job *job = jobs_submit(), *held = job;
        pthread_t thread;
        void *failed = NULL;
        int32_t done = 0;
        int64_t finished = -1, total = -1;
        ck_skg(skg_job_retain(held)); /* of the thread */
        ck_skg(skg_job_retain(held)); /* of this one */
        ck_assert_int_eq(pthread_create(&thread, NULL, cancel_often, held), 0);
        const skg_status status = skg_job_wait(&job);
        ck_assert_ptr_null(job);
        ck_assert(status == SKG_OK || status == SKG_ERR_CANCELLED);
        ck_assert_int_eq(pthread_join(thread, &failed), 0);
        ck_assert_ptr_null(failed);
        ck_skg(skg_job_cancel(held));
        ck_skg(skg_job_test(held, &done));
        ck_skg(skg_job_progress(held, &finished, &total));
        ck_assert(done == 1 && total == jobs_frames && finished >= 0 && finished <= total);
        job = held;
        ck_skg_fails(skg_job_wait(&job), SKG_ERR_ARGUMENT, "was waited for");
        skg_job_release(&held);
        ck_assert_ptr_null(held);
    }
}
END_TEST

static skg_job *submit_one(void) {
    const skg_output output = jobs_output(jobs_pixels);
    skg_job *job = NULL;
    ck_skg(skg_plan_submit(jobs_plan, 1, NULL, 1, &output, &job));
    return job;
}

static _Atomic(skg_job *) current;
static atomic_int ends;

/* Without a reference, as programs do: most cancels come when the job is gone. */
static void *cancel_what_is_there(void *unused) {
    (void)unused;
    while (!atomic_load(&ends)) {
        skg_job *job = atomic_load(&current);
        if (job && skg_job_cancel(job) != SKG_OK) return &current;
    }
    return NULL;
}

/* A handle whose job is gone may still be cancelled: the memory behind it is that of a job, or of none, and the next job begins anew. */
START_TEST(a_thread_cancels_too_late) {
    pthread_t thread;
    void *failed = NULL;
    int64_t before = 0, after = 0;
    skg_job *job = submit_one();
    ck_skg(skg_job_wait(&job));
    ck_skg(skg_allocation_count(&before));
    atomic_store(&ends, 0);
    ck_assert_int_eq(pthread_create(&thread, NULL, cancel_what_is_there, NULL), 0);
    for (int k = 0; k < 20 * TRIES; k++) {
        job = submit_one();
        atomic_store(&current, job);
        const skg_status status = skg_job_wait(&job);
        ck_assert(status == SKG_OK || status == SKG_ERR_CANCELLED);
    }
    atomic_store(&ends, 1);
    ck_assert_int_eq(pthread_join(thread, &failed), 0);
    ck_assert_ptr_null(failed);
    job = submit_one();
    ck_skg(skg_job_wait(&job));
    ck_skg(skg_job_cancel(atomic_load(&current)));
    job = submit_one();
    ck_skg(skg_job_wait(&job));
    ck_skg(skg_allocation_count(&after));
    ck_assert_int_eq(before, after);
}
END_TEST

/* However late it is cancelled: no frame is in place, nothing was written, and its steps were counted. */
START_TEST(cancelled_within_a_frame) {
    if (!jobs_hold_frames()) return;
    skg_plan *slow = jobs_long_plan(0);
    skg_status status = SKG_OK;
    const skg_output output = jobs_output(jobs_pixels);
    for (int k = 0; k < TRIES && status == SKG_OK; k++) {
        skg_job *job = NULL;
        int64_t done = 0, total = 0, before = 0;
        for (int64_t i = 0; i < PIXELS; i++) jobs_pixels[i] = UNTOUCHED;
        ck_skg(skg_plan_submit(slow, 1, NULL, 1, &output, &job));
        while (_i && done == 0) ck_skg(skg_job_progress(job, &done, &total));
        ck_skg(skg_job_cancel(job));
        before = done;
        ck_skg(skg_job_progress(job, &done, &total));
        ck_assert(total > 12 && done >= before && done <= total);
        status = skg_job_wait(&job);
    }
    ck_assert_int_eq(status, SKG_ERR_CANCELLED);
    ck_assert_str_eq(skg_last_error(), "the job was cancelled: 0 of 1 frames are in place");
    jobs_check(0);
    ck_skg(skg_plan_image(jobs_plan, &output)); /* others are not touched */
    ck_assert_mem_eq(jobs_pixels, jobs_reference, sizeof jobs_reference);
    skg_plan_release(&slow);
}
END_TEST

static atomic_int is_back;

static void *interrupt(void *unused) {
    (void)unused;
    while (!atomic_load(&is_back)) ck_skg(skg_context_interrupt(run_context));
    return NULL;
}

/* Samples that never suffice are looked for until another thread ends it; the next plan is not ended. */
START_TEST(a_plan_that_is_made_is_interrupted) {
    skg_plan *made = NULL;
    skg_plan_options options;
    skg_spot spot;
    skg_spectrum *beam = NULL;
    pthread_t thread;
    skg_plan_options_init(&options);
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_DISC, spot.extent[0] = 5;
    spot.tolerance = 1e-12, spot.samples_max = 1 << 16;
    options.spot = &spot;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    atomic_store(&is_back, 0);
    ck_assert_int_eq(pthread_create(&thread, NULL, interrupt, NULL), 0);
    const skg_status status = skg_plan_create(run_context, jobs_scene, &jobs_view, beam, &options, &made);
    atomic_store(&is_back, 1);
    pthread_join(thread, NULL);
    ck_skg_fails(status, SKG_ERR_CANCELLED,
                 "interrupted while the number of samples of the source was found");
    ck_assert_ptr_null(made);
    spot.tolerance = 0.01;
    ck_skg(skg_plan_create(run_context, jobs_scene, &jobs_view, beam, &options, &made));
    ck_skg_fails(skg_context_interrupt(NULL), SKG_ERR_ARGUMENT, "context");
    skg_plan_release(&made);
    skg_spectrum_release(&beam);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, jobs_open, jobs_close);
    tcase_add_test(tests, cancelled_at_once);
    tcase_add_loop_test(tests, cancelled_in_the_middle, 0, 2);
    tcase_add_test(tests, cancelled_after_the_end);
    tcase_add_test(tests, another_thread_cancels_while_one_waits);
    tcase_add_test(tests, a_thread_cancels_too_late);
    tcase_add_loop_test(tests, cancelled_within_a_frame, 0, 2);
    tcase_add_test(tests, a_plan_that_is_made_is_interrupted);
}

SKG_SUITE_MAIN("cancel", add_tests)
