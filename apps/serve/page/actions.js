// Buttons for what is done once, which stand at the start of their sections.

import {byId, make, same, setText} from './dom.js';
import {makeLegends} from './legends.js';
import {makePresets} from './presets.js';
import {makeUpload} from './upload.js';
import {say} from './status.js';

function downloadPng(connection) {
  say('The picture is on its way.');
  const link = make('a', {href: connection.address('picture.png'), download: 'limpid.png'});
  document.body.append(link);
  link.click();
  link.remove();
}

/// The clipboard exists only on secure pages: elsewhere the text is selected, to be copied by hand.
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    say('Copied.');
  } catch {
    const range = document.createRange();
    range.selectNodeContents(byId('command'));
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    say(document.execCommand('copy') ? 'Copied.' : 'The command line is selected: copy it.');
  }
}

class CommandLine {
  constructor(store, ask) {
    this.text = make('code', {id: 'command', tabIndex: 0, role: 'textbox', 'aria-readonly': 'true',
                               'aria-label': 'Command line'});
    this.copy = make('button', {type: 'button', textContent: 'copy', click: () => copy(this.text.textContent)});
    this.box = make('div', {className: 'command', hidden: true}, this.text, this.copy);
    this.button = make('button', {type: 'button', id: 'command-line', textContent: 'command line',
                                  click: () => ask('command_line'),
                                  title: 'The limpid render command that makes this frame again'});
    store.addEventListener('facts', () => this.show(store.facts));
  }

  show({command}) {
    if (!command) return;
    this.box.hidden = false;
    setText(this.text, command);
  }
}

const keyMilliseconds = 100; // what a key chooses in a closed list follows sooner, a choice in an open one later

/// Keys that move through a closed list choose every scene on the way, and of what they choose in an open one browsers
/// tell when the list or the window is left. Such choices wait for Enter or a click.
function openScene(connection) {
  let lastKey = -Infinity, opening = 0;
  const stopWaiting = () => {
    waiting.hidden = true;
    select.selectedIndex = 0;
  };
  const open = () => {
    if (select.value) connection.sendNumbered('open', {scene: select.value});
    stopWaiting();
  };
  const openAndStay = () => {
    open();
    select.focus(); // the button, which hides itself, would lose the keyboard's place in the page
  };
  const waiting = make('button', {type: 'button', id: 'open-scene-waiting', textContent: 'open it (Enter)',
                                  hidden: true, click: openAndStay});
  const openWaiting = event => {
    if (waiting.hidden) return;
    event.preventDefault(); // Enter opens the list in some browsers
    open();
  };
  const byKey = {Enter: openWaiting, Escape: stopWaiting};
  const select = make('select', {
    id: 'open-scene', 'aria-describedby': 'open-scene-waiting',
    keydown: event => byKey[event.key] ? byKey[event.key](event) : lastKey = performance.now(),
    change: () => {
      waiting.hidden = !select.value;
      const isClicked = performance.now() - lastKey > keyMilliseconds && document.hasFocus();
      if (isClicked) opening = setTimeout(open); // unless the list is left, of which `blur` tells next
    },
    blur: () => clearTimeout(opening)});
  const element = make('div', {className: 'field'}, make('div', {className: 'head'},
      make('label', {htmlFor: 'open-scene', textContent: 'open another scene'})), select, waiting);
  const setScenes = scenes => {
    select.replaceChildren(make('option', {value: '', textContent: 'choose…'}),
                           ...scenes.map(name => make('option', {value: name, textContent: name})));
    stopWaiting();
    element.hidden = scenes.length === 0;
  };
  return {element, setScenes};
}

/// What a request changes of these fields becomes a step of undo. Returns what hears of the request's message.
function rememberRequest(store, keys, name) {
  let waiting = null;
  const valuesNow = () => Object.fromEntries(keys.map(key => [key, store.value(key)]));
  store.addEventListener('state', () => {
    if (!waiting || !store.includes(waiting.id)) return;
    const {before} = waiting, after = valuesNow();
    waiting = null;
    if (!same(before, after)) store.remember(before, after, name);
  });
  for (const name of ['lost', 'scene']) store.addEventListener(name, () => { waiting = null; });
  return id => {
    if (store.hasState()) waiting = {id, before: valuesNow()}; // else the connection is lost
  };
}

/// Elements by section: some stand at its start, some at its end. `moved` hears of requests that move the camera.
export function makeActions(store, connection, ask, status, moved) {
  const button = (request, text, title, sent = () => {}) => {
    const element = make('button', {type: 'button', textContent: text, title, click: () => sent(ask(request))});
    element.dataset.request = request;
    return element;
  };
  const row = (...buttons) => make('div', {className: 'buttons'}, ...buttons);
  const scenes = openScene(connection);
  const upload = makeUpload(connection);
  const command = new CommandLine(store, ask);
  const presets = makePresets(store);
  const legends = makeLegends(store);
  const kept = rememberRequest(store, ['compare', 'kept_settings'], 'keep these settings');
  const noMotion = make('p', {className: 'note', id: 'no-motion', role: 'status',
                              textContent: 'This method has no motion: choose a denoiser.', hidden: true});
  const elements = {
    scene: make('div', {}, make('p', {className: 'note', id: 'device'}), scenes.element, upload.element,
                make('p', {className: 'note', id: 'scene-notes', hidden: true}),
                row(make('button', {type: 'button', id: 'download', textContent: 'download PNG',
                                    title: 'The rendered picture, lossless',
                                    click: () => downloadPng(connection)}),
                    button('reset', 'reset', 'Means, histories and the frame number begin again'),
                    button('step', 'step', 'Renders one frame, also while rendering is stopped'),
                    command.button), command.box),
    camera: row(button('reset_camera', 'reset camera', 'Back to the camera of the start', moved),
                button('see_all', 'see everything', 'To where the automatic camera would be', moved)),
    light: row(button('add_point', 'add a point', 'A lamp at the camera'),
               button('add_sun', 'add a sun', 'A sun above the scene')),
    look: row(button('measure_exposure', 'measure exposure', 'Sets the exposure for what is seen now')),
    compare: make('div', {}, row(button('keep_settings', 'keep these settings',
                                        'Compares what you change from now on with the settings as they are',
                                        kept)),
                  make('p', {className: 'note', id: 'scores'})),
    method: presets.element,
  };
  const endings = {look: legends.stops, inspect: make('div', {}, legends.values, noMotion, status.table)};
  const hello = ({requests, scenes: names, uploads, presets: list, legends: colors}) => {
    legends.setColors(colors ?? {});
    scenes.setScenes(names ?? []);
    upload.setLargest(uploads ?? 0);
    presets.setPresets(list ?? []);
    for (const element of Object.values(elements)) {
      for (const each of element.querySelectorAll('[data-request]')) {
        each.hidden = !requests.includes(each.dataset.request);
      }
    }
  };
  const showMotion = exists => { noMotion.hidden = exists; };
  return {elements, endings, hello, showMotion};
}
