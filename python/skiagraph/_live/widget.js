// A view of the widget: a frame with the page, and the way of its messages to the kernel and back.
const isDark = element => {
  for (let at = element; at; at = at.parentElement) {
    const [r, g, b, a = 1] = (getComputedStyle(at).backgroundColor.match(/[\d.]+/g) || [0, 0, 0, 0]).map(Number);
    if (a > 0) return 0.3 * r + 0.6 * g + 0.1 * b < 128;
  }
  return matchMedia('(prefers-color-scheme: dark)').matches;
};
const plain = view => view.buffer ? view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength) : view;

function render({model, el}) {
  const name = `${Date.now()}-${Math.random()}`, waiting = document.createElement('p'), frame = document.createElement('iframe');
  let port = null, dark = null;
  const tell = message => model.send({view: name, ...message});
  const tellTheme = () => {
    const now = isDark(el);
    if (port && now !== dark) port.postMessage({dark: dark = now});
  };
  const connect = () => {
    const channel = new MessageChannel();
    if (port) port.close();
    port = channel.port1, dark = null;
    port.onmessage = event => tell({messages: event.data});
    frame.contentWindow.postMessage('channel', '*', [channel.port2]);
    tellTheme();
  };
  const hear = (content, buffers) => {
    if (content.to && content.to !== name) return;
    if (content.page) {
      waiting.remove();
      frame.srcdoc = new TextDecoder().decode(plain(buffers[0]));
      el.append(frame);
    } else if (!port) return;
    else if (content.heard) port.postMessage({heard: true});
    else port.postMessage(content.text ? JSON.stringify(content.text) : plain(buffers[0]));
  };
  const fit = () => { frame.style.cssText = `width: 100%; height: ${model.get('height')}px; border: 0; display: block`; };
  const themes = new MutationObserver(tellTheme);
  for (const element of [document.documentElement, document.body]) themes.observe(element, {attributes: true});
  frame.title = 'The scene under one\'s hands';
  frame.onload = connect;
  waiting.textContent = 'The scene waits for the kernel; while a cell runs, it waits until the cell has ended.';
  el.append(waiting);
  fit();
  model.on('change:height', fit);
  model.on('msg:custom', hear);
  tell({page: true});
  return () => {
    themes.disconnect();
    model.off('msg:custom', hear);
    model.off('change:height', fit);
    tell({gone: true});
  };
}
export default {render};
