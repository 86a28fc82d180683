/* The base of every room of the library: errors, checked allocation, reference counts. Private. */
#ifndef SKG_CORE_H
#define SKG_CORE_H

#include <skiagraph/error.h>

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

/* Sets the thread's last error to the formatted sentence and returns status, so that a failure is one line:
 *     return skg_fail(SKG_ERR_MESH, "%s: no triangles", name); */
skg_status skg_fail(skg_status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Control characters become question marks: names in files may hold any, and a sentence is one line. */
void skg_one_line(char *sentence);

/* Returns from the calling function when the call failed or is stale. */
#define SKG_TRY(call)                                                                                        \
    do {                                                                                                     \
        skg_status skg_try_status = (call);                                                                  \
        if (skg_try_status != SKG_OK) return skg_try_status;                                                 \
    } while (0)

/* At the start of a public call: returns SKG_ERR_ARGUMENT when the argument is NULL. The sentence names the call
 * and the argument as the header has them: "skg_plan_view_set: the argument view is NULL". */
#define SKG_NEEDS(argument) SKG_NEEDS_OF(__func__, argument)

/* SKG_NEEDS for a function that a public one calls, whose name is given. */
#define SKG_NEEDS_OF(call, argument)                                                                         \
    do {                                                                                                     \
        if (!(argument)) return skg_fail(SKG_ERR_ARGUMENT, "%s: the argument %s is NULL", call, #argument);  \
    } while (0)

/* Like SKG_TRY, but leaves by the label `cleanup` with the local `status` set. */
#define SKG_TRY_CLEANUP(call)                                                                                \
    do {                                                                                                     \
        status = (call);                                                                                     \
        if (status != SKG_OK) goto cleanup;                                                                  \
    } while (0)

/* A precondition of a private call: what its comment asks of the caller, and no input can break. Builds with SKG_ASSERTIONS, as
 * ./check's, end the process with the place where it does not hold; in others the condition is read and not computed. */
#ifdef SKG_ASSERTIONS
_Noreturn void skg_assertion_failed(const char *condition, const char *file, int line);
#define SKG_ASSERT(condition) ((condition) ? (void)0 : skg_assertion_failed(#condition, __FILE__, __LINE__))
#else
#define SKG_ASSERT(condition) ((void)sizeof(!(condition)))
#endif

/* Stores the address of count * size zeroed bytes in the pointer at pointer_address, which may be of any object type.
 * The product is checked. A count of 0 gives a pointer that can be freed. what: for the message. */
skg_status skg_alloc(int64_t count, size_t size, const char *what, void *pointer_address);

/* Grows or shrinks the block at *pointer_address to count * size bytes. On failure the old block stays. New bytes are
 * not zeroed. */
skg_status skg_realloc(int64_t count, size_t size, const char *what, void *pointer_address);

/* Frees the block and sets the pointer at pointer_address to NULL; it may be NULL already. */
void skg_free(void *pointer_address);

/* Copies a text into memory of its own, which the caller frees. NULL gives NULL. */
skg_status skg_copy_text(const char *text, char **copy);

/* The number of owners of a handle. It starts at 1; skg_unref returns 1 when the last owner is gone. */
typedef struct {
    atomic_int owners;
} skg_refs;

void skg_refs_init(skg_refs *refs);
void skg_ref(skg_refs *refs);
int skg_unref(skg_refs *refs);

/* Implements every exported skg_X_init_sized: zeroes `size` bytes of the caller's struct, writes those of our
 * defaults that fit, and stores size in its first field. NULL or a size that holds no size field: nothing. */
void skg_struct_init(void *theirs, int32_t size, const void *defaults, size_t our_size);

/* Structs that callers fill start with int32_t size. Copies the caller's struct over our defaults: a smaller
 * size leaves our newer fields as they are; a larger one is refused unless its unknown tail is zero. name:
 * for the message. */
skg_status skg_struct_read(const void *theirs, const char *name, void *ours, size_t our_size);

/* Reads element `index` of an array as skg_struct_read does; elements lie as far apart as the first one's size says. An
 * element of another size was not prepared like the first, and is refused. */
skg_status skg_struct_read_at(const void *array, int64_t index, const char *name, void *ours,
                              size_t our_size);

/* The other way, for structs that the library fills: at most theirs->size bytes, the size field kept. */
skg_status skg_struct_write(const void *ours, size_t our_size, const char *name, void *theirs);

#endif
