// The sinogram: a line for each projection that was shown, the row of its image at the last position of the cursor. Frames are
// cached until anything but the projection changes.
'use strict';
const KEPT_BYTES = 128 * 2 ** 20;
const sinogram = {frames: new Map(), key: '', most: Infinity, row: 0.5, sweep: null, timer: 0};
// most: maximum number of cached frames. row: a fraction of the height. sweep: {back, asked, key} while all projections are requested.
const keyOfState = ({settings, poses, phase, quantity, bands, channel}) => JSON.stringify([settings, poses, phase, quantity, bands, channel]);

function keepOnly(key) {
  if (sinogram.key !== key) sinogram.frames.clear();
  sinogram.key = key;
}

// Caches a frame. its: the state that it shows.
function noteProjection(frame, its) {
  if (its.projection === null || frame.notes & 9 || live.projections < 2 || keyOfState(its) !== sinogram.key) return;
  const {frames, sweep} = sinogram;
  sinogram.most = Math.max(2, Math.floor(KEPT_BYTES / frame.numbers.byteLength));
  frames.delete(its.projection);
  frames.set(its.projection, frame);
  if (frames.size > sinogram.most) frames.delete(frames.keys().next().value);
  drawSinogramSoon();
  if (sweep && frame.wish === net.sent && its.projection === sweep.asked) stepSweep();
}

function drawSinogramSoon() {
  if (!sinogram.timer && live && live.projections > 1) sinogram.timer = setTimeout(() => { sinogram.timer = 0; drawSinogram(); }, 100);
}

function drawSinogram() {
  const canvas = byId('sinogram'), {frames, row} = sinogram, frame = frames.values().next().value, count = live.projections;
  byId('sinogram-text').textContent = `${frames.size} of ${count} projections seen`;
  byId('sinogram-now').hidden = state.projection === null;
  byId('sinogram-now').style.top = `${100 * ((state.projection ?? 0) + 0.5) / count}%`;
  if (!frame) { canvas.width = 1; return; } // empty
  const picture = new ImageData(frame.columns, count), pixels = new Uint32Array(picture.data.buffer), scale = 255 / (xray.high - xray.low);
  for (const [k, its] of frames) {
    const {columns, rows, numbers} = its, from = Math.floor(row * rows) * columns;
    for (let i = 0; i < Math.min(columns, frame.columns); i++) {
      const grey = Math.round(clamp((shownOf(its, numbers[from + i]) - xray.low) * scale, 0, 255)), g = xray.inverted ? 255 - grey : grey;
      pixels[k * frame.columns + i] = 0xff000000 | g << 16 | g << 8 | g;
    }
  }
  canvas.width = frame.columns, canvas.height = count;
  canvas.getContext('2d').putImageData(picture, 0, 0);
  if (document.activeElement !== byId('sinogram-row')) byId('sinogram-row').value = Math.floor(row * frame.rows);
}

function setRow(share) {
  sinogram.row = clamp(share, 0, 0.999999);
  drawSinogramSoon();
}

// Requests each missing projection in turn, then the first one again. A change by the user ends it.
function beginSweep() {
  if (!isOwner()) return;
  sinogram.sweep = {back: state.projection, asked: state.projection, key: sinogram.key};
  stepSweep();
}

function stepSweep() {
  const {sweep, frames} = sinogram, next = Array.from({length: live.projections}, (_, k) => k).find(k => !frames.has(k));
  if (next === undefined || frames.size >= sinogram.most) return endSweep(true);
  state.projection = sweep.asked = next;
  byId('sweep').textContent = 'stop';
  ask(false);
}

function endSweep(goesBack) {
  const {sweep} = sinogram;
  sinogram.sweep = null;
  byId('sweep').textContent = 'all projections';
  if (!goesBack) return;
  state.projection = sweep.back;
  ask(false);
}

function listenToSinogram() {
  const canvas = byId('sinogram'), row = byId('sinogram-row');
  byId('sweep').onclick = () => sinogram.sweep ? endSweep(true) : beginSweep();
  row.oninput = () => { if (row.value !== '' && xray.frame) setRow((Number(row.value) + 0.5) / (xray.frame.rows * xray.frame.factor)); };
  canvas.onclick = event => alter(s => { s.projection = clamp(Math.floor(event.offsetY / canvas.clientHeight * live.projections), 0, live.projections - 1); });
  watch(() => {
    const {sweep} = sinogram;
    keepOnly(keyOfState(state));
    if (sweep && (state.projection !== sweep.asked || keyOfState(state) !== sweep.key)) endSweep(false);
    drawSinogramSoon();
  });
}
