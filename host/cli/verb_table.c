/* Table of the verbs and the functions that run them. */
#include "verb_table.h"

#include "verbs/verbs.h"

const cli_verb cli_verbs[] = {
    {&cli_manual_image, cli_image},
    {&cli_manual_lbuffer, cli_lbuffer},
    {&cli_manual_plan, cli_plan},
    {&cli_manual_view, cli_view},
    {&cli_manual_live, cli_live},
    {&cli_manual_cost, cli_cost},
    {&cli_manual_parts, cli_parts},
    {&cli_manual_dose, cli_dose},
    {&cli_manual_mesh, cli_mesh},
    {&cli_manual_distance, cli_distance},
    {&cli_manual_material, cli_material},
    {&cli_manual_beam, cli_beam},
    {&cli_manual_devices, cli_devices},
    {&cli_manual_thorax, cli_thorax},
    {&cli_manual_make, cli_make},
    {&cli_manual_breathe, cli_breathe},
    {&cli_manual_fit, cli_fit},
    {&cli_manual_register, cli_register},
    {&cli_manual_scan, cli_scan},
    {&cli_manual_reconstruct, cli_reconstruct},
    {&cli_manual_schema, cli_schema},
    {NULL, NULL},
};
