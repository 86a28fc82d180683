/* Options of an organ that a caller may set: kinds, axes, links; boxes that turn; drivers that contradict each other. */
#include "body/bones.h"
#include "body/links.h"
#include "body/types.h"
#include "suite.h"
#include "support/angles.h"

#include <skiagraph/skiagraph.h>

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Takes the place of skg_log. */
static char warned[1000];
static int times_told;
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...) {
    (void)context, (void)level;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(warned, sizeof warned, format, arguments);
    va_end(arguments);
    times_told++;
}

static skg_body *body;

static void start(const skg_body_options *options) {
    ck_skg(skg_body_create(NULL, options, &body));
    times_told = 0;
}

/* Moves a mesh that was just made to a place, adds it and lets go of it. */
static skg_status add(skg_organ *organ, const char *label, double x, double y, double z) {
    int64_t vertices, triangles;
    const double place[3] = {x, y, z};
    ck_skg(skg_mesh_count(organ->mesh, &vertices, &triangles));
    double *p = malloc((size_t)vertices * 3 * sizeof *p);
    ck_skg(skg_mesh_positions_get(organ->mesh, p, 0));
    for (int64_t i = 0; i < 3 * vertices; i++) p[i] += place[i % 3];
    ck_skg(skg_mesh_positions_set(organ->mesh, p, 0));
    free(p);
    organ->label = label;
    skg_status status = skg_body_add(body, organ, NULL);
    skg_mesh_release(&organ->mesh);
    return status;
}

/* A cube that turns. */
static void add_block(const char *label, double edge, double x, const double turn[3],
                      const double centre[3]) {
    skg_organ organ;
    skg_organ_init(&organ);
    ck_skg(skg_mesh_create_cube(edge, &organ.mesh));
    organ.kind = SKG_ORGAN_RIGID;
    memcpy(organ.turn_rad, turn, sizeof organ.turn_rad);
    memcpy(organ.centre_mm, centre, sizeof organ.centre_mm);
    ck_skg(add(&organ, label, x, 0, 0));
}

static skg_organ_link link_to(const char *label, double distance_mm, double rigid_mm) {
    return (skg_organ_link){.size = (int32_t)sizeof(skg_organ_link),
                            .to = label,
                            .distance_mm = distance_mm,
                            .rigid_mm = rigid_mm};
}

static skg_status add_ball(const char *label, double radius, skg_tissue tissue, const skg_organ_link *links,
                           int64_t count) {
    skg_organ organ;
    skg_organ_init(&organ);
    ck_skg(skg_mesh_create_sphere(radius, 32, &organ.mesh));
    organ.kind = SKG_ORGAN_DEFORMABLE;
    organ.alpha_min = tissue.alpha_min, organ.alpha_max = tissue.alpha_max, organ.beta = tissue.beta;
    organ.links = links, organ.link_count = count;
    return add(&organ, label, 0, 0, 0);
}

static skg_body_organ *organ_named(const char *label) {
    for (int64_t i = 0; i < body->organs; i++)
        if (!strcmp(body->organ[i].label, label)) return body->organ + i;
    ck_abort_msg("no organ %s", label);
    return NULL;
}

static skg_body_measure pose(double thoracic, double diaphragmatic) {
    skg_breath_state state;
    skg_body_measure measure;
    skg_breath_state_init(&state);
    skg_body_measure_init(&measure);
    state.thoracic = thoracic, state.diaphragmatic = diaphragmatic;
    ck_skg(skg_body_pose(body, &state));
    ck_skg(skg_body_measure_get(body, &measure));
    return measure;
}

static const skg_tissue muscle = {0.7, 1.1, 0.1};

/* Farthest that a vertex is from where a rigid motion takes it, mm. */
static double off_rigid(const skg_body_organ *o, const skg_rigid *rigid) {
    double worst = 0;
    for (int64_t i = 0; i < o->vertices; i++) {
        double d[3];
        skg_rigid_displace(rigid, o->rest + 3 * i, d);
        for (int k = 0; k < 3; k++) worst = fmax(worst, fabs(d[k] - o->moved[3 * i + k]));
    }
    return worst;
}

/* Drivers that turn rigidly: so does the ball, where its boxes turn too. Sums over 100 mm: 1e-12 is some 50
 * rounding errors. */
START_TEST(boxes_turn_with_the_drivers) {
    const double angle = 15 * (_i + 1) * degree, turn[3] = {0.3 * angle, 0, sqrt(1 - 0.09) * angle};
    const double centre[3] = {40, -10, 5};
    const skg_organ_link link = link_to("block", 3, 3);
    start(NULL);
    add_block("block", 40, 0, turn, centre);
    ck_skg(add_ball("ball", 30, muscle, &link, 1));
    ck_skg(skg_body_link(body));
    skg_body_organ *ball = organ_named("ball");
    ck_assert_int_gt(ball->soft.links, 20);
    ck_assert_int_lt(ball->soft.links, ball->vertices / 2);
    ck_assert_int_eq(ball->soft.corotates, 1);
    ck_assert_int_eq(pose(1, 0).broken_links, 0);
    const skg_rigid *rigid = &organ_named("block")->rigid;
    /* A ball within 100 mm of the centre. */
    ck_assert_double_le(off_rigid(ball, rigid), 16 * DBL_EPSILON * 100);
    ball->soft.corotates = 0;
    ck_assert_int_eq(pose(1, 0).broken_links, 0);
    ck_assert_double_gt(off_rigid(ball, rigid), 0.5);
    pose(0, 0);
    for (int64_t i = 0; i < 3 * ball->vertices; i++) ck_assert(ball->moved[i] == 0);
    skg_body_release(&body);
}
END_TEST

/* Within 3 mm vertices go with the block; up to 12 mm they hang on it, and hold on to a post that stays. */
START_TEST(links_hold_and_give) {
    const double turn[3] = {0, 0, 0.04}, centre[3] = {-60, -60, 0}, far = 1e-9;
    const skg_organ_link links[2] = {link_to("block", 12, 3), link_to("post", 3, 3)};
    start(NULL);
    add_block("block", 40, -40, turn, centre);
    skg_organ post;
    skg_organ_init(&post);
    ck_skg(skg_mesh_create_cube(40, &post.mesh));
    post.kind = SKG_ORGAN_STATIC;
    ck_skg(add(&post, "post", 46, 0, 0));
    ck_skg(add_ball("ball", 26, muscle, links, 2));
    ck_skg(skg_body_link(body));
    ck_assert_int_eq(times_told, 0);
    skg_body_organ *ball = organ_named("ball");
    ck_assert_int_eq(ball->soft.corotates, 0); /* it is held */
    skg_body_measure m = pose(1, 0);
    ck_assert_int_eq(m.broken_links, 0);
    ck_assert_double_eq(m.conflict_mm, 0);
    int64_t hanging = ball->soft.chain->nodes - ball->vertices, rigid = 0, gave = 0, held = 0;
    ck_assert_int_gt(hanging, 10);
    for (int64_t d = 0; d < ball->soft.links; d++) {
        double there[3], most = 0;
        const int64_t node = ball->soft.chain->driver[d];
        skg_link_follow(body, ball->soft.link + d, there);
        for (int k = 0; k < 3; k++) /* every driver is met, at the far end of its link or at the vertex */
            ck_assert_double_eq_tol(ball->soft.state[k * ball->soft.chain->nodes + node], there[k], far);
        if (node < ball->vertices) {
            rigid += ball->soft.link[d].organ == 0, held += ball->soft.link[d].organ == 1;
            continue;
        }
        for (int64_t e = ball->soft.chain->first[node]; e < ball->soft.chain->first[node + 1]; e++)
            for (int k = 0; k < 3; k++)
                most = fmax(most, fabs(ball->moved[3 * ball->soft.chain->node[e] + k] - there[k]));
        gave += most > 0.05;
    }
    ck_assert(rigid > 0 && held > 0 && gave > 0);
    skg_body_release(&body);
}
END_TEST

/* A rigid tissue between two blocks that part: the contradiction is all of their distance, and is reported once.
 */
START_TEST(contradictions_are_named) {
    const double turn[3] = {0, 0.05, 0}, back[3] = {0, -0.05, 0}, centre[3] = {0, 0, -200};
    const skg_organ_link links[2] = {link_to("left block", 4, 4), link_to("right block", 4, 4)};
    start(NULL);
    add_block("left block", 40, 46, turn, centre);
    add_block("right block", 40, -46, back, centre);
    ck_skg(add_ball("ball", 27, (skg_tissue){1, 1, 0}, links, 2));
    ck_skg(skg_body_link(body));
    skg_body_measure m = pose(0.001, 0);
    ck_assert_int_eq(times_told, 0); /* below 1 mm: only measured */
    ck_assert_double_gt(m.conflict_mm, 0);
    const skg_body_organ *ball = organ_named("ball");
    for (int turns = 0; turns < 2; turns++) {
        double widest = 0;
        m = pose(1, 0);
        ck_assert_int_eq(m.broken_links, 0);
        for (int k = 0; k < 3; k++) {
            double low = HUGE_VAL, high = -HUGE_VAL;
            for (int64_t d = 0; d < ball->soft.links; d++)
                low = fmin(low, ball->soft.target[3 * d + k]),
                high = fmax(high, ball->soft.target[3 * d + k]);
            widest = fmax(widest, high - low);
        }
        ck_assert_double_gt(widest, 15);
        ck_assert_double_eq_tol(m.conflict_mm, widest, 16 * DBL_EPSILON * widest);
        ck_assert_str_eq(m.conflict[0], "ball");
        ck_assert(strstr(m.conflict[1], "block") && strstr(m.conflict[2], "block"));
        ck_assert_str_ne(m.conflict[1], m.conflict[2]);
        ck_assert_int_eq(times_told, 1);
        ck_assert(strstr(warned, "ball: ") && strstr(warned, "left block") && strstr(warned, "right block") &&
                  strstr(warned, " mm"));
    }
    skg_body_release(&body);
}
END_TEST

START_TEST(ties_are_posed_in_order) { /* however they were added; not in a circle */
    const double turn[3] = {0, 0, 0.1}, centre[3] = {0, 0, 0};
    const skg_organ_link to_inner = link_to("inner", 12, 12), to_block = link_to("Block", 10, 10),
                         to_outer = link_to("outer", 12, 12);
    start(NULL);
    ck_skg(add_ball("outer", 30, muscle, &to_inner, 1));
    ck_skg(add_ball("inner", 20, muscle, &to_block, 1));
    add_block("block", 20, 0, turn, centre);
    ck_skg(skg_body_link(body));
    pose(1, 0);
    const skg_body_organ *inner = organ_named("inner"), *outer = organ_named("outer");
    ck_assert_int_gt(outer->soft.stage, inner->soft.stage);
    double farthest = 0;
    for (int64_t d = 0; d < outer->soft.links; d++) { /* with where the inner one is now, not where it was */
        double there[3];
        skg_link_follow(body, outer->soft.link + d, there);
        for (int k = 0; k < 3; k++) {
            ck_assert_double_eq_tol(outer->moved[3 * outer->soft.chain->driver[d] + k], there[k],
                                    64 * DBL_EPSILON * 100);
            farthest = fmax(farthest, fabs(there[k]));
        }
    }
    ck_assert_double_gt(farthest, 1);
    skg_body_release(&body);
    start(NULL);
    ck_skg(add_ball("outer", 30, muscle, &to_inner, 1));
    ck_skg(add_ball("inner", 20, muscle, &to_outer, 1));
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "linked back");
    skg_body_release(&body);
}
END_TEST

START_TEST(the_papers_two_angles) { /* one exponential map; alike on both sides */
    const double gamma = 0.2, lambda = 0.1;
    double side_rises[2], front_rises[2];
    for (int side = 0; side < 2; side++) {
        start(NULL);
        skg_organ organ;
        skg_organ_init(&organ);
        ck_skg(skg_mesh_create_sphere(20, 12, &organ.mesh));
        organ.kind = SKG_ORGAN_RIGID;
        organ.gamma_rad = gamma, organ.lambda_rad = lambda;
        for (int k = 0; k < 3; k++) organ.centre_mm[k] = 0;
        ck_skg(add(&organ, side ? "bar right" : "bar left", 0, 0, 0));
        ck_skg(skg_body_link(body));
        pose(1, 0);
        const skg_rigid *rigid = &body->organ[0].rigid;
        const double *r = rigid->rotation;
        ck_assert_double_eq_tol(acos((r[0] + r[4] + r[8] - 1) / 2), hypot(gamma, lambda), 32 * DBL_EPSILON);
        const double lateral[3] = {side ? -100 : 100, 0, 0}, front[3] = {0, -100, 0},
                     axis[3] = {-lambda, side ? gamma : -gamma, 0};
        double d[3];
        skg_rigid_displace(rigid, axis, d); /* the axis stays */
        for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(d[k], 0, 1e-15);
        skg_rigid_displace(rigid, lateral, d);
        side_rises[side] = d[2];
        ck_assert_double_eq_tol(d[2], 100 * gamma * sin(hypot(gamma, lambda)) / hypot(gamma, lambda),
                                32 * DBL_EPSILON * 100);
        skg_rigid_displace(rigid, front, d);
        front_rises[side] = d[2];
        double once[9];
        memcpy(once, r, sizeof once);
        pose(0.5, 0); /* half the angle: its square is the whole */
        for (int i = 0; i < 9; i++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += r[i / 3 * 3 + k] * r[3 * k + i % 3];
            ck_assert_double_eq_tol(sum, once[i], 4 * DBL_EPSILON);
        }
        skg_body_release(&body);
    }
    ck_assert_double_eq_tol(side_rises[0], side_rises[1], 2 * DBL_EPSILON * 20);
    ck_assert_double_eq_tol(front_rises[0], front_rises[1], 2 * DBL_EPSILON * 20);
    ck_assert_double_gt(front_rises[0], 9);
}
END_TEST

/* The generated thorax, with something said of some of its organs. */
static void make_thorax(const skg_body_options *options, void (*say)(const char *label, skg_organ *organ)) {
    skg_thorax *thorax;
    skg_thorax_options size;
    int64_t parts;
    skg_thorax_options_init(&size);
    size.triangles = 10000;
    size.simple = 1;
    ck_skg(skg_thorax_create(&size, &thorax));
    ck_skg(skg_thorax_part_count(thorax, &parts));
    start(options);
    for (int64_t i = 0; i < parts; i++) {
        skg_thorax_part part;
        skg_organ organ;
        skg_thorax_part_init(&part);
        skg_organ_init(&organ);
        ck_skg(skg_thorax_part_get(thorax, i, &part));
        organ.mesh = part.mesh, organ.label = part.label, organ.inside = part.inside;
        if (say) say(part.label, &organ);
        ck_skg(skg_body_add(body, &organ, NULL));
    }
    skg_thorax_release(&thorax);
    ck_skg(skg_body_link(body));
}

START_TEST(axes_by_inertia) { /* there is no vertebra by itself: the posterior end, and Wilson's angles */
    static const double pump[] = {11, 10, 9, 8, 7}, bucket[] = {13, 12.25, 11.5, 10.75, 10}; /* ribs 3 to 7 */
    skg_body_options options;
    skg_body_options_init(&options);
    options.rib_axes = SKG_RIB_AXES_BONES;
    make_thorax(&options, NULL);
    for (int n = 1; n <= 12; n++)
        for (int side = 1; side >= -1; side -= 2) {
            char label[40];
            double before[2], after[2];
            snprintf(label, sizeof label, "rib %d %s", n, side > 0 ? "left" : "right");
            skg_body_organ *rib = organ_named(label);
            const double *bounds = rib->mesh->health.bounds;
            if (n <= 10)
                ck_assert_double_gt(rib->turn.head[1],
                                    bounds[1] + 0.6 * (bounds[4] - bounds[1])); /* behind */
            const double inner = side > 0 ? rib->turn.head[0] - bounds[0] : bounds[3] - rib->turn.head[0];
            ck_assert_double_lt(inner, 0.8 * (bounds[3] - bounds[0]));
            if (n < 3 || n > 7) continue;
            skg_rib_plane(rib, NULL, before, before + 1);
            skg_rotation(rib->turn.axis, rib->rigid.rotation);
            memcpy(rib->rigid.centre, rib->turn.head, sizeof rib->turn.head);
            for (int64_t i = 0; i < rib->vertices; i++)
                skg_rigid_displace(&rib->rigid, rib->rest + 3 * i, rib->moved + 3 * i);
            skg_rib_plane(rib, rib->moved, after, after + 1);
            /* Degrees of a fitted plane, which is solved for. */
            ck_assert_double_eq_tol((before[0] - after[0]) / degree, pump[n - 3], 1024 * DBL_EPSILON * 10);
            ck_assert_double_eq_tol((before[1] - after[1]) / degree, bucket[n - 3], 1024 * DBL_EPSILON * 10);
        }
    skg_body_measure m = pose(1, 1);
    ck_assert_int_eq(m.broken_links, 0);
    ck_assert(m.tidal_ml > 200 && m.tidal_ml < 1000);
    skg_body_release(&body);
}
END_TEST

static void say_some(const char *label, skg_organ *organ) {
    static const skg_organ_link links[] = {
        {.size = (int32_t)sizeof(skg_organ_link), .to = "rib", .distance_mm = 30, .rigid_mm = 20}};
    if (!strcmp(label, "rib 5 left")) {
        organ->kind = SKG_ORGAN_RIGID, organ->gamma_rad = 3 * degree, organ->lambda_rad = 2 * degree;
    } else if (!strcmp(label, "cartilage 5 left")) {
        organ->kind = SKG_ORGAN_DEFORMABLE;
    } else if (!strcmp(label, "stomach")) {
        organ->kind = SKG_ORGAN_STATIC;
    } else if (!strcmp(label, "lung left")) {
        organ->links = links, organ->link_count = 1;
    }
}

START_TEST(an_organ_is_what_it_is_set_to_be) {
    skg_body_options options;
    skg_body_options_init(&options);
    options.coupling = SKG_COUPLING_PAPER; /* which relaxation selects too */
    make_thorax(&options, NULL);
    const skg_body_organ *liver = organ_named("liver");
    pose(1, 1);
    double *plain = malloc((size_t)liver->vertices * 3 * sizeof *plain), apart = 0;
    memcpy(plain, liver->moved, (size_t)liver->vertices * 3 * sizeof *plain);
    skg_body_release(&body);
    options.relaxation = 3;
    make_thorax(&options, say_some);
    skg_body_measure m = pose(1, 1);
    ck_assert_int_eq(m.broken_links, 0); /* after the passes of relaxation, on every organ */
    liver = organ_named("liver");
    for (int64_t i = 0; i < 3 * liver->vertices; i++) apart = fmax(apart, fabs(plain[i] - liver->moved[i]));
    ck_assert_double_gt(apart, 0.1);
    for (int64_t d = 0; d < liver->soft.links; d++) /* and every driver is met to what they contradict */
        for (int k = 0; k < 3; k++)
            ck_assert_double_le(
                fabs(liver->moved[3 * liver->soft.chain->driver[d] + k] - liver->soft.target[3 * d + k]),
                0.5 * m.conflict_mm + 1e-9);
    const skg_body_organ *rib = organ_named("rib 5 left"), *other = organ_named("rib 5 right");
    const skg_body_organ *cartilage = organ_named("cartilage 5 left"), *stomach = organ_named("stomach");
    const double length = sqrt(rib->turn.axis[0] * rib->turn.axis[0] + rib->turn.axis[1] * rib->turn.axis[1]);
    ck_assert_double_eq_tol(length, hypot(3, 2) * degree, 4 * DBL_EPSILON);
    ck_assert_double_eq_tol(rib->turn.head[0], -other->turn.head[0], 1e-9); /* still about its head */
    ck_assert_int_ge(cartilage->soft.links, 3);                             /* of a coarse mesh */
    ck_assert_int_eq(cartilage->soft.corotates, 1);
    for (int64_t i = 0; i < 3 * stomach->vertices; i++) ck_assert(stomach->moved[i] == 0);
    const skg_body_organ *lung = organ_named("lung left");
    ck_assert_int_gt(lung->soft.links, 10);
    for (int64_t d = 0; d < lung->soft.links; d++)
        ck_assert_int_eq(body->organ[lung->soft.link[d].organ].role, ROLE_RIB);
    free(plain);
    skg_body_release(&body);
}
END_TEST

START_TEST(what_does_not_fit_is_refused) {
    skg_organ organ, plain;
    skg_organ_link link = link_to("nowhere", 5, 5);
    skg_organ_init(&plain);
    plain.label = "bag";
    start(NULL);
    ck_skg(skg_mesh_create_cube(10, &plain.mesh));
#define REFUSED(change, text)                                                                                \
    do {                                                                                                     \
        organ = plain;                                                                                       \
        change;                                                                                              \
        ck_skg_fails(skg_body_add(body, &organ, NULL), SKG_ERR_BREATHING, text);                             \
    } while (0)
    REFUSED(organ.kind = 7, "bag: kind 7");
    REFUSED(organ.kind = SKG_ORGAN_RIGID, "give it a rotation");
    REFUSED(organ.gamma_rad = 0.1, "not rigid");
    REFUSED((organ.kind = SKG_ORGAN_RIGID, organ.turn_rad[1] = 4), "half a turn");
    REFUSED((organ.kind = SKG_ORGAN_RIGID, organ.lambda_rad = (double)NAN), "not finite");
    REFUSED((organ.kind = SKG_ORGAN_RIGID, organ.turn_rad[1] = 1, organ.centre_mm[1] = 0), "three finite");
    REFUSED(organ.centre_mm[0] = 1, "rigid organ");
    REFUSED((organ.links = &link, organ.link_count = 1), "not deformable");
    organ.kind = SKG_ORGAN_DEFORMABLE;
    link.rigid_mm = 6;
    REFUSED((organ.kind = SKG_ORGAN_DEFORMABLE, organ.links = &link, organ.link_count = 1), "no farther");
    link.rigid_mm = 1, link.distance_mm = (double)NAN;
    REFUSED((organ.kind = SKG_ORGAN_DEFORMABLE, organ.links = &link, organ.link_count = 1), "nowhere");
    link.distance_mm = 5;
    organ = plain;
    organ.kind = SKG_ORGAN_DEFORMABLE, organ.links = &link, organ.link_count = 1;
    ck_skg(skg_body_add(body, &organ, NULL));
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "bag: linked to \"nowhere\"");
    skg_body_release(&body);
    start(NULL);
    organ.label = "spleen", organ.kind = SKG_ORGAN_BY_LABEL, organ.link_count = 0;
    ck_skg(skg_body_add(body, &organ, NULL));
    organ.label = "bag", organ.kind = SKG_ORGAN_DEFORMABLE, organ.link_count = 1, link.to = "spleen";
    ck_skg(skg_body_add(body, &organ, NULL));
    ck_skg_fails(skg_body_link(body), SKG_ERR_BREATHING, "follows another organ");
    skg_body_release(&body);
    start(NULL); /* defined, and reported: nothing is near */
    organ.link_count = 0;
    ck_skg(skg_body_add(body, &organ, NULL));
    ck_skg(skg_body_link(body));
    ck_assert(times_told == 1 && strstr(warned, "bag: deformable, but nothing"));
    ck_assert_int_eq(pose(1, 1).broken_links, 0);
    for (int k = 0; k < 24; k++) ck_assert(body->organ[0].moved[k] == 0);
    skg_body_release(&body);
    skg_mesh_release(&plain.mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, boxes_turn_with_the_drivers, 0, 3);
    tcase_add_test(tests, links_hold_and_give);
    tcase_add_test(tests, contradictions_are_named);
    tcase_add_test(tests, ties_are_posed_in_order);
    tcase_add_test(tests, the_papers_two_angles);
    tcase_add_test(tests, axes_by_inertia);
    tcase_add_test(tests, an_organ_is_what_it_is_set_to_be);
    tcase_add_test(tests, what_does_not_fit_is_refused);
}

SKG_SUITE_MAIN("organ", add_tests)
