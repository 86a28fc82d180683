// Presets of a class: geometry, beam and grid of usual examinations. Each sets Source and Detector of the scene file in one step.
'use strict';

// mm, kV, mAs. sides: the way of the beam, the directions in which columns and rows grow, in a body's axes (x to the left, y to the back,
// z to the head); without them those of the present view. gap: from the object to the detector; sod: from the source to the middle of the
// object instead.
const PRESETS = {
  'chest PA': {
    sides: [[0, -1, 0], [1, 0, 0], [0, 0, -1]], distance: 1800, gap: 50, size: [430, 430], pixels: [512, 512],
    beam: {kVp: 125, mAs: 2, Filter: [['Al', 3, 'mm']]},
    grid: {Ratio: 10, LinesPerCm: 40, StripThickness: [0.05, 'mm'], Interspace: 'Al', FocusDistance: [1800, 'mm']},
  },
  hand: {distance: 1000, gap: 10, size: [240, 300], pixels: [480, 600], beam: {kVp: 50, mAs: 2, Filter: [['Al', 2.5, 'mm']]}},
  breast: {
    distance: 650, gap: 15, size: [240, 300], pixels: [480, 600], beam: {kVp: 28, mAs: 80, Filter: [['Rh', 0.05, 'mm']]},
    grid: {Ratio: 5, LinesPerCm: 31, StripThickness: [0.016, 'mm'], FocusDistance: [650, 'mm']},
  },
  'C-arm': {
    distance: 1100, sod: 750, size: [300, 300], pixels: [512, 512], beam: {kVp: 75, mAs: 0.5, Filter: [['Al', 3, 'mm'], ['Cu', 0.2, 'mm']]},
    grid: {Ratio: 10, LinesPerCm: 40, StripThickness: [0.05, 'mm'], Interspace: 'Al', FocusDistance: [1100, 'mm']},
  },
};
// Keys that a preset replaces, as plain() spells them.
const PLACED = ['position', 'shape', 'direction', 'from', 'sod', 'sdd', 'isocentre', 'beam', 'upvector', 'rightvector', 'columnstep', 'rowstep',
  'numberofpixels', 'size', 'spacing', 'curved', 'binning', 'grid'];

// The section of the scene file without those keys. A focal spot stays; `Grid` of a source says where its samples are, and stays, too.
function restOf(section) {
  const now = {...(live.document[keyOf(live.document, section)] || {})}, stays = name => !PLACED.includes(name) ||
    (section === 'Source' && (name === 'grid' || (name === 'shape' && scene.view.projection === 'point')));
  return Object.fromEntries(Object.entries(now).filter(([key]) => stays(plain(key))));
}

// The way of the beam, columns and rows: perpendicular unit vectors.
function sidesNow() {
  const v = scene.view, way = unit(add(v.centre, -1, v.source)), across = step => add(step, -dot(step, way), way);
  const row = unit(across(v.steps[1])), column = unit(add(across(v.steps[0]), -dot(v.steps[0], row), row));
  return [way, column, row];
}

// Source and detector before and behind the object's box; null if it is too deep for the preset.
function placesOf(preset) {
  const [way, ...axes] = preset.sides || sidesNow(), [low, high] = scene.box, middle = low.map((x, k) => (x + high[k]) / 2);
  const half = Math.max(...boxPoints(low, high).map(p => dot(add(p, -1, middle), way)));
  const behind = preset.sod ? preset.distance - preset.sod : half + preset.gap;
  if (half >= behind || half >= preset.distance - behind) return null;
  const centre = add(middle, behind, way);
  return {source: add(centre, -preset.distance, way), centre, axes, depth: 2 * half};
}

function takePreset(name) {
  const preset = PRESETS[name], at = placesOf(preset), mm = p => [...p.map(x => Number(x.toPrecision(9))), 'mm'], bare = p => mm(p).slice(0, 3);
  if (!at) return showSentence(`The object is too deep for ${name}, of ${preset.distance} mm from source to detector.`);
  alter(s => {
    for (const key of Object.keys(s.settings)) if (/^(source|detector)(\.|$)/i.test(key.trim())) delete s.settings[key];
    s.settings.Source = {...restOf('Source'), Position: mm(at.source), Beam: preset.beam};
    s.settings.Detector = {
      ...restOf('Detector'), Position: mm(at.centre), RightVector: bare(at.axes[0]), UpVector: bare(at.axes[1]),
      NumberOfPixels: preset.pixels, Size: [...preset.size, 'mm'], ...(preset.grid ? {Grid: preset.grid} : {}),
    };
  });
  describe();
  change();
}

function fillPresets() {
  const box = byId('preset');
  box.replaceChildren(new Option('choose', ''), ...Object.keys(PRESETS).map(name => new Option(name, name)));
  box.onchange = () => { if (box.value) takePreset(box.value); };
  watch(() => { // says which preset the scene still is
    const isChanged = Object.keys(state.settings).some(key => /^(source|detector)\./i.test(key.trim()));
    const is = name => JSON.stringify(state.settings.Source?.Beam) === JSON.stringify(PRESETS[name].beam);
    box.value = (!isChanged && Object.keys(PRESETS).find(is)) || '';
  });
}
