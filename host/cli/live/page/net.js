// The connection: texts from the server go to `hear`, frames to `show`, and wishes go the other way.
'use strict';
// shot: the newest message about a frame.
const net = {channel: null, role: '', sent: 0, shown: 0, shot: null, hear: {}, show: null, picture: null, file: null, waits: false, timer: 0};
const HEADER = 48; // bytes before the pixels of a frame, live_header of host/cli/live/frame.h

function readFrame(buffer) {
  const view = new DataView(buffer);
  return {
    number: view.getUint32(4, true), wish: view.getUint32(8, true),
    columns: view.getUint16(12, true), rows: view.getUint16(14, true),
    low: view.getFloat64(16, true), step: view.getFloat64(24, true), flat: view.getFloat64(32, true),
    ms: view.getFloat32(40, true), factor: view.getUint16(44, true),
    quantity: view.getUint8(46), notes: view.getUint8(47),
    numbers: new Uint16Array(buffer, HEADER),
  };
}

// A file: "SKLB", the length of its name, the name, its bytes.
function readFile(buffer) {
  const length = new DataView(buffer).getUint32(4, true), name = new TextDecoder().decode(new Uint8Array(buffer, 8, length));
  return {name, bytes: new Uint8Array(buffer, 8 + length)};
}

function receive(data) {
  if (typeof data === 'string') {
    const message = JSON.parse(data);
    for (const [key, act] of Object.entries(net.hear)) if (key in message) act(message);
    return;
  }
  const mark = new DataView(data).getUint32(0);
  if (mark === 0x534b4c50) return net.picture(data); // "SKLP"
  if (mark === 0x534b4c52) return takeRadiograph(readFrame(data)); // "SKLR"
  if (mark === 0x534b4c53) { slices.frame = readFrame(data); return; } // "SKLS"
  if (mark !== 0x534b4c46) return net.file(readFile(data));
  const frame = readFrame(data);
  net.shown = frame.wish;
  settle(frame.wish);
  net.show(frame);
  say({ack: frame.number});
}

// The page says that the server computes, and greys the numbers of the older image, once a wish has waited for this long, ms.
const SOON = 80;
const showComputing = on => document.documentElement.classList.toggle('computing', on);
function expect() {
  net.timer = net.timer || setTimeout(() => showComputing(true), SOON);
}
// An answer to a wish, an image or what is wrong with it.
function settle(wish) {
  clearTimeout(net.timer);
  net.timer = 0;
  showComputing(false);
  if (wish < net.sent) expect();
}

// Returns whether the message was sent.
function say(message) {
  return !!net.channel && net.channel.send(message);
}

// At most one wish for each picture of the browser: the newest. make: called when it is sent.
function sendWish(make) {
  net.make = make;
  if (net.waits) return;
  net.waits = true;
  requestAnimationFrame(() => {
    net.waits = false;
    if (say({wish: ++net.sent, ...net.make()})) expect();
  });
}
