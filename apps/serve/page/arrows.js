// Motion as arrows over the picture: from where things were in the frame before to where they are.

const line = '#fffc', shadow = '#000a';

/// The server's grid: {columns, rows, offsets}, two numbers for each cell, in shares of the picture; 0: at rest.
export function parseMotion({width, height, data}) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const offsets = Array.from({length: 2 * width * height}, (_, i) => view.getFloat32(4 * i, true));
  return {columns: width, rows: height, offsets};
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
    path.moveTo(x + dx * place.width, y + dy * place.height);
    path.lineTo(x, y);
    heads.moveTo(x + 2.5 * ratio, y);
    heads.arc(x, y, 2.5 * ratio, 0, 2 * Math.PI);
    ++count;
  }
  context.lineWidth = 3 * ratio;
  context.strokeStyle = shadow;
  context.stroke(path);
  context.lineWidth = ratio;
  context.strokeStyle = line;
  context.stroke(path);
  context.fillStyle = line;
  context.fill(heads);
  return count;
}
