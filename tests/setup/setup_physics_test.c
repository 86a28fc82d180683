/* Materials, beams and detector responses of scene files. */
#include "setup/setup_files.h"

#include <skiagraph/plan.h>

#include <float.h>
#include <math.h>

static skg_status load_with(const char *one, const char *two) {
    const char *const settings[] = {one, two};
    skg_setup_release(&setup);
    write_file("scene.json", good);
    return skg_setup_load(NULL, path, two ? 2 : 1, settings, &setup);
}

static double bone_mu(double kev) {
    skg_scene *scene = NULL;
    skg_part part;
    double mu = 0;
    skg_part_init(&part);
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_scene_part_get(scene, 1, &part));
    ck_skg(skg_material_attenuation_get(part.material, kev, &mu));
    return mu;
}

static double mu_of(const char *name, double density, double kev) {
    skg_material *m = NULL, *dense = NULL;
    double mu = 0;
    ck_skg(skg_material_create_named(name, &m));
    if (density > 0) {
        ck_skg(skg_material_create_at_density(m, density, &dense));
        skg_material_release(&m);
        m = dense;
    }
    ck_skg(skg_material_attenuation_get(m, kev, &mu));
    skg_material_release(&m);
    return mu;
}

static const struct {
    const char *material, *density, *same;
    double at;
} kinds[] = {
    {"[\"Element\", \"Cu\"]", NULL, "Cu", 0},
    {"[\"Element\", 29]", NULL, "Cu", 0},
    {"[\"element\", \"copper\"]", NULL, "Cu", 0},
    {"[\"Compound\", \"H2O\"]", NULL, "H2O", 0},
    {"[\"compound\", \"Ca5(PO4)3OH\"]", "3.16", "Ca5(PO4)3OH", 3.16},
    {"[\"Compound\", \"Kapton\"]", NULL, "Kapton", 0},
    {"[\"Mixture\", \"Ti90Al6V4\"]", "4.43", "weight:Ti90Al6V4", 4.43},
    {"[\"Mixture\", [22, 0.9, 13, 0.06, 23, 0.04]]", "4.43", "weight:Ti90Al6V4", 4.43},
    {"[\"Mixture\", [\"Ti\", 0.9, \"Al\", 0.06, \"V\", 0.04]]", "4.43", "weight:Ti90Al6V4", 4.43},
    {"[\"HU\", 52]", NULL, "HU:52", 0},
    {"\"Bone, cortical (ICRU-44)\"", NULL, "Bone, Cortical (ICRU-44)", 0},
    {"\"liver\"", "1.1", "Liver", 1.1},
};

START_TEST(every_kind_of_material) {
    char material[256], density[64] = "";
    snprintf(material, sizeof material, "Samples.bone.Material=%s", kinds[_i].material);
    if (kinds[_i].density) snprintf(density, sizeof density, "Samples.bone.Density=%s", kinds[_i].density);
    ck_skg(load_with(material, *density ? density : NULL));
    double expected = mu_of(kinds[_i].same, kinds[_i].at, 60);
    /* H2O: 2015 weights in the formula, NIST's rounding in the table */
    ck_assert_double_eq_tol(bone_mu(60) / expected, 1, strstr(kinds[_i].material, "H2O") ? 1e-4 : 1e-14);
}
END_TEST

START_TEST(tables_of_attenuation) {
    write_file("motion.csv", "10 8\n100 0.08\n");
    ck_skg(load_with("Samples.bone.Material=[\"Table\", \"motion.csv\", \"keV\"]", NULL));
    ck_assert_double_eq_tol(bone_mu(sqrt(1000)), 0.8, 64 * DBL_EPSILON);
}
END_TEST

static void count_ends(int32_t level, const char *sentence, void *user) {
    if (level == SKG_LOG_NOTE && strstr(sentence, "ends at HU 1600")) ++*(int *)user;
}

/* Two samples beyond the end of Schneider's table: told once; up to its end: not at all. */
START_TEST(hounsfield_beyond_the_table_is_told_once) {
    skg_context *context = NULL;
    int told = 0;
    const char *settings[] = {"Samples.skin.Material=[\"HU\", 1700]", "Samples.bone.Material=[\"HU\", 2500]"};
    ck_skg(skg_context_create(NULL, &context));
    ck_skg(skg_context_log_set(context, count_ends, &told));
    write_file("scene.json", good);
    ck_skg(skg_setup_load(context, path, 2, settings, &setup));
    ck_assert_int_eq(told, 1);
    skg_setup_release(&setup);
    settings[0] = settings[1] = "Samples.bone.Material=[\"HU\", 1600]";
    ck_skg(skg_setup_load(context, path, 2, settings, &setup));
    ck_assert_int_eq(told, 1);
    skg_setup_release(&setup);
    skg_context_release(&context);
}
END_TEST

static skg_spectrum *spectrum(int64_t *count) {
    skg_spectrum *s = NULL;
    ck_skg(skg_setup_spectrum_get(setup, &s));
    ck_skg(skg_spectrum_bin_count(s, count));
    return s;
}

START_TEST(beams_of_many_energies) {
    int64_t count = 0;
    double kev = 0, photons = 0;
    ck_skg(
        load_with("Source.Beam=[{\"Energy\": 0.3, \"Unit\": \"MeV\", \"PhotonCount\": 10}, {\"Energy\": 100, "
                  "\"Unit\": \"keV\", \"PhotonCount\": 20}, {\"Energy\": 300, \"Unit\": \"keV\", "
                  "\"PhotonCount\": 5}]",
                  NULL));
    skg_spectrum *s = spectrum(&count);
    ck_assert_int_eq(count, 2);
    ck_skg(skg_spectrum_bin_get(s, 0, &kev, &photons));
    ck_assert(fabs(kev - 100) < 16 * DBL_EPSILON * 100 && fabs(photons - 20) < 16 * DBL_EPSILON * 20);
    ck_skg(skg_spectrum_bin_get(s, 1, &kev, &photons));
    ck_assert(fabs(kev - 300) < 16 * DBL_EPSILON * 300 && fabs(photons - 15) < 16 * DBL_EPSILON * 15);
    write_file("motion.csv", "0.06 5\n0.07 6\n");
    ck_skg(load_with("Source.Beam={\"TextFile\": \"motion.csv\", \"Unit\": \"MeV\"}", NULL));
    spectrum(&count);
    ck_assert_int_eq(count, 2);
    write_file("motion.csv", "/gate/source/mybeam/gps/histpoint 0.06 5\n");
    ck_skg(load_with("Source.Beam={\"Gate macro\": \"motion.csv\", \"Unit\": \"MeV\"}", NULL));
    spectrum(&count);
    ck_assert_int_eq(count, 1);
}
END_TEST

static skg_plan_options options(void) {
    skg_plan_options o;
    skg_plan_options_init(&o);
    ck_skg(skg_setup_options_get(setup, &o));
    return o;
}

static skg_quality quality(int32_t *absolute) {
    int64_t count = 0;
    skg_quality q;
    skg_spectrum *per_pixel = NULL;
    skg_quality_init(&q);
    ck_skg(skg_spectrum_absolute_get(spectrum(&count), absolute));
    ck_skg(skg_spectrum_create_resolved(spectrum(&count), &setup->view, &per_pixel));
    ck_skg(skg_spectrum_quality_get(per_pixel, &q));
    skg_spectrum_release(&per_pixel);
    ck_assert_int_eq(options().falloff, SKG_FALLOFF_AUTO);
    return q;
}

/* Without the key, falloff follows mAs (the next test). */
START_TEST(falloff_can_be_asked_for) {
    ck_skg(load_with("Falloff=true", NULL));
    ck_assert_int_eq(options().falloff, 1);
    ck_skg(load_with("Source.Beam={\"kVp\": 85, \"Filter\": [[\"Al\", 3]], \"mAs\": 1}", "Falloff=false"));
    ck_assert_int_eq(options().falloff, 0);
    ck_skg_fails(load_with("Falloff=2", NULL), SKG_ERR_FORMAT, "Falloff");
}
END_TEST

START_TEST(weight_of_bands) {
    ck_skg(load_with("Falloff=true", NULL));
    ck_assert_int_eq(options().band_weight, SKG_BAND_WEIGHT_PHOTONS);
    ck_skg(load_with("BandWeight=\"energy\"", NULL));
    ck_assert_int_eq(options().band_weight, SKG_BAND_WEIGHT_ENERGY);
    ck_skg(load_with("BandWeight=\"photons\"", NULL));
    ck_assert_int_eq(options().band_weight, SKG_BAND_WEIGHT_PHOTONS);
    ck_skg_fails(load_with("BandWeight=\"mass\"", NULL), SKG_ERR_FORMAT, "BandWeight");
}
END_TEST

/* The beam of gVXR's paediatric case; then with a load, whose photons are those per pixel of 1 mm x 2 mm at
 * 500 mm. */
START_TEST(tubes) {
    int32_t absolute = 1;
    ck_skg(load_with("Source.Beam={\"kvp\": 85, \"tube angle\": 12, \"filter\": [[\"Al\", 1], [29, 0.1]]}",
                     NULL));
    skg_quality q = quality(&absolute), with_load, by_current;
    ck_assert_int_eq(absolute, 0);
    ck_assert(q.mean_kev > 45 && q.mean_kev < 52);
    ck_skg(load_with(
        "Source.Beam={\"Peak kilo voltage\": 85, \"Filtration\": [[\"Al\", 0.1, \"cm\"], [\"Cu\", 100, "
        "\"um\"]], \"mAs\": 2}",
        NULL));
    with_load = quality(&absolute);
    ck_assert_int_eq(absolute, 1);
    ck_assert_double_eq_tol(with_load.photons / q.photons, 2 * 2 * 4, 64 * DBL_EPSILON * 16);
    ck_assert_double_eq_tol(with_load.mean_kev, q.mean_kev, 64 * DBL_EPSILON * 50);
    ck_skg(load_with(
        "Source.Beam={\"kVp\": 85, \"Filter\": [[\"Al\", 1], [\"Cu\", 0.1]], \"Exposure time\": [20, "
        "\"ms\"], \"X-ray tube current\": [100, \"mA\"]}",
        NULL));
    by_current = quality(&absolute);
    ck_assert_int_eq(absolute, 1);
    ck_assert_double_eq_tol(by_current.photons / with_load.photons, 1, 64 * DBL_EPSILON);
    ck_skg(load_with(
        "Source.Beam={\"kVp\": 85, \"Filter\": [[\"Al\", 1], [\"Cu\", 0.1]], \"mAs\": 1, \"Output\": "
        "[40, \"uGy/mAs\", 1, \"m\"]}",
        NULL));
    q = quality(&absolute);
    ck_assert_double_eq_tol(q.air_kerma_ugy, 40 * 4 * 2, 1e-6); /* times the pixel's mm2 */
    ck_skg(load_with("Source.Beam={\"kVp\": 85, \"MaxNumberOfEnergyBins\": 20, \"Model\": \"Birch\"}", NULL));
    int64_t count = 0;
    spectrum(&count);
    ck_assert(count > 10 && count <= 20);
}
END_TEST

START_TEST(responses) {
    const skg_response *r = NULL;
    double kev = 0;
    write_file("scene.json", good);
    ck_skg(load());
    r = options().response;
    ck_assert_ptr_null(r);
    ck_skg(load_with(
        "Detector.Scintillator={\"Material\": \"CsI\", \"Thickness\": 600, \"Unit\": \"um\", \"Deposition\": \"all\"}",
        NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 60, 1, &kev, NULL));
    /* keV: the last digit in print. */
    ck_assert_double_eq_tol(kev, 52.97, 0.01);
    ck_skg(load_with(
        "Detector.Scintillator={\"Material\": \"CsI\", \"Thickness\": 270.6, \"Unit\": \"mg/cm2\", \"Deposition\": \"all\"}",
        NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 60, 1, &kev, NULL));
    /* As above. */
    ck_assert_double_eq_tol(kev, 52.97, 0.01);
    ck_skg(load_with(
        "Detector.Scintillator={\"Material\": \"Gd2O2S DRZ-Plus\", \"Thickness\": 210, \"Unit\": \"um\"}",
        NULL));
    write_file("motion.csv", "0.01 0.01\n0.1 0.04\n");
    ck_skg(load_with("Detector.Energy response={\"File\": \"motion.csv\", \"Energy\": \"MeV\"}", NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 100, 1, &kev, NULL));
    ck_assert_double_eq_tol(kev, 40, 16 * DBL_EPSILON * 40);
    ck_skg(load_with("Detector.EnergyResponse={\"LUT\": [[10, 10], [100, 40]]}", NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 55, 1, &kev, NULL));
    ck_assert_double_eq_tol(kev, 25, 16 * DBL_EPSILON * 25);
}
END_TEST

START_TEST(heels) {
    static const char tube[] = "Source.Beam={\"kVp\": 85, \"TubeAngle\": 15, \"Filter\": [[\"Al\", 3]]}";
    write_file("scene.json", good);
    ck_skg(load_with(tube, NULL));
    ck_assert_ptr_null(options().heel);
    ck_skg(load_with(tube, "Source.Heel={\"Direction\": [0, 0, -2]}"));
    const skg_heel *heel = options().heel;
    ck_assert_double_eq(heel->angle_deg, 15);
    ck_assert_double_eq(heel->kvp, 85);
    ck_assert_double_eq(heel->direction[2], -1);
    ck_assert_int_eq(heel->anode, 74);
    ck_skg(load_with("Source.Beam={\"kVp\": 85, \"Filter\": [[\"Al\", 3]]}",
                     "Source.Heel={\"AnodeAngle\": 10, \"Direction\": [1, 0, 0]}"));
    heel = options().heel; /* the spectrum has this angle, too */
    ck_assert_double_eq(heel->angle_deg, 10);
    ck_skg_fails(load_with(tube, "Source.Heel={\"AnodeAngle\": 10, \"Direction\": [1, 0, 0]}"), SKG_ERR_BEAM,
                 "AnodeAngle of Heel is 10");
    ck_skg_fails(load_with(tube, "Source.Heel={}"), SKG_ERR_FORMAT, "Direction");
    ck_skg_fails(load_with("Source.Heel={\"Direction\": [1, 0, 0]}", NULL), SKG_ERR_BEAM, "needs a tube");
}
END_TEST

START_TEST(what_responses_mean_for_noise) {
    const skg_response *r = NULL;
    double seen = 0, factor = 0;
    write_file("scene.json", good);
    ck_skg(load_with("Detector.EnergyResponse={\"LUT\": [[10, 10], [100, 40]]}", NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 55, 1, NULL, &seen));
    ck_assert_double_eq(seen, 1);
    ck_skg(load_with("Detector.EnergyResponse={\"LUT\": [[10, 10], [100, 40]], \"Meaning\": \"absorbed\"}",
                     NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 100, 1, NULL, &seen));
    ck_assert_double_eq_tol(seen, 0.4, 16 * DBL_EPSILON);
    ck_skg(load_with("Detector.EnergyResponse={\"LUT\": [[10, 10, 1, 1], [100, 40, 0.5, 0.8]]}", NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 55, 1, NULL, &seen));
    ck_skg(skg_response_swank_get(r, 55, 1, &factor));
    ck_assert_double_eq_tol(seen, 0.75, 16 * DBL_EPSILON);
    ck_assert_double_eq_tol(factor, 0.9, 16 * DBL_EPSILON);
    ck_skg(
        load_with("Detector.EnergyResponse={\"Unit\": \"MeV\", \"PulseHeights\": {\"Heights\": [0.01, 0.04], "
                  "\"Rows\": [[0.04, 0.25, 0.5], [0.08, 0, 1]]}}",
                  NULL));
    r = options().response;
    ck_skg(skg_response_get(r, 40, 1, NULL, &seen));
    ck_assert_double_eq_tol(seen, 0.75, 16 * DBL_EPSILON);
    static const char *const bad[][2] = {
        {"{\"LUT\": [[10, 10], [100, 40]], \"Meaning\": \"energy\"}", "Meaning"},
        {"{\"LUT\": [[10, 10, 1], [100, 40]]}", "LUT[1]"},
        {"{\"LUT\": [[10, 10, 1], [100, 40, 1]], \"Meaning\": \"absorbed\"}", "leave the efficiencies out"},
        {"{\"LUT\": [[10, 10], [100, 40]], \"PulseHeights\": {}}", "give one of them"},
        {"{\"PulseHeights\": {\"Heights\": [10], \"Rows\": [[10, 0.5], [20, 1.5]]}}", "row 2"},
        {"{\"PulseHeights\": {\"Heights\": [10], \"Rows\": [[10, 0.5, 1], [20, 1]]}}", "Rows[0]"},
        {"{\"PulseHeights\": {\"Rows\": [[10, 0.5]]}}", "Heights"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char setting[256];
        snprintf(setting, sizeof setting, "Detector.EnergyResponse=%s", bad[k][0]);
        const skg_status status = load_with(setting, NULL);
        ck_assert_int_ne(status, SKG_OK);
        ck_assert_msg(strstr(skg_last_error(), bad[k][1]), "%s: %s", bad[k][0], skg_last_error());
    }
}
END_TEST

START_TEST(focal_spots) {
    write_file("scene.json", good);
    ck_skg(load());
    ck_assert_ptr_null(options().spot);
    ck_assert_int_eq(options().supersampling, 1);
    ck_skg(load_with("Source.Shape=[\"FocalSpot\", 0.5, \"cm\", 4]", NULL));
    ck_assert_int_eq(options().spot->shape, SKG_SPOT_CUBE);
    ck_assert_int_eq(options().spot->grid, 4);
    for (int k = 0; k < 3; k++) ck_assert_double_eq(options().spot->extent[k], 5);
    ck_skg(load_with("Source.Shape=[\"Gaussian\", 1, 0.6, \"mm\"]", "Source.Samples=128"));
    ck_assert_int_eq(options().spot->shape, SKG_SPOT_GAUSSIAN);
    ck_assert_int_eq(options().spot->samples, 128);
    ck_assert_double_eq(options().spot->extent[1], 0.6);
    ck_assert_double_eq(options().spot->off_focal, 0);
    ck_skg(load_with("Source.Shape=[\"Disc\", 1, \"mm\"]",
                     "Source.OffFocal={\"Share\": 0.1, \"Diameter\": [3, \"cm\"]}"));
    ck_assert_double_eq(options().spot->off_focal, 0.1);
    ck_assert_double_eq(options().spot->off_focal_mm, 30);
    ck_skg(load_with("Detector.Oversampling=3", NULL));
    ck_assert_int_eq(options().supersampling, 3);
}
END_TEST

START_TEST(worlds) {
    const skg_material *world = NULL;
    double mu = 0;
    ck_skg(load_with("World=Air", NULL));
    world = options().world;
    ck_skg(skg_material_attenuation_get(world, 80, &mu));
    /* Four digits in print, of 2e-4. */
    ck_assert_double_eq_tol(mu, 1.205e-3 * 0.1662, 1e-7);
    ck_skg(load_with("World=vacuum", NULL));
    world = options().world;
    ck_assert_ptr_null(world);
}
END_TEST

static const struct {
    const char *setting;
    skg_status status;
    const char *says;
} bad[] = {
    {"Samples.bone.Material=[\"Element\", \"Cx\"]", SKG_ERR_MATERIAL,
     "Samples[1].Material[1]: \"Cx\" is no element"},
    {"Samples.bone.Material=[\"Element\", 93]", SKG_ERR_FORMAT, "Material[1]: is 93"},
    {"Samples.bone.Material=[\"Compound\", \"H2Q\"]", SKG_ERR_MATERIAL, "\"H2Q\" is no material"},
    {"Samples.bone.Material=[\"Compound\", \"CaHPO4\"]", SKG_ERR_MATERIAL, "give \"Density\""},
    {"Samples.bone.Material=[\"Mixture\", [1, 0.1, 8]]", SKG_ERR_FORMAT, "pairs"},
    {"Samples.bone.Material=[\"Mixture\", [1, 0.1, 8, 0.7]]", SKG_ERR_MATERIAL,
     "sum to 0.8; they have to sum to 1 within 0.005; read leniently (--lenient)"},
    {"Samples.bone.Material=[\"Mixture\", \"Ti90Al6\"]", SKG_ERR_MATERIAL, "sum to 96"},
    {"Samples.bone.Material=[\"HU\", 4000]", SKG_ERR_MATERIAL, "outside -1050 to 3000"},
    {"Samples.bone.Material=[\"HU\", \"x\"]", SKG_ERR_FORMAT, "give a number"},
    {"Samples.bone.Material=Livre", SKG_ERR_MATERIAL, "did you mean \"Liver\""},
    {"Samples.bone.Material=[\"Table\", \"none.txt\", \"keV\"]", SKG_ERR_FILE, "none.txt"},
    {"Samples.bone.Material=[\"Table\", \"none.txt\"]", SKG_ERR_FORMAT, "has 2 elements"},
    {"World=Aer", SKG_ERR_MATERIAL, "World: "},
    {"Source.Beam={\"kVp\": 5}", SKG_ERR_BEAM, "Source.Beam: a tube voltage of 5 kV"},
    {"Source.Beam={\"kVp\": \"85\"}", SKG_ERR_FORMAT, "Source.Beam.kVp: is a string"},
    {"Source.Beam={\"kVp\": 85, \"Filter\": [[\"Cuu\", 1]]}", SKG_ERR_MATERIAL, "Source.Beam.Filter[0][0]: "},
    {"Source.Beam={\"kVp\": 85, \"Filter\": [[\"Cu\"]]}", SKG_ERR_FORMAT, "Filter[0]: has 1 elements"},
    {"Source.Beam={\"kVp\": 85, \"Filter\": [[\"Cu\", -1]]}", SKG_ERR_BEAM, "filter 1 is -1 mm"},
    {"Source.Beam={\"kVp\": 85, \"Exposure time\": [1, \"s\"]}", SKG_ERR_FORMAT, "go together"},
    {"Source.Beam={\"kVp\": 85, \"mAs\": 10, \"Exposure time\": [100, \"ms\"], \"Current\": [50, \"mA\"]}",
     SKG_ERR_FORMAT, "10 mAs, but exposure time and tube current make 5"},
    {"Source.Beam={\"kVp\": 85, \"Exposure time\": [1, \"h\"], \"Current\": 1}", SKG_ERR_FORMAT,
     "unit of time"},
    {"Source.Beam={\"kVp\": 85, \"TextFile\": \"a\"}", SKG_ERR_FORMAT, "several beams"},
    {"Source.Beam={\"TextFile\": \"none.txt\"}", SKG_ERR_FORMAT, "Unit is missing"},
    {"Source.Beam={\"TextFile\": \"none.txt\", \"Unit\": \"keV\"}", SKG_ERR_FILE, "none.txt"},
    {"Source.Beam={\"kVp\": 85, \"Output\": [1, \"Gy\", 1, \"m\"]}", SKG_ERR_FORMAT, "unit of output"},
    {"Source.Beam={\"kVp\": 85, \"Anode\": \"Ww\"}", SKG_ERR_MATERIAL, "did you mean W"},
    {"Source.Beam={\"kVpp\": 85}", SKG_ERR_FORMAT, "did you mean kVp"},
    {"Detector.EnergyResponse={}", SKG_ERR_FORMAT, "has no table"},
    {"Detector.EnergyResponse={\"LUT\": [[10, 11], [20, 20]]}", SKG_ERR_BEAM,
     "11 keV recorded of a photon of 10"},
    {"Detector.EnergyResponse={\"File\": \"none.txt\"}", SKG_ERR_FILE, "Detector.EnergyResponse.File: "},
    {"Detector.Scintillator={\"Material\": \"CsI\", \"Thickness\": 0, \"Unit\": \"um\"}", SKG_ERR_BEAM,
     "0 mm"},
    {"Detector.Scintillator={\"Material\": \"CsI\", \"Thickness\": 1}", SKG_ERR_FORMAT, "Unit is missing"},
    {"Detector.Scintillator={\"Material\": \"CsX\", \"Thickness\": 1, \"Unit\": \"um\"}", SKG_ERR_MATERIAL,
     "Detector.Scintillator.Material: "},
};

static skg_plan_options options_with(const char *one, const char *two) {
    skg_plan_options options;
    ck_skg(load_with(one, two));
    skg_plan_options_init(&options);
    ck_skg(skg_setup_options_get(setup, &options));
    return options;
}

START_TEST(line_and_point_spread) {
    skg_plan_options options = options_with("World=Vacuum", NULL);
    ck_assert_ptr_null(options.blur);
    options = options_with("Detector.LSF=[0.25, 1, 0.5]", NULL);
    ck_assert(options.blur->columns == 3 && options.blur->rows == 3 && !options.blur->point);
    ck_assert_double_eq(options.blur->along_row[2], 0.5);
    ck_assert_double_eq(options.blur->along_column[0], 0.25);
    options = options_with("Detector.LSF=[[1], [1, 2, 4]]", NULL);
    ck_assert(options.blur->columns == 1 && options.blur->rows == 3);
    ck_assert_double_eq(options.blur->along_row[0], 1);
    ck_assert_double_eq(options.blur->along_column[2], 4);
    options = options_with("Detector.PSF=[[0, 1, 2, 3, 4], [5, 6, 7, 8, 9], [1, 1, 1, 1, 1]]", NULL);
    ck_assert(options.blur->columns == 5 && options.blur->rows == 3);
    ck_assert_double_eq(options.blur->point[8], 8);
}
END_TEST

START_TEST(noises) {
    skg_plan_options options = options_with("Noise=false", NULL);
    ck_assert_int_eq(options.noise, 0);
    options = options_with("Noise=true", NULL);
    ck_assert_int_eq(options.noise, 1);
    ck_assert_double_eq(options.swank, 1);
    options = options_with("Noise={\"Quantum\": false, \"Electronic\": [2500, \"eV\"], \"Step\": [0.5, "
                           "\"keV\"], \"Swank\": 0.92, \"Seed\": -7}",
                           NULL);
    ck_assert(options.noise == 0 && options.noise_seed == -7);
    ck_assert_double_eq_tol(options.electronic_kev, 2.5, 4 * DBL_EPSILON * 2.5);
    ck_assert_double_eq(options.quantum_step_kev, 0.5);
    ck_assert_double_eq(options.swank, 0.92);
}
END_TEST

START_TEST(what_is_refused) {
    ck_skg_fails(load_with(bad[_i].setting, NULL), bad[_i].status, bad[_i].says);
    ck_assert_ptr_null(setup);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, every_kind_of_material, 0, sizeof kinds / sizeof *kinds);
    tcase_add_test(tests, tables_of_attenuation);
    tcase_add_test(tests, beams_of_many_energies);
    tcase_add_test(tests, falloff_can_be_asked_for);
    tcase_add_test(tests, weight_of_bands);
    tcase_add_test(tests, hounsfield_beyond_the_table_is_told_once);
    tcase_add_test(tests, tubes);
    tcase_add_test(tests, responses);
    tcase_add_test(tests, heels);
    tcase_add_test(tests, what_responses_mean_for_noise);
    tcase_add_test(tests, focal_spots);
    tcase_add_test(tests, worlds);
    tcase_add_test(tests, line_and_point_spread);
    tcase_add_test(tests, noises);
    tcase_add_loop_test(tests, what_is_refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("setup_physics", add_tests)
