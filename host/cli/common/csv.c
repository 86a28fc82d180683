/* Texts as fields of CSV (RFC 4180). */
#include "common/encode.h"

#include <string.h>

/* Whether a spreadsheet would take the text for a formula: it skips blanks before the first character. */
static int is_formula(const char *text) {
    text += strspn(text, " \t\r\n");
    return *text && strchr("=+-@|", *text);
}

void cli_csv_text(const char *text, FILE *stream) {
    fputs(is_formula(text) ? "\"'" : "\"", stream);
    for (; *text; text++) {
        if (*text == '"') fputc('"', stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
}
