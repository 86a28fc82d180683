// The X-ray image: window and level, histogram, the value under the cursor, before and after. None of these asks for a frame.
'use strict';
const xray = {frame: null, ends: [0, 1], before: null, low: 0, high: 1, auto: true, inverted: false, split: 0.5, at: null, probed: '', stamp: 0};
const film = byId('film'), pen = film.getContext('2d', {alpha: false});

// The shown value of a number: -ln(I/I0), so that dense matter is white.
function shownOf(frame, n) {
  const value = frame.low + frame.step * n;
  return frame.flat > 0 ? -Math.log(Math.max(value, 1e-30 * frame.flat) / frame.flat) : value;
}

// Behind jaws no photon arrives; the value is -ln of the smallest float, 87.34. Histogram and window leave it out.
const STOPPED = 87;
const isStopped = (frame, n) => shownOf(frame, n) > STOPPED;

// 256 bins of the numbers from `first` on, each of `width` numbers, of a sample of 64k or more pixels.
function countNumbers(frame) {
  const bins = new Uint32Array(256), {numbers} = frame, stride = Math.max(1, Math.floor(numbers.length / 65536)), hasJaws = live && live.jaws;
  let first = hasJaws ? 65535 : 0, last = hasJaws ? 0 : 65535;
  for (let i = 0; hasJaws && i < numbers.length; i += stride)
    if (!isStopped(frame, numbers[i])) first = Math.min(first, numbers[i]), last = Math.max(last, numbers[i]);
  const width = Math.max(1, last - first + 1) / 256;
  for (let i = 0; i < numbers.length; i += stride)
    if (numbers[i] >= first && numbers[i] <= last) bins[Math.floor((numbers[i] - first) / width)]++;
  return {bins, first, width};
}
const total = bins => bins.reduce((sum, count) => sum + count, 0);

// The numbers below and above which a share of 0.5 % lies.
function windowOf(frame) {
  const {bins, first, width} = countNumbers(frame), cut = 0.005 * total(bins);
  let from = 0, to = 255;
  for (let sum = bins[0]; sum < cut && from < 255; sum += bins[++from]);
  for (let sum = bins[255]; sum < cut && to > 0; sum += bins[--to]);
  const ends = [shownOf(frame, first + from * width), shownOf(frame, first + (to + 1) * width - 1)].sort((a, b) => a - b);
  return [ends[0], Math.max(ends[1], ends[0] + 1e-6)];
}

// Greys of all numbers.
function greys(frame, low, high) {
  const table = new Uint8ClampedArray(65536), scale = 255 / (high - low);
  if (!(frame.flat > 0)) { // without a logarithm, which is most of the time
    const [from, by] = [(frame.low - low) * scale, frame.step * scale];
    for (let n = 0; n < 65536; n++) table[n] = xray.inverted ? 255 - (from + by * n) : from + by * n;
    return table;
  }
  for (let n = 0; n < 65536; n++) {
    const grey = clamp((shownOf(frame, n) - low) * scale, 0, 255);
    table[n] = xray.inverted ? 255 - grey : grey;
  }
  return table;
}

function paintFrame(frame, low = xray.low, high = xray.high) {
  const picture = new ImageData(frame.columns, frame.rows), pixels = new Uint32Array(picture.data.buffer), table = greys(frame, low, high);
  const small = new Uint8Array(frame.columns * frame.rows);
  for (let i = 0; i < small.length; i++) {
    const g = small[i] = table[frame.numbers[i]];
    pixels[i] = 0xff000000 | g << 16 | g << 8 | g;
  }
  return {picture, small};
}

// The image fills its half of the page, whatever it has in pixels.
function fitFilm(frame) {
  film.width = frame.columns, film.height = frame.rows;
  byId('sheet').style.setProperty('--aspect', frame.columns / frame.rows);
}

function paint() {
  const frame = xray.frame;
  if (!frame) return;
  const {picture, small} = paintFrame(frame);
  if (film.width !== frame.columns || film.height !== frame.rows) fitFilm(frame);
  pen.putImageData(picture, 0, 0);
  if (xray.before) {
    const other = xray.before, sheet = new OffscreenCanvas(other.columns, other.rows), width = Math.round(xray.split * film.width);
    sheet.getContext('2d').putImageData(paintFrame(other).picture, 0, 0);
    pen.drawImage(sheet, 0, 0, xray.split * other.columns, other.rows, 0, 0, width, film.height);
    pen.fillStyle = '#f5a623';
    pen.fillRect(width - 1, 0, Math.max(1, film.width / 400), film.height);
  }
  paintRadiograph(frame);
  showOnDetector(small, frame.columns, frame.rows);
  drawSinogramSoon();
  xray.stamp++;
}

function showFrame(frame) {
  xray.frame = frame;
  noteGood(frame.wish);
  byId('waiting').hidden = true;
  if (xray.auto) [xray.low, xray.high] = windowOf(frame);
  paint();
  drawHistogramSoon();
  drawProfile();
  if (xray.at) moveCursor(xray.at);
  showCost(frame);
  countDose(frame);
  if (fixed.frame) showRadiograph();
  pairShot();
}

// Five times a second at most while images follow each other; the last one has it in any case.
let histogramTimer = 0;
function drawHistogramSoon() {
  if (!histogramTimer) histogramTimer = setTimeout(() => { histogramTimer = 0; drawHistogram(); }, 200);
}

function drawHistogram() {
  const canvas = byId('histogram'), frame = xray.frame, draw = canvas.getContext('2d');
  if (!frame || canvas.offsetParent === null) return;
  const {bins, first, width: step} = countNumbers(frame), most = Math.log(1 + Math.max(...bins)), width = canvas.width, height = canvas.height;
  const style = getComputedStyle(document.documentElement), ends = xray.ends = [shownOf(frame, first), shownOf(frame, first + 256 * step - 1)];
  const at = value => (value - ends[0]) / (ends[1] - ends[0] || 1) * width;
  draw.clearRect(0, 0, width, height);
  draw.fillStyle = style.getPropertyValue('--faint');
  bins.forEach((count, i) => {
    const h = Math.log(1 + count) / most * height;
    draw.fillRect(i * width / 256, height - h, Math.ceil(width / 256), h);
  });
  draw.fillStyle = style.getPropertyValue('--mark');
  for (const end of [xray.low, xray.high]) draw.fillRect(at(end) - 1, 0, 2, height);
  byId('low').value = number(xray.low), byId('high').value = number(xray.high);
  const photons = live && !state.bands.length && live.beam.photons, starved = photons > 0 ? bins.reduce((sum, count, i) =>
    sum + (photons * Math.exp(-shownOf(frame, first + (i + 0.5) * step)) < 10 ? count : 0), 0) / total(bins) : 0;
  byId('starved').hidden = starved < 0.001;
  byId('starved').textContent = `${number(100 * starved, 2)} % of the pixels get fewer than 10 photons.`;
}

function setWindow(low, high) {
  if (!(high > low)) return;
  Object.assign(xray, {low, high, auto: false});
  byId('auto').setAttribute('aria-pressed', false);
  paint();
  drawHistogram();
}

// Fractions of the image from its upper left corner; null outside.
function placeOn(event) {
  const rect = film.getBoundingClientRect(), x = (event.clientX - rect.left) / rect.width, y = (event.clientY - rect.top) / rect.height;
  return x >= 0 && x < 1 && y >= 0 && y < 1 ? [x, y] : null;
}
const numberAt = (frame, [x, y]) => frame.numbers[Math.floor(y * frame.rows) * frame.columns + Math.floor(x * frame.columns)];

let probeTimer = 0;
function showValue(parts = null) {
  const box = byId('value'), frame = xray.frame, at = xray.at;
  box.hidden = !at || !frame;
  if (box.hidden) return;
  const n = numberAt(frame, at), value = frame.low + frame.step * n, shown = shownOf(frame, n);
  const [columns, rows] = [frame.columns * frame.factor, frame.rows * frame.factor];
  const lines = [`column ${Math.floor(at[0] * columns)}, row ${Math.floor(at[1] * rows)}`, `-ln(I/I0) ${number(shown, 5)}, I/I0 ${number(Math.exp(-shown), 4)}`];
  if (frame.flat > 0) lines.push(`${number(value, 6)} ${live ? live.unit : ''}`);
  if (isCompared(frame)) lines.push(`radiograph ${number(shownOf(fixed.frame, numberAt(fixed.frame, at)), 5)}`);
  for (const [label, mm] of parts || []) lines.push(`${label}: ${number(mm, 4)} mm`);
  box.replaceChildren(...lines.map(line => make('div', line)));
}

function moveCursor(at) {
  xray.at = at;
  if (at) setRow(at[1]);
  showValue();
  clearTimeout(probeTimer);
  xray.probed = ''; // so that an answer about the last pixel is ignored
  if (at && xray.frame) probeTimer = setTimeout(() => {
    const {columns, rows, factor} = xray.frame, pixel = [Math.floor(at[0] * columns * factor), Math.floor(at[1] * rows * factor)];
    xray.probed = String(pixel);
    say({probe: pixel});
  }, 150);
}

// The wheel zooms the image about the cursor, dragging moves it, and a double click shows all of it. px of the page.
const lens = {zoom: 1, x: 0, y: 0};
function setLens(zoom, x, y) {
  const sheet = byId('sheet'), room = [sheet.offsetWidth, sheet.offsetHeight].map(side => (zoom - 1) * side / 2);
  Object.assign(lens, {zoom, x: clamp(x, -room[0], room[0]), y: clamp(y, -room[1], room[1])});
  sheet.style.transform = zoom === 1 ? '' : `translate(${lens.x}px, ${lens.y}px) scale(${zoom})`;
}
function zoomFilm(event) {
  const rect = byId('sheet').getBoundingClientRect(), lines = event.deltaMode === 1 ? 16 : 1;
  const zoom = clamp(lens.zoom * Math.exp(-clamp(event.deltaY * lines, -240, 240) * 0.0025), 1, 40), share = zoom / lens.zoom;
  const at = [event.clientX - rect.left - rect.width / 2 + lens.x, event.clientY - rect.top - rect.height / 2 + lens.y];
  event.preventDefault();
  setLens(zoom, at[0] - share * (at[0] - lens.x), at[1] - share * (at[1] - lens.y));
  moveCursor(placeOn(event));
}
function listenToLens() {
  film.addEventListener('wheel', zoomFilm, {passive: false});
  film.addEventListener('dblclick', () => setLens(1, 0, 0));
  film.addEventListener('pointerdown', event => { if (!profile.on && lens.zoom > 1) film.setPointerCapture(event.pointerId); });
  film.addEventListener('pointermove', event => {
    if (!profile.on && event.buttons & 1) setLens(lens.zoom, lens.x + event.movementX, lens.y + event.movementY);
  });
  new ResizeObserver(() => setLens(lens.zoom, lens.x, lens.y)).observe(byId('sheet'));
}

function listenToFilm() {
  listenToLens();
  film.addEventListener('pointermove', event => { if (!profile.drags) moveCursor(placeOn(event)); });
  film.addEventListener('pointerleave', () => moveCursor(null));
  net.hear.probed = message => { if (xray.at && String(message.probed) === xray.probed) showValue(message.parts); };
  const typed = () => setWindow(Number(byId('low').value), Number(byId('high').value));
  byId('low').onchange = byId('high').onchange = typed;
  byId('auto').onclick = () => {
    xray.auto = !xray.auto;
    byId('auto').setAttribute('aria-pressed', xray.auto);
    if (xray.auto && xray.frame) showFrame(xray.frame);
  };
  byId('invert').onclick = () => { byId('invert').setAttribute('aria-pressed', xray.inverted = !xray.inverted); paint(); paintSlices(); };
  byId('keep').onclick = () => {
    xray.before = xray.before ? null : xray.frame;
    byId('keep').setAttribute('aria-pressed', !!xray.before);
    byId('split').hidden = !xray.before;
    paint();
  };
  byId('split').oninput = () => { xray.split = Number(byId('split').value); paint(); };
  const histogram = byId('histogram');
  let end = '';
  const pull = event => {
    const {ends} = xray, value = ends[0] + event.offsetX / histogram.clientWidth * (ends[1] - ends[0]);
    if (!end) end = Math.abs(value - xray.low) < Math.abs(value - xray.high) ? 'low' : 'high';
    setWindow(end === 'low' ? value : xray.low, end === 'high' ? value : xray.high);
  };
  histogram.onpointerdown = event => { histogram.setPointerCapture(event.pointerId); end = ''; pull(event); };
  histogram.onpointermove = event => { if (event.buttons) pull(event); };
}
