/* Prints the poses that a scenario has here, for test_toolbox.py: a line of numbers for each projection. */
#include <skiagraph/skiagraph.h>

#include <inttypes.h>
#include <stdio.h>

static void print_numbers(const double *numbers, int count) {
    for (int i = 0; i < count; i++) printf("%.17g ", numbers[i]);
}

static skg_status print_view(const skg_scan *scan, int64_t k) {
    skg_view view;
    skg_view_init(&view);
    const skg_status status = skg_scan_view_get(scan, k, &view);
    if (status != SKG_OK) return status;
    print_numbers(view.source, 3);
    print_numbers(view.centre, 3);
    print_numbers(view.column_step, 3);
    print_numbers(view.row_step, 3);
    return SKG_OK;
}

/* The samples of a projection: those that move have a pose of their own. */
static skg_status print_samples(const skg_setup *setup, const skg_scan_record *record, int64_t k) {
    skg_scene *scene = NULL;
    int64_t count = 0;
    skg_status status = skg_setup_scene_get(setup, &scene);
    if (status == SKG_OK) status = skg_scene_part_count(scene, &count);
    for (int64_t p = 0; p < count && status == SKG_OK; p++) {
        skg_part part;
        skg_part_init(&part);
        status = skg_scene_part_get(scene, p, &part);
        const double *pose = part.pose;
        for (int64_t m = 0; m < record->moving_count; m++)
            if (record->moving_parts[m] == p)
                pose = record->moving_poses + 16 * (k * record->moving_count + m);
        print_numbers(pose, 16);
    }
    return status;
}

int main(int count, char **words) {
    skg_setup *setup = NULL;
    skg_scan *scan = NULL;
    skg_scan_record record;
    int64_t projections = 0;
    if (count != 2) return 2;
    skg_scan_record_init(&record);
    skg_status status = skg_setup_load(NULL, words[1], 0, NULL, &setup);
    if (status == SKG_OK) status = skg_setup_scan_get(setup, &scan);
    if (status == SKG_OK) status = skg_setup_record_get(setup, &record);
    if (status == SKG_OK) status = skg_scan_projection_count(scan, &projections);
    for (int64_t k = 0; k < projections && status == SKG_OK; k++) {
        double angle = 0;
        status = skg_scan_angle_get(scan, k, &angle);
        if (status == SKG_OK) status = print_view(scan, k);
        if (status == SKG_OK) status = print_view(record.known ? record.known : scan, k);
        printf("%.17g ", angle);
        if (status == SKG_OK) status = print_samples(setup, &record, k);
        printf("\n");
    }
    if (status != SKG_OK) fprintf(stderr, "%s\n", skg_last_error());
    skg_setup_release(&setup);
    return status == SKG_OK ? 0 : 1;
}
