// Small pictures of the map with what changed on it, for lists of earlier states.
import { coloursNow } from './colours.js';
import type { Floor } from './floor.js';
import type { Point } from './geometry.js';

const pictures = new WeakMap<Floor, Map<string, ImageData>>();

/** The map's walls at this size, however many cells there are: a pixel is a wall where any of its cells is one. */
function cellsAt(floor: Floor, width: number, height: number): ImageData {
  const key = `${width} ${height} ${document.documentElement.dataset['theme'] ?? ''}`;
  const made = pictures.get(floor)?.get(key);
  if (made) return made;
  const { columns, rows } = floor.info;
  const scale = scaleOf(floor, width, height);
  const found = new Uint8Array(width * height);  // 0 nothing, 1 unknown, 2 free, 3 wall
  for (let row = 0; row < rows; ++row) {
    const y = Math.min(height - 1, Math.floor((rows - 1 - row) * scale));
    for (let column = 0; column < columns; ++column) {
      const at = y * width + Math.min(width - 1, Math.floor(column * scale));
      const value = floor.cells[row * columns + column]!;
      found[at] = Math.max(found[at]!, value < 0 ? 1 : value < 50 ? 2 : 3);
    }
  }
  const colours = coloursNow();
  const kinds = [colours.unknown, colours.unknown, colours.free, colours.wall];
  const image = new ImageData(width, height);
  for (let i = 0; i < found.length; ++i) image.data.set([...kinds[found[i]!]!, 255], 4 * i);
  if (!pictures.has(floor)) pictures.set(floor, new Map());
  pictures.get(floor)!.set(key, image);
  return image;
}

const scaleOf = (floor: Floor, width: number, height: number): number => Math.min(1, width / floor.info.columns, height / floor.info.rows);

/** A canvas of the map, at most this large, and where a point of the map is on it. */
export function mapPicture(canvas: HTMLCanvasElement, floor: Floor, widthPx: number, heightPx: number): { c: CanvasRenderingContext2D; place: (p: Point) => Point } {
  const fit = Math.min(widthPx / floor.info.columns, heightPx / floor.info.rows);
  const [width, height] = [Math.max(1, Math.round(floor.info.columns * fit)), Math.max(1, Math.round(floor.info.rows * fit))];
  [canvas.width, canvas.height] = [width, height];
  const c = canvas.getContext('2d')!;
  const small = { width: Math.max(1, Math.min(width, floor.info.columns)), height: Math.max(1, Math.min(height, floor.info.rows)) };
  const source = document.createElement('canvas');
  [source.width, source.height] = [small.width, small.height];
  source.getContext('2d')!.putImageData(cellsAt(floor, small.width, small.height), 0, 0);
  c.imageSmoothingEnabled = false;
  c.drawImage(source, 0, 0, width, height);
  return { c, place: (p) => { const at = floor.toGrid(p); return { x: at.x * fit, y: height - at.y * fit }; } };
}
