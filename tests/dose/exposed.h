/* Scenes whose dose is asked for, and their figures. The device is run_context of support/run.h. */
#ifndef SKG_TESTS_DOSE_EXPOSED_H
#define SKG_TESTS_DOSE_EXPOSED_H

#include "scatter/subject.h"
#include "suite.h"

#include <math.h>

static const double JOULE_PER_KEV = 1.602176634e-16;

/* Mass energy-absorption of dry air at 60 keV, cm2/g (NIST). */
static const double AIR_60_KEV = 0.03041;

/* A plan of the subject without scatter at the detector. */
static inline void make_plan(subject *s) {
    skg_spectrum *beam = NULL;
    s->options.collimation = s->jaws.kind == SKG_COLLIMATION_OPEN ? NULL : &s->jaws;
    skg_plan_release(&s->plan);
    ck_skg(skg_spectrum_create_mono(s->kev, s->photons, &beam));
    ck_skg(skg_plan_create(run_context, s->scene, &s->view, s->beam ? s->beam : beam, &s->options, &s->plan));
    skg_spectrum_release(&beam);
}

static inline skg_dose_options options_of(int64_t histories) {
    skg_dose_options options;
    skg_dose_options_init(&options);
    options.histories = histories;
    return options;
}

static inline skg_dose *dose_of(subject *s, const skg_dose_options *options) {
    skg_dose *dose = NULL;
    make_plan(s);
    ck_skg(skg_dose_create(s->plan, options, &dose));
    return dose;
}

static inline skg_dose_report report_of(const skg_dose *dose) {
    skg_dose_report report;
    skg_dose_report_init(&report);
    ck_skg(skg_dose_report_get(dose, &report));
    return report;
}

static inline skg_dose_point point_of(const skg_dose *dose, int64_t index) {
    skg_dose_point point;
    skg_dose_point_init(&point);
    ck_skg(skg_dose_point_get(dose, index, &point));
    return point;
}

static inline skg_dose_part part_of(const skg_dose *dose, int64_t index) {
    skg_dose_part part;
    skg_dose_part_init(&part);
    ck_skg(skg_dose_part_get(dose, index, &part));
    return part;
}

/* The field of the subject is 200 x 150 mm at 700 mm from the source. */
static inline subject open_box(double x, double y, double z, const char *material) {
    subject s;
    subject_open(&s);
    subject_add_box(&s, x, y, z, material);
    return s;
}

/* Adds the tests of what stays in parts (stays.c), of masses (masses.c), of cells (cells.c), and of exposures together (sums.c). */
void add_stays(TCase *tests);
void add_sums(TCase *tests);
void add_masses(TCase *tests);
void add_cells_tests(TCase *tests);

#endif
