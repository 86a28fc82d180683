#include "scene/setup.h"
#include "core/units.h"

#include <inttypes.h>
#include <string.h>

static const skg_json_key source_keys[] = {
    {"Position", NULL, SKG_KEY_READ},
    {"Direction", NULL, SKG_KEY_READ},
    {"Shape", NULL, SKG_KEY_READ},
    {"Beam", NULL, SKG_KEY_READ},
};

static const skg_json_key channel_keys[] = {
    {"Energy", NULL, SKG_KEY_READ},
    {"Unit", NULL, SKG_KEY_READ},
    {"PhotonCount", NULL, SKG_KEY_READ},
};

/* A tube or a file of energies. */
static const skg_json_key spectrum_keys[] = {
    {"kVp", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"PeakKiloVoltage", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"TubeAngle", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"mAs", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"ExposureTime", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"X-ray tube current", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"Current", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"Filter", "a filter of the beam", SKG_KEY_NOT_YET},
    {"Filtration", "a filter of the beam", SKG_KEY_NOT_YET},
    {"MaxNumberOfEnergyBins", "the spectrum of a tube", SKG_KEY_NOT_YET},
    {"GateMacro", "a spectrum from a file", SKG_KEY_NOT_YET},
    {"TextFile", "a spectrum from a file", SKG_KEY_NOT_YET},
    {"Unit", "a spectrum from a file", SKG_KEY_NOT_YET},
};

static skg_status read_shape(const skg_json_object *source, int32_t *parallel) {
    static const char *const shapes[] = {"PointSource", "Point",        "Cone",
                                         "ConeBeam",    "ParallelBeam", "Parallel"};
    skg_json_node node, first;
    int64_t choice = 0;
    SKG_TRY(skg_json_need(source, "Shape", "\"PointSource\" or \"ParallelBeam\"", &node));
    if (json_is_array(node.value)) {
        static const char *const spots[] = {"FocalSpot"};
        first = skg_json_element(&node, 0);
        SKG_TRY(skg_json_choice(&first, "shape of an extended source", spots, 1, &choice));
        return skg_json_fail(&node, SKG_ERR_UNSUPPORTED,
                             "a focal spot is not simulated yet; use \"PointSource\"");
    }
    SKG_TRY(skg_json_choice(&node, "shape of a source", shapes, 6, &choice));
    *parallel = choice >= 4;
    return SKG_OK;
}

static skg_status read_channel(skg_setup *setup, const skg_json_node *node) {
    skg_json_object channel;
    skg_json_node energy_node, unit_node, photons_node;
    double energy = 0, photons = 0, kev = 1;
    const char *unit = NULL;
    SKG_TRY(skg_json_read_object(node, channel_keys, sizeof channel_keys / sizeof *channel_keys, &channel));
    SKG_TRY(skg_json_need(&channel, "Energy", "60", &energy_node));
    SKG_TRY(skg_json_need(&channel, "Unit", "\"keV\"", &unit_node));
    SKG_TRY(skg_json_need(&channel, "PhotonCount", "1000", &photons_node));
    SKG_TRY(skg_json_number(&energy_node, &energy));
    SKG_TRY(skg_json_text(&unit_node, &unit));
    SKG_TRY(skg_json_number(&photons_node, &photons));
    skg_status status = skg_unit_of_energy(unit, &kev);
    if (status != SKG_OK) return skg_json_fail(&unit_node, status, "%s", skg_last_error());
    status = skg_spectrum_mono(energy * kev, photons, &setup->spectrum);
    if (status != SKG_OK) return skg_json_fail(node, status, "%s", skg_last_error());
    return SKG_OK;
}

static skg_status read_beam(skg_setup *setup, const skg_json_node *node) {
    static const char *const example = "[{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]";
    if (json_is_object(node->value)) {
        skg_json_object ignored;
        SKG_TRY(skg_json_read_object(node, spectrum_keys, sizeof spectrum_keys / sizeof *spectrum_keys,
                                     &ignored));
        return skg_json_fail(node, SKG_ERR_FORMAT, "describes no beam; give %s", example);
    }
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, example, &count));
    if (count == 0) return skg_json_fail(node, SKG_ERR_BEAM, "has no energy; give %s", example);
    if (count > 1)
        return skg_json_fail(node, SKG_ERR_UNSUPPORTED,
                             "a beam of %" PRId64 " energies is not simulated yet; give one", count);
    skg_json_node channel = skg_json_element(node, 0);
    return read_channel(setup, &channel);
}

skg_status skg_setup_read_source(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    skg_json_object source;
    skg_json_node beam;
    int32_t parallel = 0;
    SKG_TRY(skg_json_read_object(node, source_keys, sizeof source_keys / sizeof *source_keys, &source));
    SKG_TRY(read_shape(&source, &parallel));
    skg_view_init(&setup->view);
    skg_json_node position = skg_json_member(&source, "Position");
    skg_json_node direction = skg_json_member(&source, "Direction");
    if (direction.value) {
        if (!parallel)
            return skg_json_fail(&direction, SKG_ERR_FORMAT,
                                 "only a parallel beam has a direction; give a Position");
        if (position.value)
            return skg_json_fail(&direction, SKG_ERR_FORMAT,
                                 "give either Position or Direction (a beam from infinity), not both");
        setup->view.projection = SKG_PARALLEL_FROM_INFINITY;
        SKG_TRY(skg_json_direction(&direction, setup->view.source));
    } else {
        static const char *const example = "[0, -500, 0, \"mm\"]";
        setup->view.projection = parallel ? SKG_PARALLEL : SKG_POINT;
        SKG_TRY(skg_json_need(&source, "Position", example, &position));
        SKG_TRY(skg_json_lengths(&position, example, 3, setup->view.source));
    }
    SKG_TRY(skg_json_need(&source, "Beam", "[{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]",
                          &beam));
    return read_beam(setup, &beam);
}
