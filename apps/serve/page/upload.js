// Files of this device as scenes and environments: dropped on the page, or chosen. Only where the program allows it.

import {make, takesText} from './dom.js';
import {say} from './status.js';

const endings = ['.glb', '.gltf', '.obj', '.hdr', '.exr'];
const reasons = {403: 'the program was started without --uploads', 413: 'the file is too large',
                 400: 'scenes and environments have other names', 503: 'too many files are on their way or in use',
                 507: 'the program cannot store it'};

/// What a name may have; the ending stays.
const allowed = name => name.replace(/[^A-Za-z0-9._-]/g, '_');

/// The program takes one file at a time: the first that it can open, wherever it stands among its textures.
const canOpen = ({name}) => endings.some(ending => name.toLowerCase().endsWith(ending));
const chosenOf = files => files.find(canOpen) ?? files[0];

function aboutOthers({length}) {
  if (length < 2) return '';
  const others = length === 2 ? 'The other file was' : `The ${length - 1} other files were`;
  return ` ${others} ignored: the program takes one at a time, so a scene with its textures must be one .glb.`;
}

/// Anywhere on the page: a browser opens what is dropped on nothing, and the page would be gone. Text may be dropped
/// where it is typed.
function takeDrops(send) {
  const isTyped = target => target instanceof Element && takesText(target); // Firefox names texts, too
  const isOurs = ({dataTransfer, target}) => dataTransfer.types.includes('Files') || !isTyped(target);
  addEventListener('dragover', event => isOurs(event) && event.preventDefault());
  addEventListener('drop', event => {
    if (!isOurs(event)) return;
    event.preventDefault();
    send([...event.dataTransfer.files]);
  });
}

export function makeUpload(connection) {
  let largest = 0;
  const send = async files => {
    const file = chosenOf(files);
    if (!file) return;
    const tell = text => say(text + aboutOthers(files));
    if (largest === 0) return tell(`${file.name} was not sent: ${reasons[403]}.`);
    if (file.size > largest) {
      return tell(`${file.name} is larger than the ${Math.floor(largest / 1e6)} MB that the program takes.`);
    }
    tell(`${file.name} is on its way.`);
    try {
      const address = `${connection.address('upload')}&name=${encodeURIComponent(allowed(file.name))}`;
      const {ok, status} = await fetch(address, {method: 'POST', body: file});
      tell(ok ? `${file.name} was sent.` : `${file.name} was not taken: ${reasons[status] ?? `error ${status}`}.`);
    } catch {
      tell(`${file.name} was not sent: the connection was lost.`);
    }
  };
  const input = make('input', {type: 'file', id: 'upload', accept: endings.join(), change: () => {
    send([...input.files]);
    input.value = '';
  }});
  const element = make('div', {className: 'field', hidden: true},
      make('div', {className: 'head'}, make('label', {htmlFor: 'upload', textContent: 'open a file from this device'})),
      input);
  takeDrops(send);
  const setLargest = bytes => {
    largest = bytes;
    element.hidden = bytes <= 0;
  };
  return {element, setLargest};
}
