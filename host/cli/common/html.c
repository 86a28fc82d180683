/* Text within pages. */
#include "common/encode.h"

void cli_html_text(const char *text, FILE *page) {
    for (; *text; text++) {
        if (*text == '<')
            fputs("&lt;", page);
        else if (*text == '&')
            fputs("&amp;", page);
        else if (*text == '"')
            fputs("&quot;", page);
        else
            fputc(*text, page);
    }
}
