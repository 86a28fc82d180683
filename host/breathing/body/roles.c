/* Roles of organs in the breath, by label and tissue. */
#include "body/types.h"

#include "core/text.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

int skg_label_begins(const char *label, const char *word) {
    size_t i = 0;
    for (; word[i]; i++)
        if (tolower((unsigned char)label[i]) != tolower((unsigned char)word[i])) return 0;
    return !isalpha((unsigned char)label[i]);
}

static int has_word(const char *label, const char *word) {
    for (const char *c = label; *c; c++)
        if ((c == label || !isalpha((unsigned char)c[-1])) && skg_label_begins(c, word)) return 1;
    return 0;
}

skg_role skg_role_of(const char *label, int *number, int *side) {
    static const struct {
        const char *word;
        skg_role role;
    } rule[] = {{"rib", ROLE_RIB},
                {"sternum", ROLE_STERNUM},
                {"cartilage", ROLE_CARTILAGE},
                {"diaphragm", ROLE_DIAPHRAGM},
                {"lung", ROLE_LINKED},
                {"liver", ROLE_LINKED},
                {"heart", ROLE_LINKED},
                {"skin", ROLE_LINKED},
                {"muscle", ROLE_LINKED},
                {"ascending aorta", ROLE_SPANNED},
                {"vena cava", ROLE_SPANNED},
                {"pulmonary trunk", ROLE_SPANNED},
                {"pulmonary artery", ROLE_CARRIED},
                {"pulmonary vessels", ROLE_SPANNED},
                {"bowel", ROLE_SPANNED},
                {"perirenal fat", ROLE_CARRIED},
                {"gallbladder", ROLE_CARRIED},
                {"stomach", ROLE_CARRIED},
                {"spleen", ROLE_CARRIED},
                {"kidney", ROLE_CARRIED},
                {"trachea", ROLE_SPANNED},
                {"bronchus", ROLE_CARRIED},
                {"common bile duct", ROLE_SPANNED},
                {"needle", ROLE_NEEDLE}};
    *side = has_word(label, "left") || has_word(label, "l") ? 1 : 0;
    if (has_word(label, "right") || has_word(label, "r")) *side = -1;
    *number = 0;
    for (size_t i = 0; i < sizeof rule / sizeof *rule; i++) {
        if (!skg_label_begins(label, rule[i].word)) continue;
        if (rule[i].role == ROLE_RIB || rule[i].role == ROLE_CARTILAGE) {
            const char *digits = label + strcspn(label, "0123456789");
            long value = strtol(digits, NULL, 10);
            if (rule[i].role == ROLE_CARTILAGE && !*digits) return ROLE_LINKED; /* all cartilages of a side */
            if (value < 1 || value > 12 || *side == 0) return ROLE_STATIC;
            *number = (int)value;
        }
        return rule[i].role;
    }
    return ROLE_STATIC;
}

int skg_label_stays(const char *label) {
    static const char *const word[] = {"spine",      "spinal canal",   "vertebra", "disc",
                                       "discs",      "clavicle",       "scapula",  "aorta",
                                       "oesophagus", "brachiocephalic"};
    for (size_t i = 0; i < sizeof word / sizeof *word; i++)
        if (skg_label_begins(label, word[i])) return 1;
    return 0;
}

int skg_label_is_wall(const char *label) {
    return skg_label_begins(label, "skin") || skg_label_begins(label, "muscle");
}

/* The diaphragm's is the paper's muscle. The others are assumptions: the softer the organ, the wider its limits. */
skg_tissue skg_tissue_of(const char *label) {
    static const struct {
        const char *word;
        skg_tissue tissue;
    } known[] = {{"diaphragm", {0.7, 1.1, 0.1}},    {"lung", {0.5, 1.6, 0.3}},
                 {"liver", {0.97, 1.05, 0.03}},     {"heart", {0.7, 1.3, 0.1}},
                 {"cartilage", {0.85, 1.15, 0.15}}, {"skin", {0.75, 1.3, 0.25}},
                 {"muscle", {0.75, 1.3, 0.25}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (skg_label_begins(label, known[i].word)) return known[i].tissue;
    return (skg_tissue){0.8, 1.2, 0.1};
}

/* Boxes lie along the axes, while the sheet of the diaphragm turns as it flattens, and the liver below it shears: their
 * limits are wider. The paper's are for motion along the axes. */
skg_tissue skg_coupled_tissue_of(const char *label) {
    static const struct {
        const char *word;
        skg_tissue tissue;
    } known[] = {{"diaphragm", {0.5, 1.3, 0.7}}, {"lung", {0.5, 1.6, 0.7}},  {"liver", {0.8, 1.2, 0.3}},
                 {"heart", {0.6, 1.7, 0.6}},     {"skin", {0.7, 1.4, 0.45}}, {"muscle", {0.7, 1.4, 0.45}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (skg_label_begins(label, known[i].word)) return known[i].tissue;
    return skg_tissue_of(label);
}
