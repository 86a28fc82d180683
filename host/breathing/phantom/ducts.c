/* Bile ducts. */
#include "phantom/makers.h"
#include "phantom/shapes.h"

enum { DUCTS = 8 };

/* Bile ducts within the liver: three points and the radius, mm. Where ducts join, a gap is left. */
static const struct {
    double line[3][3], radius;
} duct[DUCTS] = {
    {{{-34, -62, -93}, {-48, -60, -86}, {-60, -60, -78}}, 2.0},  /* right hepatic duct */
    {{{-66, -64, -75}, {-76, -74, -72}, {-86, -84, -75}}, 1.5},  /* right anterior */
    {{{-65, -54, -76}, {-73, -44, -77}, {-78, -34, -84}}, 1.5},  /* right posterior */
    {{{-62, -62, -70}, {-68, -66, -52}, {-70, -66, -34}}, 1.3},  /* upward */
    {{{-90, -84, -79}, {-93, -80, -92}, {-92, -74, -106}}, 1.1}, /* anterior, downward */
    {{{-26, -64, -88}, {-10, -72, -74}, {4, -80, -62}}, 1.8},    /* left hepatic duct */
    {{{8, -81, -60}, {19, -82, -55}, {29, -82, -49}}, 1.3},      /* left lateral */
    {{{2, -85, -66}, {0, -93, -66}, {-4, -104, -68}}, 1.2},      /* left medial */
};

skg_status skg_thorax_ducts(const skg_thorax_plan *plan, int64_t liver, int64_t skin, skg_thorax *thorax) {
    static const double common[4][3] = {
        {-30, -64, -111}, {-26, -64, -126}, {-21, -66, -150}, {-14, -66, -184}};
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    int64_t around = skg_shape_count(plan->resolution, 8, 5), rings = skg_shape_count(plan->resolution, 9, 4);
    double curve[17][3];
    for (int i = 0; i < DUCTS && status == SKG_OK; i++) {
        status = skg_shape_spline(duct[i].line, 3, 17, curve);
        if (status == SKG_OK)
            status = skg_shape_cord("bile ducts", (const double(*)[3])curve, 17, duct[i].radius,
                                    duct[i].radius, 1, rings, around, &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_add(thorax, "bile ducts", 1000, liver, &arrays);
    if (status == SKG_OK) status = skg_shape_spline(common, 4, 17, curve);
    if (status == SKG_OK)
        status = skg_shape_cord("common bile duct", (const double(*)[3])curve, 17, 3, 3, 1,
                                skg_shape_count(plan->resolution, 12, 5), around, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "common bile duct", 1000, skin, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}
