/* The readers of a scene file's sections. Private.
 *
 * The schema is that of gVXR's scene files; docs/scene-files.md lists every key. What the schema leaves open is read as
 * gVXR does:
 *   - Shapes take their arguments in the order of its calls: Cube [edge, unit], Cuboid [x, y, z, unit], Cylinder
 *     [sectors, height, radius, unit] with the axis along y, and StepWedge an object. It has no Sphere; ours is Sphere
 *     [sectors, radius, unit].
 *   - Without RightVector, columns grow along UpVector x (source - detector).
 *   - MoveToCentre of a sample is applied before its Transform; as a bare string among the samples it moves all of them
 *     together, after all else.
 *   - The first projection of a Scan turns the samples by StartAngle about RotationAxis. */
#ifndef SKG_SECTIONS_H
#define SKG_SECTIONS_H

#include "mesh/mesh.h"
#include "setup/reader.h"

/* Each reads one section into reader->setup. Source comes before Detector, which needs to know where the beam comes
 * from, and both before Scan. A detector that is fitted to the parts comes after Samples; its node->value may be
 * NULL. */
skg_status skg_setup_read_source(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_detector(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_scan(skg_setup_reader *reader, const skg_json_node *node);

/* graph: a SceneGraph, which is one more sample, its file with all its meshes. Either value may be NULL, not both. */
skg_status skg_setup_read_samples(skg_setup_reader *reader, const skg_json_node *node,
                                  const skg_json_node *graph);
/* Whether the detector is fitted: there is none, or one without Position. */
skg_status skg_setup_is_fitted(const skg_json_node *detector, int32_t *fitted);

/* Places a detector without Position behind the parts, and a source that gives a side only in front of them. spacing: [2] of its pixels;
 * NULL: such that the parts cover it. */
skg_status skg_setup_fit_view(skg_setup_reader *reader, const skg_json_object *detector,
                              const double *spacing);

/* Bounds of all vertices in the world, mm: least x, y, z, largest x, y, z. */
skg_status skg_setup_bounds(const skg_scene *scene, double *bounds);

void skg_scan_section_free(skg_scan_section *section);

/* Keeps the text of the scene file that skg_setup_hash_get digests besides the files. */
skg_status skg_setup_keep_text(skg_setup_reader *reader);

/* The section Breathing, after Samples, whose labels it names. node->value may be NULL. */
skg_status skg_setup_read_breathing(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_body_fit(const skg_json_node *node, skg_body_fit_section *fit);
void skg_breathing_section_free(skg_breathing_section *section);

/* The key Organs of that section. */
skg_status skg_setup_read_organs(skg_setup_reader *reader, const skg_json_node *node);
void skg_setup_organs_free(skg_breathing_section *section);

/* Shape of a source and how it is sampled. */
skg_status skg_setup_read_source_shape(skg_setup_reader *reader, const skg_json_object *source,
                                       int32_t *parallel);

/* The key Beam. With mAs the spectrum is absolute. */
skg_status skg_setup_read_beam(skg_setup_reader *reader, const skg_json_node *node);

/* The keys Bowtie of a source (value NULL: none) and Grid of a detector. */
skg_status skg_setup_read_bowtie(skg_setup_reader *reader, const skg_json_node *node);
skg_status skg_setup_read_grid(skg_setup_reader *reader, const skg_json_object *detector);
void skg_setup_in_beam_free(skg_setup *setup);

/* The key Collimation (value NULL: none). has_view: 1: source and detector have been read, and the jaws have to stand before the
 * detector. */
skg_status skg_setup_read_collimation(skg_setup_reader *reader, const skg_json_node *node, int has_view);

/* The key Scatter (value NULL: none). */
skg_status skg_setup_read_scatter(skg_setup_reader *reader, const skg_json_node *node);

/* EnergyResponse or Scintillator of a detector. */
skg_status skg_setup_read_response(skg_setup_reader *reader, const skg_json_object *detector);

/* Counting of a detector that has its place. */
skg_status skg_setup_read_counting(skg_setup_reader *reader, const skg_json_object *detector);

/* GreyValues of a detector. */
skg_status skg_setup_read_grey_values(skg_setup_reader *reader, const skg_json_object *detector);
void skg_grey_section_free(skg_grey_section *section);

/* Reads the keys of Scan for the recording of its projections; after the scan is made. */
skg_status skg_setup_read_record(skg_setup_reader *reader, const skg_json_object *scan);

/* A table of rows of `width` numbers. The caller frees it. */
skg_status skg_setup_read_rows(const skg_json_node *node, int64_t width, const char *example, int64_t *count,
                               double **rows);

/* Poses of a sample that moves during the scan, instead of its Transform. own: from the mesh's axes to those before
 * them. part: its number */
skg_status skg_setup_read_poses(skg_setup_reader *reader, const skg_json_node *node, const double *own,
                                int64_t part);

/* LSF, PSF or MTF, and DQE, of a detector that has its place; the Depths of its scintillator (value NULL: none). */
skg_status skg_setup_read_blur(skg_setup_reader *reader, const skg_json_object *detector);
skg_status skg_setup_read_depths(skg_setup_reader *reader, const skg_json_node *node);
void skg_setup_blur_free(skg_setup *setup);

/* Binning and BinningNoise of the detector: the view, the rays of a pixel and the blur become those of bins. */
skg_status skg_setup_read_binning(skg_setup_reader *reader, const skg_json_object *detector);

/* Applies the binning to photons and noise, after these are read. */
skg_status skg_setup_bin_counts(skg_setup_reader *reader);

/* The key Noise of the file (value NULL: none). */
skg_status skg_setup_read_noise(skg_setup_reader *reader, const skg_json_node *node);

/* A material: its name, or an array that begins with its kind. density: in g/cm3; value NULL: not given. label: the
 * name of a material that has none of its own; may be NULL. The caller releases the material. */
skg_status skg_setup_read_material(skg_setup_reader *reader, const skg_json_node *node,
                                   const skg_json_node *density, const char *label, skg_material **material);

/* The meshes loaded so far: a file that several samples use is loaded once. */
typedef struct {
    struct skg_loaded_mesh {
        const char *path, *group; /* of the scene's text; group NULL: the whole file */
        double unit_mm;           /* 0: the file's */
        int32_t flip;
        skg_mesh *mesh;
    } * loaded;
    int64_t count;
    struct skg_fetched_mesh { /* loaded beforehand, by several threads */
        char *path;
        const char *group;
        double unit_mm;
        /* its mesh is NULL if that failed; the failure is found again where the sample is read */
        skg_loaded loaded;
    } * fetched;
    int64_t fetched_count;
    int32_t as_wound; /* as in skg_mesh_reading */
} skg_mesh_cache;

void skg_mesh_cache_clear(skg_mesh_cache *cache);

/* Adds the file of a sample to those that are loaded beforehand, if it has one that threads may share. */
skg_status skg_mesh_cache_want(const skg_setup_reader *reader, const skg_json_object *sample,
                               skg_mesh_cache *cache);

/* Loads them. */
skg_status skg_mesh_cache_fetch(skg_mesh_cache *cache);

/* Takes a mesh that was loaded beforehand, or loads it. */
skg_status skg_mesh_cache_load(skg_mesh_cache *cache, skg_context *context, const char *path,
                               const char *group, double unit_mm, skg_mesh **mesh);

/* Whether two names of groups are the same; NULL: no group. */
int skg_mesh_cache_same(const char *a, const char *b);

/* The mesh of a sample: from its Path, or generated. flip: turn a leaky mesh inside out (the normals of a closed one
 * point outward anyway). The caller releases the mesh. own: pose of the generated mesh in the axes of the schema. */
skg_status skg_setup_read_shape(skg_setup_reader *reader, const skg_json_object *sample, int32_t flip,
                                skg_mesh_cache *cache, skg_mesh **mesh, double *own);

/* The volume of a sample: its file, and what its values are. The caller releases it. */
skg_status skg_setup_read_volume(skg_setup_reader *reader, const skg_json_object *sample,
                                 skg_volume **volume);

/* pose <- pose T for each entry T of a Transform: the last entry acts on the vertices first. */
skg_status skg_setup_read_transform(const skg_json_node *node, double *pose);

#endif
