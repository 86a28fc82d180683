// The page's wish: settings on top of the scene file, and what moves parts. Undo goes through older ones.
'use strict';
let live = null; // what the server says of the scene
// As the file has it; with a radiograph, the projection that it was taken from.
const fresh = () => ({settings: {}, poses: {}, phase: null, projection: live?.fixed?.projection ?? null, quantity: 'attenuation', bands: [], channel: 0, play: false});
let state = fresh();
const trail = {past: [], future: []}, watchers = []; // watchers: called when the state has changed

const plain = name => name.toLowerCase().replace(/[\s_-]/g, '');
const keyOf = (object, name) => Object.keys(object || {}).find(key => plain(key) === plain(name));

// The value of a path of the scene file, with what was set; undefined: there is none.
function valueOf(path) {
  for (const [key, value] of Object.entries(state.settings)) if (plain(key) === plain(path)) return value === null ? undefined : value;
  let at = live && live.document;
  for (const step of path.split('.')) {
    if (at === null || typeof at !== 'object') return undefined;
    at = Array.isArray(at) ? at[Number(step)] : at[keyOf(at, step)];
  }
  return at;
}

const watch = act => { watchers.push(act); act(); };
const changed = () => watchers.forEach(act => act());
const isOwner = () => net.role === 'owner';

// States by their wish, and the last one of which there is an image: what the server refuses is taken back.
const asked = new Map();
let good = null;
function noteGood(wish) {
  good = asked.get(wish) ?? good;
  for (const older of asked.keys()) if (older < wish) asked.delete(older);
}
function giveUp(wish) {
  const bad = asked.get(wish);
  if (!isOwner() || !good || !bad || bad === good || bad !== JSON.stringify(state)) return;
  state = JSON.parse(good);
  if (trail.past.at(-1) === good) trail.past.pop();
  ask(false);
}

function ask(dragging) {
  sendWish(() => {
    asked.set(net.sent, JSON.stringify(state));
    return {...state, drag: dragging};
  });
  byId('undo').disabled = !trail.past.length;
  byId('redo').disabled = !trail.future.length;
  changed();
}

// Changes the state by a function. While something is dragged, `begun` is what mark() has returned.
function alter(act, dragging = false, begun = null) {
  if (!isOwner()) return;
  const old = begun || JSON.stringify(state);
  byId('sentence').hidden = true;
  act(state);
  if (!dragging && JSON.stringify(state) !== old) {
    trail.past.push(old);
    if (trail.past.length > 200) trail.past.shift();
    trail.future = [];
  }
  ask(dragging);
}
const mark = () => JSON.stringify(state);

function set(path, value, dragging = false, begun = null) {
  alter(s => {
    for (const key of Object.keys(s.settings)) if (plain(key) === plain(path)) delete s.settings[key];
    s.settings[path] = value;
  }, dragging, begun);
}

function step(from, to) {
  if (!isOwner() || !trail[from].length) return;
  trail[to].push(JSON.stringify(state));
  state = JSON.parse(trail[from].pop());
  ask(false);
}
const undo = () => step('past', 'future'), redo = () => step('future', 'past');
const reset = () => alter(s => Object.assign(s, fresh()));

// A geometry that changes makes a new page; what can be undone goes with it.
function keepHistory() {
  try { sessionStorage.setItem('trail', JSON.stringify(trail)); } catch (error) { /* private windows may have none */ }
}
function findHistory() {
  try { Object.assign(trail, JSON.parse(sessionStorage.getItem('trail')) || {}); } catch (error) { /* likewise */ }
}
