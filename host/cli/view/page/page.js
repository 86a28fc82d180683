// The page beside its picture: lists and controls, and its own keys.
'use strict';
const labels = []; // {element, point} at points of the world
let playing = false, before = 0;
const resize = () => resizeTo(window.devicePixelRatio || 1);

// Draws now; tests call it before they read pixels.
function draw() {
  drawScene();
  for (const {element, point} of labels) {
    const at = place(shot.m, point, canvas.clientWidth, canvas.clientHeight);
    element.hidden = !shot.marks || !at || at[0] < 0 || at[1] < 0 || at[0] > canvas.clientWidth || at[1] > canvas.clientHeight;
    if (element.hidden) continue;
    const x = clamp(at[0] + 8, 0, canvas.clientWidth - element.offsetWidth - 4);
    element.style.transform = `translate(${x}px, ${at[1] - 22}px)`;
  }
  dirty = false;
}

function step(now) {
  if (playing) {
    setTime(shot.time + (now - before) / 1000 / scene.motion.seconds);
    byId('moment').value = shot.time;
  }
  before = now;
  if (dirty) draw();
  requestAnimationFrame(step);
}

function setTime(time) {
  shot.time = time - Math.floor(time);
  byId('now').textContent = `${(shot.time * scene.motion.seconds).toFixed(2)} s of ${number(scene.motion.seconds, 3)} s`;
  change();
}

function play(on) {
  playing = on;
  byId('play').textContent = on ? 'pause' : 'play';
}

function press(id, on) {
  byId(id).setAttribute('aria-pressed', on);
  change();
}
const toggles = {
  parallel: () => press('parallel', camera.parallel = !camera.parallel),
  marks: () => press('marks', shot.marks = !shot.marks),
  panel: () => { press('panel', !document.querySelector('aside').classList.toggle('closed')); resize(); },
  sensitive: () => changes.size && colourParts(!isColoured()),
  dark: () => darken(!document.documentElement.classList.contains('dark')),
};

function showRow(i) {
  const mesh = meshes[i], colour = mesh.colour.slice(0, 3).map(x => Math.round(255 * x));
  const opacity = isColoured() ? 1 : Math.max(mesh.colour[3], 0.2); // colours of a scale are read off
  rows[i].className = i === shot.chosen ? 'chosen' : i === shot.under ? 'under' : '';
  rows[i].firstChild.checked = mesh.visible;
  rows[i].querySelector('.swatch').style.background = `rgb(${colour.join(' ')} / ${opacity})`;
}

function setUnder(i) {
  const old = shot.under;
  if (old === i) return;
  shot.under = i;
  for (const k of [old, i]) if (k >= 0) showRow(k);
  change();
}

function setChosen(i) {
  const old = shot.chosen;
  shot.chosen = i;
  for (const k of [old, i]) if (k >= 0) showRow(k);
  if (i >= 0 && rows[i].scrollIntoViewIfNeeded) rows[i].scrollIntoViewIfNeeded();
  describe();
  change();
}

function setVisible(i, on) {
  meshes[i].visible = on;
  showRow(i);
  change();
}

function fillTable(table, pairs) {
  table.replaceChildren(...pairs.map(([name, value]) => {
    const row = make('tr');
    row.append(make('th', name), make('td', value));
    return row;
  }));
}

// The chosen part, and how opaque it is.
function describe() {
  const about = byId('about'), part = scene.parts[shot.chosen], mesh = meshes[shot.chosen];
  if (!part) return about.replaceChildren(make('p', 'Point at a part to see its name; click it to choose it.', 'faint'));
  const table = make('table'), row = make('div', '', 'row'), slider = make('input'), sides = mesh.high.map((x, k) => x - part.low[k]);
  const pairs = [['box', sides.map(x => number(x, 3)).join(' x ') + ' mm'], ['triangles', part.shown === part.of ? part.of : `${part.shown} of ${part.of}`]];
  if (part.material) pairs.unshift(['material', part.material]);
  if (part.density > 0) pairs.splice(-2, 0, ['density', number(part.density) + ' g/cm\u00b3']);
  if (part.inside >= 0) pairs.push(['inside', scene.parts[part.inside].label]);
  const its = changeOf(shot.chosen);
  if (its) pairs.push(['for a mm', percent(its.largest)], ['along', its.direction.map(x => x.toFixed(2)).join(', ')]);
  fillTable(table, pairs);
  Object.assign(slider, {type: 'range', min: 0, max: 1, step: 0.01, value: mesh.colour[3]});
  slider.setAttribute('aria-label', 'Opacity');
  slider.oninput = () => { mesh.colour[3] = Number(slider.value); showRow(shot.chosen); change(); };
  const alone = make('button', 'only this');
  alone.onclick = () => meshes.forEach((_, i) => setVisible(i, i === shot.chosen));
  row.append(make('span', 'opacity', 'faint'), slider, alone);
  about.replaceChildren(make('strong', part.label), table, row);
}

function fillPanel() {
  const d = scene.distances, moves = scene.motion ? `, breathes for ${number(scene.motion.seconds, 3)} s` : '';
  document.title = scene.name + ' - Skiagraph';
  byId('name').textContent = scene.name;
  const of = scene.triangles.shown === scene.triangles.of ? '' : ` of ${scene.triangles.of}`;
  byId('size').textContent = `${scene.parts.length} parts, ${scene.triangles.shown}${of} triangles${moves}`;
  const pairs = [['magnification', number(d.magnification)], ['detector', `${number(d.width)} x ${number(d.height)} mm`],
    ['', `${scene.view.columns} x ${scene.view.rows} pixels`]];
  if (d.source_detector !== null) pairs.unshift(['source to detector', number(d.source_detector) + ' mm'], ['source to centre', number(d.source_object) + ' mm']);
  if (scene.path.length) pairs.push(['scan', `${scene.path.length / 3} positions of the source`]);
  fillTable(byId('measures'), pairs);
  rows = scene.parts.map((part, i) => {
    const row = make('label'), box = make('input');
    Object.assign(box, {type: 'checkbox', checked: true});
    box.onchange = () => setVisible(i, box.checked);
    const name = make('span', part.label, 'name');
    row.title = part.label;
    row.append(box, make('span', '', 'swatch'), name);
    if (changeOf(i)) row.append(make('span', percent(changeOf(i).largest), 'change'));
    row.onpointerenter = () => setUnder(i);
    row.onpointerleave = () => setUnder(-1);
    name.onclick = event => { event.preventDefault(); setChosen(shot.chosen === i ? -1 : i); };
    return row;
  });
  byId('list').append(...listed().map(i => rows[i]));
  rows.forEach((_, i) => showRow(i));
  listenToList(byId('filter'), setVisible);
  describe();
}

function addLabel(text, point) {
  const element = make('div', text, 'label');
  byId('labels').append(element);
  labels.push({element, point});
}

function fillLabels() {
  const v = scene.view, d = scene.distances, [low, high] = scene.box, length = 0.2 * Math.max(...high.map((x, k) => x - low[k]));
  const middle = v.strips.length / 2 - 1;
  addLabel(v.projection === 'point' ? 'source' : 'parallel beam', v.source);
  addLabel(d.source_detector === null ? 'detector' : `detector at ${number(d.source_detector)} mm`, v.strips[middle][0].map((x, k) => (x + v.strips[v.strips.length - 1 - middle][0][k]) / 2));
  ['x', 'y', 'z'].forEach((name, k) => addLabel(name, low.map((x, i) => x + (i === k) * length)));
  if (d.source_detector === null) return;
  addLabel(`${number(d.source_object)} mm to the centre`, add(v.source, d.source_object / 2, unit(add(v.centre, -1, v.source))));
}

let waiting = null;
function point(event) {
  if (event.pointerType === 'touch') return;
  if (!waiting) requestAnimationFrame(() => { pointAt(waiting.offsetX, waiting.offsetY); waiting = null; });
  waiting = event;
}

function pointAt(x, y) {
  const i = partAt(x, y), hint = byId('hint');
  setUnder(i);
  hint.hidden = i < 0;
  if (i < 0) return;
  hint.textContent = scene.parts[i].label;
  hint.style.transform = `translate(${clamp(x + 14, 0, canvas.clientWidth - hint.offsetWidth - 4)}px, ${y + 16}px)`;
}

const pick = (x, y) => setChosen(partAt(x, y));

function listenToMouse() {
  listenToCanvas();
  canvas.addEventListener('pointerdown', () => { byId('hint').hidden = true; });
  canvas.onpointerleave = () => { setUnder(-1); byId('hint').hidden = true; };
}

const keys = {
  ...keysOfView, p: toggles.parallel, m: toggles.marks, s: toggles.sensitive, d: toggles.dark, l: toggles.panel, Escape: () => setChosen(-1),
  ' ': () => scene.motion && play(!playing),
  h: () => shot.chosen >= 0 && setVisible(shot.chosen, !meshes[shot.chosen].visible),
};

function listenToKeys() {
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(text|search|range)$/.test(event.target.type)) return;
    if (event.target.tagName === 'BUTTON' && event.key === ' ') return;
    const act = keys[pressedKey(event)];
    if (!pressArrow(event)) {
      if (!act) return;
      act();
    }
    event.preventDefault();
    change();
  });
}

// In a frame of another page, NAME.html?bare: no list and no buttons, and the parts fill the picture.
function setBare(on) {
  document.documentElement.classList.toggle('bare', bare = on);
  resize();
  if (on) lookAs('parts');
}

function begin() {
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  Object.keys(shaders).forEach(compile);
  prepareMarks();
  measureWhole();
  prepareParts();
  uploadParts();
  fillPanel();
  fillLegend();
  fillLabels();
  listenToMouse();
  listenToKeys();
  for (const id of Object.keys(toggles)) byId(id).onclick = toggles[id];
  byId('help').onclick = keys['?'];
  darken(dark.matches);
  dark.addEventListener('change', () => darken(dark.matches));
  camera.parallel = scene.parallel;
  press('parallel', camera.parallel);
  resize();
  lookAs('start');
  setBare(location.search === '?bare');
  if (scene.motion) {
    byId('time').hidden = false;
    byId('moment').oninput = () => { play(false); setTime(Number(byId('moment').value)); };
    byId('play').onclick = () => play(!playing);
    setTime(0);
    play(!window.matchMedia('(prefers-reduced-motion: reduce)').matches);
  }
  byId('loading').hidden = true;
  requestAnimationFrame(step);
}

function fail(reason) {
  byId('loading').hidden = true;
  byId('failure').hidden = false;
  byId('failure').textContent = 'The scene cannot be drawn: ' + reason;
}
canvas.addEventListener('webglcontextlost', () => fail('the browser took the graphics memory away; load the page again.'));
if (!gl) fail('this browser has no WebGL 2, or it is switched off.');
else try { begin(); } catch (error) { fail(error.message); throw error; }
