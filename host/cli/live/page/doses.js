// Dose of the frames: of one, for a second at the rate of the last two, and summed up over all since the sum was reset.
'use strict';
// figures: of a frame, null where the scene has none. sums: of the frames that were counted.
const doses = {figures: null, frames: 0, sums: {}};
const DOSE_ROWS = [['air_kerma_uGy', 'air kerma at the entrance', '\u00b5Gy'], ['kap_uGy_cm2', 'kerma-area product', '\u00b5Gy cm\u00b2'],
  ['detector_air_kerma_uGy', 'air kerma at the detector', '\u00b5Gy']];

function takeDose(figures) {
  doses.figures = figures;
  showDoses();
}

function resetDoses() {
  doses.frames = 0, doses.sums = {};
  showDoses();
}

// An image that a better one follows, with more photons of scatter, is the same exposure.
function countDose(frame) {
  if (!doses.figures || frame.notes & 8) return;
  doses.frames++;
  for (const [name] of DOSE_ROWS) doses.sums[name] = (doses.sums[name] || 0) + (doses.figures[name] || 0);
  showDoses();
}

function showDoses() {
  const figures = doses.figures;
  byId('dose').hidden = !figures;
  if (!figures) return;
  const line = (name, ...texts) => {
    const row = make('tr');
    row.append(make('th', name), ...texts.map(text => make('td', text, 'number')));
    return row;
  };
  const text = value => value === undefined || value === null ? '-' : number(value, 3), each = perSecond();
  byId('doses').replaceChildren(line('', 'frame', 'second', 'sum'),
    ...DOSE_ROWS.map(([name, words, unit]) => line(`${words}, ${unit}`, text(figures[name]), text(each * figures[name]), text(doses.sums[name] || 0))),
    line('exposure index', text(figures.exposure_index), '', ''));
  byId('dose-frames').textContent = `${doses.frames} frames, parts where the file has them`;
}
