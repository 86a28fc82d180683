/** @file
 * Materials: how strongly matter attenuates photons.
 *
 * Cross sections are those of NIST XCOM for the elements 1 to 92 and photons of 1 keV to 20 MeV (warranted
 * from 5 keV), interpolated by natural cubic splines in ln-ln for each process, photo absorption from edge to
 * edge. At an absorption edge the value above the edge holds. materials/README.md has source, unit and
 * licence of each table.
 *
 * A material never changes and may be shared by threads. Functions that make one return SKG_ERR_MATERIAL
 * unless they say otherwise; the caller releases the result. A `name` is for messages and may be NULL.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_MATERIAL_H
#define SKIAGRAPH_MATERIAL_H

#include <skiagraph/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Matter: a composition with a density, or a linear attenuation coefficient. */
typedef struct skg_material skg_material;

/** Makes a material from the text that a user writes:
 *
 *     "Fe", "Iron"           an element by symbol or name
 *     "bone cortical icru44" a name of the tables, without regard to case, blanks and punctuation, or words
 *                            that only one name contains; four letters or more may be the beginning of a word
 *     "H2O", "Ca5(PO4)3OH"   a chemical formula by atoms; refused if its numbers add up to 100 +- 1, because
 *                            fractions by mass were probably meant. Refused, too, because they hardly ever mean the formula:
 *                            one element that is no molecule ("SS409", "C45"), "PC", "PS", "PU" and other plastics, and a
 *                            dopant in brackets without a number ("NaI(Tl)"). Digits below the line count as digits
 *     "weight:Ti90Al6V4"     fractions by mass, in parts of 100
 *     "HU:52"                tissue by Hounsfield number, see skg_material_create_hounsfield
 *     "solution:Iodine:300"  300 mg/ml in water, see skg_material_create_solution
 *     "Vacuum"               nothing
 *     "mu:0.2"               this linear attenuation coefficient in 1/cm at every energy
 *
 * For a name that is not found the message has the nearest known ones. */
SKG_API skg_status skg_material_create_named(const char *text, skg_material **material);

/** Makes an element with the density of the tables.
 *
 *     z   atomic number, 1 to 92 */
SKG_API skg_status skg_material_create_element(int32_t z, skg_material **material);

/** Makes a compound from its chemical formula by atoms.
 *
 *     formula   such as "H2O", "Ca5(PO4)3OH"; numbers may have decimals
 *     density   g/cm3; 0: the density of the element, or of the tables' material with this formula; if there
 *               is none, the density is unknown */
SKG_API skg_status skg_material_create_formula(const char *formula, double density, skg_material **material);

/** Makes a mixture of elements.
 *
 *     count       number of elements
 *     z           [count] atomic numbers, 1 to 92
 *     fractions   [count] fractions by mass. If their sum is within 0.005 of 1 they are scaled to 1, which
 *                 skg_material_note_get says; otherwise the call fails
 *     density     g/cm3; 0: unknown */
SKG_API skg_status skg_material_create_mixture(const char *name, int64_t count, const int32_t *z,
                                               const double *fractions, double density,
                                               skg_material **material);

/** Makes a solution in water. It is taken that volumes add: a millilitre holds the solute at the density of the tables, and
 * water. skg_material_note_get says so, with the density that follows.
 *
 *     solute   an element, or a compound whose density the tables have: "Iodine", "NaI"
 *     mg_ml    mass of the solute in a millilitre of the solution, mg, above 0 and below that of the solute itself
 *     errors   SKG_ERR_MATERIAL */
SKG_API skg_status skg_material_create_solution(const char *solute, double mg_ml, skg_material **material);

/** Makes human tissue from its Hounsfield number.
 *
 *     hu       -1050 to 3000
 *     method   density and composition of Schneider, Bortfeld and Schlegel, Phys. Med. Biol. 45 (2000) 459.
 *              The density has steps (1.1199 to 1.0762 g/cm3 at HU 100), the composition is constant between
 *              the steps of their table, which ends at HU 1600. Beyond it bone of the last composition and of
 *              rising density goes on (skg_material_note_get says so): a metal has to be named. */
SKG_API skg_status skg_material_create_hounsfield(double hu, skg_material **material);

/** How skg_material_create_naive_hounsfield interpolates. */
enum skg_interpolation {
    /** Linear in Hounsfield number and energy. */
    SKG_INTERPOLATION_BILINEAR = 0,
    /** Linear in the logarithms of HU + 1000, energy and attenuation. */
    SKG_INTERPOLATION_BILOGARITHMIC = 1
};

/** Makes human tissue in the naive way, to show its error. Not for images.
 *
 *     hu              -998 (gas) to 1330 (cortical bone)
 *     interpolation   enum skg_interpolation
 *     method          linear attenuation coefficients interpolated between tissue-equivalent gas, water, soft
 *                     tissue and cortical bone by their Hounsfield numbers at 80 keV, and between the
 *                     energies of the tables (Vidal and Villard 2016, Eq. 13 and Fig. 12) */
SKG_API skg_status skg_material_create_naive_hounsfield(double hu, int32_t interpolation,
                                                        skg_material **material);

/** Makes a material that has one linear attenuation coefficient at every energy.
 *
 *     per_cm   1/cm, finite, at least 0 */
SKG_API skg_status skg_material_create_mu(const char *name, double per_cm, skg_material **material);

/** Makes a material from a table of linear attenuation coefficients.
 *
 *     count          number of energies, at least 2
 *     energies_kev   [count] keV, rising; at an absorption edge the same energy stands twice
 *     per_cm         [count] 1/cm, above 0
 *     method         log-log interpolation; no values beyond the ends */
SKG_API skg_status skg_material_create_table(const char *name, int64_t count, const double *energies_kev,
                                             const double *per_cm, skg_material **material);

/** Makes a material from a text file with two columns, energy and linear attenuation coefficient in 1/cm.
 * Lines that begin with # are skipped.
 *
 *     unit     of the energies: "eV", "keV" or "MeV"
 *     errors   SKG_ERR_FILE; SKG_ERR_FORMAT with the line */
SKG_API skg_status skg_material_load_table(const char *path, const char *unit, skg_material **material);

/** Makes the same matter with another density.
 *
 *     density   g/cm3, above 0
 *     errors    SKG_ERR_MATERIAL if the material is given by its linear attenuation coefficient */
SKG_API skg_status skg_material_create_at_density(const skg_material *material, double density,
                                                  skg_material **dense);

/** Makes the same matter with the form factors of its molecules, which change where Rayleigh scattering sends photons: in liquids and
 * tissues atoms are not free, and few photons go straight on. How many photons scatter stays that of free atoms (XCOM).
 *
 *     material       with a known composition
 *     count          number of rows, at least 2
 *     per_angstrom   [count] momentum transfer sin(theta/2) / wavelength, 1/Angstrom, rising, from 0 or above to 0.4 or more
 *     squares        [count] F^2 of a molecule, or of any amount of the matter, in any unit; above 0
 *     method         linear between rows; the first row also holds below it. From the last one on atoms are free. The squares are scaled so
 *                    that their sum over the last fifth of the momentum transfers is that of free atoms
 *     errors         SKG_ERR_MATERIAL
 *
 * @since 0.1.0 */
SKG_API skg_status skg_material_create_form_factor(const skg_material *material, int64_t count,
                                                   const double *per_angstrom, const double *squares,
                                                   skg_material **bound);

/** Adds an owner to a material. */
SKG_API skg_status skg_material_retain(skg_material *material);

/** Removes an owner; the last one frees the material. */
SKG_API void skg_material_release(skg_material **material);

/** Gets the linear attenuation coefficient at a photon energy.
 *
 *     energy_kev   1 keV to 20 MeV, or the range of the material's table
 *     per_cm       result, 1/cm
 *     errors       SKG_ERR_MATERIAL if the energy is out of range or the density is unknown */
SKG_API skg_status skg_material_attenuation_get(const skg_material *material, double energy_kev,
                                                double *per_cm);

/** Mass attenuation coefficients by process, cm2/g. The library fills it; prepare with
 * skg_coefficients_init. */
typedef struct {
    /** Set by skg_coefficients_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Coherent scattering. */
    double rayleigh;
    /** Incoherent scattering. */
    double compton;
    /** Photo absorption. */
    double photo;
    /** Production of pairs and triplets. */
    double pair;
    /** Sum of the four: mu/rho with coherent scattering. */
    double total;
} skg_coefficients;

SKG_INIT(skg_coefficients)

/** Gets the mass attenuation coefficients at a photon energy in keV. Errors: SKG_ERR_MATERIAL if the energy
 * is out of range or the composition is unknown. */
SKG_API skg_status skg_material_coefficients_get(const skg_material *material, double energy_kev,
                                                 skg_coefficients *coefficients);

/** Gets the Hounsfield number at a photon energy in keV: 1000 (mu / mu_water - 1), with water at 1 g/cm3 (the
 * paper's Eq. 6). */
SKG_API skg_status skg_material_hounsfield_get(const skg_material *material, double energy_kev, double *hu);

/** Gets the density in g/cm3; 0 if it is unknown or has no meaning. */
SKG_API skg_status skg_material_density_get(const skg_material *material, double *density);

/** Number of elements in the composition; 0 if it is unknown. */
SKG_API skg_status skg_material_element_count(const skg_material *material, int64_t *count);

/** Gets the atomic number of element 0 <= index < count, and its fraction by mass. */
SKG_API skg_status skg_material_element_get(const skg_material *material, int64_t index, int32_t *z,
                                            double *fraction);

/** Gets the energies at which the attenuation jumps.
 *
 *     capacity    length of edges_kev; 0 to count only
 *     edges_kev   [capacity] result: the first of them, keV, rising, 1 to 20000; NULL if capacity is 0
 *     count       result: how many there are, which may be more than capacity */
SKG_API skg_status skg_material_edges_get(const skg_material *material, int64_t capacity, double *edges_kev,
                                          int64_t *count);

/** Gets the form factors of a material's molecules.
 *
 *     capacity       rows that there is room for; 0 to count only
 *     per_angstrom   [capacity] result: momentum transfers of the first rows, 1/Angstrom; NULL if capacity is 0
 *     squares        [capacity] result: F^2 of 1 g, 1/g; likewise
 *     count          result: number of rows, which may be more than capacity; 0: atoms are free
 *
 * @since 0.1.0 */
SKG_API skg_status skg_material_form_factor_get(const skg_material *material, int64_t capacity,
                                                double *per_angstrom, double *squares, int64_t *count);

/** Gets the material's name, valid as long as the material. */
SKG_API skg_status skg_material_name_get(const skg_material *material, const char **name);

/** Gets what a user should know of the material: the source of its composition, or that its fractions were
 * scaled; "" for nothing. Valid as long as the material. */
SKG_API skg_status skg_material_note_get(const skg_material *material, const char **note);

/** Number of materials in the tables. */
SKG_API skg_status skg_material_tabled_count(int64_t *count);

/** Gets the names of material 0 <= index < count of the tables, separated by ";", and its density in g/cm3.
 * The text is static. */
SKG_API skg_status skg_material_tabled_get(int64_t index, const char **name, double *density);

/** Gets the symbol of an element: "Fe" for 26. The text is static. */
SKG_API skg_status skg_element_symbol_get(int32_t z, const char **symbol);

/** Gets the names of an element, separated by ";": "Aluminium;Aluminum" for 13. The text is static. */
SKG_API skg_status skg_element_names_get(int32_t z, const char **names);

/** Gets the atomic number of an element: 26 for "Fe", "iron" or "26". */
SKG_API skg_status skg_element_number_get(const char *text, int32_t *z);

#ifdef __cplusplus
}
#endif
#endif
