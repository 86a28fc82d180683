// The radiograph of --fixed: over the image, beside it or as the difference; and the button that registers the chosen part to it.
'use strict';
// frame: the radiograph. runs: a registration is under way.
const fixed = {frame: null, how: 'over', share: 0.5, runs: false};

// Whether an image is of the radiograph's view; a draft has larger pixels.
function isCompared(frame) {
  return !!fixed.frame && !!live && !!live.fixed && state.projection === live.fixed.projection &&
    ['columns', 'rows'].every(side => Math.max(1, Math.floor(fixed.frame[side] / frame.factor)) === frame[side]);
}

// The attenuation of the full colour: 2 at the left end of the slider, 0.02 at the right one.
const fullColour = () => 2 * 0.01 ** fixed.share;

// Model less radiograph: blue where the model attenuates less, red where more; the colours are those of the page of `register --report`.
function paintDifference(frame) {
  const table = of => Float32Array.from({length: 65536}, (_, n) => shownOf(of, n)), [ours, theirs] = [table(frame), table(fixed.frame)];
  const picture = new ImageData(frame.columns, frame.rows), most = fullColour(), ground = [238, 240, 243], less = [5, 48, 143], more = [166, 15, 31];
  for (let row = 0, at = 0; row < frame.rows; row++) {
    const first = Math.floor((row + 0.5) * fixed.frame.rows / frame.rows) * fixed.frame.columns;
    for (let column = 0; column < frame.columns; column++, at++) {
      const there = first + Math.floor((column + 0.5) * fixed.frame.columns / frame.columns);
      const by = ours[frame.numbers[at]] - theirs[fixed.frame.numbers[there]], share = Math.min(Math.abs(by) / most, 1), colour = by < 0 ? less : more;
      for (let k = 0; k < 3; k++) picture.data[4 * at + k] = ground[k] + share * (colour[k] - ground[k]);
      picture.data[4 * at + 3] = 255;
    }
  }
  pen.putImageData(picture, 0, 0);
}

// Draws it on the film. With an automatic window each has its own, because a radiograph's flat field may be a guess.
function paintRadiograph(frame) {
  if (fixed.how === 'off' || !isCompared(frame)) return;
  if (fixed.how === 'difference') return paintDifference(frame);
  const {columns, rows} = fixed.frame, sheet = new OffscreenCanvas(columns, rows), [low, high] = xray.auto ? windowOf(fixed.frame) : [xray.low, xray.high];
  const isBeside = fixed.how === 'beside', share = isBeside ? fixed.share : 1;
  sheet.getContext('2d').putImageData(paintFrame(fixed.frame, low, high).picture, 0, 0);
  pen.globalAlpha = isBeside ? 1 : fixed.share;
  pen.drawImage(sheet, 0, 0, share * columns, rows, 0, 0, share * film.width, film.height);
  pen.globalAlpha = 1;
}

function showRadiograph() {
  const isHere = !fixed.frame || !xray.frame || isCompared(xray.frame), slider = byId('fixed-share');
  byId('fixed').hidden = !live || !live.fixed;
  if (byId('fixed').hidden) return;
  const of = live.fixed.projection === null ? 'the scene\u2019s own view' : `projection ${live.fixed.projection}`;
  slider.hidden = fixed.how === 'off';
  slider.setAttribute('aria-label', {over: 'Opacity of the radiograph', beside: 'Radiograph to the left, image to the right', difference: 'Scale of the colours', off: ''}[fixed.how]);
  byId('fixed-text').textContent = `${live.fixed.path}, of ${of}. ` + (!isHere ? 'It is not shown: the image is of another view or size.' : fixed.how === 'difference' ?
    `Blue: the image attenuates less than the radiograph, red: more; the full colour is ${number(fullColour(), 2)} of -ln(I/I0).` : '');
  showRegister();
}

function showRegister() {
  const button = byId('register'), isPart = chosen.kind === 'part', isHere = !!xray.frame && isCompared(xray.frame);
  button.textContent = isPart ? `register ${scene.parts[chosen.part].label}` : 'register';
  button.disabled = !isPart || !isHere || !isOwner() || fixed.runs;
  byId('register-stop').hidden = !fixed.runs;
  if (!fixed.runs) byId('register-step').textContent = !isPart ? 'choose a part first' : isHere ? '' : 'show the radiograph\u2019s view first';
}

function registerEnded() {
  fixed.runs = false;
  showRegister();
}

function showStep({registering: {part, step, most}}) {
  fixed.runs = true;
  showRegister();
  byId('register-step').textContent = `${scene.parts[part].label}: step ${step} of at most ${most}`;
}

const short = x => Math.abs(x) < 1e-3 && x !== 0 ? x.toExponential(1) : number(x, 3);
// [name, unit that is shown, how many of them one is]
const freedomNames = [['shift x', 'mm', 1], ['shift y', 'mm', 1], ['shift z', 'mm', 1], ['turn x', '\u00b0', 180 / Math.PI], ['turn y', '\u00b0', 180 / Math.PI], ['turn z', '\u00b0', 180 / Math.PI]];

// Takes the pose that a registration has found as a wish, like that of a drag, but for a part that has moved meanwhile.
function showFound({registered: found}) {
  registerEnded();
  byId('freedoms').replaceChildren();
  if (found.error) {
    byId('verdict').className = 'warn';
    byId('verdict').textContent = found.error;
    return;
  }
  const isFailed = found.status === 'failed';
  byId('verdict').className = found.status === 'agrees' ? '' : 'warn';
  byId('verdict').textContent = [`${found.label}: ${found.verdict}. ` + (isFailed ? 'It stays where it was.' :
    `Moved by ${short(found.shift_mm)} mm, turned by ${short(found.turn_deg)}\u00b0.`), ...found.warnings].join(' ');
  const head = make('tr');
  head.append(make('th'), ...['sigma, noise alone', 'with structure', ''].map(text => make('td', text, 'number faint')));
  byId('freedoms').append(head, ...freedomNames.map(([name, unit, by], k) => {
    const row = make('tr');
    row.append(make('th', name), ...[found.sigma, found.sigma_structure].map(sigma => make('td', sigma[k] === null ? '-' : `${short(by * sigma[k])} ${unit}`, 'number')),
      make('td', found.determined[k] ? '' : 'not determined', 'warn'));
    return row;
  }));
  if (isFailed || !found.pose) return;
  alter(s => { s.poses[found.part] = found.pose; });
  describe();
  change();
}

function takeRadiograph(frame) {
  fixed.frame = frame;
  paint();
  showRadiograph();
}

function fillRadiograph() {
  const how = byId('fixed-how'), share = byId('fixed-share');
  how.onchange = () => { fixed.how = how.value; paint(); showRadiograph(); };
  share.oninput = () => { fixed.share = Number(share.value); paint(); showRadiograph(); };
  byId('register').onclick = () => {
    if (!say({register: chosen.part})) return;
    fixed.runs = true;
    byId('verdict').textContent = '';
    byId('freedoms').replaceChildren();
    showRegister();
    byId('register-step').textContent = 'preparing';
  };
  byId('register-stop').onclick = () => say({register: null});
  watch(showRadiograph);
}
