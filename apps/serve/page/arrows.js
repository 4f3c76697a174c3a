// Motion as arrows over the picture: from where things were in the frame before to where they are.

const line = '#fffc', shadow = '#000a';
const shortestHead = 5, longestHead = 9, headShare = 0.4; // pixels of the page; the last: of the arrow

/// The server's grid: {columns, rows, offsets}, two numbers for each cell, in shares of the picture; 0: at rest.
export function parseMotion({width, height, data}) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const offsets = Array.from({length: 2 * width * height}, (_, i) => view.getFloat32(4 * i, true));
  return {columns: width, rows: height, offsets};
}

/// A light line with a dark edge, on any picture.
export function strokeVisibly(context, path, ratio) {
  context.lineWidth = 3 * ratio;
  context.strokeStyle = shadow;
  context.stroke(path);
  context.lineWidth = ratio;
  context.strokeStyle = line;
  context.stroke(path);
}

/// `place`: the picture's rectangle on the canvas. `ratio`: pixels of the canvas for one of the page. Returns the
/// number of arrows.
export function drawArrows(context, {columns, rows, offsets}, place, ratio) {
  const path = new Path2D(), heads = new Path2D();
  let count = 0;
  for (let i = 0; i < columns * rows; ++i) {
    const dx = offsets[2 * i], dy = offsets[2 * i + 1];
    if (dx === 0 && dy === 0) continue;
    const x = place.x + (i % columns + 0.5) / columns * place.width;
    const y = place.y + (Math.floor(i / columns) + 0.5) / rows * place.height;
    const backX = dx * place.width, backY = dy * place.height, length = Math.hypot(backX, backY);
    path.moveTo(x + backX, y + backY);
    path.lineTo(x, y);
    const size = ratio * Math.min(Math.max(headShare * length / ratio, shortestHead), longestHead) / length;
    heads.moveTo(x, y);
    heads.lineTo(x + size * (backX - 0.5 * backY), y + size * (backY + 0.5 * backX));
    heads.lineTo(x + size * (backX + 0.5 * backY), y + size * (backY - 0.5 * backX));
    heads.closePath();
    ++count;
  }
  strokeVisibly(context, path, ratio);
  context.fillStyle = line;
  context.fill(heads);
  return count;
}
