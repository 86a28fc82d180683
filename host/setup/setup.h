/* The inside of a set-up, and the readers of a scene file's sections. Private.
 *
 * The schema is that of gVXR's scene files; docs/scene-files.md lists every key. What its files leave open is
 * settled here as its reader does it:
 *   - makers take their arguments in the order of its calls: Cube [edge, unit], Cuboid [x, y, z, unit],
 *     Cylinder [sectors, height, radius, unit] with the axis along y, StepWedge an object. Its reader has no
 *     Sphere; ours is Sphere [sectors, radius, unit].
 *   - without RightVector, columns grow along UpVector x (source - detector).
 *   - MoveToCentre of a sample comes before its Transform; the bare string moves all samples together, last.
 *   - the first projection of a Scan turns the samples by StartAngle about RotationAxis. */
#ifndef SKG_SETUP_PRIVATE_H
#define SKG_SETUP_PRIVATE_H

#include "scene/scene.h"
#include "setup/json.h"

#include <skiagraph/breathing.h>
#include <skiagraph/setup.h>

/* The section Scan, as given; angles in degrees. */
typedef struct {
    int32_t present; /* 1 or 0; all else is 0 where 0 */
    double start, step, final;
    int32_t has_step, has_final, include_last, flat_field;
    int64_t projections; /* 0: not given */
    int64_t white_images;
    double centre[3]; /* mm, of the rotation */
    double axis[3];   /* of the rotation, length 1 */
    char *folder;     /* OutFolder relative to the scene file's own, or NULL */
    int64_t view_count;
    skg_view *views; /* [view_count] a sample of those after the first */
} skg_scan_section;

/* A value over time: straight between its points (s, value), constant beyond them. */
typedef struct {
    double *points; /* [count][2], times rising */
    int64_t count;  /* 0: not given */
} skg_curve;

/* The section Breathing; without it the defaults. */
typedef struct {
    skg_breath breath; /* samples and holds are those below */
    skg_body_options body;
    double *samples;
    skg_breath_hold *holds;
    int32_t lung_density; /* 1: keeps the lungs' mass */
    int32_t is_given;     /* 1: the file has it */
    int64_t organ_count;
    struct skg_breathing_organ {
        int64_t part;
        char *as;        /* label whose rule it follows; NULL: its own */
        skg_organ organ; /* kind, tissue, rotation and links; no mesh */
        char **to;       /* of the links, which point to them */
        skg_organ_link *links;
    } * organs;
    skg_curve weight; /* factor on both channels */
    skg_curve needle; /* depth below the skin, mm */
    int64_t contrast_count;
    struct skg_breathing_contrast {
        int64_t part;
        skg_curve share;
    } * contrasts;
} skg_breathing_section;

/* The key Noise; all zero but swank: none. */
typedef struct {
    int32_t quantum, reserved;
    double electronic_kev, step_kev, swank;
    int64_t seed;
} skg_setup_noise;

struct skg_setup {
    skg_scene *scene;
    skg_spectrum *spectrum;
    int32_t absolute;       /* 1: photons come from mAs */
    int32_t falloff;        /* 1: the beam falls off with distance */
    skg_response *response; /* NULL: ideal */
    skg_material *world;    /* around the parts; NULL: vacuum */
    skg_detector_blur blur; /* columns 0: none */
    double *blur_samples;   /* that it points to */
    skg_setup_noise noise;
    skg_spot spot;
    int32_t supersampling; /* rays a side of a pixel */
    skg_view view;         /* of the first projection */
    skg_scan_section scan;
    skg_breathing_section breathing;
    int32_t precision, has_precision;
    int32_t repair, has_repair, clip;
    double tolerance; /* negative: not given */
};

/* What the readers share. */
typedef struct {
    skg_context *context;
    skg_json_file file;
    char *folder; /* of the scene file, with its last slash; "" */
    skg_setup *setup;
} skg_setup_reader;

/* Each reads one section into reader->setup. Source before Detector (which needs to know where the beam comes
 * from), both before Scan. */
skg_status skg_setup_read_source(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_detector(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_samples(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_scan(skg_setup_reader *reader, const skg_json_node *node);

/* node->value may be absent; after Samples, whose labels it names (setup_breathing.c). */
skg_status skg_setup_read_breathing(skg_setup_reader *reader, const skg_json_node *node);
void skg_breathing_section_free(skg_breathing_section *section);

/* The key Organs of it (setup_organs.c); what it says of a part goes into that part's organ. */
skg_status skg_setup_read_organs(skg_setup_reader *reader, const skg_json_node *node);
void skg_setup_describe_organ(const skg_breathing_section *section, int64_t part, skg_organ *organ);
void skg_setup_organs_free(skg_breathing_section *section);

/* The number of the sample with this label, which stands at a node. */
skg_status skg_setup_find_part(const skg_setup_reader *reader, const skg_json_node *node, const char *label,
                               int64_t *part);

/* Shape of a source and how it is sampled (setup_spot.c). */
skg_status skg_setup_read_source_shape(skg_setup_reader *reader, const skg_json_object *source,
                                       int32_t *parallel);

/* The key Beam; with mAs in photons per mm2 at 1 m until the detector is known and skg_setup_place_beam was
 * called. node: of the beam or what it lies in, for messages. */
skg_status skg_setup_read_beam(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_place_beam(skg_setup_reader *reader, const skg_json_node *node);

/* EnergyResponse or Scintillator of a detector. */
skg_status skg_setup_read_response(skg_setup_reader *reader, const skg_json_object *detector);

/* LSF or PSF of a detector; Noise of the file (value NULL: none). */
skg_status skg_setup_read_blur(skg_setup_reader *reader, const skg_json_object *detector);
skg_status skg_setup_read_noise(skg_setup_reader *reader, const skg_json_node *node);

/* A material: its name, or an array with its kind; density may be absent (value NULL). label: its name where
 * it has none of its own; may be NULL. The caller releases it. */
skg_status skg_setup_read_material(skg_setup_reader *reader, const skg_json_node *node,
                                   const skg_json_node *density, const char *label, skg_material **material);

/* Meshes that were loaded, so that a file used by several samples is loaded once. */
typedef struct {
    struct skg_loaded_mesh {
        char *path;
        double unit_mm;
        int32_t flip;
        skg_mesh *mesh;
    } * loaded;
    int64_t count;
} skg_mesh_cache;

void skg_mesh_cache_clear(skg_mesh_cache *cache);

/* The mesh of a sample: its Path, or one of the makers. flip: turn an open mesh inside out (a closed one is
 * outward anyway). The caller releases the mesh. own: pose of the maker's axes in those of the schema. */
skg_status skg_setup_read_shape(skg_setup_reader *reader, const skg_json_object *sample, int32_t flip,
                                skg_mesh_cache *cache, skg_mesh **mesh, double *own);

/* M <- M T for each entry of a Transform: the last entry acts on the vertices first. */
skg_status skg_setup_read_transform(const skg_json_node *node, double *pose);

/* Path relative to the scene file's folder; the caller frees it. */
skg_status skg_setup_resolve(const skg_setup_reader *reader, const char *path, char **resolved);

#endif
