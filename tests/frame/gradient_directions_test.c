/* Derivatives along several directions at once are those along each alone, bit by bit. */
#include "core/context.h"
#include "device/device.h"
#include "gradients.h"
#include "support/doubles.h"

#include <math.h>
#include <string.h>

enum { DIRECTIONS = 8, NODES_MAX = 32, VERTICES_MAX = 4096 };

static const setting settings[] = {
    {.name = "one energy"},
    {.name = "priority", .priority = 1, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "a hole by priority", .priority = 1, .hole = 1, .world = 1, .colours = 1},
    {.name = "nested, bands", .nested = 1, .bands = 2, .colours = 1},
    {.name = "parallel", .parallel = 1, .nested = 1},
    {.name = "spot, supersampling, falloff", .spot = 1, .supersampling = 2, .falloff = 1, .priority = 1},
    {.name = "blur", .blur = 1, .colours = 1, .quantity = SKG_QUANTITY_ATTENUATION},
    {.name = "tolerance", .tolerance = 1e-3, .colours = 1, .nested = 1},
};
enum { SETTINGS = sizeof settings / sizeof *settings };

/* Arrays to which the directions point. */
static double poses[DIRECTIONS][PARTS][6], coefficients[PARTS * NODES_MAX], changes[PARTS];
static double source[3] = {0.3, -0.2, 1}, detector[6] = {0, 0, 1, 1e-3, 0, 2e-3};
static double moves[3 * VERTICES_MAX];
static const double *vertices[PARTS];

/* A part, another one with the source, the detector, vertices, matter, both with a pose, nothing, and the first once more. */
static void make_directions(skg_plan *plan, skg_direction *directions) {
    int64_t nodes = 0, count = 0, triangles = 0;
    ck_skg(skg_plan_node_count(plan, &nodes));
    ck_assert_int_le(nodes, NODES_MAX);
    ck_skg(skg_mesh_count(meshes[1], &count, &triangles));
    ck_assert_int_le(count, VERTICES_MAX);
    memset(poses, 0, sizeof poses);
    memset(vertices, 0, sizeof vertices);
    for (int i = 0; i < 3 * VERTICES_MAX; i++) moves[i] = sin(i);
    for (int i = 0; i < PARTS * NODES_MAX; i++) coefficients[i] = 1e-3 * cos(i);
    for (int d = 0; d < DIRECTIONS; d++) skg_direction_init(&directions[d]);
    poses[0][0][0] = poses[1][1][4] = poses[5][0][2] = poses[7][0][0] = 1;
    changes[0] = 0.5;
    vertices[1] = moves;
    directions[0].poses = poses[0][0];
    directions[1].poses = poses[1][0], directions[1].source = source;
    directions[2].detector = detector;
    directions[3].vertices = vertices;
    directions[4].densities = changes;
    directions[5].poses = poses[5][0], directions[5].densities = changes;
    directions[5].attenuations = coefficients, directions[5].nodes = nodes;
    directions[6].poses = poses[6][0];
    directions[7].poses = poses[7][0];
}

START_TEST(together_they_have_the_bits_of_each) {
    static double together[DIRECTIONS * CHANNELS_MAX * PIXELS], alone[CHANNELS_MAX * PIXELS];
    const setting *set = &settings[_i / 2];
    const int32_t precision = _i % 2 ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    const int64_t size = (set->bands ? set->bands : 1) * PIXELS;
    skg_direction directions[DIRECTIONS];
    int64_t saturated[DIRECTIONS];
    result r;
    if (precision == SKG_PRECISION_DOUBLE && !run_has_double()) return;
    make_scene(set);
    allocate(&r);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, precision, SKG_STRATEGY_AUTO);
    make_directions(plan, directions);
    memset(together, 0x55, sizeof together);
    ck_skg(skg_plan_derivatives(plan, NULL, DIRECTIONS, directions, DOUBLES(together), saturated));
    for (int d = 0; d < DIRECTIONS; d++) {
        int64_t cut = -1;
        double largest = 0;
        ck_skg(skg_plan_derivatives(plan, NULL, 1, &directions[d], DOUBLES(alone), &cut));
        ck_assert_int_eq(saturated[d], cut);
        for (int64_t i = 0; i < size; i++) {
            largest = fmax(largest, fabs(alone[i]));
            ck_assert_msg(together[d * size + i] == alone[i],
                          "%s, direction %d, value %d: %.17g, alone %.17g", set->name, d, (int)i,
                          together[d * size + i], alone[i]);
        }
        ck_assert_msg((largest > 0) == (d != 6), "%s, direction %d: %g", set->name, d, largest);
    }
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* Rows, channels and directions of an output, further apart than they need be, and what stands between them. */
enum { ROW = SIDE + 3, CHANNEL = SIDE * ROW + 5, DIRECTION = 2 * CHANNEL + 7, FIRST = 11 };
enum { SPREAD = FIRST + DIRECTIONS * DIRECTION };
static const float BETWEEN = -7e30f;

static skg_output spread_output(int32_t type) {
    skg_output output;
    skg_output_init(&output);
    output.type = type;
    output.row_stride = ROW, output.channel_stride = CHANNEL, output.frame_stride = DIRECTION;
    return output;
}

/* Asserts that every value is the dense one, rounded where the output has floats, and that nothing else was written. */
static void check_spread(const char *name, int64_t channels, const double *dense, const skg_output *output,
                         const void *got) {
    int64_t values = 0;
    for (int64_t i = 0; i < SPREAD; i++) {
        const int is_double = output->type == SKG_TYPE_FLOAT64;
        const int64_t at = i - FIRST, d = at / DIRECTION, c = at % DIRECTION / CHANNEL,
                      row = at % DIRECTION % CHANNEL / ROW, column = at % DIRECTION % CHANNEL % ROW;
        const int is_value = at >= 0 && c < channels && row < SIDE && column < SIDE;
        const double value = is_double ? ((const double *)got)[i] : (double)((const float *)got)[i];
        double wanted = (double)BETWEEN;
        if (is_value) wanted = dense[((d * channels + c) * SIDE + row) * SIDE + column];
        values += is_value;
        ck_assert_msg(value == (is_double ? wanted : (double)(float)wanted),
                      "%s, element %d: %.17g instead of %.17g", name, (int)i, value, wanted);
    }
    ck_assert_int_eq(values, DIRECTIONS * channels * PIXELS);
}

/* Floats are the doubles rounded; strides and the caller's buffers change no value. */
START_TEST(every_output_has_the_same_values) {
    static double dense[DIRECTIONS * 2 * PIXELS], doubles[SPREAD];
    static float floats[SPREAD];
    const setting set = {.name = "bands", .nested = 1, .bands = 2, .colours = 1};
    const int in_buffer = _i & 1, is_double = _i & 2;
    const size_t bytes = is_double ? sizeof doubles : sizeof floats;
    skg_direction directions[DIRECTIONS];
    cl_int code = CL_SUCCESS;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    make_directions(plan, directions);
    ck_skg(skg_plan_derivatives(plan, NULL, DIRECTIONS, directions, DOUBLES(dense), NULL));
    for (int i = 0; i < SPREAD; i++) doubles[i] = (double)(floats[i] = BETWEEN);
    void *memory = is_double ? (void *)doubles : floats;
    skg_output output = spread_output(is_double ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32);
    cl_mem buffer = in_buffer
                        ? clCreateBuffer(run_context->device->cl, CL_MEM_COPY_HOST_PTR, bytes, memory, &code)
                        : NULL;
    ck_assert_int_eq(code, CL_SUCCESS);
    output.buffer = buffer;
    output.offset = FIRST * (is_double ? 8 : 4);
    output.data = in_buffer ? NULL : (char *)memory + output.offset;
    ck_skg(skg_plan_derivatives(plan, NULL, DIRECTIONS, directions, &output, NULL));
    if (buffer)
        ck_assert_int_eq(
            clEnqueueReadBuffer(run_context->device->queue, buffer, CL_TRUE, 0, bytes, memory, 0, NULL, NULL),
            CL_SUCCESS);
    if (buffer) clReleaseMemObject(buffer);
    check_spread(in_buffer ? "a buffer" : "host memory", 2, dense, &output, memory);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* Dense images of doubles are made where they go, also if there is room between directions. */
START_TEST(directions_may_stand_apart) {
    enum { APART = PIXELS + 13 };
    static double dense[DIRECTIONS * PIXELS], apart[DIRECTIONS * APART];
    const setting set = {.name = "one energy"};
    skg_direction directions[DIRECTIONS];
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    make_directions(plan, directions);
    ck_skg(skg_plan_derivatives(plan, NULL, DIRECTIONS, directions, DOUBLES(dense), NULL));
    for (int i = 0; i < DIRECTIONS * APART; i++) apart[i] = (double)BETWEEN;
    skg_output output = *DOUBLES(apart);
    output.frame_stride = APART;
    ck_skg(skg_plan_derivatives(plan, NULL, DIRECTIONS, directions, &output, NULL));
    for (int i = 0; i < DIRECTIONS * APART; i++)
        ck_assert_msg(apart[i] ==
                          (i % APART < PIXELS ? dense[i / APART * PIXELS + i % APART] : (double)BETWEEN),
                      "element %d: %.17g", i, apart[i]);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* An output that the directions do not fit. */
static void check_refused(skg_plan *plan, const skg_direction *directions, const skg_output *output,
                          const char *reason) {
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 2, directions, output, NULL), SKG_ERR_ARGUMENT, reason);
}

START_TEST(outputs_that_cannot_be_filled_are_refused) {
    static double found[2 * PIXELS];
    const setting set = {.name = "one energy"};
    skg_direction directions[2];
    cl_int code = CL_SUCCESS;
    skg_output output;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    for (int d = 0; d < 2; d++) skg_direction_init(&directions[d]);
    check_refused(plan, directions, NULL, "skg_plan_derivatives: the argument derivatives is NULL");
    skg_output_init(&output);
    check_refused(plan, directions, &output, "the output has no memory: its data is NULL");
    output = *DOUBLES(found), output.kind = SKG_OUTPUT_LENGTHS;
    check_refused(
        plan, directions, &output,
        "skg_plan_derivatives: an output of kind 1; there are derivatives of SKG_OUTPUT_IMAGE alone");
    output = *DOUBLES(found), output.type = 7;
    check_refused(plan, directions, &output, "output type 7 is unknown");
    output = *DOUBLES(found), output.row_stride = SIDE - 1;
    check_refused(plan, directions, &output, "a row stride of 23 elements does not hold 24 columns");
    output = *DOUBLES(found), output.frame_stride = PIXELS - 1;
    check_refused(plan, directions, &output, "a frame stride of 575 elements does not hold 1 channels");
    cl_mem buffer = clCreateBuffer(run_context->device->cl, CL_MEM_READ_WRITE, sizeof found - 1, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    output = *DOUBLES(NULL), output.buffer = buffer;
    check_refused(plan, directions, &output, "the images end at byte 9216, the buffer at 9215");
    output.offset = 4;
    check_refused(plan, directions, &output, "an offset of 4 bytes is no multiple of an element's 8");
    clReleaseMemObject(buffer);
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

START_TEST(what_is_wrong_is_said) {
    static double found[3 * PIXELS];
    const setting set = {.name = "one energy"};
    skg_direction directions[3];
    double bad[6] = {0, 0, 0, 0, (double)NAN, 0};
    skg_job *job = NULL;
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    for (int d = 0; d < 3; d++) skg_direction_init(&directions[d]);
    directions[2].detector = bad;
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 3, directions, DOUBLES(found), NULL), SKG_ERR_ARGUMENT,
                 "skg_plan_derivatives: number 4 of direction 2's detector is nan; it has to be finite");
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 0, directions, DOUBLES(found), NULL), SKG_ERR_ARGUMENT,
                 "skg_plan_derivatives: 0 directions; at least 1");
    ck_skg_fails(skg_plan_derivatives_submit(plan, NULL, -1, directions, DOUBLES(found), NULL, &job),
                 SKG_ERR_ARGUMENT, "skg_plan_derivatives_submit: -1 directions; at least 1");
    ck_assert_ptr_null(job);
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 1, NULL, DOUBLES(found), NULL), SKG_ERR_ARGUMENT,
                 "skg_plan_derivatives: the argument directions is NULL");
    ck_skg_fails(skg_plan_derivatives(plan, NULL, 1, &directions[2], DOUBLES(found), NULL), SKG_ERR_ARGUMENT,
                 "skg_plan_derivatives: number 4 of the direction's detector is nan; it has to be finite");
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, together_they_have_the_bits_of_each, 0, 2 * SETTINGS);
    tcase_add_loop_test(tests, every_output_has_the_same_values, 0, 4);
    tcase_add_test(tests, directions_may_stand_apart);
    tcase_add_test(tests, outputs_that_cannot_be_filled_are_refused);
    tcase_add_test(tests, what_is_wrong_is_said);
}

SKG_SUITE_MAIN("gradient_directions", add_tests)
