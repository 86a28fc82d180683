/* A caller's decimal comma changes no file, no name and no sentence, and is as it was after the calls. */
#include "everything.h"
#include "suite.h"
#include "support/run.h"

#include <locale.h>
#include <string.h>

static char folder[] = "/tmp/skg_locale_XXXXXX";

/* Makes a German locale in a folder of its own; 0: this system has no means. */
static int set_comma(void) {
    char command[160];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >%s/log 2>&1", folder,
             folder);
    const int made = system(command) >= 0 && setenv("LOCPATH", folder, 1) == 0 &&
                     setlocale(LC_ALL, "de_DE.UTF-8") && strcmp(localeconv()->decimal_point, ",") == 0;
    snprintf(command, sizeof command, "rm -r %s", folder);
    ck_assert_int_eq(system(command), 0);
    return made;
}

START_TEST(decimal_comma) {
    static everything point, comma;
    skg_spectrum *beam = NULL;
    char number[16];
    run_open();
    do_everything(&point);
    if (!set_comma()) {
        run_close();
        skip_test("no locale with a decimal comma can be made here");
    }
    do_everything(&comma);
    ck_skg_fails(skg_spectrum_create_mono(-0.5, 1, &beam), SKG_ERR_BEAM, "-0.5 keV");
    run_close();
    snprintf(number, sizeof number, "%g", 0.5);
    ck_assert_str_eq(number, "0,5");
    ck_assert_str_eq(comma.material, "HU -741.5");
    ck_assert_ptr_nonnull(strstr(comma.channel, "55.5"));
    ck_assert_int_eq(memcmp(&comma, &point, sizeof point), 0);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, decimal_comma);
}

SKG_SUITE_MAIN("locale", add_tests)
