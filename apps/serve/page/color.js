// Linear Rec. 709 radiance as the browser's colour (hue and saturation) and a brightness, and back.

function encode(v) {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055;
}

function decode(v) {
  return v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4);
}

/// The largest component.
export function peakOf(linear) {
  return Math.max(...linear);
}

/// '#rrggbb' of the colour at its brightest.
export function hexOf(linear) {
  const peak = Math.max(peakOf(linear), 1e-20);
  return '#' + linear.map(v => Math.round(255 * encode(v / peak)).toString(16).padStart(2, '0')).join('');
}

/// The colour whose largest component is `peak`. Black has no hue: it counts as white.
export function linearOf(hex, peak) {
  const parts = [1, 3, 5].map(i => decode(parseInt(hex.slice(i, i + 2), 16) / 255));
  const largest = peakOf(parts);
  return largest > 0 ? parts.map(v => v * peak / largest) : [peak, peak, peak];
}
