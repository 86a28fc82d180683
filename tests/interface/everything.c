/* Uses the whole library, from a thorax to files and an image: numbers that no state of the caller may change. */
#include "everything.h"

#include "suite.h"
#include "support/run.h"

#include <skiagraph/breathing.h>

#include <locale.h>
#include <string.h>

static uint64_t hash_of_file(const char *folder, const char *name) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    ck_assert_int_eq(fseek(file, 0, SEEK_END), 0);
    const long size = ftell(file);
    char *bytes = malloc((size_t)size);
    ck_assert_ptr_nonnull(bytes);
    rewind(file);
    ck_assert_uint_eq(fread(bytes, 1, (size_t)size, file), (size_t)size);
    const uint64_t hash = run_hash(bytes, size);
    free(bytes);
    ck_assert_int_eq(fclose(file), 0);
    return hash;
}

/* A thorax in its folder, read again and breathing. */
static skg_setup *thorax_of(const char *folder, skg_motion **motion) {
    skg_thorax_options options;
    skg_thorax *thorax = NULL;
    skg_setup *setup = NULL;
    char path[256];
    snprintf(path, sizeof path, "%s/thorax.json", folder);
    skg_thorax_options_init(&options);
    options.triangles = 10000;
    options.simple = 1;
    ck_skg(skg_thorax_create(&options, &thorax));
    ck_skg(skg_thorax_save(thorax, folder));
    skg_thorax_release(&thorax);
    ck_skg(skg_setup_load(run_context, path, 0, NULL, &setup));
    ck_skg(skg_motion_create(run_context, setup, motion));
    ck_skg(skg_motion_pose_at_phase(*motion, 0.3));
    return setup;
}

static void image_of(const skg_setup *setup, const char *folder, everything *done) {
    const double bands[3] = {0, 55.5, 200};
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_plan_options options;
    skg_channel channel;
    skg_output output;
    skg_picture picture;
    skg_view view = run_view(EVERYTHING_SIDE, 9.5);
    char path[256];
    ck_skg(skg_setup_scene_get(setup, &scene));
    ck_skg(skg_setup_spectrum_get(setup, &spectrum));
    skg_plan_options_init(&options);
    ck_skg(skg_setup_options_get(setup, &options));
    options.overlaps = 0;
    options.bands = 2;
    options.band_kev = bands;
    ck_skg(skg_plan_create(run_context, scene, &view, spectrum, &options, &plan));
    skg_output_init(&output);
    output.data = done->image;
    ck_skg(skg_plan_image(plan, &output));
    skg_channel_init(&channel);
    ck_skg(skg_plan_channel_get(plan, 0, &channel));
    snprintf(done->channel, sizeof done->channel, "%s", channel.name);
    skg_picture_init(&picture);
    picture.data = done->image;
    picture.columns = picture.rows = EVERYTHING_SIDE;
    picture.view = &view;
    snprintf(path, sizeof path, "%s/image.mha", folder);
    ck_skg(skg_picture_save(&picture, path));
    skg_plan_release(&plan);
}

void do_everything(everything *done) {
    char folder[] = "/tmp/skg_everything_XXXXXX", command[64];
    skg_material *lung = NULL;
    skg_spectrum *beam = NULL;
    skg_motion *motion = NULL;
    skg_tube tube;
    skg_quality quality;
    memset(done, 0, sizeof *done);
    ck_assert_ptr_nonnull(mkdtemp(folder));
    const char *name = NULL;
    ck_skg(skg_material_create_hounsfield(-741.5, &lung));
    ck_skg(skg_material_name_get(lung, &name));
    snprintf(done->material, sizeof done->material, "%s", name);
    ck_skg(skg_material_attenuation_get(lung, 61.3, &done->per_cm));
    skg_material_release(&lung);
    skg_tube_init(&tube);
    tube.kvp = 80;
    skg_quality_init(&quality);
    ck_skg(skg_spectrum_create_tube(&tube, &beam));
    ck_skg(skg_spectrum_quality_get(beam, &quality));
    done->half_value_mm = quality.hvl1_mm_al;
    skg_spectrum_release(&beam);
    skg_setup *setup = thorax_of(folder, &motion);
    image_of(setup, folder, done);
    skg_motion_release(&motion);
    skg_setup_release(&setup);
    done->files = hash_of_file(folder, "thorax.json") ^ 3 * hash_of_file(folder, "image.mha") ^
                  5 * hash_of_file(folder, "skin.ply");
    snprintf(command, sizeof command, "rm -r %s", folder);
    ck_assert_int_eq(system(command), 0);
}

int everything_comma(void) {
    char folder[] = "/tmp/skg_locale_XXXXXX", command[160];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >%s/log 2>&1", folder,
             folder);
    const int made = system(command) >= 0 && setenv("LOCPATH", folder, 1) == 0 &&
                     setlocale(LC_ALL, "de_DE.UTF-8") && strcmp(localeconv()->decimal_point, ",") == 0;
    snprintf(command, sizeof command, "rm -r %s", folder);
    ck_assert_int_eq(system(command), 0);
    return made;
}
