/** @file
 * Scene files: scene, view, spectrum and options from JSON, in the schema that users of gVXR have ("JSON
 * 1.0.0": WindowSize, Source, Detector, Samples, Scan) with keys of our own. docs/scene-files.md lists all of
 * them. Keys and names are read without regard to case, lengths have unit strings, paths are relative to the
 * file. */
#ifndef SKIAGRAPH_SETUP_H
#define SKIAGRAPH_SETUP_H

#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The contents of a scene file. */
typedef struct skg_setup skg_setup;

/** Reads a scene file.
 *
 *     context    receives warnings and notes; may be NULL
 *     path       -: standard input; paths in the scene are then relative to the working folder
 *     count      number of settings
 *     settings   [count] "KEY=VALUE" with dotted paths, applied to the contents before they are read, such as
 *                "Detector.Size=[100, 100, \"mm\"]" or "Samples.liver.Type=inner"; NULL if count is 0
 *     setup      result; the caller releases it
 *     errors     SKG_ERR_FILE; SKG_ERR_FORMAT with line and column if it is no JSON, or with the path of a
 *                key that is unknown (and the nearest known name) or of the wrong kind; SKG_ERR_ARGUMENT (a
 *                setting); SKG_ERR_SCENE, SKG_ERR_MESH, SKG_ERR_MATERIAL, SKG_ERR_BEAM; SKG_ERR_UNSUPPORTED
 *                for a key of the schema that is not simulated yet */
SKG_API skg_status skg_setup_load(skg_context *context, const char *path, int64_t count,
                                  const char *const *settings, skg_setup **setup);

/** Frees a set-up and releases what it holds. Plans retain what they need of it. */
SKG_API void skg_setup_release(skg_setup **setup);

/** Gets the scene, which is valid as long as the set-up and not retained for the caller. */
SKG_API skg_status skg_setup_scene_get(const skg_setup *setup, skg_scene **scene);

/** Gets the spectrum, which is valid as long as the set-up and not retained for the caller. */
SKG_API skg_status skg_setup_spectrum_get(const skg_setup *setup, skg_spectrum **spectrum);

/** Gets the view; of a scan, that of the first projection. */
SKG_API skg_status skg_setup_view_get(const skg_setup *setup, skg_view *view);

/** Gets the number of projections of the file's scan; 1 without a scan, 0 if its keys do not define it. */
SKG_API skg_status skg_setup_projection_count_get(const skg_setup *setup, int64_t *count);

/** Gets the options of a plan.
 *
 *     options   in and out: prepared with skg_plan_options_init; fields of which the file says nothing stay
 *
 * Response, world, spot, blur and views are valid as long as the set-up. Falloff is on if the file gives mAs
 * or has the key Falloff. The views are a sample of those of the scan. */
SKG_API skg_status skg_setup_options_get(const skg_setup *setup, skg_plan_options *options);

#ifdef __cplusplus
}
#endif
#endif
