// The way to the server: a WebSocket. In a notebook it is the window around this frame, which speaks to the kernel. A channel has
// send(message), which returns whether it was sent, and renew(), by which a page with other surfaces is asked for. What arrives goes to receive().
'use strict';
const isNotebook = location.protocol === 'about:', AS_FIRST = isNotebook ? 'as it was' : 'as in the file';

function socketChannel() {
  const scheme = location.protocol === 'https:' ? 'wss' : 'ws', folder = location.pathname.replace(/[^/]*$/, '');
  let socket = null, tries = 0;
  const open = () => {
    socket = new WebSocket(`${scheme}://${location.host}${folder}socket${location.search}`);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => { tries = 0; };
    socket.onmessage = event => receive(event.data);
    socket.onclose = () => {
      showRole(tries < 20 ? 'not connected' : 'the server has ended; this is its last image');
      if (tries++ < 20) setTimeout(open, 500 * Math.min(tries, 6));
    };
  };
  open();
  return {
    send: message => {
      const isOpen = socket.readyState === WebSocket.OPEN;
      if (isOpen) socket.send(JSON.stringify(message));
      return isOpen;
    },
    renew: () => { keepHistory(); location.reload(); },
  };
}

const PATIENCE = 700; // ms without an answer of the kernel, after which the page says that it waits

// Messages go in bundles. The kernel answers a bundle when it has dealt with it, and hears nothing while a cell runs; meanwhile
// the newest message of each kind waits for the next bundle.
function frameChannel() {
  const waiting = new Map();
  let port = null, isUnderWay = false, timer = 0;
  const post = () => {
    isUnderWay = true;
    port.postMessage([...waiting.values()]);
    waiting.clear();
    timer = setTimeout(() => showRole('the kernel is busy; what is changed here waits until its cell has ended'), PATIENCE);
  };
  const take = ({data}) => {
    if (typeof data === 'string' || data instanceof ArrayBuffer) return receive(data);
    if ('dark' in data) setDark(data.dark);
    if (!data.heard) return;
    clearTimeout(timer);
    isUnderWay = false;
    tellRole();
    if (waiting.size) post();
  };
  addEventListener('message', event => {
    if (event.source !== window.parent || !event.ports.length) return;
    port = event.ports[0];
    port.onmessage = take;
    post(); // nothing yet: the page is there
  });
  return {
    send: message => {
      waiting.set(message.take || Object.keys(message)[0], message);
      if (port && !isUnderWay) post();
      return true;
    },
    renew: () => {}, // the kernel sends another page by itself
  };
}
