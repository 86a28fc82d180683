/* Man pages in the macros of man(7). */
#include "pages/pages.h"

#include "manual/manual.h"

#include <ctype.h>
#include <string.h>

/* Text of ours with what roff would take for its own escaped: `word` becomes bold, a hyphen of a flag stays
 * one. */
static void put_text(const char *text, FILE *stream) {
    int is_bold = 0;
    if (*text == '.' || *text == '\'') fputs("\\&", stream);
    for (; *text; text++) {
        if (*text == '`') {
            fputs(is_bold ? "\\fR" : "\\fB", stream);
            is_bold = !is_bold;
        } else if (*text == '\\') {
            fputs("\\e", stream);
        } else if (*text == '-') {
            fputs("\\-", stream);
        } else {
            fputc(*text, stream);
        }
    }
}

static void put_line(const char *text, FILE *stream) {
    put_text(text, stream);
    fputc('\n', stream);
}

static void put_section(const char *title, FILE *stream) {
    fprintf(stream, ".SH %s\n", title);
}

static void put_items(const cli_item *items, FILE *stream) {
    for (; items->name; items++) {
        fputs(".TP\n\\fB", stream);
        put_text(items->name, stream);
        fputs("\\fR\n", stream);
        put_line(items->meaning, stream);
    }
}

static void put_paragraphs(const char *const *text, FILE *stream) {
    for (int i = 0; text[i]; i++) {
        if (i > 0) fputs(".PP\n", stream);
        put_line(text[i], stream);
    }
}

static void put_flag(const cli_flag *flag, FILE *stream) {
    char argument[128];
    cli_flag_argument(flag, argument, sizeof argument);
    fputs(".TP\n\\fB", stream);
    put_text(flag->name, stream);
    fputs("\\fR", stream);
    if (*argument) {
        fputs(" \\fI", stream);
        put_text(argument, stream);
        fputs("\\fR", stream);
    }
    fputc('\n', stream);
    put_line(flag->meaning, stream);
    if (!flag->values) return;
    fputs(".RS\n", stream);
    put_items(flag->values, stream);
    fputs(".RE\n", stream);
}

/* has_check: also status 1. check: what it stands for, or NULL. */
static void put_statuses(int has_check, const char *check, FILE *stream) {
    put_section("EXIT STATUS", stream);
    for (const cli_item *status = cli_exit_statuses; status->name; status++) {
        const int is_check = strcmp(status->name, "1") == 0;
        if (is_check && !has_check) continue;
        fprintf(stream, ".TP\n\\fB%s\\fR\n", status->name);
        if (is_check && check)
            fprintf(stream, "A check failed: %s.\n", check);
        else
            put_line(status->meaning, stream);
    }
}

static void put_examples(const cli_item *examples, FILE *stream) {
    if (!examples) return;
    put_section("EXAMPLES", stream);
    for (; examples->name; examples++) {
        fputs(".TP\n\\fB", stream);
        put_text(examples->name, stream);
        fputs("\\fR\n", stream);
        fputc(toupper((unsigned char)examples->meaning[0]), stream);
        put_text(examples->meaning + 1, stream);
        fputs(".\n", stream);
    }
}

void pages_man_verb(const cli_manual *manual, const char *version, FILE *stream) {
    char name[64] = "";
    for (size_t i = 0; manual->name[i] && i < sizeof name - 1; i++)
        name[i] = (char)toupper((unsigned char)manual->name[i]);
    fprintf(stream, ".TH SKIAGRAPH\\-%s 1 \"\" \"Skiagraph %s\" \"User Commands\"\n", name, version);
    put_section("NAME", stream);
    fprintf(stream, "skiagraph\\-%s \\- ", manual->name);
    put_line(manual->summary, stream);
    put_section("SYNOPSIS", stream);
    fprintf(stream, "\\fBskiagraph %s\\fR ", manual->name);
    if (*manual->operands) fprintf(stream, "\\fI%s\\fR ", manual->operands);
    if (manual->required) {
        put_text(manual->required, stream);
        fputc(' ', stream);
    }
    fputs("[\\fIFLAGS\\fR]\n", stream);
    put_section("DESCRIPTION", stream);
    put_paragraphs(manual->text, stream);
    put_section("OPTIONS", stream);
    for (const cli_flag *const *flag = manual->flags; *flag; flag++) put_flag(*flag, stream);
    put_flag(&cli_flag_help, stream);
    put_statuses(manual->check != NULL, manual->check, stream);
    if (manual->has_device) {
        put_section("ENVIRONMENT", stream);
        put_items(cli_environment, stream);
    }
    if (manual->files) {
        put_section("FILES", stream);
        put_items(manual->files, stream);
    }
    put_examples(manual->examples, stream);
    put_section("SEE ALSO", stream);
    fputs(".BR skiagraph (1)\n", stream);
}

void pages_man_command(const char *version, FILE *stream) {
    fprintf(stream, ".TH SKIAGRAPH 1 \"\" \"Skiagraph %s\" \"User Commands\"\n", version);
    put_section("NAME", stream);
    fputs("skiagraph \\- ", stream);
    put_line(cli_summary, stream);
    put_section("SYNOPSIS", stream);
    fputs("\\fBskiagraph\\fR \\fIVERB\\fR ...\n", stream);
    put_section("DESCRIPTION", stream);
    put_paragraphs(cli_text, stream);
    put_section("VERBS", stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) {
        fprintf(stream, ".TP\n\\fB%s\\fR%s\\fI%s\\fR\n", (*manual)->name, *(*manual)->operands ? " " : "",
                (*manual)->operands);
        put_line((*manual)->summary, stream);
    }
    put_items(cli_other_verbs, stream);
    put_statuses(1, NULL, stream);
    put_section("ENVIRONMENT", stream);
    put_items(cli_environment, stream);
    put_section("SEE ALSO", stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++)
        fprintf(stream, ".BR skiagraph\\-%s (1)%s\n", (*manual)->name, manual[1] ? "," : "");
}
