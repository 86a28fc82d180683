// The list of parts, and what is chosen: its numbers to type, material and opacity.
'use strict';
const field = (label, value, act, step = 'any', unit = '') => {
  const row = make('label', label, 'field'), input = make('input');
  Object.assign(input, {type: 'number', step, value});
  input.onchange = () => { if (input.value !== '' && Number.isFinite(Number(input.value))) act(Number(input.value)); };
  row.append(input, make('span', unit, 'faint'));
  return row;
};

function showRows() {
  rows.forEach((row, i) => {
    row.className = chosen.kind === 'part' && chosen.part === i ? 'row part chosen' : 'row part';
    row.firstChild.checked = meshes.length ? meshes[i].visible : true;
    row.querySelector('button').setAttribute('aria-pressed', chosen.part === i);
  });
  for (const kind of ['source', 'detector']) byId('choose-' + kind).setAttribute('aria-pressed', chosen.kind === kind);
}

function fillParts() {
  rows = scene.parts.map((part, i) => {
    const row = make('div', '', 'row part'), box = make('input'), name = make('button', part.label, 'plain'), colour = make('span', '', 'swatch');
    Object.assign(box, {type: 'checkbox', checked: true, title: 'shown in 3D'});
    box.setAttribute('aria-label', 'show ' + part.label);
    box.onchange = () => { if (meshes.length) meshes[i].visible = box.checked; change(); };
    name.onclick = () => choose(chosen.part === i ? '' : 'part', chosen.part === i ? -1 : i);
    colour.style.background = `rgb(${part.colour.slice(0, 3).join(' ')})`;
    row.append(box, colour, name);
    return row;
  });
  byId('list').replaceChildren(...rows);
  listenToList(byId('find'), (i, on) => { if (meshes.length) meshes[i].visible = on; showRows(); change(); });
  byId('find').onkeydown = event => {
    const first = rows.findIndex(row => !row.hidden);
    if (event.key === 'Enter' && first >= 0) choose('part', first);
  };
  for (const kind of ['source', 'detector']) byId('choose-' + kind).onclick = () => choose(chosen.kind === kind ? '' : kind);
}

// Three numbers of a place, and three of a turn that is made when it is typed.
function poseFields(middle) {
  const box = make('div', '', 'grid'), names = ['x', 'y', 'z'];
  names.forEach((name, k) => box.append(field(name, number(middle[k], 7), value =>
    moveChosen(shift(AXES[k].map(a => a * (value - middle[k])))), 'any', 'mm')));
  if (canTurn()) names.forEach((name, k) => box.append(field('turn ' + name, 0, value =>
    moveChosen(turnAbout(middle, AXES[k], value * Math.PI / 180)), 'any', '\u00b0')));
  return box;
}

function describe() {
  const about = byId('about'), middle = middleOf(), typed = about.contains(document.activeElement) ? document.activeElement : null;
  const place = typed ? [...about.querySelectorAll('input')].indexOf(typed) : -1;
  about.replaceChildren();
  if (!chosen.kind) return about.append(make('p', 'Click a part, the source or the detector to choose it; arrows move it, rings turn it.', 'faint'));
  about.append(make('strong', chosen.kind === 'part' ? scene.parts[chosen.part].label : chosen.kind));
  if (chosen.kind === 'part') about.append(...aboutPart());
  if (middle) about.append(poseFields(middle));
  if (chosen.kind !== 'part' && middle)
    about.append(make('p', `source to detector ${number(size(add(scene.view.centre, -1, scene.view.source)), 5)} mm`, 'faint'));
  if (place >= 0 && about.querySelectorAll('input')[place]) about.querySelectorAll('input')[place].focus();
}

function aboutPart() {
  const part = scene.parts[chosen.part], mesh = meshes[chosen.part], row = make('div', '', 'row'), slider = make('input'), alone = make('button', 'only this');
  const home = make('button', 'back to its place');
  const words = [part.material, part.density > 0 ? number(part.density) + ' g/cm\u00b3' : '', `${part.of} triangles`].filter(Boolean);
  Object.assign(slider, {type: 'range', min: 0, max: 1, step: 0.01, value: mesh ? mesh.colour[3] : 1});
  slider.setAttribute('aria-label', 'Opacity in 3D');
  slider.oninput = () => { mesh.colour[3] = Number(slider.value); change(); };
  alone.onclick = () => { meshes.forEach((m, i) => { m.visible = i === chosen.part; }); showRows(); change(); };
  home.onclick = () => { const i = chosen.part; alter(s => { delete s.poses[i]; }); describe(); change(); };
  home.disabled = !state.poses[chosen.part];
  row.append(make('span', 'opacity', 'faint'), slider, alone, home);
  return [make('p', words.join(', '), 'faint'), row];
}
