/* Materials: how strongly matter attenuates.
 *
 * Materials never change once made and may be shared by threads. */
#ifndef SKIAGRAPH_MATERIAL_H
#define SKIAGRAPH_MATERIAL_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_material skg_material;

/* The same linear attenuation coefficient at every energy; per_cm in 1/cm, finite, >= 0. name: for messages;
 * may be NULL. Errors: SKG_ERR_MATERIAL. */
SKG_API skg_status skg_material_mu(const char *name, double per_cm, skg_material **material);

SKG_API skg_status skg_material_retain(skg_material *material);
SKG_API void skg_material_release(skg_material **material);

/* Linear attenuation coefficient in 1/cm at a photon energy in keV. */
SKG_API skg_status skg_material_attenuation(const skg_material *material, double energy_kev, double *per_cm);

/* The material's name; valid as long as the material. */
SKG_API skg_status skg_material_name(const skg_material *material, const char **name);

#ifdef __cplusplus
}
#endif
#endif
