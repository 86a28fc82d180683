// A slice through the scene, reconstructed from a few projections, beside the one before it; switches say what of the beam, the detector and the
// body is in the projections.
'use strict';
const SWITCHES = ['spectrum', 'noise', 'scatter', 'motion'];
// before, after: {frame, figures}. frame: arrived, its figures follow.
const slices = {before: null, after: null, frame: null, runs: false, low: 0, high: 1, auto: true};

const switchOf = name => byId('switch-' + name);
const withoutOf = name => (live && live.without && live.without[name]) || null; // why a switch changes nothing

function beginSlice() {
  const wanted = Object.fromEntries(SWITCHES.map(name => [name, switchOf(name).checked && !withoutOf(name)]));
  if (!say({reconstruct: {...wanted, at: Number(byId('slice-at').value)}})) return;
  showSliceStep('computing', true);
}

function showSliceStep(text, runs, isWarning = false) {
  slices.runs = runs;
  byId('reconstruct-stop').hidden = !runs;
  byId('slices').classList.toggle('old', runs);
  byId('slice-step').className = isWarning ? 'warn' : 'faint';
  byId('slice-step').textContent = text;
}
function endSlice() {
  if (slices.runs) showSliceStep('', false);
}

const nameSlice = figures => [figures.spectrum ? 'spectrum' : `${number(figures.mean_keV, 3)} keV`, ...SWITCHES.slice(1).filter(name => figures[name])].join(', ');

function takeSlice({reconstructed: found}) {
  const {frame} = slices;
  slices.frame = null;
  if (found.error) return showSliceStep(found.error, false, true);
  showSliceStep('', false);
  Object.assign(slices, {before: slices.after, after: {frame, figures: found}});
  if (slices.auto) [slices.low, slices.high] = windowOf(frame);
  const moved = found.seconds > 0 ? `, during ${number(found.seconds, 3)} s` : '';
  byId('slice-text').textContent = `${found.projections} projections of ${found.columns} x ${found.rows} pixels${moved}; voxels of ${number(found.voxel_mm, 3)} mm, ` +
    `across ${found.across} at ${number(found.at_mm, 4)} mm.` + (found.truncated > 0 ? ` The detector cuts off ${number(100 * found.truncated, 2)} % of the rows.` : '');
  paintSlices();
}

function paintSlices() {
  byId('slice-box').hidden = !slices.after;
  byId('slice-low').value = number(slices.low, 3), byId('slice-high').value = number(slices.high, 3);
  byId('slice-auto').setAttribute('aria-pressed', slices.auto);
  for (const which of ['before', 'after']) {
    const its = slices[which], canvas = byId('slice-' + which);
    canvas.parentElement.hidden = !its;
    if (!its) continue;
    canvas.width = its.frame.columns, canvas.height = its.frame.rows;
    canvas.getContext('2d').putImageData(paintFrame(its.frame, slices.low, slices.high).picture, 0, 0);
    canvas.nextElementSibling.textContent = `${which}: ${nameSlice(its.figures)}`;
  }
}

function setSliceWindow(low, high) {
  if (high > low) Object.assign(slices, {low, high, auto: false});
  paintSlices();
}

function fillSlices() {
  Object.assign(net.hear, {reconstructed: takeSlice, reconstructing: ({reconstructing: {done, of}}) => showSliceStep(of ? `computing, ${done} of ${of}` : 'computing', true)});
  switchOf('spectrum').checked = true;
  for (const name of ['noise', 'scatter']) switchOf(name).checked = !!valueOf(name);
  byId('reconstruct').onclick = beginSlice;
  byId('reconstruct-stop').onclick = () => say({reconstruct: null});
  byId('slice-low').onchange = byId('slice-high').onchange = () => setSliceWindow(Number(byId('slice-low').value), Number(byId('slice-high').value));
  byId('slice-auto').onclick = () => {
    slices.auto = !slices.auto;
    if (slices.auto) [slices.low, slices.high] = windowOf(slices.after.frame);
    paintSlices();
  };
  byId('slices').onclick = () => byId('slices').classList.toggle('large');
  for (const which of ['before', 'after']) {
    const canvas = byId('slice-' + which);
    canvas.onpointermove = event => {
      const {frame} = slices[which], at = [event.offsetX / canvas.clientWidth, event.offsetY / canvas.clientHeight].map(x => clamp(x, 0, 0.9999));
      byId('slice-value').textContent = `${which}: ${number(shownOf(frame, numberAt(frame, at)), 3)} per cm`;
    };
    canvas.onpointerleave = () => { byId('slice-value').textContent = ''; };
  }
  watch(() => {
    for (const name of SWITCHES) switchOf(name).disabled = !!withoutOf(name);
    byId('slice-why').textContent = SWITCHES.filter(withoutOf).map(name => `No ${name}: ${withoutOf(name)}.`).join(' ');
  });
}
