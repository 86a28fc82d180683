/* Prints manuals, and the overview of all verbs. */
#include "manual/manual.h"

#include <string.h>

enum { WIDTH = 80, COLUMN = 21, LONGEST_HEAD = 128 };

/* Prints words up to the width; lines after the first begin at `indent`. column: where the first one begins. */
static void put_paragraph(const char *text, int indent, int column, FILE *stream) {
    int is_first = 1;
    while (*text) {
        const int length = (int)strcspn(text, " ");
        if (!is_first && column + 1 + length > WIDTH) {
            fprintf(stream, "\n%*s", indent, "");
            column = indent;
        } else if (!is_first) {
            fputc(' ', stream);
            column++;
        }
        fprintf(stream, "%.*s", length, text);
        column += length;
        text += length + (text[length] == ' ');
        is_first = 0;
    }
    fputc('\n', stream);
}

/* Two columns; the second begins on a line of its own if the first is too long. */
static void put_row(const char *head, const char *text, int left, int right, FILE *stream) {
    if (left + (int)strlen(head) + 2 > right)
        fprintf(stream, "%*s%s\n%*s", left, "", head, right, "");
    else
        fprintf(stream, "%*s%-*s", left, "", right - left, head);
    put_paragraph(text, right, right, stream);
}

static void put_items(const char *title, const cli_item *items, FILE *stream) {
    if (!items) return;
    fprintf(stream, "\n%s:\n", title);
    for (; items->name; items++) put_row(items->name, items->meaning, 2, COLUMN, stream);
}

static void put_flag(const cli_flag *flag, FILE *stream) {
    char argument[LONGEST_HEAD], head[LONGEST_HEAD + 32];
    cli_flag_argument(flag, argument, sizeof argument);
    snprintf(head, sizeof head, "%s%s%s", flag->name, *argument ? " " : "", argument);
    put_row(head, flag->meaning, 2, COLUMN, stream);
    for (const cli_item *value = flag->values; value && value->name; value++)
        put_row(value->name, value->meaning, COLUMN + 2, COLUMN + 18, stream);
}

/* check: the one of a verb; NULL: it has none, and cannot end with status 1. */
static void put_statuses(const char *check, int is_overview, FILE *stream) {
    fprintf(stream, "\nexit status:\n");
    for (const cli_item *status = cli_exit_statuses; status->name; status++) {
        const int is_check = strcmp(status->name, "1") == 0;
        char text[128];
        if (is_check && !check && !is_overview) continue;
        snprintf(text, sizeof text, "A check failed: %s.", check ? check : "");
        put_row(status->name, is_check && check ? text : status->meaning, 2, 5, stream);
    }
}

void cli_help_overview(FILE *stream) {
    char head[64];
    fprintf(stream, "usage: skiagraph VERB ...\n%s.\n\nverbs:\n", cli_summary);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) {
        snprintf(head, sizeof head, "%s %s", (*manual)->name, (*manual)->operands);
        put_row(head, (*manual)->summary, 2, COLUMN, stream);
    }
    for (const cli_item *verb = cli_other_verbs; verb->name; verb++)
        put_row(verb->name, verb->meaning, 2, COLUMN, stream);
    fputs("\n`skiagraph help VERB` lists the flags of a verb.\n", stream);
    put_statuses(NULL, 1, stream);
}

void cli_help_verb(const cli_manual *manual, FILE *stream) {
    fprintf(stream, "usage: skiagraph %s %s%s%s%s[FLAGS]\n%s\n", manual->name, manual->operands,
            *manual->operands ? " " : "", manual->required ? manual->required : "",
            manual->required ? " " : "", manual->summary);
    for (const char *const *text = manual->text; *text; text++) {
        fputc('\n', stream);
        put_paragraph(*text, 0, 0, stream);
    }
    fputs("\nflags:\n", stream);
    for (const cli_flag *const *flag = manual->flags; *flag; flag++) put_flag(*flag, stream);
    put_flag(&cli_flag_help, stream);
    put_items("files", manual->files, stream);
    if (manual->examples) fputs("\nexamples:\n", stream);
    for (const cli_item *example = manual->examples; example && example->name; example++) {
        fprintf(stream, "  %s\n%*s", example->name, COLUMN, "");
        put_paragraph(example->meaning, COLUMN, COLUMN, stream);
    }
    put_statuses(manual->check, 0, stream);
}
