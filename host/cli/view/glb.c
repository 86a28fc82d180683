/* The parts of a scene as a file for other viewers, glTF 2.0 in one file (.glb), written by Assimp. */
#include "view/pages.h"

#include "common/file.h"
#include "common/say.h"

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PROPERTIES = 5 };

/* A part in the structs of Assimp, whose memory is the writer's, not Assimp's. */
typedef struct {
    struct aiMesh mesh;
    struct aiNode node;
    struct aiMaterial material;
    struct aiMaterialProperty property[PROPERTIES], *list[PROPERTIES];
    struct aiMesh *shown;
    unsigned number; /* of the mesh */
    struct aiString name;
    float colour[4], opacity, dull, rough;
    struct aiFace *faces;
    unsigned *corners;
} item;

typedef struct {
    struct aiScene scene;
    struct aiNode root;
    item *items;
    struct aiMesh **meshes;
    struct aiMaterial **materials;
    struct aiNode **nodes;
} work;

static void name(struct aiString *to, const char *text) {
    const size_t length = strlen(text);
    to->length = (ai_uint32)(length < sizeof to->data - 1 ? length : sizeof to->data - 1);
    memcpy(to->data, text, to->length);
    to->data[to->length] = '\0';
}

static void add_property(item *i, const char *key, enum aiPropertyTypeInfo type, void *data, size_t size) {
    struct aiMaterialProperty *p = &i->property[i->material.mNumProperties];
    name(&p->mKey, key);
    p->mType = type, p->mData = data, p->mDataLength = (unsigned)size;
    i->list[i->material.mNumProperties++] = p;
}

/* glTF has linear colours; ours are sRGB's (IEC 61966-2-1). */
static float linear(uint8_t grey) {
    const double s = grey / 255.0;
    return (float)(s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4));
}

static void paint(item *i, const uint8_t *colour) {
    for (int k = 0; k < 3; k++) i->colour[k] = linear(colour[k]);
    i->colour[3] = 1, i->opacity = colour[3] / 255.0F, i->dull = 0, i->rough = 1;
    i->material.mProperties = i->list, i->material.mNumAllocated = PROPERTIES;
    add_property(i, "?mat.name", aiPTI_String, &i->name, sizeof i->name.length + i->name.length + 1);
    add_property(i, "$clr.base", aiPTI_Float, i->colour, sizeof i->colour);
    add_property(i, "$mat.opacity", aiPTI_Float, &i->opacity, sizeof i->opacity);
    add_property(i, "$mat.metallicFactor", aiPTI_Float, &i->dull, sizeof i->dull);
    add_property(i, "$mat.roughnessFactor", aiPTI_Float, &i->rough, sizeof i->rough);
}

static int fill(const view_shape *shape, unsigned number, const char *label, item *i) {
    const int64_t triangles = shape->surface.triangles;
    struct aiMesh *mesh = &i->mesh;
    i->faces = calloc((size_t)triangles + 1, sizeof *i->faces);
    i->corners = calloc((size_t)triangles + 1, 3 * sizeof *i->corners);
    if (!i->faces || !i->corners) return cli_error(CLI_DEVICE, "out of host memory for %s", label);
    for (int64_t t = 0; t < triangles; t++) {
        for (int k = 0; k < 3; k++) i->corners[3 * t + k] = (unsigned)shape->surface.corners[3 * t + k];
        i->faces[t] = (struct aiFace){.mNumIndices = 3, .mIndices = i->corners + 3 * t};
    }
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mNumVertices = (unsigned)shape->surface.vertices;
    mesh->mNumFaces = (unsigned)triangles;
    mesh->mVertices = (struct aiVector3D *)(void *)shape->positions;
    mesh->mFaces = i->faces;
    mesh->mMaterialIndex = number;
    name(&mesh->mName, label);
    name(&i->node.mName, label);
    name(&i->name, label);
    aiIdentityMatrix4(&i->node.mTransformation);
    i->number = number;
    i->node.mNumMeshes = 1, i->node.mMeshes = &i->number;
    return CLI_DONE;
}

/* Metres, and y is up in glTF: the node of all parts turns z up into it. */
static void place(work *g, unsigned count) {
    struct aiMatrix4x4 *m = &g->root.mTransformation;
    const float metre = 1e-3F;
    m->a1 = metre, m->b3 = metre, m->c2 = -metre, m->d4 = 1;
    name(&g->root.mName, "skiagraph");
    g->root.mNumChildren = count, g->root.mChildren = g->nodes;
    g->scene.mRootNode = &g->root;
    g->scene.mNumMeshes = g->scene.mNumMaterials = count;
    g->scene.mMeshes = g->meshes, g->scene.mMaterials = g->materials;
}

static int build(const view_work *w, const view_shapes *shapes, work *g) {
    const size_t count = (size_t)shapes->count;
    uint8_t *colours = malloc(4 * count + 1);
    g->items = calloc(count + 1, sizeof *g->items);
    g->meshes = calloc(count + 1, sizeof(struct aiMesh *));
    g->materials = calloc(count + 1, sizeof(struct aiMaterial *));
    g->nodes = calloc(count + 1, sizeof(struct aiNode *));
    if (!colours || !g->items || !g->meshes || !g->materials || !g->nodes) {
        free(colours);
        return cli_error(CLI_DEVICE, "out of host memory for the parts");
    }
    const skg_status status = skg_look_colours_get(w->session.scene, colours);
    int exit_status = status == SKG_OK ? CLI_DONE : cli_fail(status);
    for (size_t p = 0; p < count && exit_status == CLI_DONE; p++) {
        const char *label = "";
        item *i = &g->items[p];
        skg_scene_part_label_get(w->session.scene, (int64_t)p, &label);
        exit_status = fill(&shapes->shapes[p], (unsigned)p, label, i);
        paint(i, colours + 4 * p);
        i->node.mParent = &g->root;
        g->meshes[p] = &i->mesh, g->materials[p] = &i->material, g->nodes[p] = &i->node;
    }
    place(g, (unsigned)count);
    free(colours);
    return exit_status;
}

int view_write_glb(view_work *w, const char *path) {
    view_shapes shapes = {0};
    work g = {0};
    int exit_status = view_shapes_make(w->session.scene, 1, INT64_MAX, &shapes);
    if (exit_status == CLI_DONE) exit_status = view_shapes_take(w->session.scene, 0, &shapes);
    if (exit_status == CLI_DONE) exit_status = build(w, &shapes, &g);
    if (exit_status == CLI_DONE) {
        const struct aiExportDataBlob *blob = aiExportSceneToBlob(&g.scene, "glb2", 0);
        exit_status =
            blob ? cli_write_file(path, blob->data, blob->size)
                 : cli_error(CLI_OUTPUT, "%s: cannot be written: Assimp: %s", path, aiGetErrorString());
        if (blob) aiReleaseExportBlob(blob);
    }
    for (int64_t p = 0; g.items && p < shapes.count; p++) {
        free(g.items[p].faces);
        free(g.items[p].corners);
    }
    free(g.items);
    free(g.meshes);
    free(g.materials);
    free(g.nodes);
    view_shapes_free(&shapes);
    return exit_status;
}
