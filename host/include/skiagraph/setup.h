/* Scene files: a whole set-up (scene, view, spectrum, options) from JSON in the schema that gVXR users have
 * ("JSON 1.0.0": WindowSize, Source, Detector, Samples, Scan), plus keys of our own
 * (docs/scene-files.md lists all of them). Keys and names without regard to case; lengths
 * with unit strings; paths relative to the file. */
#ifndef SKIAGRAPH_SETUP_H
#define SKIAGRAPH_SETUP_H

#include <skiagraph/plan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_setup skg_setup;

/* Reads a scene file. settings: `count` strings "KEY=VALUE" with dotted paths ("Detector.Size=[100, 100,
 * \"mm\"]", "Samples.liver.Type=inner"), applied to the file's contents before they are read; may be NULL
 * when count is 0. context: for warnings and notes; may be NULL. Errors: SKG_ERR_FILE, SKG_ERR_FORMAT (not
 * JSON: line and column; a key or value of the wrong kind: its path in the file, with the nearest known
 * name), SKG_ERR_ARGUMENT (a setting), SKG_ERR_SCENE, SKG_ERR_MESH, SKG_ERR_MATERIAL, SKG_ERR_BEAM,
 * SKG_ERR_UNSUPPORTED (a key of the schema not simulated yet). The caller releases the set-up. */
SKG_API skg_status skg_setup_load(skg_context *context, const char *path, int64_t count,
                                  const char *const *settings, skg_setup **setup);
SKG_API void skg_setup_release(skg_setup **setup);

/* What it holds; scene, spectrum, and the response, world and blur of the options are valid as long as the
 * set-up (plans retain them). The view is that of a scan's first projection. options, prepared with
 * skg_plan_options_init, keep what the file does not say; falloff is on where photons come from mAs, or by
 * the key Falloff; views are a sample of a scan's, valid as long as the set-up. */
SKG_API skg_status skg_setup_scene_get(const skg_setup *setup, skg_scene **scene);
SKG_API skg_status skg_setup_spectrum_get(const skg_setup *setup, skg_spectrum **spectrum);
SKG_API skg_status skg_setup_view_get(const skg_setup *setup, skg_view *view);
SKG_API skg_status skg_setup_options_get(const skg_setup *setup, skg_plan_options *options);

#ifdef __cplusplus
}
#endif
#endif
