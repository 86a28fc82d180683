/* Writes a scene with a circular scan as a CTSimU scenario of format 1.2. */
#include "core/core.h"
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "setup/save.h"
#include "setup/scenario_json.h"
#include "setup/scenario_parts.h"
#include "trajectory/types.h"

#include <skiagraph/setup.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PATH_LENGTH = 4096 };

static skg_status check_path(const char *path) {
    const size_t length = strlen(path), ending = strlen(skg_scenario_ending);
    if (length > ending && skg_same_name(path + length - ending, skg_scenario_ending)) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: a CTSimU scenario is written to a file that ends in %s", path,
                    skg_scenario_ending);
}

/* Fails for scans with a property that a CTSimU scenario cannot hold, and names it. */
static skg_status check_scan(const skg_setup *setup, const skg_scan_options *o) {
    const double moves[] = {o->pitch_mm,
                            skg_length(o->source_travel_mm),
                            skg_length(o->source_drift_mm),
                            skg_length(o->detector_drift_mm),
                            o->source_jitter_mm,
                            o->detector_jitter_mm,
                            o->angle_jitter_rad,
                            (double)o->detector_fixed,
                            o->detector_skew_rad};
    static const char *const names[] = {"Pitch",
                                        "SourceTravel",
                                        "Drift of the source",
                                        "Drift of the detector",
                                        "Jitter of the source",
                                        "Jitter of the detector",
                                        "Jitter of the angle",
                                        "FixedDetector",
                                        "DetectorSkew"};
    const char *what = skg_scan_is_table(setup->scan.scan) ? "Table"
                       : setup->scan.moving_count > 0      ? "Poses"
                                                           : NULL;
    if (!what && setup->scan.intensities) what = "Intensity";
    for (size_t i = 0; i < sizeof moves / sizeof *moves && !what; i++)
        if (moves[i] != 0) what = names[i];
    if (!what) return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "Scan: %s is not written as a CTSimU scenario, which holds circular scans here; the geometry alone is in the "
        ".csv of --geometry",
        what);
}

static skg_status check_spot(const skg_spot *spot) {
    const int32_t shape = spot->shape;
    if (spot->off_focal > 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "Source.OffFocal: a CTSimU scenario holds no off-focal radiation");
    if (shape == SKG_SPOT_POINT ||
        ((shape == SKG_SPOT_RECTANGLE || shape == SKG_SPOT_GAUSSIAN) && !(skg_length(spot->axis) > 0)))
        return SKG_OK;
    return skg_fail(
        SKG_ERR_UNSUPPORTED,
        "Source.Shape: a CTSimU scenario holds points, and rectangles and Gaussian spots across the beam");
}

/* The stage: w along the axis, u any direction across it. */
static void find_stage(const skg_scan_options *o, skg_scenario_stage *stage) {
    int least = 0;
    double any[3] = {0};
    for (int k = 1; k < 3; k++)
        if (fabs(o->axis[k]) < fabs(o->axis[least])) least = k;
    any[least] = 1;
    memcpy(stage->axes[2], o->axis, sizeof stage->axes[2]);
    skg_cross(any, o->axis, stage->axes[1]);
    skg_scale_vector(1 / skg_length(stage->axes[1]), stage->axes[1], stage->axes[1]);
    skg_cross(stage->axes[1], o->axis, stage->axes[0]);
    memcpy(stage->centre, o->centre, sizeof stage->centre);
}

static json_t *placed(const double *centre, const double *u, const double *w) {
    json_t *object = json_object();
    json_object_set_new(object, "center", skg_scenario_vector(centre, "xyz", "mm"));
    json_object_set_new(object, "vector_u", skg_scenario_vector(u, "xyz", NULL));
    json_object_set_new(object, "vector_w", skg_scenario_vector(w, "xyz", NULL));
    json_object_set_new(object, "deviations", json_array());
    return object;
}

/* Source, detector and stage at angle 0. distance: result: from the source to the detector's plane, mm */
static skg_status put_geometry(const skg_view *view, const skg_scenario_stage *stage, json_t *scenario,
                               double *distance) {
    static const double away_mm = 1000; /* of a source at infinity: any */
    double source[3], beam[3], columns[3], normal[3], u[3];
    if (view->radius > 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "a scenario of CTSimU has no curved detector; write the scene as .json");
    skg_cross(view->column_step, view->row_step, normal);
    skg_scale_vector(1 / skg_length(normal), normal, normal);
    skg_scale_vector(1 / skg_length(view->column_step), view->column_step, columns);
    if (fabs(skg_dot(columns, view->row_step)) > 1e-6 * skg_length(view->row_step))
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "Detector: its rows and columns are not across each other; a CTSimU scenario has no skew");
    if (view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY) {
        skg_scale_vector(1 / skg_length(view->source), view->source, beam);
        skg_scale_vector(1, view->centre, source);
        skg_add_scaled(source, -away_mm, beam, source);
    } else {
        skg_scale_vector(1, view->source, source);
        skg_add_scaled(view->centre, -1, source, beam);
        skg_scale_vector(1 / skg_length(beam), beam, beam);
    }
    skg_scale_vector(1, columns, u); /* the width of the focal spot lies along the projected columns */
    skg_add_scaled(u, -skg_dot(columns, beam), beam, u);
    skg_scale_vector(1 / skg_length(u), u, u);
    double way[3];
    skg_add_scaled(view->centre, -1, source, way);
    *distance = fabs(skg_dot(way, normal));
    json_t *geometry = json_object(), *its = placed(source, u, beam);
    json_object_set_new(its, "type",
                        json_string(view->projection == SKG_PROJECTION_POINT ? "cone" : "parallel"));
    json_object_set_new(geometry, "source", its);
    json_object_set_new(geometry, "detector", placed(view->centre, columns, normal));
    json_object_set_new(geometry, "stage", placed(stage->centre, stage->axes[0], stage->axes[2]));
    json_object_set_new(scenario, "geometry", geometry);
    return SKG_OK;
}

/* Photons per s, sr and mA, so that 1 mA and the time of a projection give those of the scene in the pixel before the source. */
static skg_status write_spectrum(const skg_setup *setup, double per_sr, const char *path) {
    skg_spectrum *spectrum = NULL;
    skg_output_file file;
    int64_t count = 0;
    SKG_TRY(skg_spectrum_create_resolved(setup->spectrum, &setup->scan.scan->view, &spectrum));
    skg_status status = skg_spectrum_bin_count(spectrum, &count);
    if (status == SKG_OK) status = skg_output_open(path, &file);
    if (status == SKG_OK) {
        fprintf(file.stream, "# energy (keV), photons (1/(s sr mA)); written by skiagraph\n");
        for (int64_t i = 0; i < count && status == SKG_OK; i++) {
            double kev = 0, photons = 0;
            status = skg_spectrum_bin_get(spectrum, i, &kev, &photons);
            fprintf(file.stream, "%.17g, %.17g\n", kev, photons * per_sr);
        }
        if (status == SKG_OK)
            status = skg_output_commit(&file);
        else
            skg_output_discard(&file);
    }
    skg_spectrum_release(&spectrum);
    return status;
}

static skg_status put_source(const skg_setup *setup, double per_sr, const char *path, json_t *scenario) {
    const double fwhm = 2 * sqrt(2 * log(2)), *extent = setup->spot.extent;
    char name[PATH_LENGTH], whole[PATH_LENGTH];
    const int32_t shape = setup->spot.shape;
    SKG_TRY(skg_scenario_name(path, "-spectrum.csv", 1, whole, sizeof whole));
    SKG_TRY(skg_scenario_name(path, "-spectrum.csv", 0, name, sizeof name));
    SKG_TRY(write_spectrum(setup, per_sr, whole));
    json_t *source = json_object(), *spot = json_object();
    json_object_set_new(source, "current", skg_scenario_number(1, "mA"));
    json_object_set_new(source, "spectrum",
                        json_pack("{s:b, s:{s:s}}", "monochromatic", 0, "file", "value", name));
    if (shape == SKG_SPOT_RECTANGLE)
        json_object_set_new(spot, "size",
                            json_pack("{s:o, s:o}", "u", skg_scenario_number(extent[0], "mm"), "v",
                                      skg_scenario_number(extent[1], "mm")));
    if (shape == SKG_SPOT_GAUSSIAN)
        json_object_set_new(spot, "sigma",
                            json_pack("{s:o, s:o}", "u", skg_scenario_number(extent[0] / fwhm, "mm"), "v",
                                      skg_scenario_number(extent[1] / fwhm, "mm")));
    json_object_set_new(source, "spot", spot);
    json_object_set_new(scenario, "source", source);
    return SKG_OK;
}

static void put_detector(const skg_view *view, double seconds, double dead, json_t *scenario) {
    json_t *detector = json_object();
    json_object_set_new(detector, "type", json_string("ideal"));
    json_object_set_new(detector, "columns", json_pack("{s:I}", "value", (json_int_t)view->columns));
    json_object_set_new(detector, "rows", json_pack("{s:I}", "value", (json_int_t)view->rows));
    json_object_set_new(detector, "pixel_pitch",
                        json_pack("{s:o, s:o}", "u", skg_scenario_number(skg_length(view->column_step), "mm"),
                                  "v", skg_scenario_number(skg_length(view->row_step), "mm")));
    json_object_set_new(detector, "bit_depth", json_pack("{s:i}", "value", 32));
    json_object_set_new(detector, "integration_time", skg_scenario_number(seconds, "s"));
    json_object_set_new(detector, "dead_time", skg_scenario_number(dead, "s"));
    json_object_set_new(detector, "gray_value",
                        json_pack("{s:{s:f}, s:{s:f}}", "imin", "value", 0.0, "imax", "value", 1.0));
    json_object_set_new(scenario, "detector", detector);
}

/* Angles rise in a scenario, whose direction says which way the stage turns. */
static void put_acquisition(const skg_scan_options *o, json_t *scenario) {
    const double degree = 180 / SKG_PI, sign = o->step_rad < 0 ? -1 : 1, start = sign * o->start_rad * degree;
    const double range = fabs(o->step_rad) * (double)o->projections * degree;
    json_t *acquisition = json_object();
    json_object_set_new(acquisition, "start_angle", skg_scenario_number(start, "deg"));
    json_object_set_new(acquisition, "stop_angle", skg_scenario_number(start + range, "deg"));
    json_object_set_new(acquisition, "direction", json_string(sign < 0 ? "CW" : "CCW"));
    json_object_set_new(acquisition, "scan_mode", json_string("stop+go"));
    json_object_set_new(acquisition, "number_of_projections", json_integer(o->projections));
    json_object_set_new(acquisition, "include_final_angle", json_false());
    json_object_set_new(acquisition, "frame_average", json_integer(1));
    json_object_set_new(scenario, "acquisition", acquisition);
}

static skg_status fill(const skg_setup *setup, const char *path, json_t *scenario) {
    const skg_scan *scan = setup->scan.scan;
    const skg_view *view = &scan->view;
    const double seconds = scan->options.exposure_s > 0 ? scan->options.exposure_s : 1;
    double distance = 0, normal[3];
    skg_scenario_stage stage;
    find_stage(&scan->options, &stage);
    json_object_set_new(scenario, "file",
                        json_pack("{s:s, s:s, s:{s:i, s:i}}", "name", "written by skiagraph", "file_type",
                                  "CTSimU Scenario", "file_format_version", "major", 1, "minor", 2));
    SKG_TRY(put_geometry(view, &stage, scenario, &distance));
    skg_cross(view->column_step, view->row_step, normal);
    put_detector(view, seconds, fmax(scan->options.interval_s - seconds, 0), scenario);
    put_acquisition(&scan->options, scenario);
    SKG_TRY(skg_scenario_put_parts(setup, &stage, path, scenario));
    return put_source(setup, distance * distance / (skg_length(normal) * seconds), path, scenario);
}

skg_status skg_setup_save_scenario(const skg_setup *setup, const char *path) {
    SKG_PLAIN;
    skg_scan *scan = NULL;
    SKG_NEEDS(setup);
    SKG_NEEDS(path);
    SKG_TRY(check_path(path));
    SKG_TRY(skg_setup_scan_get(setup, &scan));
    SKG_TRY(check_scan(setup, &scan->options));
    SKG_TRY(check_spot(&setup->spot));
    json_t *scenario = json_object();
    skg_status status = fill(setup, path, scenario);
    if (status == SKG_OK) status = skg_setup_write_json(scenario, path);
    json_decref(scenario);
    return status;
}
