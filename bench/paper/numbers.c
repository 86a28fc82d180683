/* One ray through a cylinder of bone (20 sectors, 2 cm across) in a cube of soft tissue (3 cm): it meets an
 * edge of the cylinder and the diagonals of the cube's faces. Source and detector are 10 cm away. */
#include "paper/numbers.h"

#include <math.h>

enum { PRECISIONS = 3, ENERGIES = 4 };

static const char *const precision_names[PRECISIONS] = {"half", "single", "double"};
static const int32_t precisions[PRECISIONS] = {SKG_PRECISION_HALF, SKG_PRECISION_SINGLE,
                                               SKG_PRECISION_DOUBLE};
static const double kev[ENERGIES] = {80, 100, 200, 300};
static const double photons[ENERGIES] = {1, 10, 20, 10}; /* Eq. 14 has the first energy, Eq. 15 the others */
/* The paper's Tables 3 and 4, 1/cm. */
static const double printed_bone[ENERGIES] = {.3971, .3328, .2369, .2018};
static const double printed_soft[ENERGIES] = {.1937, .1800, .1445, .1251};
/* The results of its Eq. 14 and 15, and those of its 16-bit buffers, keV. */
static const double printed_equation[2] = {29.789, 4353.175}, printed_half[2] = {29.831, 4355.469};

typedef struct {
    int known; /* 0: the device lacks this precision */
    double lengths[2], kev;
} ray;

static void add(skg_scene *scene, skg_mesh *mesh, skg_material *material, int64_t inside) {
    skg_part part;
    skg_part_init(&part);
    part.mesh = mesh, part.material = material, part.inside = inside;
    bench_try(skg_scene_part_add(scene, &part, NULL), "scene");
    skg_mesh_release(&mesh);
}

static skg_scene *object(skg_context *context, skg_material *bone, skg_material *soft) {
    skg_scene *scene = NULL;
    skg_mesh *cube = NULL, *cylinder = NULL;
    bench_try(skg_scene_create(context, &scene), "scene");
    bench_try(skg_mesh_create_cube(30, &cube), "cube");
    bench_try(skg_mesh_create_cylinder(10, 30, 20, &cylinder), "cylinder");
    add(scene, cube, soft, -1);
    add(scene, cylinder, bone, 0);
    return scene;
}

static skg_spectrum *beam_of(int equation) {
    skg_spectrum *beam = NULL;
    if (equation == 0)
        bench_try(skg_spectrum_create_mono(kev[0], photons[0], &beam), "beam");
    else
        bench_try(skg_spectrum_create_bins(ENERGIES - 1, kev + 1, photons + 1, &beam), "beam");
    return beam;
}

/* Energy in keV and path lengths in mm of the middle pixel. */
static ray trace(const paper_study *study, skg_material *bone, skg_material *soft, int equation,
                 int32_t precision) {
    enum { PIXELS = 301, MIDDLE = PIXELS / 2 };
    static double pixels[PIXELS];
    ray out = {0};
    skg_plan *plan = NULL;
    skg_view view;
    skg_plan_options options;
    skg_output output;
    skg_scene *scene = object(study->context, bone, soft);
    skg_spectrum *beam = beam_of(equation);
    skg_view_init(&view);
    view.columns = PIXELS, view.rows = 1;
    view.source[0] = -100, view.centre[0] = 100;
    view.column_step[1] = view.row_step[2] = 0.3;
    skg_plan_options_init(&options);
    options.precision = precision;
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = pixels;
    const skg_status status = skg_plan_create(study->context, scene, &view, beam, &options, &plan);
    if (status != SKG_ERR_UNSUPPORTED) {
        bench_try(status, "plan");
        out.known = 1;
        bench_try(skg_plan_image(plan, &output), "image");
        out.kev = pixels[MIDDLE];
        for (int64_t part = 0; part < 2; part++) {
            skg_job *job = NULL;
            output.kind = SKG_OUTPUT_LENGTHS;
            output.part = part;
            output.lengths = SKG_LENGTHS_SURFACE;
            bench_try(skg_plan_submit(plan, 1, NULL, 1, &output, &job), "lengths");
            bench_try(skg_job_wait(&job), "lengths");
            out.lengths[part] = pixels[MIDDLE];
        }
    }
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    return out;
}

/* 2 cm of bone and 1 cm of soft tissue. */
static double closed_form(const skg_material *bone, const skg_material *soft, int equation) {
    double sum = 0;
    for (int k = equation ? 1 : 0; k < (equation ? ENERGIES : 1); k++) {
        double in_bone = 0, in_soft = 0;
        bench_try(skg_material_attenuation_get(bone, kev[k], &in_bone), "bone");
        bench_try(skg_material_attenuation_get(soft, kev[k], &in_soft), "soft tissue");
        sum += photons[k] * kev[k] * exp(-2 * in_bone - in_soft);
    }
    return sum;
}

/* Prints a value and its relative difference from the truth. */
static void print_value(const paper_study *study, const char *what, int precision, int known, double value,
                        double truth, int digits, const char *unit) {
    char name[128];
    if (!known) {
        printf(" - |");
        return;
    }
    const double off = 100 * (value / truth - 1);
    printf(fabs(off) < 1e-3 ? " %.*f (%+.1e %%) |" : " %.*f (%+.3f %%) |", digits, value, off);
    snprintf(name, sizeof name, "%s; %s", what, precision_names[precision]);
    paper_row(study, "number", name, 0, 0, value, unit);
}

static void print_lengths(const paper_study *study, const ray *rays) {
    static const char *const names[2] = {"path length in the cube", "path length in the cylinder"};
    static const double truth[2] = {3, 2};
    for (int part = 1; part >= 0; part--) {
        printf("| %s, cm | - | - | %g |", names[part], truth[part]);
        for (int p = 0; p < PRECISIONS; p++)
            print_value(study, names[part], p, rays[p].known, rays[p].lengths[part] / 10, truth[part], 6,
                        "cm");
        printf("\n");
    }
}

static void print_equation(const paper_study *study, const char *from, int equation, const ray *rays,
                           double truth) {
    char what[64];
    snprintf(what, sizeof what, "Eq. %d %s", 14 + equation, from);
    printf("| %s, keV | %.3f | %.3f (%+.3f %%) | %.*f |", what, printed_equation[equation],
           printed_half[equation], 100 * (printed_half[equation] / printed_equation[equation] - 1),
           equation ? 4 : 6, truth);
    for (int p = 0; p < PRECISIONS; p++)
        print_value(study, what, p, rays[p].known, rays[p].kev, truth, equation ? 3 : 5, "keV");
    printf("\n");
}

static void print_coefficients(const paper_study *study, const skg_material *bone, const skg_material *soft) {
    const skg_material *const materials[2] = {bone, soft};
    const double *const printed[2] = {printed_bone, printed_soft};
    static const char *const names[2] = {"bone, 1329 HU", "soft tissue, 51 HU"};
    printf("\nmu in 1/cm, printed (Tables 3 and 4) / ours (difference from the printed one):\n\n"
           "| material | 80 keV | 100 keV | 200 keV | 300 keV |\n|---|---:|---:|---:|---:|\n");
    for (int m = 0; m < 2; m++) {
        printf("| %s |", names[m]);
        for (int k = 0; k < ENERGIES; k++) {
            char what[64];
            double mu = 0;
            bench_try(skg_material_attenuation_get(materials[m], kev[k], &mu), names[m]);
            printf(" %.4f / %.4f (%+.2f %%) |", printed[m][k], mu, 100 * (mu / printed[m][k] - 1));
            snprintf(what, sizeof what, "mu of %.4s at %g keV", names[m], kev[k]);
            paper_row(study, "number", what, 0, 0, mu, "1/cm");
        }
        printf("\n");
    }
}

/* Returns 1 if half does not give the values that are printed for 16 bits. */
static int print_rays(const paper_study *study, const char *from, skg_material *bone, skg_material *soft,
                      int with_lengths) {
    int differs = 0;
    ray rays[2][PRECISIONS];
    for (int equation = 0; equation < 2; equation++)
        for (int p = 0; p < PRECISIONS; p++)
            rays[equation][p] = trace(study, bone, soft, equation, precisions[p]);
    if (with_lengths) print_lengths(study, rays[0]);
    for (int equation = 0; equation < 2; equation++) {
        print_equation(study, from, equation, rays[equation], closed_form(bone, soft, equation));
        differs |= fabs(rays[equation][0].kev - printed_half[equation]) > 0.0005;
    }
    return differs;
}

int paper_numbers(const paper_study *study) {
    skg_material *bone = NULL, *soft = NULL;
    printf(
        "## Sections 4.3.2 and 4.3.3: one ray\n\n"
        "2 cm of bone in 3 cm of soft tissue. In brackets: the difference from the closed form with the same mu; for the "
        "paper's 16-bit buffers, from the paper's equation.\n\n"
        "| quantity | printed: equation | printed: 16 bits | closed form | half | single | double |\n"
        "|---|---:|---:|---:|---:|---:|---:|\n");
    bench_try(skg_material_create_table("bone", ENERGIES, kev, printed_bone, &bone), "bone");
    bench_try(skg_material_create_table("soft tissue", ENERGIES, kev, printed_soft, &soft), "soft tissue");
    const int differs = print_rays(study, "from the printed mu", bone, soft, 1);
    skg_material_release(&bone);
    skg_material_release(&soft);
    /* The paper's 1329.886 and 51.715, cut to whole numbers as its code did. */
    bench_try(skg_material_create_hounsfield(1329, &bone), "bone");
    bench_try(skg_material_create_hounsfield(51, &soft), "soft tissue");
    print_rays(study, "from 1329 and 51 HU", bone, soft, 0);
    printf("\nFrom the printed mu, half gives all digits that are printed for 16 bits: %s.\n",
           differs ? "NO" : "yes");
    print_coefficients(study, bone, soft);
    skg_material_release(&bone);
    skg_material_release(&soft);
    return differs;
}
