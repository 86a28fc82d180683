/* Compiled programs in the user's folder: taken from there, and kept there. */
#include "device/cache.h"
#include "device/programs.h"

#include <string.h>

skg_digest skg_binary_key(const skg_device *device, const skg_program_text *text) {
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add(&digester, device->identity.bytes, sizeof device->identity.bytes);
    skg_digest_add_text(&digester, text->options);
    for (int32_t i = 0; i < text->files; i++) {
        skg_digest_add_text(&digester, text->names[i]);
        skg_digest_add_text(&digester, text->digests[i]);
    }
    return skg_digest_end(&digester);
}

cl_program skg_binary_load(skg_device *device, const skg_digest *key, const char *options) {
    void *data = NULL;
    int64_t bytes = 0;
    cl_int code = CL_SUCCESS, loaded = CL_SUCCESS;
    if (!skg_store_read(device->store, key, SKG_KEPT_PROGRAM, &data, &bytes)) return NULL;
    const size_t size = (size_t)bytes;
    const unsigned char *binary = data;
    cl_program program =
        clCreateProgramWithBinary(device->cl, 1, &device->id, &size, &binary, &loaded, &code);
    if (code == CL_SUCCESS && loaded == CL_SUCCESS)
        code = clBuildProgram(program, 1, &device->id, options, NULL, NULL);
    skg_free(&data);
    if (code == CL_SUCCESS && loaded == CL_SUCCESS) return program;
    if (program) clReleaseProgram(program);
    skg_store_remove(device->store, key, SKG_KEPT_PROGRAM);
    return NULL;
}

void skg_binary_save(const skg_device *device, const skg_digest *key, cl_program program) {
    size_t size = 0;
    unsigned char *binary = NULL;
    cl_uint devices = 0;
    /* A program of the caller's context may have several devices; then there are several binaries. */
    if (clGetProgramInfo(program, CL_PROGRAM_NUM_DEVICES, sizeof devices, &devices, NULL) != CL_SUCCESS ||
        devices != 1)
        return;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL) != CL_SUCCESS ||
        size == 0)
        return;
    if (skg_alloc((int64_t)size, 1, "compiled kernels", &binary) != SKG_OK) return;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof(unsigned char *), &binary, NULL) == CL_SUCCESS)
        skg_store_write(device->store, key, SKG_KEPT_PROGRAM, binary, (int64_t)size);
    skg_free(&binary);
}

int skg_binary_pays(const skg_device *device, const skg_digest *key) {
    void *data = NULL;
    int64_t bytes = 0;
    int32_t uses = 0;
    if (!device->caches) return 1;
    if (skg_store_read(device->store, key, SKG_KEPT_USES, &data, &bytes) && bytes == (int64_t)sizeof uses)
        memcpy(&uses, data, sizeof uses);
    skg_free(&data);
    if (++uses >= SKG_USES_THAT_PAY) {
        skg_store_remove(device->store, key, SKG_KEPT_USES);
        return 1;
    }
    skg_store_write(device->store, key, SKG_KEPT_USES, &uses, sizeof uses);
    return 0;
}
