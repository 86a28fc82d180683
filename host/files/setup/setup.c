/* A set-up as a handle, and the keys at the top of its file. */
#include "core/context.h"
#include "core/text.h"
#include "ctsimu/ctsimu.h"
#include "setup/keys.h"
#include "setup/sections.h"
#include "json/json_file.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The version is [1, 0, 0]. Any of version 1 is read. */
static skg_status read_version(const skg_json_object *top) {
    skg_json_node node = skg_json_member(top, "File format version");
    double version[3] = {1, 0, 0};
    if (node.value) SKG_TRY(skg_json_numbers(&node, "[1, 0, 0]", 3, version));
    if (version[0] != 1)
        return skg_json_fail(&node, SKG_ERR_UNSUPPORTED, "is version %g; only version 1 is known",
                             version[0]);
    return SKG_OK;
}

static skg_status read_precision(skg_setup *setup, const skg_json_object *top) {
    static const char *const names[] = {"single", "double", "half"};
    static const int32_t values[] = {SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE, SKG_PRECISION_HALF};
    skg_json_node node = skg_json_member(top, "Precision");
    setup->said.precision = -1;
    if (!node.value) return SKG_OK;
    int64_t choice = 0;
    SKG_TRY(skg_json_choice(&node, "precision", names, 3, &choice));
    setup->said.precision = values[choice];
    return SKG_OK;
}

/* One word of Repair: what to do about leaky meshes, that inverted components are turned, or that components are united. */
static skg_status read_repair_word(skg_setup *setup, const skg_json_node *node) {
    enum { ORIENTATION = 3, UNION = 4 };
    static const char *const names[] = {[SKG_REPAIR_NONE] = "none",
                                        [SKG_REPAIR_NEIGHBOURS] = "neighbours",
                                        [SKG_REPAIR_EXACT] = "exact",
                                        [ORIENTATION] = "orientation",
                                        [UNION] = "union"};
    int64_t choice = 0;
    SKG_TRY(skg_json_choice(node, "repair", names, 5, &choice));
    if (choice == ORIENTATION || choice == UNION) {
        *(choice == UNION ? &setup->unite : &setup->orient) = 1;
        return SKG_OK;
    }
    if (setup->said.repair >= 0)
        return skg_json_fail(node, SKG_ERR_FORMAT, "a repair of leaky meshes was chosen before");
    setup->said.repair = (int32_t)choice;
    setup->as_wound = choice == SKG_REPAIR_NONE;
    return SKG_OK;
}

/* Repair of meshes, and whether parts are clipped at their parents. */
static skg_status read_repair(skg_setup *setup, const skg_json_object *top) {
    const skg_json_node repair = skg_json_member(top, "Repair"), clip = skg_json_member(top, "Clip");
    int64_t count = 0;
    setup->said.repair = -1;
    if (clip.value) SKG_TRY(skg_json_flag(&clip, &setup->clip));
    if (!repair.value) return SKG_OK;
    if (!json_is_array(repair.value)) return read_repair_word(setup, &repair);
    SKG_TRY(skg_json_array(&repair, "[\"exact\", \"orientation\"]", &count));
    for (int64_t i = 0; i < count; i++) {
        const skg_json_node word = skg_json_element(&repair, i);
        SKG_TRY(read_repair_word(setup, &word));
    }
    return SKG_OK;
}

static skg_status read_band_weight(skg_setup *setup, const skg_json_object *top) {
    static const char *const names[] = {
        [SKG_BAND_WEIGHT_PHOTONS] = "photons", [SKG_BAND_WEIGHT_ENERGY] = "energy"};
    const skg_json_node node = skg_json_member(top, "BandWeight");
    setup->said.band_weight = -1;
    if (!node.value) return SKG_OK;
    int64_t choice = 0;
    SKG_TRY(skg_json_choice(&node, "weight of bands", names, 2, &choice));
    setup->said.band_weight = (int32_t)choice;
    return SKG_OK;
}

static skg_status read_tolerance(skg_setup *setup, const skg_json_object *top) {
    skg_json_node node = skg_json_member(top, "Tolerance");
    setup->said.tolerance = -1;
    if (!node.value) return SKG_OK;
    double tolerance = 0;
    SKG_TRY(skg_json_number(&node, &tolerance));
    if (tolerance < 0 || tolerance >= 1)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "is %g; give a relative error from 0 to below 1",
                             tolerance);
    setup->said.tolerance = tolerance;
    return SKG_OK;
}

/* A material, {"Material": ..., "Density": ...}, or "Vacuum". */
static skg_status read_world(skg_setup_reader *reader, const skg_json_object *top) {
    skg_json_node node = skg_json_member(top, "World"), density = {0}, material = node;
    skg_json_object world;
    if (!node.value) return SKG_OK;
    if (json_is_string(node.value) && skg_same_name(json_string_value(node.value), "vacuum")) return SKG_OK;
    if (json_is_object(node.value)) {
        SKG_TRY(skg_json_read_object(&node, &skg_keys_world, &world));
        SKG_TRY(skg_json_need(&world, "Material", "\"Air\"", &material));
        density = skg_json_member(&world, "Density");
    }
    return skg_setup_read_material(reader, &material, &density, "world", &reader->setup->world);
}

/* Whether the world scatters. It says nothing where there is no world, or no scatter. */
static skg_status read_world_scatter(skg_setup *setup, const skg_json_object *top) {
    const skg_json_node node = skg_json_member(top, "WorldScatter");
    int32_t scatters = 1;
    if (node.value) SKG_TRY(skg_json_flag(&node, &scatters));
    setup->world_scatter_off = !scatters;
    return SKG_OK;
}

/* A section that a file has to have. A partial text may leave it out together with `twin`. */
static skg_status need(const skg_setup_reader *reader, const skg_json_object *top, const char *name,
                       const char *twin, const char *example, skg_json_node *section) {
    *section = skg_json_member(top, name);
    if (section->value || (reader->source.partial && !skg_json_member(top, twin).value)) return SKG_OK;
    return skg_json_need(top, name, example, section);
}

static skg_status read_all(skg_setup_reader *reader) {
    skg_json_node root = skg_json_root(&reader->file), source, detector, samples;
    skg_json_object top;
    int32_t fitted = 0;
    skg_view_init(&reader->setup->view);
    SKG_TRY(skg_json_read_object(&root, &skg_keys_scene, &top));
    SKG_TRY(need(reader, &top, "Source", "Detector", "{ ... }", &source));
    detector = skg_json_member(&top, "Detector");
    const skg_json_node graph = skg_json_member(&top, "SceneGraph");
    samples = skg_json_member(&top, "Samples");
    if (!graph.value) SKG_TRY(need(reader, &top, "Samples", "Samples", "[ ... ]", &samples));
    SKG_TRY(read_version(&top));
    SKG_TRY(read_precision(reader->setup, &top));
    SKG_TRY(read_tolerance(reader->setup, &top));
    SKG_TRY(read_repair(reader->setup, &top));
    SKG_TRY(read_band_weight(reader->setup, &top));
    if (source.value) SKG_TRY(skg_setup_is_fitted(&detector, &fitted));
    if (source.value) SKG_TRY(skg_setup_read_source(reader, &source));
    if (fitted) SKG_TRY(skg_setup_read_samples(reader, &samples, &graph));
    if (source.value) SKG_TRY(skg_setup_read_detector(reader, &detector));
    const skg_json_node falloff = skg_json_member(&top, "Falloff");
    reader->setup->falloff = SKG_FALLOFF_AUTO;
    if (falloff.value) SKG_TRY(skg_json_flag(&falloff, &reader->setup->falloff));
    const skg_json_node collimation = skg_json_member(&top, "Collimation");
    SKG_TRY(skg_setup_read_collimation(reader, &collimation, source.value != NULL));
    const skg_json_node scatter = skg_json_member(&top, "Scatter");
    SKG_TRY(skg_setup_read_scatter(reader, &scatter));
    SKG_TRY(read_world(reader, &top));
    SKG_TRY(read_world_scatter(reader->setup, &top));
    skg_json_node noise = skg_json_member(&top, "Noise");
    SKG_TRY(skg_setup_read_noise(reader, &noise));
    SKG_TRY(skg_setup_bin_counts(reader));
    if (reader->setup->has_tube && !reader->setup->absolute && reader->setup->noise.quantum)
        skg_logger_say(
            &reader->log, SKG_LOG_NOTE,
            "the noise is that of the photons that 1 mAs sends to a mm2 at 1 m, taken as those of a pixel, because "
            "the tube has no mAs");
    skg_json_node scan = skg_json_member(&top, "Scan");
    if (scan.value && !source.value) return skg_json_fail(&scan, SKG_ERR_SCENE, "needs Source and Detector");
    if (scan.value && fitted)
        return skg_json_fail(
            &scan, SKG_ERR_FORMAT,
            "needs a detector at a given place, because the parts turn; give Detector.Position");
    if (scan.value) SKG_TRY(skg_setup_read_scan(reader, &scan));
    if (!fitted) SKG_TRY(skg_setup_read_samples(reader, &samples, &graph));
    skg_json_node breathing = skg_json_member(&top, "Breathing");
    return skg_setup_read_breathing(reader, &breathing);
}

/* Gives what was kept while reading to the log. */
static void say_remarks(const skg_setup_reader *reader) {
    for (size_t i = 0; i < json_array_size(reader->file.remarks); i++)
        skg_logger_say(&reader->log, SKG_LOG_WARNING, "%s",
                       json_string_value(json_array_get(reader->file.remarks, i)));
}

void skg_setup_source_init_sized(void *source, int32_t size) {
    const skg_setup_source defaults = {0};
    skg_struct_init(source, size, &defaults, sizeof defaults);
}

static skg_status check_texts(int64_t count, const char *const *texts, const char *what) {
    if (count < 0 || (count > 0 && !texts))
        return skg_fail(SKG_ERR_ARGUMENT, "skg_setup_source: %s: %" PRId64 ", but the array is %s", what,
                        count, texts ? "there" : "NULL");
    for (int64_t i = 0; i < count; i++)
        if (!texts[i])
            return skg_fail(SKG_ERR_ARGUMENT, "skg_setup_source: %s[%" PRId64 "] is NULL", what, i);
    return SKG_OK;
}

/* Of a scenario, before there is a set-up of it. */
static skg_status find_file(void *user, const char *name, const char **path) {
    return skg_setup_find_file(user, name, path);
}

/* Makes a set-up from reader->source; its text NULL: from the file of its path. */
static skg_status make(skg_setup_reader *reader, skg_setup **setup) {
    const skg_setup_source *source = &reader->source;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(check_texts(source->setting_count, source->settings, "settings"));
    SKG_TRY_CLEANUP(check_texts(source->file_count, source->file_names, "file_names"));
    SKG_TRY_CLEANUP(check_texts(source->file_count, source->file_paths, "file_paths"));
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *reader->setup, "set-up", &reader->setup));
    SKG_TRY_CLEANUP(skg_copy_text(source->path, &reader->folder));
    char *slash = strrchr(reader->folder, '/');
    *(slash ? slash + 1 : reader->folder) = '\0';
    SKG_TRY_CLEANUP(source->text ? skg_json_parse(source->text, source->path, &reader->file)
                                 : skg_json_open(source->path, &reader->file));
    for (int64_t i = 0; i < source->setting_count; i++)
        SKG_TRY_CLEANUP(skg_json_set(&reader->file, source->settings[i]));
    reader->file.lenient = source->lenient;
    reader->file.lengths = source->lengths_only;
    if (skg_ctsimu_is(&reader->file)) SKG_TRY_CLEANUP(skg_ctsimu_translate(&reader->file, find_file, reader));
    SKG_TRY_CLEANUP(read_all(reader));
    SKG_TRY_CLEANUP(skg_setup_keep_text(reader));
    say_remarks(reader);
    *setup = reader->setup;
    reader->setup = NULL;
cleanup:
    skg_setup_release(&reader->setup);
    skg_json_close(&reader->file);
    skg_free(&reader->folder);
    return status;
}

static skg_status load(skg_context *context, const char *path, int64_t count, const char *const *settings,
                       skg_setup **setup) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_setup_load", setup);
    *setup = NULL;
    SKG_NEEDS_OF("skg_setup_load", path);
    skg_setup_reader reader = {.context = context};
    if (context) reader.log = context->log;
    reader.source.path = path;
    reader.source.settings = settings;
    reader.source.setting_count = count;
    return make(&reader, setup);
}

skg_status skg_setup_load(skg_context *context, const char *path, int64_t count, const char *const *settings,
                          skg_setup **setup) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, load(context, path, count, settings, setup));
}

static skg_status create(skg_context *context, const skg_setup_source *source, skg_setup **setup) {
    SKG_PLAIN;
    SKG_NEEDS_OF("skg_setup_create", setup);
    *setup = NULL;
    skg_setup_reader reader = {.context = context};
    SKG_TRY(skg_struct_read(source, "skg_setup_source", &reader.source, sizeof reader.source));
    if (!reader.source.text && !reader.source.path)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_setup_source: both text and path are NULL; give one of them");
    if (!reader.source.path) reader.source.path = "scene";
    reader.log =
        context ? context->log : (skg_logger){.call = reader.source.log, .user = reader.source.log_user};
    return make(&reader, setup);
}

skg_status skg_setup_create(skg_context *context, const skg_setup_source *source, skg_setup **setup) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, source, setup));
}

void skg_setup_release(skg_setup **setup) {
    if (!setup || !*setup) return;
    skg_scene_release(&(*setup)->scene);
    skg_spectrum_release(&(*setup)->spectrum);
    skg_response_release(&(*setup)->response);
    skg_counter_release(&(*setup)->counter);
    skg_material_release(&(*setup)->world);
    skg_setup_in_beam_free(*setup);
    skg_setup_blur_free(*setup);
    skg_scan_section_free(&(*setup)->scan);
    skg_grey_section_free(&(*setup)->grey);
    skg_breathing_section_free(&(*setup)->breathing);
    skg_setup_files_free(*setup);
    skg_free(&(*setup)->text);
    skg_free(setup);
}

skg_status skg_setup_scene_get(const skg_setup *setup, skg_scene **scene) {
    SKG_NEEDS(setup);
    SKG_NEEDS(scene);
    *scene = setup->scene;
    return SKG_OK;
}

skg_status skg_setup_spectrum_get(const skg_setup *setup, skg_spectrum **spectrum) {
    SKG_NEEDS(setup);
    SKG_NEEDS(spectrum);
    *spectrum = setup->spectrum;
    return SKG_OK;
}

skg_status skg_setup_view_get(const skg_setup *setup, skg_view *view) {
    SKG_NEEDS(setup);
    return skg_struct_write(&setup->view, sizeof setup->view, "skg_view", view);
}

skg_status skg_setup_projection_count_get(const skg_setup *setup, int64_t *count) {
    SKG_NEEDS(setup);
    SKG_NEEDS(count);
    *count = setup->scan.scan ? 0 : 1;
    if (setup->scan.has_count) return skg_scan_projection_count(setup->scan.scan, count);
    return SKG_OK;
}

skg_status skg_setup_scan_get(const skg_setup *setup, skg_scan **scan) {
    SKG_NEEDS(setup);
    SKG_NEEDS(scan);
    if (!setup->scan.scan)
        return skg_fail(SKG_ERR_SCENE,
                        "the scene has no key Scan; add one, such as {\"NumberOfProjections\": 360, "
                        "\"FinalAngle\": 360}");
    if (!setup->scan.has_count)
        return skg_fail(
            SKG_ERR_SCENE,
            "Scan: the number of projections is not given; add NumberOfProjections, or AngleStep and "
            "FinalAngle, or a Table");
    *scan = setup->scan.scan;
    return SKG_OK;
}

skg_status skg_setup_options_get(const skg_setup *setup, skg_plan_options *options) {
    SKG_NEEDS(setup);
    skg_plan_options ours = {.size = sizeof ours};
    SKG_TRY(skg_struct_read(options, "skg_plan_options", &ours, sizeof ours));
    const skg_plan_options *said = &setup->said;
    if (said->precision >= 0) ours.precision = said->precision;
    if (said->tolerance >= 0) ours.tolerance = said->tolerance;
    if (setup->falloff != SKG_FALLOFF_AUTO) ours.falloff = setup->falloff;
    if (said->repair >= 0) ours.repair = said->repair;
    if (setup->clip) ours.clip = 1;
    if (setup->unite) ours.unite = 1;
    if (setup->world_scatter_off) ours.world_scatter_off = 1;
    if (said->band_weight >= 0) ours.band_weight = said->band_weight;
    if (setup->spot.shape != SKG_SPOT_POINT) ours.spot = &setup->spot;
    if (said->heel) ours.heel = said->heel;
    if (said->bowtie) ours.bowtie = said->bowtie;
    if (said->grid) ours.grid = said->grid;
    if (said->collimation) ours.collimation = said->collimation;
    if (said->scatter) ours.scatter = said->scatter;
    if (setup->oblique) ours.oblique = 1;
    if (setup->supersampling > 1) ours.supersampling = setup->supersampling;
    if (setup->response) ours.response = setup->response;
    if (setup->counter) ours.counter = setup->counter, ours.quantity = SKG_QUANTITY_PHOTONS;
    if (setup->world) ours.world = setup->world;
    if (setup->scan.view_count) ours.view_count = setup->scan.view_count, ours.views = setup->scan.views;
    if (setup->blur.shape.columns > 0) ours.blur = &setup->blur.shape;
    if (setup->depths.count > 0) ours.depth_blur = &setup->depths;
    if (setup->dqe.count > 0) ours.dqe = &setup->dqe;
    if (setup->noise.quantum || setup->noise.electronic_kev > 0 || setup->noise.step_kev > 0) {
        ours.noise = setup->noise.quantum;
        ours.swank = setup->noise.swank;
        ours.noise_seed = setup->noise.seed;
        ours.electronic_kev = setup->noise.electronic_kev;
        ours.quantum_step_kev = setup->noise.step_kev;
    }
    return skg_struct_write(&ours, sizeof ours, "skg_plan_options", options);
}
