// The page begins: what the server says is handed out, and keys.
'use strict';
let firstGeometry = null, sentenceTimer = 0;

function showRole(text) {
  byId('role').textContent = text;
  document.documentElement.classList.toggle('reader', !isOwner());
}

const tellRole = () => showRole(isOwner() ? '' : 'another page changes the scene; this one shows it');

function showSentence(text, stays = false) {
  const box = byId('sentence');
  box.textContent = text;
  box.hidden = !text;
  clearTimeout(sentenceTimer);
  if (!stays) sentenceTimer = setTimeout(() => { box.hidden = true; }, 8000);
}

function setDark(on) {
  darken(on);
  drawHistogram();
  drawProfile();
}

// The scene as the server has it. Other surfaces need another page.
function takeScene(message) {
  const is_first = live === null;
  live = message.scene;
  if (firstGeometry !== null && live.geometry !== firstGeometry) return net.channel.renew();
  firstGeometry = live.geometry;
  if (is_first) {
    const {wish, ...kept} = live.state;
    state = kept;
    net.sent = wish;
    good = JSON.stringify(state);
    fillBeam();
    fillBands();
    fillSpot();
    fillJaws();
    fillPresets();
    fillMotion();
    listenToSinogram();
    fillDials();
    fillRadiograph();
    fillSlices();
    ask3D();
  }
  showSentence('');
  showExposure(live.beam);
  if (live.dose) takeDose(live.dose);
  showPlan();
  changed();
}
// Takes a state that was changed outside of the page. fresh: and older states are about another document.
function adopt({adopted, fresh}) {
  const {wish, ...kept} = adopted;
  if (fresh) trail.past = [];
  else trail.past.push(JSON.stringify(state));
  trail.future = [];
  state = kept, net.sent = wish;
  asked.clear();
  good = JSON.stringify(state);
  changed();
  ask3D();
}
const ask3D = () => { describe(); change(); byId('undo').disabled = !trail.past.length; byId('redo').disabled = !trail.future.length; };

const keys = {
  ...keysOfView, d: () => byId('dark').click(), i: () => byId('invert').click(),
  a: () => byId('auto').click(), b: () => byId('keep').click(), l: () => byId('profiles').click(), m: () => byId('measure-3d').click(), c: () => nextCut(), Escape: () => { choose(''); clearTape(); },
  s: () => choose('source'), t: () => choose('detector'), '/': () => byId('find').focus(),
  ' ': () => { if (!byId('breath').hidden) byId('play').click(); },
};

// With Alt, arrow and page keys move what is chosen: along x, z and y, by 1 mm, with Shift by 10 mm.
const pushes = {ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1], PageUp: [0, 1, 0], PageDown: [0, -1, 0]};

function pressed(event) {
  const key = pressedKey(event), isField = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
  if ((event.ctrlKey || event.metaKey) && key === 'z' && !isField) {
    if (event.shiftKey) redo(); else undo();
  } else if (event.altKey && pushes[key] && chosen.kind) {
    moveChosen(shift(pushes[key].map(x => x * (event.shiftKey ? 10 : 1))));
  } else if (isField || event.ctrlKey || event.metaKey || event.altKey || (event.target.tagName === 'BUTTON' && key === ' ')) {
    return;
  } else if (key === 'Enter' && event.target === canvas && tape.on) addEnd(canvas.clientWidth / 2, canvas.clientHeight / 2);
  else if (!pressArrow(event)) {
    if (!keys[key]) return;
    keys[key]();
  }
  event.preventDefault();
  change();
}

// Compiles shaders and makes meshes, so that this browser draws by itself.
function prepareGL() {
  if (detector) return;
  Object.keys(shaders).forEach(compile);
  prepareMarks();
  uploadParts();
}

function begin3D() {
  measureWhole();
  prepareParts();
  listenToServed();
  listenToCanvas();
  listenToGizmo();
  listenToCut();
  listenToTape();
  lookAs('start');
  resize();
  requestAnimationFrame(step3D);
}

function begin() {
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  document.title = scene.name + ' - Skiagraph live';
  byId('name').textContent = scene.name;
  begin3D();
  fillParts();
  listenToFilm();
  listenToProfile();
  listenToCost();
  listenToTakes();
  findHistory();
  Object.assign(net, {show: showFrame, picture: showPicture});
  net.hear.role = message => { net.role = message.role; restartPictures(); tellRole(); registerEnded(); endSlice(); change(); };
  Object.assign(net.hear, {registering: showStep, registered: showFound});
  net.hear.scene = takeScene;
  net.hear.adopted = adopt;
  net.hear.dosed = message => takeDose(message.dosed);
  byId('dose-reset').onclick = resetDoses;
  net.hear.error = message => { settle(message.wish); giveUp(message.wish); showSentence(message.error, true); };
  net.hear.refused = message => { settle(net.sent); registerEnded(); endSlice(); showSentence(message.refused); };
  for (const [id, act] of Object.entries({undo, redo, reset})) byId(id).onclick = () => { act(); describe(); change(); };
  byId('help').onclick = keys['?'];
  byId('dark').onclick = () => setDark(!document.documentElement.classList.contains('dark'));
  document.addEventListener('keydown', pressed);
  document.querySelectorAll('details').forEach(box => { box.ontoggle = drawHistogram; });
  setDark(dark.matches);
  if (!isNotebook) dark.addEventListener('change', () => setDark(dark.matches));
  if (isNotebook) {
    document.documentElement.classList.add('notebook');
    Object.assign(byId('reset'), {textContent: AS_FIRST, title: 'the scene as it was when this page began, or Python last placed source, detector or beam'});
  }
  describe();
  net.channel = isNotebook ? frameChannel() : socketChannel();
}
begin();
