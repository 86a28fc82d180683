// The controls of beam, noise, breath, scan and of the dials of accuracy. Each sets keys of the scene file.
'use strict';

// A number with its slider; the picture follows while it is dragged.
function dial(id, path, fallback) {
  const box = byId(id), slider = box.querySelector('input[type=range]'), text = box.querySelector('input[type=number]');
  let begun = null;
  slider.oninput = () => { begun = begun || mark(); text.value = slider.value; set(path, Number(slider.value), true, begun); };
  slider.onchange = () => { const old = begun; begun = null; set(path, Number(slider.value), false, old); };
  text.onchange = () => { if (text.value !== '' && Number.isFinite(Number(text.value))) set(path, Number(text.value)); };
  watch(() => {
    const value = valueOf(path), shown = typeof value === 'number' ? value : fallback;
    if (document.activeElement !== text) text.value = shown;
    if (!begun) slider.value = shown;
  });
}

// The filters of a tube: name and millimetres each.
function showFilters() {
  const box = byId('filters'), name = ['Filter', 'Filters', 'Filtration'].find(n => valueOf('Source.Beam.' + n)) || 'Filter';
  const list = valueOf('Source.Beam.' + name) || [], put = next => { set('Source.Beam.' + name, next); showFilters(); };
  if (box.contains(document.activeElement) && document.activeElement.tagName === 'INPUT') return;
  box.replaceChildren(...list.map((filter, i) => {
    const row = make('div', '', 'row'), matter = make('input'), mm = make('input'), drop = make('button', 'remove');
    const changedTo = () => { document.activeElement.blur(); put(list.map((f, k) => k === i ? [matter.value, Number(mm.value), f[2] || 'mm'] : f)); };
    Object.assign(matter, {value: filter[0], size: 6}), Object.assign(mm, {type: 'number', step: 'any', min: 0, value: filter[1]});
    matter.setAttribute('aria-label', 'Material of the filter'), mm.setAttribute('aria-label', 'Thickness of the filter');
    matter.onchange = mm.onchange = changedTo;
    drop.onclick = () => put(list.filter((_, k) => k !== i));
    row.append(matter, mm, make('span', filter[2] || 'mm', 'faint'), drop);
    return row;
  }));
  const more = make('button', 'add a filter');
  more.onclick = () => put([...list, ['Al', 1, 'mm']]);
  box.append(more);
}

function showBeam() {
  const beam = valueOf('Source.Beam'), isTube = !!beam && !Array.isArray(beam) && (valueOf('Source.Beam.kVp') ?? valueOf('Source.Beam.PeakKiloVoltage')) !== undefined;
  const isMono = Array.isArray(beam) && beam.length === 1;
  byId('tube').hidden = !isTube, byId('mono').hidden = !isMono;
  byId('make-tube').hidden = isTube;
  if (isTube) showFilters();
  if (isMono && document.activeElement !== byId('energy')) byId('energy').value = beam[0][keyOf(beam[0], 'Energy')];
}

function fillBeam() {
  dial('kv', keyOf(valueOf('Source.Beam'), 'PeakKiloVoltage') ? 'Source.Beam.PeakKiloVoltage' : 'Source.Beam.kVp', 80);
  dial('mas', 'Source.Beam.mAs', 1);
  byId('energy').onchange = () => {
    const beam = structuredClone(valueOf('Source.Beam'));
    beam[0][keyOf(beam[0], 'Energy')] = Number(byId('energy').value);
    set('Source.Beam', beam);
  };
  byId('make-tube').onclick = () => set('Source.Beam', {kVp: 80, Filter: [['Al', 2.5, 'mm']]});
  byId('noise').onchange = () => set('Noise', byId('noise').checked);
  watch(() => { byId('noise').checked = !!valueOf('Noise'); showBeam(); });
}

// The edges of photon-counting bands, and the band that is shown.
function fillBands() {
  const text = byId('bands'), channel = byId('channel');
  text.onchange = () => {
    const edges = text.value.split(/[\s,;]+/).filter(Boolean).map(Number);
    if (edges.length !== 1 && edges.length <= 17 && edges.every((x, k) => x >= 0 && x < Infinity && (k === 0 || x > edges[k - 1])))
      return alter(s => { s.bands = edges, s.channel = 0; });
    text.value = state.bands.join(', ');
    showSentence('Bands are 2 to 17 rising edges in keV, such as 20, 40, 60.');
  };
  channel.onchange = () => alter(s => { s.channel = Number(channel.value); });
  watch(() => {
    if (document.activeElement !== text) text.value = state.bands.join(', ');
    channel.hidden = state.bands.length < 2;
    channel.replaceChildren(...state.bands.slice(1).map((edge, k) => new Option(`${state.bands[k]} to ${edge} keV`, k)));
    channel.value = state.channel;
  });
}

function fillMotion() {
  const phase = byId('phase'), play = byId('play'), projection = byId('projection');
  let begun = null;
  byId('breath').hidden = !live || live.period === null;
  byId('scan').hidden = !live || live.projections < 2;
  phase.oninput = () => { begun = begun || mark(); alter(s => { s.phase = Number(phase.value) % 1, s.play = false; }, true, begun); change(); };
  phase.onchange = () => { const old = begun; begun = null; alter(s => { s.phase = Number(phase.value) % 1, s.play = false; }, false, old); };
  play.onclick = () => { alter(s => { s.play = !s.play, s.phase = s.phase ?? 0; }); change(); };
  projection.max = live ? live.projections - 1 : 0;
  projection.oninput = () => { begun = begun || mark(); alter(s => { s.projection = Number(projection.value); }, true, begun); };
  projection.onchange = () => { const old = begun; begun = null; alter(s => { s.projection = Number(projection.value); }, false, old); };
  watch(() => {
    if (!begun) phase.value = state.phase ?? 0, projection.value = state.projection ?? 0;
    byId('phase-text').textContent = state.phase === null ? AS_FIRST : number(state.phase, 3);
    byId('projection-text').textContent = state.projection === null ? 'the scene\u2019s own view' : `${state.projection} of ${live.projections}, ${number(live.angles[state.projection] ?? NaN, 4)}\u00b0`;
    play.textContent = state.play ? 'stop' : 'breathe';
  });
}

function fillDials() {
  const choices = {tolerance: 'Tolerance', precision: 'Precision', rays: 'Detector.Oversampling', scatter: 'Scatter'};
  const read = {tolerance: Number, precision: text => text, rays: Number, scatter: text => text === 'off' ? false : Number(text)};
  for (const [id, path] of Object.entries(choices)) {
    const box = byId(id);
    box.onchange = () => set(path, read[id](box.value));
    watch(() => {
      const value = valueOf(path), text = value === undefined ? box.dataset.none : id === 'scatter' && !value ? 'off' : String(typeof value === 'object' ? value.Tolerance : value);
      if (![...box.options].some(option => option.value === text)) box.append(new Option(text, text));
      box.value = text;
    });
  }
  byId('key-form').onsubmit = event => {
    event.preventDefault();
    const words = byId('key').value, at = words.indexOf('=');
    if (at < 1) return showSentence('A key is set as KEY=VALUE, such as Source.Beam.kVp=90.');
    const text = words.slice(at + 1).trim();
    let value = text;
    try { value = JSON.parse(text); } catch (error) { /* a word without quotes is a text */ }
    set(words.slice(0, at).trim(), value);
  };
  watch(() => {
    byId('keys').replaceChildren(...Object.entries(state.settings).map(([key, value]) => {
      const row = make('div', '', 'row'), drop = make('button', AS_FIRST);
      drop.onclick = () => alter(s => { delete s.settings[key]; });
      row.append(make('code', `${key}=${JSON.stringify(value)}`), drop);
      return row;
    }));
  });
}
