// One control for each kind of field. Each maker returns {element, show(value)}; `focusable` is what a label names.

import {make, numberText} from './dom.js';
import {isLogarithmic, sliderPosition, sliderValue} from './slider.js';
import {hexOf, linearOf, peakOf} from './color.js';

const sliderSteps = 200;
export const brightnessSpan = {min: 0, max: 100, scale: 'logarithmic', smallest: 0.01};

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/// Marks the time in which the user's hand is on a control, so that it does not jump. `begins`: more events that tell
/// of a hand. Returns whether it is there.
function holdWhile(input, hold, ...begins) {
  let held = false;
  const set = now => {
    if (now !== held) hold(held = now);
  };
  for (const begin of ['pointerdown', 'keydown', ...begins]) input.addEventListener(begin, () => set(true));
  for (const end of ['pointerup', 'pointercancel', 'keyup', 'blur', 'change']) {
    input.addEventListener(end, () => set(false));
  }
  return () => held;
}

function checkbox({id, describedBy, change}) {
  const input = make('input', {type: 'checkbox', id, 'aria-describedby': describedBy,
                               change: () => change(input.checked)});
  return {element: input, show: value => { input.checked = value === true; }};
}

function select({id, describedBy, change}, choices) {
  const input = make('select', {id, 'aria-describedby': describedBy});
  let values = [];
  const setChoices = list => { // [[value, text, help], ...]; help may be missing
    if (JSON.stringify(list) === JSON.stringify(values)) return;
    values = list;
    const chosen = input.selectedIndex;
    input.replaceChildren(...list.map(([, text, help]) => make('option', {textContent: text, title: help ?? ''})));
    input.selectedIndex = chosen;
  };
  setChoices(choices);
  input.addEventListener('change', () => change(values[input.selectedIndex][0]));
  return {element: input, setChoices, show: value => {
    const index = values.findIndex(([v]) => v === value);
    if (input.selectedIndex !== index) input.selectedIndex = index; // setting it moves the mark in an open list
  }};
}

/// A number to type; it is taken when the user leaves the field, presses Enter, or uses its arrows. What is being typed
/// stays, whatever states arrive.
function numberField({id, label, describedBy, minimum, maximum, whole, change}) {
  const input = make('input', {type: 'number', id, 'aria-label': label, 'aria-describedby': describedBy, min: minimum,
                               max: maximum, step: whole ? 1 : 'any', inputMode: whole ? 'numeric' : 'decimal'});
  let shown = 0, typing = false;
  const show = value => {
    shown = value;
    const text = numberText(value);
    if (!typing && input.value !== text) input.value = text;
  };
  const take = () => {
    typing = false;
    const value = input.valueAsNumber;
    if (Number.isNaN(value)) return show(shown);
    const allowed = clamp(whole ? Math.round(value) : value, minimum ?? -Infinity, maximum ?? Infinity);
    show(allowed);
    change(allowed);
  };
  input.addEventListener('input', () => { typing = true; });
  input.addEventListener('change', take);
  input.addEventListener('blur', () => typing && take());
  return {element: input, show};
}

/// A slider over the useful part of the range, with a field for any allowed number.
function slider(options) {
  const {id, label, describedBy, span, whole, unit, change, hold} = options;
  const lines = whole && !isLogarithmic(span);
  const input = make('input', {type: 'range', id, 'aria-describedby': describedBy, min: lines ? span.min : 0,
                               max: lines ? span.max : 1, step: lines ? 1 : 'any'});
  const field = numberField({...options, id: id + '-number', label: label + ', number'});
  let current = 0;
  const position = value => lines ? clamp(value, span.min, span.max) : sliderPosition(span, value);
  const take = () => {
    let value = lines ? input.valueAsNumber : sliderValue(span, input.valueAsNumber);
    if (whole) value = Math.round(value);
    // A step on a logarithmic slider may be less than one: it counts as one.
    const way = Math.sign(input.valueAsNumber - position(current));
    if (whole && value === current) value = clamp(current + way, span.min, span.max);
    change(value);
  };
  input.addEventListener('input', take);
  holdWhile(input, hold);
  const show = value => {
    current = value;
    input.value = position(value);
    input.setAttribute('aria-valuetext', numberText(value) + (unit ? ' ' + unit : ''));
    field.show(value);
  };
  // With the step 'any' the arrow keys have no step: they get one here.
  input.addEventListener('keydown', event => {
    const way = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10}[event.key];
    if (lines || !way) return;
    event.preventDefault();
    input.value = input.valueAsNumber + way / sliderSteps;
    take();
  });
  return {element: make('div', {className: 'slider'}, input, field.element), show};
}

/// Three numbers.
function vector({id, label, describedBy, change}) {
  let current = [0, 0, 0];
  const axes = ['x', 'y', 'z'].map((axis, i) => numberField({
    id: i === 0 ? id : `${id}-${axis}`, label: `${label} ${axis}`, describedBy,
    change: value => change(current.map((v, j) => j === i ? value : v))}));
  return {element: make('div', {className: 'vector', role: 'group', 'aria-label': label}, ...axes.map(a => a.element)),
          show: value => {
            current = value;
            axes.forEach((axis, i) => axis.show(value[i]));
          }};
}

/// Hue and saturation as the browser chooses colours, and a brightness.
function color({id, label, describedBy, change, hold, withBrightness = true}) {
  let current = [1, 1, 1];
  const input = make('input', {type: 'color', id, 'aria-label': label, 'aria-describedby': describedBy});
  const peak = () => Math.max(peakOf(current), withBrightness ? 0 : 1e-3);
  // The browser's chooser is a window of its own: the hand in it is known by what it chooses, until it closes.
  const isHeld = holdWhile(input, hold, 'input');
  input.addEventListener('input', () => change(linearOf(input.value, peak())));
  const scaled = value => current.map(v => peakOf(current) > 0 ? v * value / peakOf(current) : value);
  const brightness = withBrightness && slider({
    id: id + '-brightness', label: label + ', brightness', describedBy, span: brightnessSpan, minimum: 0, maximum: 1e9,
    change: value => change(scaled(value)), hold});
  brightness?.element?.firstChild.setAttribute('aria-label', label + ', brightness');
  return {element: make('div', {className: 'color'}, input, brightness ? brightness.element : null),
          show: value => {
            current = value;
            const losesHue = document.activeElement === input && peakOf(value) === 0;
            if (!isHeld() && !losesHue) input.value = hexOf(value);
            if (brightness) brightness.show(peakOf(value));
          }};
}

/// A switch, and where it is on a colour.
function background(options) {
  const box = make('input', {type: 'checkbox', id: options.id, 'aria-describedby': options.describedBy});
  const chosen = color({...options, id: options.id + '-color'});
  box.addEventListener('change', () => options.change(box.checked ? [1, 1, 1] : null));
  return {element: make('div', {className: 'background'}, box, chosen.element),
          show: value => {
            box.checked = value !== null;
            chosen.element.hidden = value === null;
            if (value) chosen.show(value);
          }};
}

function text({id, describedBy, change}) {
  const input = make('input', {type: 'text', id, 'aria-describedby': describedBy, change: () => change(input.value)});
  return {element: input, show: value => {
    if (document.activeElement !== input) input.value = value;
  }};
}

export {checkbox, select, numberField, slider, vector, color, background, text};
