/* The sources of the kernels, built in. kernels/CMakeLists.txt makes the table. Private. */
#ifndef SKG_SOURCES_H
#define SKG_SOURCES_H

typedef struct {
    const char *name; /* "raster.cl" */
    const char *text;
    const char *digest; /* SHA-256 of the text, in hexadecimal */
} skg_kernel_source;

extern const skg_kernel_source skg_kernel_sources[];
extern const int skg_kernel_source_count;
extern const char skg_kernel_sources_digest[]; /* SHA-256 of names and contents, in hexadecimal */

#endif
