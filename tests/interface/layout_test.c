/* lib/bindings/interface.json is what the headers say: values, offsets, sizes, types. Functions and enumerators that
 * the list lacks are found by symbols.cmake. */
#include "interface/layout.h"
#include "suite.h"

#include <string.h>

#define ANEW "; make the list anew: cmake --build BUILD --target interface_list"

START_TEST(values_are_listed) {
    for (const listed_value *v = listed_values; v->name; v++)
        ck_assert_msg(v->value == v->listed_value, "%s is %d, listed as %d" ANEW, v->name, v->value,
                      v->listed_value);
}
END_TEST

/* Without gaps from `size` to the end: a field that the list lacks would leave one, and padding would be bytes that
 * nobody sets. */
START_TEST(fields_are_listed) {
    const listed_field *f = listed_fields;
    for (const listed_struct *s = listed_structs; s->name; s++) {
        size_t end = 0;
        ck_assert_msg(s->size == s->listed_size, "%s has %zu bytes, listed with %zu" ANEW, s->name, s->size,
                      s->listed_size);
        ck_assert_msg(!strcmp(f->of, s->name) && !strcmp(f->name, "size"), "%s does not begin with size",
                      s->name);
        for (; f->of && !strcmp(f->of, s->name); f++) {
            ck_assert_msg(f->offset == f->listed_offset && f->size == f->listed_size &&
                              f->size == f->type_size,
                          "%s.%s is at %zu with %zu bytes, listed at %zu with %zu" ANEW, s->name, f->name,
                          f->offset, f->size, f->listed_offset, f->listed_size);
            ck_assert_msg(f->offset == end,
                          "%s has bytes before %s that are no field, or the list lacks it" ANEW, s->name,
                          f->name);
            end = f->offset + f->size;
        }
        ck_assert_msg(s->size == end, "%s has bytes behind its last listed field" ANEW, s->name);
    }
    ck_assert_ptr_null(f->of);
}
END_TEST

static int ends_with(const char *name, const char *end) {
    const size_t length = strlen(name), tail = strlen(end);
    return length >= tail && !strcmp(name + length - tail, end);
}

/* But for what error.h excepts. */
START_TEST(functions_return_a_status) {
    static const char *const excepted[] = {"skg_last_cl_error", "skg_last_error",  "skg_lung_hounsfield",
                                           "skg_status_name",   "skg_status_text", "skg_version",
                                           "skg_version_number"};
    listed_types();
    for (const listed_function *f = listed_functions; f->name; f++) {
        int is_excepted = 0;
        for (size_t i = 0; i < sizeof excepted / sizeof *excepted; i++)
            is_excepted |= !strcmp(f->name, excepted[i]);
        if (ends_with(f->name, "_init_sized") || ends_with(f->name, "_release"))
            ck_assert_msg(!strcmp(f->returns, "void"), "%s", f->name);
        else
            ck_assert_msg(is_excepted != !strcmp(f->returns, "skg_status"), "%s returns %s", f->name,
                          f->returns);
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, values_are_listed);
    tcase_add_test(tests, fields_are_listed);
    tcase_add_test(tests, functions_return_a_status);
}

SKG_SUITE_MAIN("interface layout", add_tests)
