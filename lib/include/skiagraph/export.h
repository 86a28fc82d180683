/** @file
 * Which names leave the library, and the rule that all structs of the interface obey.
 *
 * Every struct that a caller passes begins with `int32_t size`, the number of bytes that the caller's program
 * knows. skg_X_init sets it and writes the defaults; the library then reads and writes that many bytes only.
 * It is an inline function, so that the size is that of the header which the program was compiled with; it
 * calls skg_X_init_sized, which a binding for another language calls with the size of its own struct.
 *
 * - An older program, whose struct is shorter, runs with a newer library: the library takes its defaults for
 *   the fields that the program does not have.
 * - A newer program runs with an older library as long as the fields that this library does not know are 0.
 *   Otherwise the call fails with SKG_ERR_ARGUMENT.
 * - The elements of an array of structs lie as far apart as the first element's size says, and all have the
 *   same size.
 * - No struct contains another one by value.
 *
 * Whoever extends the library adds a field at the end of its struct, and gives 0 the meaning of what the
 * library did before. A default other than 0 is possible for the fields of the first release only.
 *
 * A name is as old as the comment at the head of its header says (since), or its own comment if that says it.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_EXPORT_H
#define SKIAGRAPH_EXPORT_H

#include <stdint.h>

#if defined(__GNUC__)
/** Marks a function that programs may call. All other names stay inside the library. */
#define SKG_API __attribute__((visibility("default")))
#else
/** Marks a function that programs may call. */
#define SKG_API
#endif

/** Declares the two functions that prepare a struct of the interface. In C++ as in C. */
#define SKG_INIT(type)                                                                                       \
    SKG_API void type##_init_sized(void *object, int32_t size);                                              \
    static inline void type##_init(type *object) {                                                           \
        type##_init_sized(object, (int32_t)sizeof *object);                                                  \
    }

#endif
