// Puts the page together.

import {Connection} from './connection.js';
import {Gestures} from './gestures.js';
import {Panel} from './panel.js';
import {Picture} from './picture.js';
import {Status, say} from './status.js';
import {Store} from './store.js';
import {Stream, codecsHere} from './stream.js';
import {makeActions} from './actions.js';
import {makeDivider} from './divider.js';
import {makeInspection} from './inspection.js';
import {parseMotion} from './arrows.js';
import {rememberMovements} from './movements.js';
import {makeKeys} from './keys.js';
import {makeToolbar} from './toolbar.js';
import {watchViewport} from './viewport.js';
import {byId} from './dom.js';

const token = new URLSearchParams(location.search).get('token') ?? '';
const stage = byId('stage');
const picture = new Picture(byId('picture'));
const connection = new Connection(token, {hear, see: buffer => stream.take(buffer)});
const store = new Store(changes => connection.sendNumbered('edit', {changes}));
const ask = (request, content = {}) => connection.sendNumbered('ask', {request, ...content});
const status = new Status(store);
const movements = rememberMovements(store);
const actions = makeActions(store, connection, ask, status, movements.begin);
const panel = new Panel(store, ask, actions);
const toolbar = makeToolbar(store, picture, ask);
const showDivider = makeDivider(picture, () => ({
  left: store.value('pass') ? store.facts.images?.[store.value('image')] ?? store.value('pass')
      : store.value('denoiser') === 'none' ? store.value('integrator') ?? '' : store.value('denoiser') ?? '',
  right: store.facts.compared_with || store.value('compare') || '',
}));
let codecs = codecsHere();

const stream = new Stream({
  show: (header, image) => {
    // What was compared until now may still arrive.
    if (header.side === 'right' && store.value('compare') === 'nothing') return image.close();
    picture.show(header.side, image);
    if (header.side === 'right') return void (stage.dataset.comparedLossless = header.lossless);
    stage.dataset.frame = header.frame;
    stage.dataset.kind = header.kind;
    stage.dataset.inspected = header.inspected;
    stage.dataset.lossless = header.lossless;
    stage.classList.add('has-picture');
    if (header.inspected) inspection.imageChanged();
  },
  move: header => {
    // What moved until now may still arrive.
    if (!store.value('arrows')) return;
    const motion = parseMotion(header);
    picture.setMotion(motion);
    actions.showMotion(motion.columns > 0);
  },
  received: frame => connection.send('received', {frame}),
  fail: error => {
    say(`A picture could not be decoded (${error.message}): going on with JPEG.`);
    codecs = Promise.resolve(['jpeg']);
    stream.reset();
    start();
  },
});

const gestures = new Gestures(stage, picture, {
  steer: sum => {
    if (connection.isBusy) return !connection.isOpen; // without a connection movements are lost
    movements.begin(connection.sendNumbered('steer', sum));
    return true;
  },
  focus: position => {
    if (isInside(position)) movements.begin(ask('focus', {position}));
  },
  touchesPixels: toolbar.touchesPixels,
});

const inspection = makeInspection(store, picture, stage, position => connection.sendNumbered('read', {position}));
const isInside = position => position.every(v => v >= 0 && v <= 1);
const viewport = watchViewport(stage, picture, store);
makeKeys({store, stage, picture, ask, toolbar});

async function start() {
  connection.send('start', {codecs: await codecs});
}

const handlers = {
  hello: message => {
    store.setFields(message.fields, message.groups ?? {});
    actions.hello(message);
  },
  state: message => {
    const first = !store.hasState();
    store.receiveState(message.state, message.message ?? 0);
    if (first) viewport.send();
    picture.setExtent(store.value('viewport'));
    if (store.value('compare') === 'nothing' && picture.isCompared) picture.show('right', null);
    if (!store.value('arrows')) {
      picture.setMotion(null);
      actions.showMotion(true);
    }
    showDivider();
  },
  facts: message => {
    store.receiveFacts(message.facts);
    picture.setProbe(store.facts.values ? store.facts.probed_at : null);
  },
  ack: message => store.acknowledge(message.id, message.message),
  values: message => inspection.showValues(message),
  refused: message => say(`Refused: ${message.why}`),
};

function hear(message) {
  handlers[message.type]?.(message);
}

connection.addEventListener('open', () => {
  document.body.classList.remove('lost');
  byId('connection').textContent = 'connected';
  start();
});
connection.addEventListener('lost', () => {
  document.body.classList.add('lost');
  byId('connection').textContent = connection.attempts > 3
      ? 'No connection. If the program was started again, open the address that it prints.'
      : 'The connection was lost: connecting again…';
  stream.reset();
  store.forgetEdits();
  movements.forget();
});
connection.connect();
