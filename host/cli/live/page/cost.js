// Cost of the image: its time by stages, the effects that are on, and what each dial would change, as it was measured.
'use strict';
const rates = [];

// Images a second of the last two; 0: too few.
const perSecond = () => rates.length > 5 ? 1000 * (rates.length - 1) / (performance.now() - rates[0]) : 0;

function showCost(frame) {
  const now = performance.now();
  rates.push(now);
  while (rates.length && now - rates[0] > 2000) rates.shift();
  const each = rates.length > 5 ? `, ${number(1000 * (rates.length - 1) / (now - rates[0]), 3)} images/s` : '';
  const reduced = frame.factor > 1 ? `, every ${frame.factor}th pixel while it moves` : '', notes = [];
  byId('ms').textContent = `${number(frame.ms, 3)} ms for ${frame.columns} x ${frame.rows}${each}${reduced}`;
  if (frame.notes & 2) notes.push('Some values are not finite; they are shown as the largest.');
  if (frame.notes & 4) notes.push('Some path lengths lie outside the range for which the tolerance was verified.');
  if (frame.notes & 8) notes.push('The scatter is refined while nothing moves.');
  byId('notes').textContent = notes.join(' ');
}

function bars(box, pairs, text) {
  const most = Math.max(1e-9, ...pairs.map(([, value]) => value));
  box.replaceChildren(...pairs.map(([name, value]) => {
    const row = make('tr'), cell = make('td'), bar = make('div', '', 'bar');
    bar.style.width = 100 * value / most + '%';
    cell.append(bar);
    row.append(make('th', name), cell, make('td', text(value), 'number'));
    return row;
  }));
}

// Adds a frame to the sinogram when both the frame and its message have arrived, in either order.
function pairShot() {
  if (net.shot && xray.frame && net.shot.shot === xray.frame.number) noteProjection(xray.frame, net.shot.state);
}

// While the scene breathes by itself, most messages about frames have the phase alone.
function showPhase(phase) {
  state.phase = phase;
  change();
}

let lastShot = 0, lastView = '';
function showShot(message) {
  if (!live) return;
  if (!message.view) return showPhase(message.phase); // all else is as before
  const now = performance.now(), isCalm = now - lastShot > 200 || !state.play; // while it breathes, texts follow five times a second
  if (isCalm) lastShot = now, bars(byId('stages'), Object.entries(message.stages), ms => number(ms, 3) + ' ms');
  byId('scattered').textContent = message.scatter ? `scatter: ${message.scatter.histories} photons in ${number(message.scatter.seconds, 3)} s, mean ${number(message.scatter.mean, 3)} +- ${number(message.scatter.sigma, 2)}` : '';
  live.beam = message.beam;
  if (isCalm) showExposure(live.beam);
  net.shot = message;
  pairShot();
  const view = JSON.stringify(message.view);
  if (view !== lastView) {
    lastView = view;
    takeView(message.view);
  }
  if (state.play && message.phase !== null) {
    state.phase = message.phase;
    if (isCalm) changed();
  }
  if (!grip && chosen.kind && chosen.kind !== 'part') describe();
  if (!isOwner()) {
    const {wish, ...kept} = message.state;
    state = kept, net.sent = wish;
    changed();
  }
  change();
}

function showPlan() {
  const plan = live.plan, on = plan.effects.filter(effect => effect.on);
  byId('plan').textContent = `${plan.precision}, ${plan.triangles} triangles, ${plan.nodes} of ${plan.bins} energies, ${plan.planes} planes, ` +
    `${plan.samples} rays a pixel; error of fewer energies at most ${number(plan.bound, 2)}; loaded in ${number(live.load_ms, 3)} ms, planned in ${number(live.plan_ms, 3)} ms on ${live.device}`;
  byId('warnings').replaceChildren(...(live.warnings || []).map(sentence => make('p', sentence)));
  byId('effects').replaceChildren(...on.map(effect => {
    const row = make('tr');
    row.append(make('th', effect.name), make('td', effect.reason, 'faint'));
    return row;
  }));
}

// Each result with a switch that sets the dial.
function showMeasured(message) {
  const body = byId('results');
  byId('measure').disabled = message.measured !== null;
  if (message.measured === null) return;
  if (message.key === null) body.replaceChildren();
  const row = make('tr'), button = make('button', message.measured, 'plain'), when = new Date(1000 * message.when).toLocaleTimeString();
  if (message.key) button.onclick = () => set(message.key, message.value);
  else button.disabled = true;
  const name = make('th');
  name.append(button);
  row.title = message.sentence || `measured at ${when}`;
  row.append(name, make('td', message.ms === null ? 'unknown' : number(message.ms, 3) + ' ms', 'number'),
    make('td', message.key === null ? '' : message.error === null ? 'unknown' : number(100 * message.error, 2) + ' %', 'number'));
  body.append(row);
}

function listenToCost() {
  byId('measure').onclick = () => { if (isOwner()) byId('results').replaceChildren(), byId('measure').disabled = true, say({measure: true}); };
  net.hear.measured = showMeasured;
  net.hear.shot = showShot;
}
