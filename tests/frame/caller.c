/* A caller with OpenCL objects of its own, and a cube of 20 mm with a ball inside. */
#include "caller.h"
#include "suite.h"

static void make_cl(caller *c, size_t bytes) {
    cl_platform_id platforms[8];
    cl_device_id device = NULL;
    cl_uint count = 0;
    cl_int code = CL_DEVICE_NOT_FOUND;
    ck_assert_int_eq(clGetPlatformIDs(8, platforms, &count), CL_SUCCESS);
    for (cl_uint n = 0; n < count && code != CL_SUCCESS; n++)
        code = clGetDeviceIDs(platforms[n], CL_DEVICE_TYPE_ALL, 1, &device, NULL);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->device = device;
    c->cl = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->queue = clCreateCommandQueue(c->cl, device, 0, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    c->buffer = clCreateBuffer(c->cl, CL_MEM_READ_WRITE, bytes, NULL, &code);
    ck_assert_int_eq(code, CL_SUCCESS);
    ck_skg(skg_context_create_cl(c->cl, device, c->queue, &c->context));
}

void add_part(caller *c, const char *label, skg_mesh *mesh, double mu, int64_t inside) {
    skg_part part;
    skg_material *material = NULL;
    ck_skg(skg_material_create_mu(label, mu, &material));
    skg_part_init(&part);
    part.label = label;
    part.mesh = mesh;
    part.material = material;
    part.inside = inside;
    ck_skg(skg_scene_part_add(c->scene, &part, NULL));
    skg_material_release(&material);
    skg_mesh_release(&mesh);
}

void open_caller(caller *c, size_t bytes, const skg_plan_options *options) {
    skg_mesh *cube = NULL, *ball = NULL;
    skg_spectrum *beam = NULL;
    *c = (caller){0};
    make_cl(c, bytes);
    ck_skg(skg_scene_create(c->context, &c->scene));
    ck_skg(skg_mesh_create_cube(20, &cube));
    ck_skg(skg_mesh_create_sphere(6, 24, &ball));
    add_part(c, "cube", cube, 0.2, -1);
    add_part(c, "ball", ball, 0.5, 0);
    skg_view_init(&c->view);
    c->view.columns = c->view.rows = SIDE;
    c->view.source[2] = -500;
    c->view.centre[2] = 100;
    c->view.column_step[0] = c->view.row_step[1] = 1;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(c->context, c->scene, &c->view, beam, options, &c->plan));
    skg_spectrum_release(&beam);
}

void close_caller(caller *c) {
    skg_plan_release(&c->plan);
    skg_scene_release(&c->scene);
    skg_context_release(&c->context);
    clReleaseMemObject(c->buffer);
    clReleaseCommandQueue(c->queue);
    clReleaseContext(c->cl);
}

skg_output output_of(void *data) {
    skg_output output;
    skg_output_init(&output);
    output.data = data;
    return output;
}
