/* The section Source. */
#include "setup/keys.h"
#include "setup/sections.h"

/* Where only path lengths are wanted, any energy does for a beam that is absent. */
static const double STAND_IN_KEV = 60;

/* The side of the parts on which the source stands: a name, or a direction from their centre. */
static skg_status read_side(skg_setup_reader *reader, const skg_json_node *node) {
    reader->has_side = 1;
    if (!json_is_string(node->value)) return skg_json_direction(node, reader->side);
    return skg_json_at(
        node, skg_side_get(json_string_value(node->value), reader->side, &reader->seen_from_detector));
}

/* Distances and the point that the axis of a C-arm passes, which go with From. */
static skg_status read_arm(skg_setup_reader *reader, const skg_json_object *source) {
    const skg_json_node sod = skg_json_member(source, "SOD"), sdd = skg_json_member(source, "SDD"),
                        middle = skg_json_member(source, "Isocentre");
    const skg_json_node *const given = sod.value ? &sod : sdd.value ? &sdd : &middle;
    if (!given->value) return SKG_OK;
    if (!reader->has_side)
        return skg_json_fail(given, SKG_ERR_FORMAT,
                             "goes with From, from which source and detector are placed");
    if (sod.value) SKG_TRY(skg_json_lengths(&sod, "[750, \"mm\"]", 1, &reader->source_mm));
    if (sdd.value) SKG_TRY(skg_json_lengths(&sdd, "[1100, \"mm\"]", 1, &reader->detector_mm));
    if (sod.value && !(reader->source_mm > 0))
        return skg_json_fail(&sod, SKG_ERR_SCENE, "is %g mm; give a distance above 0", reader->source_mm);
    if (sdd.value && !(reader->detector_mm > reader->source_mm))
        return skg_json_fail(
            &sdd, SKG_ERR_SCENE,
            "is %g mm; the detector stands behind the isocentre, which is %g mm from the source",
            reader->detector_mm, reader->source_mm);
    reader->has_isocentre = middle.value != NULL;
    return middle.value ? skg_json_lengths(&middle, "[0, 0, 0, \"mm\"]", 3, reader->isocentre) : SKG_OK;
}

/* Before the beam, whose tube has the angle of the anode. node->value may be NULL. */
static skg_status read_heel(skg_setup *setup, const skg_json_node *node) {
    skg_json_object heel;
    skg_json_node direction;
    skg_heel_init(&setup->heel);
    setup->heel.angle_deg = 0; /* not given */
    if (!node->value) return SKG_OK;
    SKG_TRY(skg_json_read_object(node, &skg_keys_heel, &heel));
    skg_json_node angle = skg_json_member(&heel, "AnodeAngle");
    if (angle.value) SKG_TRY(skg_json_number(&angle, &setup->heel.angle_deg));
    if (angle.value && !(setup->heel.angle_deg > 0))
        return skg_json_fail(&angle, SKG_ERR_BEAM, "is %g; give the angle of the anode in degrees, above 0",
                             setup->heel.angle_deg);
    SKG_TRY(skg_json_need(&heel, "Direction", "[1, 0, 0]", &direction));
    SKG_TRY(skg_json_direction(&direction, setup->heel.direction));
    setup->said.heel = &setup->heel;
    return SKG_OK;
}

skg_status skg_setup_read_source(skg_setup_reader *reader, const skg_json_node *node) {
    skg_setup *setup = reader->setup;
    skg_json_object source;
    skg_json_node beam;
    int32_t parallel = 0;
    SKG_TRY(skg_json_read_object(node, &skg_keys_source, &source));
    SKG_TRY(skg_setup_read_source_shape(reader, &source, &parallel));
    skg_view_init(&setup->view);
    skg_json_node position = skg_json_member(&source, "Position");
    skg_json_node direction = skg_json_member(&source, "Direction");
    const skg_json_node side = skg_json_member(&source, "From");
    if (side.value) {
        if (position.value || direction.value)
            return skg_json_fail(&side, SKG_ERR_FORMAT, "give either From, or %s, not both",
                                 position.value ? "Position" : "Direction");
        setup->view.projection = parallel ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        SKG_TRY(read_side(reader, &side));
    } else if (direction.value) {
        if (!parallel)
            return skg_json_fail(&direction, SKG_ERR_FORMAT,
                                 "only a parallel beam has a Direction; give a Position");
        if (position.value)
            return skg_json_fail(&direction, SKG_ERR_FORMAT,
                                 "give either Position or Direction (a beam from infinity), not both");
        setup->view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
        SKG_TRY(skg_json_direction(&direction, setup->view.source));
    } else {
        static const char *const example = "[0, -500, 0, \"mm\"]";
        setup->view.projection = parallel ? SKG_PROJECTION_PARALLEL : SKG_PROJECTION_POINT;
        SKG_TRY(skg_json_need(&source, "Position", example, &position));
        SKG_TRY(skg_json_lengths(&position, example, 3, setup->view.source));
    }
    SKG_TRY(read_arm(reader, &source));
    const skg_json_node lines = skg_json_member(&source, "LSF");
    if (lines.value)
        SKG_TRY(skg_json_remark(&lines,
                                "is passed over, as gVXR does; a line spread function belongs to Detector"));
    beam = skg_json_member(&source, "Beam");
    if (node->file->lengths && (!beam.value || json_is_null(beam.value))) {
        SKG_TRY(skg_json_remark(node,
                                "there is no Beam: path lengths are right, and %g keV stand in for the beam",
                                STAND_IN_KEV));
        return skg_spectrum_create_mono(STAND_IN_KEV, 1, &setup->spectrum);
    }
    SKG_TRY(skg_json_need(&source, "Beam", "[{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]",
                          &beam));
    skg_json_node heel = skg_json_member(&source, "Heel"), bowtie = skg_json_member(&source, "Bowtie");
    SKG_TRY(read_heel(setup, &heel));
    SKG_TRY(skg_setup_read_bowtie(reader, &bowtie));
    SKG_TRY(skg_setup_read_beam(reader, &beam));
    if (setup->said.heel && !setup->has_tube)
        return skg_json_fail(&heel, SKG_ERR_BEAM,
                             "needs a tube, whose anode makes it; give a Beam with kVp, or leave Heel out");
    return SKG_OK;
}
