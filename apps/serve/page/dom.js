// Short ways to make elements.

/// Properties that are functions are listeners; `data`, `aria` and others with a dash are attributes.
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (typeof value === 'function') element.addEventListener(name, value);
    else if (name in element && !name.includes('-')) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter(child => child !== null && child !== undefined));
  return element;
}

export const byId = id => document.getElementById(id);

/// Where something is typed.
export function takesText(element) {
  return element.matches('input:not([type=checkbox], [type=range], [type=color], [type=file]), textarea');
}

/// Where something is typed, or letters choose from a list.
export function takesLetters(element) {
  return takesText(element) || element.matches('select');
}

/// Sets text only where it differs: live regions speak each change.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/// A listener that runs once `milliseconds` passed without a further call.
export function debounced(milliseconds, run) {
  let timer = 0;
  return (...values) => {
    clearTimeout(timer);
    timer = setTimeout(() => run(...values), milliseconds);
  };
}

export function same(a, b) {
  return a === b || JSON.stringify(a) === JSON.stringify(b);
}

/// Whole numbers as they are, others with at most six digits; without an exponent where that is short.
export function numberText(value) {
  const number = Number(value);
  return String(Number.isSafeInteger(number) ? number : Number(number.toPrecision(6)));
}
