// How much the image changes when a part moves by a mm, on pages that were made with --sensitivity: colours, numbers and legend.
'use strict';
const RAMP = [[59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]]; // viridis without its darkest end
const UNKNOWN = [150, 150, 150], DECADES = 3; // the scale is logarithmic, and ends that far below the largest
const changes = new Map((scene.sensitivity ? scene.sensitivity.parts : []).map(its => [its.part, its]));
const changeOf = i => changes.get(scene.parts[i].label);
const percent = share => `${number(100 * share, 2)} %`;

// The ends of the scale.
function scaleEnds() {
  const values = [...changes.values()].map(its => its.largest).filter(x => x > 0), high = Math.max(...values, 0);
  const low = Math.max(Math.min(...values, high), high * 10 ** -DECADES);
  return [low < high ? low : high / 10, high];
}

// 0 at the low end of the scale, 1 at the high one.
function levelOf(value) {
  const [low, high] = scaleEnds();
  return value > low ? clamp(Math.log(value / low) / Math.log(high / low), 0, 1) : 0;
}

function rampAt(level) {
  const at = level * (RAMP.length - 1), k = Math.min(Math.floor(at), RAMP.length - 2);
  return RAMP[k].map((x, i) => Math.round(x + (at - k) * (RAMP[k + 1][i] - x)));
}

// Numbers of the parts in the order of the list: what changes the image most comes first.
function listed() {
  const value = i => changeOf(i)?.largest ?? -1;
  return [...scene.parts.keys()].sort((i, j) => changes.size ? value(j) - value(i) : i - j);
}

// Whether the colours are those of the scale.
const isColoured = () => byId('sensitive').getAttribute('aria-pressed') === 'true';

// Parts keep their opacity.
function colourParts(on) {
  byId('scale').hidden = !on;
  press('sensitive', on);
  scene.parts.forEach((part, i) => {
    const its = changeOf(i), colour = !on ? part.colour : its ? rampAt(levelOf(its.largest)) : UNKNOWN;
    for (let k = 0; k < 3; k++) meshes[i].colour[k] = colour[k] / 255;
    showRow(i);
  });
}

function fillLegend() {
  const its = scene.sensitivity, [low, high] = scaleEnds(), ofColours = [], notes = [];
  if (!its) return;
  byId('legend').hidden = false;
  byId('sensitive').hidden = !changes.size;
  byId('ramp').style.background = `linear-gradient(to right, ${RAMP.map(c => `rgb(${c.join(' ')})`).join(', ')})`;
  byId('ends').replaceChildren(...[low, Math.sqrt(low * high), high].map(x => make('span', percent(x))));
  if (changes.size) notes.push('Root mean square over all pixels, as a share of the open beam, along the direction that changes the image most.');
  if ([...changes.values()].some(x => x.largest < low)) ofColours.push('Parts below the scale have its first colour.');
  if (changes.size && changes.size < its.of) ofColours.push('Grey parts were not measured.');
  if (its.saturated) notes.push('Some slopes of faces were cut off, and the changes are larger than shown.');
  if (its.reason) notes.push(`No sensitivity: ${its.reason}.`);
  byId('below').textContent = ofColours.join(' ');
  byId('notes').textContent = notes.join(' ');
  colourParts(changes.size > 0);
}
