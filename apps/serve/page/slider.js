// Positions of a slider, 0 to 1, and the values that they stand for: base/slider_span.h once more.

const zeroShare = 0.03; // share of a logarithmic slider's length that stands for 0

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

function rounded(value) {
  return value === 0 ? 0 : Number(value.toPrecision(3));
}

// Where the logarithmic part starts: the value, and the position.
function startOf(span) {
  return span.min > 0 ? [span.min, 0] : [span.smallest, zeroShare];
}

export function isLogarithmic(span) {
  return span.scale === 'logarithmic';
}

export function sliderPosition(span, value) {
  const inside = clamp(value, span.min, span.max);
  if (!isLogarithmic(span)) return (inside - span.min) / (span.max - span.min);
  const [first, start] = startOf(span);
  if (inside < first) return 0;
  return start + (1 - start) * Math.log(inside / first) / Math.log(span.max / first);
}

export function sliderValue(span, position) {
  if (position <= 0) return span.min;
  if (position >= 1) return span.max;
  let value = span.min + position * (span.max - span.min);
  if (isLogarithmic(span)) {
    const [first, start] = startOf(span);
    if (position < start) return span.min;
    value = first * Math.pow(span.max / first, (position - start) / (1 - start));
  }
  return clamp(rounded(value), span.min, span.max);
}
