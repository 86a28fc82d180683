// Mouse, fingers, wheel and keys on the 3D view, places for the eye, and the list of parts: for the pages of `view` and of `live`.
// Each of them says what a place of the canvas does, point(event) under the mouse and pick(x, y) clicked, and has a resize().
'use strict';
const byId = id => document.getElementById(id);
const make = (kind, text = '', name = '') => Object.assign(document.createElement(kind), {textContent: text, className: name});
const number = (x, digits = 4) => x === null || !Number.isFinite(x) ? '-' : String(Number(x.toPrecision(digits)));
let dirty = true;
let standing = 'start'; // where the eye was put, until it is moved by hand
let bare = false; // in a frame of another page, which scrolls until the scene is clicked
let rows = []; // of the list of parts
const change = () => { dirty = true; };

function resizeTo(ratio) {
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width, canvas.height = height;
  if (standing) lookAs(standing);
  change();
}

// Where the eye stands at first: across the beam, a little from the source and from above, or as the command was told.
function lookAs(name) {
  const v = scene.view, up = v.up, aspect = canvas.width / canvas.height;
  const beam = unit(add(v.centre, -1, v.source)), sides = {front: [0, -1, 0], side: [1, 0, 0], top: [0, 0, 1]};
  if (sides[name]) look(sides[name], [0, 0, 1]);
  else if (name === 'source') look(beam.map(x => -x), up);
  else if (name === 'start' && scene.from) look(scene.from, scene.up);
  else if (name === 'start') look(add(add(unit(cross(beam, up)), -0.55, beam), 0.42, unit(up)), up);
  if (name === 'parts') {
    const of = shot.chosen >= 0 ? [shot.chosen] : [...meshes.keys()].filter(i => meshes[i].visible);
    fit((of.length ? of : [...meshes.keys()]).flatMap(i => boxPoints(scene.parts[i].low, meshes[i].high)), aspect);
  } else fit(whole.points, aspect);
  standing = name;
  change();
}

// The ground of the page and of the picture.
function darken(on) {
  document.documentElement.classList.toggle('dark', on);
  const ground = getComputedStyle(document.documentElement).getPropertyValue('--ground').trim();
  shot.ground = [1, 3, 5].map(i => parseInt(ground.slice(i, i + 2), 16) / 255);
  byId('dark').setAttribute('aria-pressed', on);
  change();
}

// One finger or the left button turns; two fingers, another button or Shift move; wheel and pinch zoom.
const fingers = new Map();
let moved = 0;
function dragged(event) {
  const old = fingers.get(event.pointerId), rect = canvas.getBoundingClientRect(), height = rect.height;
  if (!old) return point(event);
  const dx = event.clientX - old.x, dy = event.clientY - old.y;
  moved += Math.hypot(dx, dy);
  if (fingers.size === 1) {
    if (event.shiftKey || event.buttons & 6) pan(dx / height, dy / height);
    else orbit(dx / height * Math.PI, dy / height * Math.PI);
  } else if (fingers.size === 2) {
    const other = [...fingers.values()].find(f => f !== old), length = (x, y) => Math.max(Math.hypot(x - other.x, y - other.y), 1);
    const x = (event.clientX + other.x) / 2 - rect.left, y = (event.clientY + other.y) / 2 - rect.top;
    pan(dx / height / 2, dy / height / 2);
    zoom(length(old.x, old.y) / length(event.clientX, event.clientY), (x - rect.width / 2) / height, (height / 2 - y) / height);
  }
  old.x = event.clientX, old.y = event.clientY;
  standing = '';
  change();
}

function listenToCanvas() {
  canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (fingers.size === 1) moved = 0;
  };
  canvas.onpointermove = dragged;
  canvas.onpointerup = canvas.onpointercancel = event => {
    fingers.delete(event.pointerId);
    if (event.type === 'pointerup' && moved < 4 && event.button === 0) pick(event.offsetX, event.offsetY);
  };
  canvas.oncontextmenu = event => event.preventDefault();
  canvas.ondblclick = () => lookAs('parts');
  canvas.addEventListener('wheel', event => {
    const height = canvas.clientHeight, lines = event.deltaMode === 1 ? 16 : 1;
    if (bare && document.activeElement !== canvas) return;
    event.preventDefault();
    zoom(Math.exp(clamp(event.deltaY * lines, -240, 240) * 0.0015), (event.offsetX - canvas.clientWidth / 2) / height, (height / 2 - event.offsetY) / height);
    standing = '';
    change();
  }, {passive: false});
  document.querySelectorAll('[data-look]').forEach(button => { button.onclick = () => lookAs(button.dataset.look); });
  new ResizeObserver(resize).observe(canvas);
}

const nearer = factor => { zoom(factor, 0, 0); standing = ''; };
const keysOfView = {
  '0': () => lookAs('start'), Home: () => lookAs('start'), '1': () => lookAs('front'), '2': () => lookAs('side'), '3': () => lookAs('top'),
  '4': () => lookAs('source'), f: () => lookAs('parts'), '+': () => nearer(0.9), '=': () => nearer(0.9), '-': () => nearer(1 / 0.9),
  '?': () => { const box = byId('key-list'); if (box.open) box.close(); else box.show(); },
};
const pressedKey = event => event.key.length === 1 ? event.key.toLowerCase() : event.key;

// An arrow key turns, with Shift it moves. Returns whether it is one.
const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
function pressArrow(event) {
  const arrow = arrows[event.key];
  if (!arrow) return false;
  if (event.shiftKey) pan(arrow[0] * 0.04, arrow[1] * 0.04);
  else orbit(arrow[0] * 0.09, arrow[1] * 0.09);
  standing = '';
  return true;
}

// The list of parts is searched by a box; show(i, on) shows or hides a part.
function listenToList(box, show) {
  box.oninput = () => {
    const wanted = box.value.toLowerCase();
    rows.forEach((row, i) => { row.hidden = !scene.parts[i].label.toLowerCase().includes(wanted); });
  };
  for (const [id, on] of [['all', true], ['none', false]])
    byId(id).onclick = () => rows.forEach((row, i) => { if (!row.hidden) show(i, on); });
}
