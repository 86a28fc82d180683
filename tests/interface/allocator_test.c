/* The allocator of the process: everything comes from it and goes back to it, also where it fails. The error handler of a
 * context: it hears of each failure once. */
#include "suite.h"

#include <skiagraph/skiagraph.h>

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE };

/* Each block has a header that tells whether it came from here. */
typedef struct {
    uint64_t mark;
    int64_t bytes;
} header;
static const uint64_t ALIVE = 0x736b696167726170u, FREED = 0x6672656564667265u;

/* An allocator that counts, and fails at one call. */
typedef struct {
    atomic_llong calls, live, bytes;
    int64_t fails_at; /* number of the call, from 0; -1: never */
} counter;

static int fails(counter *c) {
    const int64_t now = atomic_fetch_add(&c->calls, 1);
    return now == c->fails_at;
}

static void *allocate(int64_t bytes, void *user) {
    counter *c = user;
    ck_assert_int_gt(bytes, 0);
    if (fails(c)) return NULL;
    header *made = malloc(sizeof *made + (size_t)bytes);
    *made = (header){ALIVE, bytes};
    memset(made + 1, 0xa5, (size_t)bytes); /* nobody may count on zeros */
    atomic_fetch_add(&c->live, 1);
    atomic_fetch_add(&c->bytes, bytes);
    return made + 1;
}

static void release(void *memory, void *user) {
    counter *c = user;
    header *own = (header *)memory - 1;
    ck_assert_msg(own->mark == ALIVE, "a block that is not the allocator's, or was freed");
    own->mark = FREED;
    atomic_fetch_sub(&c->live, 1);
    atomic_fetch_sub(&c->bytes, own->bytes);
    free(own);
}

static void *reallocate(void *memory, int64_t bytes, void *user) {
    counter *c = user;
    if (!memory) return allocate(bytes, user);
    header *own = (header *)memory - 1;
    ck_assert_msg(own->mark == ALIVE, "a block that is not the allocator's, or was freed");
    if (fails(c)) return NULL;
    header *made = malloc(sizeof *made + (size_t)bytes);
    *made = (header){ALIVE, bytes};
    memcpy(made + 1, own + 1, (size_t)(bytes < own->bytes ? bytes : own->bytes));
    atomic_fetch_add(&c->bytes, bytes - own->bytes);
    own->mark = FREED;
    free(own);
    return made + 1;
}

static void use(counter *c, int64_t fails_at) {
    skg_allocator allocator;
    skg_allocator_init(&allocator);
    *c = (counter){.fails_at = fails_at};
    allocator.allocate = allocate;
    allocator.reallocate = reallocate;
    allocator.release = release;
    allocator.user = c;
    ck_skg(skg_allocator_set(&allocator));
}

static void use_default(void) {
    ck_skg(skg_allocator_set(NULL));
}

static int64_t count_blocks(void) {
    int64_t count = -1;
    ck_skg(skg_allocation_count(&count));
    return count;
}

/* Objects of a program. Each stays NULL until it is made. */
typedef struct {
    skg_context *context;
    skg_setup *setup;
    skg_plan *plan;
    skg_mesh *mesh;
    skg_material *material;
    skg_spectrum *beam;
    skg_job *job;
    float image[PIXELS];
    int errors; /* that the handler heard of */
    skg_status heard;
    char sentence[512];
} program;

static void hear(skg_status status, const char *sentence, void *user) {
    program *p = user;
    p->errors++;
    p->heard = status;
    snprintf(p->sentence, sizeof p->sentence, "%s", sentence);
}

static const char text[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\", \"Beam\": [{\"Energy\": 60, "
    "\"Unit\": \"keV\", \"PhotonCount\": 1000}]}, \"Detector\": {\"Position\": [0, 10, 0, \"cm\"], "
    "\"UpVector\": [0, 0, -1], \"NumberOfPixels\": [24, 24], \"Size\": [24, 24, \"cm\"]}, \"Samples\": "
    "[{\"Label\": \"block\", \"Cube\": [80, \"mm\"], \"Material\": \"water\", \"Type\": \"outer\"}, "
    "{\"Label\": \"bone\", \"Sphere\": [16, 30, \"mm\"], \"Material\": \"bone cortical icru44\"}]}";

/* A set-up, a mesh, a material and a tube on the side, a plan and two frames. Ends at the first failure. */
static skg_status run(program *p) {
    skg_setup_source source;
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_plan_options options;
    skg_tube tube;
    skg_view view;
    skg_output output;
    skg_status status = skg_context_create(NULL, &p->context);
    skg_setup_source_init(&source);
    skg_plan_options_init(&options);
    skg_tube_init(&tube);
    skg_view_init(&view);
    skg_output_init(&output);
    source.text = text;
    output.data = p->image;
    tube.kvp = 90;
    if (status == SKG_OK) status = skg_context_error_set(p->context, hear, p);
    if (status == SKG_OK) status = skg_setup_create(p->context, &source, &p->setup);
    if (status == SKG_OK) status = skg_setup_scene_get(p->setup, &scene);
    if (status == SKG_OK) status = skg_setup_spectrum_get(p->setup, &spectrum);
    if (status == SKG_OK) status = skg_setup_view_get(p->setup, &view);
    if (status == SKG_OK) status = skg_mesh_create_sphere(20, 16, &p->mesh);
    if (status == SKG_OK) status = skg_material_create_named("H2O", &p->material);
    if (status == SKG_OK) status = skg_spectrum_create_tube(&tube, &p->beam);
    options.noise = 1;
    if (status == SKG_OK) status = skg_plan_create(p->context, scene, &view, spectrum, &options, &p->plan);
    if (status == SKG_OK) status = skg_plan_image(p->plan, &output);
    if (status == SKG_OK) status = skg_plan_submit(p->plan, 1, NULL, 1, &output, &p->job);
    if (status == SKG_OK) status = skg_job_wait(&p->job);
    return status;
}

static void end(program *p) {
    if (p->job) skg_job_wait(&p->job);
    skg_plan_release(&p->plan);
    skg_spectrum_release(&p->beam);
    skg_material_release(&p->material);
    skg_mesh_release(&p->mesh);
    skg_setup_release(&p->setup);
    skg_context_release(&p->context);
}

START_TEST(everything_comes_from_the_allocator_and_goes_back) {
    static counter c;
    static program first, second;
    ck_skg(run(&first));
    end(&first);
    ck_assert_int_eq(count_blocks(), 0);
    use(&c, -1);
    ck_skg(run(&second));
    ck_assert_int_gt(atomic_load(&c.calls), 100);
    ck_assert_int_eq(atomic_load(&c.live), count_blocks());
    ck_skg_fails(skg_allocator_set(NULL), SKG_ERR_ARGUMENT, "pieces of memory");
    end(&second);
    ck_assert_int_eq(atomic_load(&c.live), 0);
    ck_assert_int_eq(atomic_load(&c.bytes), 0);
    ck_assert_int_eq(count_blocks(), 0);
    use_default();
    ck_assert_mem_eq(first.image, second.image, sizeof first.image);
    ck_assert_int_eq(first.errors + second.errors, 0);
}
END_TEST

/* Fails each allocation once. The calls fail with SKG_ERR_MEMORY, the handler hears of it once, and nothing stays. Where an
 * allocation that fails is no failure of the call (kernels that cannot be kept), the image is the same. */
START_TEST(an_allocator_that_fails_leaves_nothing) {
    static counter c;
    static program whole, broken;
    int64_t refused = 0;
    use(&c, -1);
    ck_skg(run(&whole));
    end(&whole);
    const int64_t all = atomic_load(&c.calls);
    use_default();
    for (int64_t n = 0; n < all; n += 1 + n / 40) { /* all of the first ones, then fewer */
        memset(&broken, 0, sizeof broken);
        use(&c, n);
        const skg_status status = run(&broken);
        if (status != SKG_OK) {
            ck_assert_msg(status == SKG_ERR_MEMORY, "allocation %d: %s (%s)", (int)n, skg_status_name(status),
                          skg_last_error());
            refused++;
            ck_assert_int_le(broken.errors, 1);
            if (broken.errors) ck_assert_int_eq(broken.heard, status);
        } else {
            ck_assert_int_eq(broken.errors, 0);
            ck_assert_mem_eq(broken.image, whole.image, sizeof whole.image);
        }
        end(&broken);
        ck_assert_msg(atomic_load(&c.live) == 0, "allocation %d: %d blocks stay", (int)n,
                      (int)atomic_load(&c.live));
        use_default();
    }
    ck_assert_int_gt(refused, 20);
}
END_TEST

START_TEST(an_allocator_is_whole) {
    skg_allocator allocator;
    skg_allocator_init(&allocator);
    ck_skg(skg_allocator_set(&allocator));
    allocator.allocate = allocate;
    ck_skg_fails(skg_allocator_set(&allocator), SKG_ERR_ARGUMENT, "or none of them");
    ck_skg_fails(skg_allocation_count(NULL), SKG_ERR_ARGUMENT, "count is NULL");
    allocator.size = 0;
    ck_skg_fails(skg_allocator_set(&allocator), SKG_ERR_ARGUMENT, "skg_allocator_init");
}
END_TEST

START_TEST(a_handler_hears_of_each_failure_once) {
    static program p, other;
    skg_output output, lengths;
    skg_mesh *mesh = NULL;
    skg_setup *none = NULL;
    skg_view view;
    int32_t done = 0;
    skg_output_init(&output);
    skg_output_init(&lengths);
    lengths.kind = SKG_OUTPUT_LENGTHS;
    lengths.part = 9;
    skg_view_init(&view);
    ck_skg(run(&p));
    ck_skg(run(&other));
    ck_assert_int_eq(p.errors, 0);
    const skg_status failed[] = {skg_plan_image(p.plan, &output),
                                 skg_plan_submit(p.plan, 0, NULL, 1, &output, &p.job),
                                 skg_plan_submit(p.plan, 1, NULL, 1, &lengths, &p.job),
                                 skg_plan_view_set(p.plan, NULL),
                                 skg_plan_view_set(p.plan, &view),
                                 skg_mesh_load(p.context, "nowhere.stl", 1, &mesh),
                                 skg_setup_load(p.context, "nowhere.json", 0, NULL, &none)};
    for (size_t n = 0; n < sizeof failed / sizeof *failed; n++) ck_assert_int_lt(failed[n], SKG_OK);
    ck_assert_int_eq(p.errors, sizeof failed / sizeof *failed);
    ck_assert_int_eq(other.errors, 0);
    ck_skg_fails(skg_mesh_load(p.context, "nowhere.stl", 1, &mesh), SKG_ERR_FILE, "nowhere.stl");
    ck_assert_int_eq(p.heard, SKG_ERR_FILE);
    ck_assert_ptr_nonnull(strstr(p.sentence, "nowhere.stl"));
    ck_skg_fails(skg_mesh_load(NULL, "nowhere.stl", 1, &mesh), SKG_ERR_FILE, "nowhere.stl");
    ck_skg_fails(skg_job_test(NULL, &done), SKG_ERR_ARGUMENT, "skg_job_test");
    const int before = p.errors;
    ck_skg(skg_context_error_set(p.context, NULL, NULL));
    ck_assert_int_ne(skg_plan_image(p.plan, &output), SKG_OK);
    ck_assert_int_eq(p.errors, before);
    end(&p);
    end(&other);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, everything_comes_from_the_allocator_and_goes_back);
    tcase_add_test(tests, an_allocator_that_fails_leaves_nothing);
    tcase_add_test(tests, an_allocator_is_whole);
    tcase_add_test(tests, a_handler_hears_of_each_failure_once);
}

SKG_SUITE_MAIN("allocator", add_tests)
