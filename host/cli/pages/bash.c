/* Completion for bash: a function that looks at the verb and at the word before the cursor. */
#include "pages/pages.h"

#include "manual/manual.h"

static void put_words(const cli_item *items, FILE *stream) {
    for (const cli_item *item = items; item->name; item++)
        fprintf(stream, "%s%s", item == items ? "" : " ", item->name);
}

/* The command that completes what a value or an operand names. */
static void put_names(int names, FILE *stream) {
    static const char *const commands[] = {[CLI_NAMES_NOTHING] = ":",
                                           [CLI_NAMES_FILE] = "_skiagraph_files -f",
                                           [CLI_NAMES_OUTPUT] = "_skiagraph_files -f",
                                           [CLI_NAMES_FOLDER] = "_skiagraph_files -d",
                                           [CLI_NAMES_KEY] = "_skiagraph_keys",
                                           [CLI_NAMES_SCENE] =
                                               "_skiagraph_files -d; _skiagraph_files -f -X '!*.json'"};
    fputs(commands[names], stream);
}

static void put_values(const cli_manual *manual, FILE *stream) {
    for (const cli_flag *const *flag = manual->flags; *flag; flag++) {
        if (!cli_flag_has_value(*flag)) continue;
        fprintf(stream, "    %s/%s) ", manual->name, (*flag)->name);
        if ((*flag)->values) {
            fputs("_skiagraph_words \"", stream);
            put_words((*flag)->values, stream);
            fputc('"', stream);
        } else {
            put_names((*flag)->names, stream);
        }
        fputs("; return ;;\n", stream);
    }
}

static void put_verb(const cli_manual *manual, FILE *stream) {
    fprintf(stream, "    %s)\n        if [[ $current == -* ]]; then\n            _skiagraph_words \"",
            manual->name);
    for (const cli_flag *const *flag = manual->flags; *flag; flag++) fprintf(stream, "%s ", (*flag)->name);
    fprintf(stream, "%s\"\n        else\n            ", cli_flag_help.name);
    put_names(manual->names, stream);
    fputs("\n        fi\n        ;;\n", stream);
}

void pages_bash(FILE *stream) {
    fputs("# Completion of skiagraph for bash.\n"
          "_skiagraph_words() {\n"
          "    local reply\n"
          "    mapfile -t reply < <(compgen -W \"$1\" -- \"$current\")\n"
          "    COMPREPLY+=(\"${reply[@]}\")\n"
          "}\n\n"
          "_skiagraph_files() {\n"
          "    local reply\n"
          "    mapfile -t reply < <(compgen \"$@\" -- \"$current\")\n"
          "    COMPREPLY+=(\"${reply[@]}\")\n"
          "    compopt -o filenames 2>/dev/null\n"
          "}\n\n"
          "_skiagraph_keys() {\n"
          "    _skiagraph_words \"$(\"${COMP_WORDS[0]}\" schema --paths 2>/dev/null)\"\n"
          "    compopt -o nospace 2>/dev/null\n"
          "}\n\n"
          "_skiagraph() {\n"
          "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
          "    COMPREPLY=()\n"
          "    if ((COMP_CWORD == 1)) || [[ ${COMP_WORDS[1]} == help && $COMP_CWORD == 2 ]]; then\n"
          "        _skiagraph_words \"",
          stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++)
        fprintf(stream, "%s ", (*manual)->name);
    put_words(cli_other_verbs, stream);
    fputs(" --help --version\"\n"
          "        return\n"
          "    fi\n"
          "    if [[ $current == = ]]; then # of --flag=value, which bash splits\n"
          "        current=\n"
          "    elif [[ $previous == = ]]; then\n"
          "        previous=${COMP_WORDS[COMP_CWORD-2]}\n"
          "    fi\n"
          "    case ${COMP_WORDS[1]}/$previous in\n",
          stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) put_values(*manual, stream);
    fputs("    esac\n    case ${COMP_WORDS[1]} in\n", stream);
    for (const cli_manual *const *manual = cli_manuals; *manual; manual++) put_verb(*manual, stream);
    fputs("    esac\n}\n\ncomplete -F _skiagraph skiagraph\n", stream);
}
