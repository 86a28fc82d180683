/* Completion for zsh, by _arguments. */
#include "pages/pages.h"

#include "manual/manual.h"

#include <string.h>

/* Text inside of single quotes, with the characters that _arguments and _describe read escaped. */
static void put_quoted(const char *text, size_t length, FILE *stream) {
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\'') {
            fputs("'\\''", stream);
            continue;
        }
        if (strchr("[]:\\", text[i])) fputc('\\', stream);
        fputc(text[i], stream);
    }
}

/* The first sentence, without its full stop. */
static size_t sentence_length(const char *text) {
    const char *end = strstr(text, ". ");
    const size_t length = end ? (size_t)(end - text) : strlen(text);
    return length > 0 && text[length - 1] == '.' ? length - 1 : length;
}

static const char *action_of(int names) {
    static const char *const actions[] = {
        [CLI_NAMES_NOTHING] = "",
        [CLI_NAMES_FILE] = "_files",
        [CLI_NAMES_OUTPUT] = "_files",
        [CLI_NAMES_FOLDER] = "_files -/",
        [CLI_NAMES_KEY] = "{compadd -S \"\" -- ${(f)\"$(skiagraph schema --paths 2>/dev/null)\"}}",
        [CLI_NAMES_SCENE] = "_files -g \"*.json\""};
    return actions[names];
}

/* A flag as _arguments takes it: *--name=[meaning]:ARGUMENT:action. The star: it may be repeated. The equals
 * sign: the value may follow one, or be a word of its own. */
static void put_flag(const cli_flag *flag, FILE *stream) {
    char argument[128];
    fprintf(stream, "            '*%s%s[", flag->name,
            cli_flag_has_value(flag) && strncmp(flag->name, "--", 2) == 0 ? "=" : "");
    put_quoted(flag->meaning, sentence_length(flag->meaning), stream);
    fputc(']', stream);
    if (cli_flag_has_value(flag)) {
        cli_flag_argument(flag, argument, sizeof argument);
        fputc(':', stream);
        put_quoted(argument, strlen(argument), stream);
        fputc(':', stream);
        if (flag->values) {
            fputc('(', stream);
            for (const cli_item *value = flag->values; value->name; value++)
                fprintf(stream, "%s%s", value == flag->values ? "" : " ", value->name);
            fputc(')', stream);
        } else {
            fputs(action_of(flag->names), stream);
        }
    }
    fputs("' \\\n", stream);
}

static void put_verb(const cli_manual *manual, FILE *stream) {
    fprintf(stream, "    %s)\n        _arguments \\\n", manual->name);
    for (const cli_flag *const *flag = manual->flags; *flag; flag++) put_flag(*flag, stream);
    put_flag(&cli_flag_help, stream);
    if (manual->most != 0)
        fprintf(stream, "            '%s:%s:%s'\n", manual->most < 0 ? "*" : "1", manual->operands,
                action_of(manual->names));
    else
        fputs("            && return 0\n", stream);
    fputs("        ;;\n", stream);
}

void pages_zsh(FILE *stream) {
    fputs("#compdef skiagraph\n"
          "# Completion of skiagraph for zsh.\n"
          "_skiagraph() {\n"
          "    local -a verbs\n"
          "    verbs=(\n",
          stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) {
        fprintf(stream, "        '%s:", (*manual)->name);
        put_quoted((*manual)->summary, strlen((*manual)->summary), stream);
        fputs("'\n", stream);
    }
    for (const cli_item *verb = cli_other_verbs; verb->name; verb++) {
        fprintf(stream, "        '%s:", verb->name);
        put_quoted(verb->meaning, strlen(verb->meaning), stream);
        fputs("'\n", stream);
    }
    fputs("    )\n"
          "    if (( CURRENT == 2 )) || [[ $words[2] == help && CURRENT -eq 3 ]]; then\n"
          "        _describe -t verbs verb verbs\n"
          "        return\n"
          "    fi\n"
          "    shift words # _arguments begins at the verb\n"
          "    (( CURRENT-- ))\n"
          "    case $words[1] in\n",
          stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) put_verb(*manual, stream);
    fputs("    esac\n}\n\n_skiagraph \"$@\"\n", stream);
}
