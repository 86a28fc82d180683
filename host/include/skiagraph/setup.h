/** @file
 * Scene files: scene, view, spectrum and options from JSON, in the schema that users of gVXR have ("JSON
 * 1.0.0": WindowSize, Source, Detector, Samples, Scan) with keys of our own. docs/scene-files.md lists all of
 * them. Keys and names are read without regard to case, lengths have unit strings, paths are relative to the
 * file.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SETUP_H
#define SKIAGRAPH_SETUP_H

#include <skiagraph/plan.h>
#include <skiagraph/readout.h>
#include <skiagraph/scan.h>

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

/** Where skg_setup_create takes a scene from, and how it is read. Prepare with skg_setup_source_init; set `text`, or `path`
 * alone. */
typedef struct {
    /** Set by skg_setup_source_init. */
    int32_t size;
    /** 1: Samples may be missing or empty, and so may Source and Detector, both together. Then the spectrum
     * is NULL and the view as skg_view_init leaves it, and the caller completes them. 0: as in a file. */
    int32_t partial;
    /** 1: what can be passed over is a warning and not an error: unknown keys, fractions of a mixture that do
     * not sum to 1 (they are scaled), a Size that contradicts Spacing (Spacing holds). */
    int32_t lenient;
    /** 1: only path lengths are wanted. A source without a beam and a sample without a usable material are
     * warnings: 60 keV stand in for the beam, and a material that attenuates nothing. */
    int32_t lengths_only;
    /** The JSON text, as a file has it; NULL: the file at `path` is read, as by skg_setup_load. */
    const char *text;
    /** Where the text is from: paths in it are relative to the folder of this path, and messages begin with
     * it. NULL: "scene", in the working folder. */
    const char *path;
    /** [setting_count] as of skg_setup_load. */
    const char *const *settings;
    /** Number of settings. */
    int64_t setting_count;
    /** [file_count] names of files as the text has them, which are read from elsewhere. */
    const char *const *file_names;
    /** [file_count] where these files are. */
    const char *const *file_paths;
    /** Number of such files. */
    int64_t file_count;
    /** Receives warnings and notes if the context is NULL; may be NULL. */
    skg_log_function log;
    /** Passed to log. */
    void *log_user;
} skg_setup_source;

SKG_INIT(skg_setup_source)

/** Makes a set-up from a text or file; otherwise as skg_setup_load. */
SKG_API skg_status skg_setup_create(skg_context *context, const skg_setup_source *source, skg_setup **setup);

/** Gets the JSON text of a set-up: the scene file after its settings, with its keys in order, as skg_setup_create takes it. A
 * CTSimU scenario is the scene file that it was read as.
 *
 *     text   result: valid as long as the set-up */
SKG_API skg_status skg_setup_text_get(const skg_setup *setup, const char **text);

/** Number of the files that the scene names and that were read: meshes, spectra, responses, materials. */
SKG_API skg_status skg_setup_file_count(const skg_setup *setup, int64_t *count);

/** Gets file 0 <= index < count, in the order in which they were first read, each once.
 *
 *     name   result: as the scene has it
 *     path   result: where it was read. Both are valid as long as the set-up */
SKG_API skg_status skg_setup_file_get(const skg_setup *setup, int64_t index, const char **name,
                                      const char **path);

/** Changes that skg_setup_save writes into a scene file. Prepare with skg_setup_changes_init: none. */
typedef struct {
    /** Set by skg_setup_changes_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of parts that are moved. */
    int64_t part_count;
    /** [part_count] their numbers */
    const int64_t *parts;
    /** [part_count][16] their motions, in the world and in addition to their poses: affine matrices, row by row. */
    const double *motions;
    /** Number of views that are replaced. */
    int64_t view_count;
    /** [view_count] projections of the key Scan, which becomes a table of poses, or -1 for source and detector of the scene; NULL: -1. */
    const int64_t *projections;
    /** [view_count] the views */
    const skg_view *views;
} skg_setup_changes;

SKG_INIT(skg_setup_changes)

/** Writes a set-up as a scene file, which appears whole or not at all. Paths of files stay relative if they lead to the same file from the
 * folder of the scene that is written, and become absolute otherwise.
 *
 *     changes   NULL: the scene as it was read, after its settings
 *     errors    SKG_ERR_OUTPUT; SKG_ERR_UNSUPPORTED for a part that cannot be moved in the text, since a command among the samples
 *               places all of them together */
SKG_API skg_status skg_setup_save(const skg_setup *setup, const skg_setup_changes *changes, const char *path);

/** Writes a set-up with a circular scan as a CTSimU scenario of format 1.2 (docs/ctsimu.md), with meshes and spectrum in files beside it:
 * of box.ctsimu.json box-part-1.stl and so on, without the parts that lie inside, and box-spectrum.csv. Noise, blur, scatter and other
 * effects of beam and detector are not written: the detector is ideal, and the beam falls off with distance and obliquity.
 *
 *     path     ends in .ctsimu.json
 *     errors   SKG_ERR_ARGUMENT (path), SKG_ERR_SCENE (no scan), SKG_ERR_OUTPUT; SKG_ERR_UNSUPPORTED for what a scenario cannot hold
 *              or is not written: other scans than circular ones, samples with Poses, volumes of cells, materials without
 *              composition or density, a skewed detector, spots that are neither points nor rectangles nor Gaussian */
SKG_API skg_status skg_setup_save_scenario(const skg_setup *setup, const char *path);

/** Gets where the source stands, for the words of `Source.From`: "front" (-y), "side" (+x), "top" (+z), and those of the clinic, for a body whose
 * x points to its left, y to its back and z to its head: "AP" (the source in front), "PA" (behind), "LAT" (a left lateral: the source at the
 * right side, the detector at the left), and angles of a C-arm, "LAO 30 CRAN 20", which say where the detector stands: from in front of the
 * body towards its left (LAO) or right (RAO), 0 to 180 degrees, and towards its head (CRAN, CRA) or feet (CAUD, CAU), 0 to 90 (DICOM's
 * positioner angles). In upper or lower case.
 *
 *     direction       result: [3] from the middle of the body to the source, of length 1
 *     from_detector   result: 1: its picture is as seen from the detector, 0: from the source. The body's right side is then on the viewer's
 *                     left, as radiographs are hung, and a left lateral faces left
 *     errors          SKG_ERR_ARGUMENT for other words */
SKG_API skg_status skg_side_get(const char *name, double *direction, int32_t *from_detector);

/** Gets the JSON Schema (draft 2020-12) of scene files, from the same tables by which they are read: names, forms, limits and meaning of
 * every key. A file that it refuses is refused when it is read; what depends on several keys, or on other files, only reading tells.
 *
 *     text       result: [capacity], ends with a 0; NULL: only its size is wanted
 *     capacity   bytes of text
 *     size       result: bytes that text needs
 *     errors     SKG_ERR_ARGUMENT if capacity does not suffice */
SKG_API skg_status skg_setup_schema_get(char *text, int64_t capacity, int64_t *size);

/** Frees a set-up and releases what it holds. Plans retain what they need of it. */
SKG_API void skg_setup_release(skg_setup **setup);

/** Gets the scene, which is valid as long as the set-up and not retained for the caller. */
SKG_API skg_status skg_setup_scene_get(const skg_setup *setup, skg_scene **scene);

/** Gets the spectrum, NULL if a partial text has none, which is valid as long as the set-up and not retained for the caller. It is
 * absolute (beam.h) if the file gives mAs. */
SKG_API skg_status skg_setup_spectrum_get(const skg_setup *setup, skg_spectrum **spectrum);

/** Gets the view; of a scan, that of the first projection. */
SKG_API skg_status skg_setup_view_get(const skg_setup *setup, skg_view *view);

/** Gets the number of projections of the file's scan; 1 without a scan, 0 if its keys do not define it. */
SKG_API skg_status skg_setup_projection_count_get(const skg_setup *setup, int64_t *count);

/** Gets the scan of the key Scan, which is valid as long as the set-up and not retained for the caller.
 *
 *     scan     result
 *     errors   SKG_ERR_SCENE if the file has no key Scan, or one that does not say how many projections there
 *              are */
SKG_API skg_status skg_setup_scan_get(const skg_setup *setup, skg_scan **scan);

/** How a scan is recorded, apart from its geometry. The library fills it; prepare with skg_scan_record_init. Its pointers
 * are valid as long as the set-up. */
typedef struct {
    /** Set by skg_scan_record_init. */
    int32_t size;
    /** 1: the scene comes from a CTSimU scenario, and a folder is written in its layout. */
    int32_t ctsimu;
    /** 1: the scene has GreyValues (skg_setup_readout_get). */
    int32_t grey_values;
    /** 1: flat fields have the noise of the grey values. */
    int32_t flat_noise;
    /** 1: dark fields have it. */
    int32_t dark_noise;
    /** 1: the numbers of flat and dark fields are given. */
    int32_t fields;
    /** Number of flat fields. */
    int64_t flats;
    /** Frames of which each is averaged. */
    int64_t flat_frames;
    /** Number of dark fields. */
    int64_t darks;
    /** Frames of which each is averaged. */
    int64_t dark_frames;
    /** Geometry for the reconstruction (the key KnownTable). It differs from the geometry of the simulation if the scene
     * simulates a misalignment of which the reconstruction does not know. NULL: the scan's own geometry. */
    skg_scan *known;
    /** [projections] intensity of the beam over that of the first projection, for grey values; NULL: 1 */
    const double *intensities;
    /** Number of parts that move from one projection to the next. */
    int64_t moving_count;
    /** [moving_count] numbers of these parts */
    const int64_t *moving_parts;
    /** [projections][moving_count][16] their poses */
    const double *moving_poses;
} skg_scan_record;

SKG_INIT(skg_scan_record)

/** Gets how the scan of a set-up is recorded.
 *
 *     record   in and out: prepared with skg_scan_record_init */
SKG_API skg_status skg_setup_record_get(const skg_setup *setup, skg_scan_record *record);

/** Gets the grey values of the detector. Its full_kev is 0 and has to be set: the greatest value of a flat field of the
 * first projection. Its pointers are valid as long as the set-up.
 *
 *     readout   in and out: prepared with skg_readout_init; unchanged if the scene has no GreyValues */
SKG_API skg_status skg_setup_readout_get(const skg_setup *setup, skg_readout *readout);

/** Gets the text that identifies what a set-up was read from: the SHA-256 of the scene file after its settings
 * and of the contents of every file that it names. Two set-ups with the same text are the same scene.
 *
 *     hash     result: [size] bytes, at least 65: 64 hexadecimal digits and a zero
 *     errors   SKG_ERR_ARGUMENT (size), SKG_ERR_FILE if a file cannot be read any more */
SKG_API skg_status skg_setup_hash_get(const skg_setup *setup, char *hash, int64_t size);

/** Gets the options of a plan.
 *
 *     options   in and out: prepared with skg_plan_options_init; fields of which the file says nothing stay
 *
 * Response, world, spot, heel, bow-tie, grid, collimation, scatter, blurs, DQE and views are valid as long as the set-up. Falloff is as the key
 * Falloff says; without the key it follows the beam. The views are a sample of those of the scan. */
SKG_API skg_status skg_setup_options_get(const skg_setup *setup, skg_plan_options *options);

#ifdef __cplusplus
}
#endif
#endif
