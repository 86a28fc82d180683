// Downloads: the scene file, the command line, a Python script, and files of the image.
'use strict';
function save(name, bytes, type = 'application/octet-stream') {
  const link = make('a');
  link.href = URL.createObjectURL(new Blob([bytes], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Puts a value at a path of a scene file.
function putIn(object, path, value) {
  const steps = path.split('.'), last = steps.pop();
  let at = object;
  for (const step of steps) {
    const key = Array.isArray(at) ? Number(step) : keyOf(at, step) || step;
    at = at[key] = at[key] ?? {};
  }
  at[keyOf(at, last) || last] = value;
}

// [number in Samples, its Transform] of each part that was moved; the last move comes first, because it acts last.
function transforms(document) {
  const samples = document[keyOf(document, 'Samples')] || [], indices = samples.flatMap((sample, i) => typeof sample === 'object' ? [i] : []);
  return Object.entries(state.poses).filter(([part]) => indices[part] !== undefined).map(([part, m]) => {
    const sample = samples[indices[part]], columns = [0, 1, 2, 3].flatMap(c => [0, 1, 2, 3].map(r => m[4 * r + c]));
    return [indices[part], [['Matrix', columns], ...(sample[keyOf(sample, 'Transform')] || [])]];
  });
}

function sceneFile() {
  const document = structuredClone(live.document);
  for (const [path, value] of Object.entries(state.settings)) if (/^(source|detector)\./i.test(path)) putIn(document, path, value);
  for (const [index, transform] of transforms(document)) putIn(document, `Samples.${index}.Transform`, transform);
  return document;
}

const quoted = text => "'" + text.replaceAll("'", "'\\''") + "'";
function commandLine() {
  const words = Object.entries(state.settings).map(([key, value]) => `${key}=${JSON.stringify(value)}`);
  for (const [index, transform] of transforms(live.document)) words.push(`Samples.${index}.Transform=${JSON.stringify(transform)}`);
  const verb = state.phase === null ? 'image' : 'breathe', bands = state.bands.length && verb === 'image' ? ` --bands ${state.bands}` : '';
  const more = bands + (state.phase === null ? '' : ` --phase ${state.phase}`);
  return `skiagraph ${verb} ${quoted(live.path)}${words.map(word => ' --set ' + quoted(word)).join('')}${more} -o image.mha`;
}

// null, true and false are spelt differently in Python; texts are those of JSON.
const python = value => Array.isArray(value) ? `[${value.map(python).join(', ')}]` :
  value !== null && typeof value === 'object' ? `{${Object.entries(value).map(([k, v]) => `${JSON.stringify(k)}: ${python(v)}`).join(', ')}}` :
  value === null ? 'None' : value === true ? 'True' : value === false ? 'False' : JSON.stringify(value);

function pythonScript() {
  const lines = ['"""An image of a scene as it was set on the page of skiagraph live."""', 'import numpy as np', 'from skiagraph import Scene', ''];
  lines.push(`scene = Scene(${python(live.path)}, settings={`, ...Object.entries(state.settings).map(([k, v]) => `    ${python(k)}: ${python(v)},`), '})');
  for (const [part, m] of Object.entries(state.poses)) {
    const rows = [0, 4, 8, 12].map(r => python(m.slice(r, r + 4))), label = python(scene.parts[part].label);
    lines.push(`moved = np.array([${rows.join(', ')}])`, `scene[${label}].pose = moved @ scene[${label}].pose`);
  }
  if (state.phase !== null) lines.push(`scene.breathe(phase=${state.phase})`);
  lines.push(`image = scene.image(${state.bands.length ? `bands=[${state.bands.join(', ')}]` : ''})`, 'np.save("image.npy", image)', '');
  return lines.join('\n');
}

const takes = {
  json: () => save('scene.json', JSON.stringify(sceneFile(), null, 2) + '\n', 'application/json'),
  py: () => save('image.py', pythonScript(), 'text/x-python'),
  command: () => {
    byId('command').textContent = commandLine();
    byId('command').hidden = false;
    if (state.bands.length && state.phase !== null) showSentence('The verb breathe has no --bands, so the command leaves them out; the Python script has them.');
    if (navigator.clipboard) navigator.clipboard.writeText(commandLine()).catch(() => {});
  },
  png: () => say({take: 'png'}), tif: () => say({take: 'tif'}), mha: () => say({take: 'mha'}),
};

function listenToTakes() {
  document.querySelectorAll('[data-take]').forEach(button => { button.onclick = () => live && takes[button.dataset.take](); });
  net.file = file => save(file.name, file.bytes);
}
