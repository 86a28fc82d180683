/* Materials: how strongly matter attenuates.
 *
 * Cross sections: NIST XCOM, elements 1 to 92, photons of 1 keV to 20 MeV (warranted from 5 keV); natural
 * cubic splines in ln-ln per process, photo absorption in pieces from edge to edge. At an absorption edge the
 * value above it counts. Tables with source, unit and licence: materials/README.md.
 *
 * Materials never change once made and may be shared by threads. Failures are SKG_ERR_MATERIAL unless said
 * otherwise. Where a name is asked for it is for messages and may be NULL. */
#ifndef SKIAGRAPH_MATERIAL_H
#define SKIAGRAPH_MATERIAL_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_material skg_material;

/* A material as people write it:
 *     "Fe", "Iron"                     an element by symbol or name
 *     "Water", "bone cortical icru44"  a name of the tables, without regard to case, blanks and punctuation;
 *                                      or words that only one name has
 *     "H2O", "Ca5(PO4)3OH"             a formula by atoms; refused where its numbers sum to 100 +- 1
 *     "weight:Ti90Al6V4"               by mass; the numbers are taken as parts of 100
 *     "HU:52"                          tissue by Hounsfield number (skg_material_create_hounsfield)
 *     "mu:0.2"                         linear attenuation coefficient in 1/cm at every energy
 * A name that is not found: the nearest known ones are in the message. */
SKG_API skg_status skg_material_create_named(const char *text, skg_material **material);

/* Element 1 <= z <= 92 at its density of the tables. */
SKG_API skg_status skg_material_create_element(int32_t z, skg_material **material);

/* Chemical formula by atoms ("H2O", "Ca5(PO4)3OH", "C5H8O2"); numbers may have decimals. density in g/cm3;
 * 0: that of a tabled material written like it, or of the element, else not known. */
SKG_API skg_status skg_material_create_formula(const char *formula, double density, skg_material **material);

/* `count` elements z[i] with fractions by mass. Their sum has to be 1 within 0.005 (then they are scaled to
 * 1, and skg_material_note_get says so). density in g/cm3; 0: not known. */
SKG_API skg_status skg_material_create_mixture(const char *name, int64_t count, const int32_t *z,
                                               const double *fractions, double density,
                                               skg_material **material);

/* Human tissue by Hounsfield number, -1050 to 3000: density and composition by Schneider, Bortfeld and
 * Schlegel 2000 (density in pieces, not quite continuous: 1.1199 to 1.0762 g/cm3 at HU 100; composition
 * constant from step to step; amalgam from 1640, titanium from 2300). */
SKG_API skg_status skg_material_create_hounsfield(double hu, skg_material **material);

/* How a Hounsfield number and an energy between those of a table are looked up. */
enum { SKG_INTERPOLATION_BILINEAR = 0, SKG_INTERPOLATION_BILOGARITHMIC = 1 };

/* The naive way, kept to show its error (Vidal and Villard 2016, Eq. 13 and Fig. 12): mu interpolated between
 * tissue-equivalent gas, water, soft tissue and cortical bone by their Hounsfield numbers at 80 keV and
 * between the energies of the tables, linear or logarithmic in all three (HU + 1000); from the gas's -998 to
 * bone's 1330. Not for images. */
SKG_API skg_status skg_material_create_naive_hounsfield(double hu, int32_t interpolation,
                                                        skg_material **material);

/* The same linear attenuation coefficient at every energy; per_cm in 1/cm, finite, >= 0. */
SKG_API skg_status skg_material_create_mu(const char *name, double per_cm, skg_material **material);

/* A table of linear attenuation coefficients: count >= 2 energies in keV, rising (an edge: one energy twice),
 * and values above 0 in 1/cm; log-log interpolation between them, none beyond. */
SKG_API skg_status skg_material_create_table(const char *name, int64_t count, const double *energies_kev,
                                             const double *per_cm, skg_material **material);

/* The same from a text file of two columns: energy in the unit ("eV", "keV", "MeV"), 1/cm. Lines that start
 * with # are read past. Errors: SKG_ERR_FILE, SKG_ERR_FORMAT with the line. */
SKG_API skg_status skg_material_load_table(const char *path, const char *unit, skg_material **material);

/* The same matter at another density in g/cm3, above 0; SKG_ERR_MATERIAL for one that is given by its linear
 * attenuation coefficient. */
SKG_API skg_status skg_material_create_at_density(const skg_material *material, double density,
                                                  skg_material **dense);

SKG_API skg_status skg_material_retain(skg_material *material);
SKG_API void skg_material_release(skg_material **material);

/* Linear attenuation coefficient in 1/cm at a photon energy in keV. SKG_ERR_MATERIAL where the density is
 * not known, or the energy lies outside 1 keV to 20 MeV or a table's range. */
SKG_API skg_status skg_material_attenuation_get(const skg_material *material, double energy_kev,
                                                double *per_cm);

/* Mass coefficients in cm2/g by process. Prepare with skg_coefficients_init. */
typedef struct {
    int32_t size;
    int32_t reserved; /* 0 */
    double rayleigh, compton, photo, pair;
    double total; /* their sum: mu/rho with coherent scattering */
} skg_coefficients;

SKG_API void skg_coefficients_init(skg_coefficients *coefficients);
SKG_API skg_status skg_material_coefficients_get(const skg_material *material, double energy_kev,
                                                 skg_coefficients *coefficients);

/* Hounsfield number at an energy: 1000 (mu/mu_water - 1) (the paper's Eq. 6), water at 1 g/cm3. */
SKG_API skg_status skg_material_hounsfield_get(const skg_material *material, double energy_kev, double *hu);

/* Density in g/cm3; 0 where it is not known or has no meaning. */
SKG_API skg_status skg_material_density_get(const skg_material *material, double *density);

/* Composition: how many elements (0 where it is not known), and each: atomic number, fraction by mass. */
SKG_API skg_status skg_material_element_count(const skg_material *material, int64_t *count);
SKG_API skg_status skg_material_element_get(const skg_material *material, int64_t index, int32_t *z,
                                            double *fraction);

/* Energies in keV, 1 to 20 000, at which mu jumps: at most `most` of them go to edges (NULL with most = 0: to
 * count), rising; *count is how many there are. */
SKG_API skg_status skg_material_edges_get(const skg_material *material, int64_t most, double *edges_kev,
                                          int64_t *count);

/* The material's name, and what one should know of it ("" for nothing): source of its composition,
 * normalised fractions. Valid as long as the material. */
SKG_API skg_status skg_material_name_get(const skg_material *material, const char **name);
SKG_API skg_status skg_material_note_get(const skg_material *material, const char **note);

/* The names of the tables, for lists: count, and each one's names separated by ";" and
 * density in g/cm3. Static storage. */
SKG_API skg_status skg_material_tabled_count(int64_t *count);
SKG_API skg_status skg_material_tabled_get(int64_t index, const char **name, double *density);

/* "Fe" of 26 and 26 of "Fe" (also "iron", "26"). Static storage. */
SKG_API skg_status skg_element_symbol(int32_t z, const char **symbol);
SKG_API skg_status skg_element_number(const char *text, int32_t *z);

#ifdef __cplusplus
}
#endif
#endif
