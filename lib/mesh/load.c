/* Mesh files. STL, OBJ, OFF, PLY and 3MF have readers of our own; every other format is read by Assimp. Assimp would lose too
 * much of these: it makes a vertex of every corner of an OBJ file and groups its faces, so that the file's
 * numbering is gone; it keeps only floats; it accepts truncated ascii STL, OFF and PLY files as complete ones, and leaks
 * memory when it refuses one. */
#include "core/context.h"
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "mesh/archive.h"
#include "mesh/assimp_files.h"
#include "mesh/counts.h"
#include "mesh/file_unit.h"
#include "mesh/instances.h"
#include "mesh/mesh.h"
#include "mesh/read.h"

#include <assimp/cimport.h>
#include <assimp/commonMetaData.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Opens a regular file that is not empty. */
static skg_status open_file(const char *path, FILE **stream, int64_t *size) {
    SKG_TRY(skg_input_open(path, SKG_INPUT_LARGE, stream, size));
    if (*size > 0) return SKG_OK;
    fclose(*stream);
    return skg_fail(SKG_ERR_FORMAT, "%s: the file is empty", path);
}

typedef skg_status (*reader)(const skg_mesh_file *file, skg_mesh_arrays *arrays);

/* Reads the whole file into memory and calls the reader. */
static skg_status read_here(FILE *stream, const char *path, int64_t size, reader read,
                            skg_mesh_arrays *arrays) {
    skg_mesh_file file = {path, NULL, size};
    SKG_TRY(skg_alloc(size + 1, 1, path, &file.bytes));
    skg_status status = SKG_OK;
    if (fread(file.bytes, 1, (size_t)size, stream) != (size_t)size)
        status = skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s", path, strerror(errno));
    else
        status = read(&file, arrays);
    skg_free(&file.bytes);
    return status;
}

/* The determinant of the linear part. */
static double determinant(const struct aiMatrix4x4 *m) {
    const double pose[16] = {(double)m->a1, (double)m->a2, (double)m->a3, 0,
                             (double)m->b1, (double)m->b2, (double)m->b3, 0,
                             (double)m->c1, (double)m->c2, (double)m->c3, 0};
    return skg_pose_determinant(pose);
}

/* Adds one object of a file, placed by its node. Vertices and faces keep their order; the corners of a face turn where the node
 * mirrors, as glTF 2.0 says of a
 * negative determinant. */
static skg_status add_object(const struct aiMesh *object, const struct aiMatrix4x4 *m,
                             skg_mesh_arrays *arrays) {
    const int64_t base = arrays->vertices;
    const int mirrored = determinant(m) < 0;
    for (unsigned i = 0; i < object->mNumVertices; i++) {
        double x = (double)object->mVertices[i].x, y = (double)object->mVertices[i].y,
               z = (double)object->mVertices[i].z;
        double position[3] = {(double)m->a1 * x + (double)m->a2 * y + (double)m->a3 * z + (double)m->a4,
                              (double)m->b1 * x + (double)m->b2 * y + (double)m->b3 * z + (double)m->b4,
                              (double)m->c1 * x + (double)m->c2 * y + (double)m->c3 * z + (double)m->c4};
        SKG_TRY(skg_mesh_add_vertex(arrays, position));
    }
    for (unsigned i = 0; i < object->mNumFaces; i++) {
        const struct aiFace *face = &object->mFaces[i];
        skg_polygon polygon = {0};
        arrays->left_out += face->mNumIndices < 3;
        for (unsigned k = 0; face->mNumIndices >= 3 && k < face->mNumIndices; k++) {
            const unsigned corner = face->mIndices[mirrored ? face->mNumIndices - 1 - k : k];
            if (corner >= object->mNumVertices)
                return skg_fail(SKG_ERR_MESH, "face %u names vertex %u of an object of %u", i, corner,
                                object->mNumVertices);
            SKG_TRY(skg_mesh_add_corner(arrays, &polygon, base + (int64_t)corner));
        }
    }
    return SKG_OK;
}

/* at: the place of the node itself. Its own meshes are a named piece. */
static skg_status add_node(const struct aiScene *scene, const struct aiNode *node,
                           const struct aiMatrix4x4 *at, skg_mesh_arrays *arrays) {
    if (node->mNumMeshes > 0) SKG_TRY(skg_mesh_begin_object(arrays, node->mName.data));
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        SKG_TRY(add_object(scene->mMeshes[node->mMeshes[i]], at, arrays));
    for (unsigned i = 0; i < node->mNumChildren; i++) {
        struct aiMatrix4x4 below = *at;
        aiMultiplyMatrix4(&below, &node->mChildren[i]->mTransformation);
        SKG_TRY(add_node(scene, node->mChildren[i], &below, arrays));
    }
    return SKG_OK;
}

/* Adds what the objects of a node and below it take in memory, and how often they are placed. */
static void count_node(const struct aiScene *scene, const struct aiNode *node, double *times, double *bytes) {
    *times += 1;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const struct aiMesh *object = scene->mMeshes[node->mMeshes[i]];
        *bytes += 3 * sizeof(double) * (double)object->mNumVertices +
                  3 * sizeof(int32_t) * (double)object->mNumFaces;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) count_node(scene, node->mChildren[i], times, bytes);
}

/* The last net, of formats that are not counted before they are opened. */
static skg_status check_scene(const char *path, int64_t size, const struct aiScene *scene) {
    double times = 0, bytes = 0;
    /* Assimp makes a mesh of bones where COLLADA has none */
    if (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE && skg_mesh_is_collada(path))
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: no triangles: its scene places no geometry; place the geometry in the program "
                        "that made it, and export again",
                        path);
    if (scene->mRootNode) count_node(scene, scene->mRootNode, &times, &bytes);
    SKG_TRY(skg_mesh_check_times(path, times, "node", scene->mRootNode ? scene->mRootNode->mName.data : "",
                                 times));
    return skg_mesh_check_bytes(path, size, bytes);
}

/* Whether a list of extensions, between blanks and without points, has that of the path. */
static int lists_extension(const char *list, const char *path) {
    const char *dot = strrchr(path, '.');
    char extension[16];
    while (dot && *(list += strspn(list, " "))) {
        const size_t length = strcspn(list, " ");
        snprintf(extension, sizeof extension, ".%.*s", (int)length, list);
        if (skg_same_name(dot, extension)) return 1;
        list += length;
    }
    return 0;
}

/* Assimp reads files by their contents, too. Refuses one whose extension names a unit that is not that of its format, and one of a
 * format that a reader of our own reads under its own extension, which Assimp would take cut off. */
static skg_status check_format(const char *path, const struct aiScene *scene, const skg_mesh_arrays *arrays) {
    static const char *const ours[] = {"a.stl", "a.obj", "a.off", "a.ply", "a.3mf"};
    const struct aiImporterDesc *found = NULL;
    const char *format = NULL;
    for (unsigned i = 0; scene->mMetaData && i < scene->mMetaData->mNumProperties; i++)
        if (strcmp(scene->mMetaData->mKeys[i].data, AI_METADATA_SOURCE_FORMAT) == 0 &&
            scene->mMetaData->mValues[i].mType == AI_AISTRING)
            format = ((const struct aiString *)scene->mMetaData->mValues[i].mData)->data;
    for (size_t k = 0; format && !found && k < aiGetImportFormatCount(); k++) {
        const struct aiImporterDesc *one = aiGetImportFormatDescription(k);
        if (strcmp(one->mName, format) == 0) found = one;
    }
    if (!found || lists_extension(found->mFileExtensions, path)) return SKG_OK;
    int is_ours = 0;
    for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
        is_ours |= lists_extension(found->mFileExtensions, ours[k]);
    if (!is_ours && arrays->file_unit_mm == 0) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: is a file of another format than its extension says; rename it to one of: %s", path,
                    found->mFileExtensions);
}

/* Assimp's post-processing is off: it would weld vertices, split polygons and sort faces. Of COLLADA it puts unit and axes into the
 * root node, which has no place of its own: there the numbers of the file are kept, and the unit is used once, here. */
static skg_status read_by_assimp(FILE *stream, const char *path, int64_t size, skg_mesh_arrays *arrays) {
    struct aiFileIO files;
    SKG_TRY(skg_archive_check(path, stream));
    SKG_TRY(skg_mesh_check_counts(path, stream, size));
    SKG_TRY(skg_mesh_file_unit(path, stream, size, arrays->unit_mm > 0, &arrays->file_unit_mm));
    skg_assimp_files(&files);
    const struct aiScene *scene = aiImportFileEx(path, 0, &files);
    if (!scene && skg_archive_is(stream))
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: is a ZIP archive, as only 3MF may be; unpack it, and give the file in it", path);
    if (!scene) return skg_fail(SKG_ERR_FORMAT, "%s: %s", path, aiGetErrorString());
    struct aiMatrix4x4 at;
    aiIdentityMatrix4(&at);
    skg_status status = check_format(path, scene, arrays);
    if (status == SKG_OK) status = check_scene(path, size, scene);
    if (status != SKG_OK) {
        aiReleaseImport(scene);
        return status;
    }
    if (scene->mRootNode && !skg_mesh_is_collada(path)) at = scene->mRootNode->mTransformation;
    if (scene->mRootNode) status = add_node(scene, scene->mRootNode, &at, arrays);
    if (arrays->file_unit_mm == 0) arrays->file_unit_mm = skg_mesh_scene_unit(scene);
    if (status != SKG_OK) skg_fail(status, "%s: %s", path, skg_last_error());
    aiReleaseImport(scene);
    return status;
}

static int has_extension(const char *path, const char *extension) {
    const char *dot = strrchr(path, '.');
    return dot && skg_same_name(dot, extension);
}

static reader find_reader(const char *path) {
    if (has_extension(path, ".stl")) return skg_mesh_read_stl;
    if (has_extension(path, ".obj")) return skg_mesh_read_obj;
    if (has_extension(path, ".off")) return skg_mesh_read_off;
    if (has_extension(path, ".ply")) return skg_mesh_read_ply;
    return NULL;
}

/* Files that hold no triangles: curved solids, and meshes with volume cells that Python reads. */
static skg_status refuse_kind(const char *path, FILE *stream) {
    static const char *const solids[] = {".step",   ".stp", ".iges", ".igs", ".brep",
                                         ".sldprt", ".ipt", ".x_t",  ".sat", ".prt"};
    static const char *const cells[] = {".vtk", ".vtu", ".vtp", ".msh", ".inp", ".med", ".exo"};
    char start[14] = "";
    const size_t length = fread(start, 1, sizeof start - 1, stream);
    rewind(stream);
    if (strncmp(start, "#VRML", 5) == 0 || strncmp(start, "#X3D V", 6) == 0)
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: is text of VRML, which is not read; convert it to .x3d (XML), .ply or .stl, for instance with "
            "MeshLab",
            path);
    int is_solid = length > 12 && memcmp(start, "ISO-10303-21;", 13) == 0 && !has_extension(path, ".ifc");
    for (size_t k = 0; k < sizeof solids / sizeof *solids; k++) is_solid |= has_extension(path, solids[k]);
    if (is_solid)
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: holds curved solids, not triangles; mesh it first, for instance with FreeCAD (Mesh > Create mesh from "
            "shape, then export STL) or gmsh (gmsh -2 FILE -o part.stl)",
            path);
    for (size_t k = 0; k < sizeof cells / sizeof *cells; k++)
        if (has_extension(path, cells[k]))
            return skg_fail(
                SKG_ERR_FORMAT,
                "%s: the command does not read %s; in Python, sk.Mesh.from_meshio(\"FILE\") does, volume cells by "
                "their skin; or `meshio convert FILE part.ply`",
                path, cells[k]);
    return SKG_OK;
}

static skg_status read_file(const char *path, skg_mesh_arrays *arrays) {
    FILE *stream;
    int64_t size = 0;
    SKG_TRY(open_file(path, &stream, &size));
    const reader read = find_reader(path);
    skg_status status = read ? SKG_OK : refuse_kind(path, stream);
    if (status == SKG_OK)
        status = read                          ? read_here(stream, path, size, read, arrays)
                 : has_extension(path, ".3mf") ? skg_mesh_read_3mf(stream, path, size, arrays)
                                               : read_by_assimp(stream, path, size, arrays);
    fclose(stream);
    return status;
}

static const char *name_of(const char *path) {
    const char *name = strrchr(path, '/');
    return name ? name + 1 : path;
}

int skg_mesh_is_shareable(const char *path) {
    return find_reader(path) != NULL;
}

skg_status skg_mesh_load_silently(const char *path, const skg_mesh_reading *reading, skg_loaded *loaded) {
    skg_mesh_arrays arrays = {.as_wound = reading->as_wound, .unit_mm = reading->unit_mm};
    *loaded = (skg_loaded){0};
    skg_status status = read_file(path, &arrays);
    if (status == SKG_OK && reading->group) status = skg_mesh_keep_group(&arrays, path, reading->group);
    if (status == SKG_OK && arrays.triangles > 0) status = skg_mesh_drop_unused(&arrays, path);
    if (status != SKG_OK) {
        skg_mesh_arrays_free(&arrays);
        return status;
    }
    arrays.unit_from = reading->unit_mm > 0      ? SKG_UNIT_NAMED
                       : arrays.file_unit_mm > 0 ? SKG_UNIT_FILE
                                                 : SKG_UNIT_ASSUMED;
    arrays.unit_mm = reading->unit_mm > 0      ? reading->unit_mm
                     : arrays.file_unit_mm > 0 ? arrays.file_unit_mm
                                               : 1;
    loaded->left_out = arrays.left_out;
    loaded->trailing = arrays.trailing;
    loaded->unused = reading->group ? 0 : arrays.unused;
    loaded->not_printed = arrays.not_printed;
    for (int64_t i = 0; i < 3 * arrays.vertices; i++) arrays.positions[i] *= arrays.unit_mm;
    return skg_mesh_adopt(NULL, name_of(path), &arrays, &loaded->mesh);
}

/* A unit that the caller names wins. */
static void note_unit(const skg_context *context, const skg_mesh *mesh) {
    char named[32], text[128];
    if (mesh->unit_from != SKG_UNIT_NAMED || mesh->file_unit_mm <= 0 || mesh->file_unit_mm == mesh->unit_mm)
        return;
    skg_unit_describe(mesh->file_unit_mm, named, sizeof named);
    skg_unit_contradict(mesh->unit_mm, named, text, sizeof text);
    skg_log(context, SKG_LOG_NOTE, "%s: %s", mesh->name, text);
}

void skg_mesh_load_warn(const skg_context *context, const char *path, const skg_loaded *loaded) {
    if (loaded->left_out > 0)
        skg_log(context, SKG_LOG_WARNING, "%s: %" PRId64 " points or lines left out", name_of(path),
                loaded->left_out);
    if (loaded->trailing > 0)
        skg_log(context, SKG_LOG_WARNING, "%s: %" PRId64 " bytes behind the last triangle are not read",
                name_of(path), loaded->trailing);
    if (loaded->not_printed > 0)
        skg_log(context, SKG_LOG_WARNING, "%s: %" PRId64 " objects of the type support or other left out",
                name_of(path), loaded->not_printed);
    if (!loaded->mesh) return;
    if (loaded->unused > 0)
        skg_log(context, SKG_LOG_NOTE, "%s: %" PRId64 " %s of no triangle left out", name_of(path),
                loaded->unused, skg_plural(loaded->unused, "vertex", "vertices"));
    skg_mesh_warn_turned(context, loaded->mesh);
    note_unit(context, loaded->mesh);
}

void skg_mesh_reading_init_sized(void *reading, int32_t size) {
    const skg_mesh_reading defaults = {0};
    skg_struct_init(reading, size, &defaults, sizeof defaults);
}

static skg_status load(skg_context *context, const char *call, const char *path,
                       const skg_mesh_reading *reading, skg_mesh **mesh) {
    SKG_PLAIN;
    skg_loaded loaded;
    skg_mesh_reading wanted;
    SKG_NEEDS_OF(call, mesh);
    *mesh = NULL;
    SKG_NEEDS_OF(call, path);
    skg_mesh_reading_init(&wanted);
    SKG_TRY(skg_struct_read(reading, "skg_mesh_reading", &wanted, sizeof wanted));
    if (!*path) return skg_fail(SKG_ERR_ARGUMENT, "the path of a mesh is empty; name a file");
    if (!isfinite(wanted.unit_mm) || wanted.unit_mm < 0)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: unit %g mm is not usable; give one that is finite and above 0",
                        path, wanted.unit_mm);
    if (wanted.as_wound < 0 || wanted.as_wound > 1)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: as_wound is %" PRId32 "; give 0 or 1", path, wanted.as_wound);
    const skg_status status = skg_mesh_load_silently(path, &wanted, &loaded);
    skg_mesh_load_warn(context, path, &loaded);
    *mesh = loaded.mesh;
    return status;
}

skg_status skg_mesh_load_as(skg_context *context, const char *path, const skg_mesh_reading *reading,
                            skg_mesh **mesh) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, load(context, "skg_mesh_load_as", path, reading, mesh));
}

skg_status skg_mesh_load(skg_context *context, const char *path, double unit_mm, skg_mesh **mesh) {
    const skg_mesh_reading reading = {.size = sizeof reading, .unit_mm = unit_mm};
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, load(context, "skg_mesh_load", path, &reading, mesh));
}
