// The tools' icons: strokes in a square of 16.
const circle = (x: number, y: number, r: number): string => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
const lens = `${circle(6.5, 6.5, 4.5)}M10 10l4 4`;

const undo = 'M6 2.5 2.5 6 6 9.5M2.5 6H9a4 4 0 0 1 0 8H6';
const redo = 'M10 2.5 13.5 6 10 9.5M13.5 6H7a4 4 0 0 0 0 8h3';
const bin = 'M2.5 4.5h11M6 4.5v-2h4v2M4 4.5l1 9h6l1-9M6.5 7v4M9.5 7v4';
const clock = `${circle(8, 8, 6)}M8 4.5V8l2.5 1.5`;
const again = 'M13.5 8A5.5 5.5 0 1 1 12 4.2M13 1.5v3.2H9.8';
const disk = 'M2.5 2.5h8l3 3v8h-11zM5 2.5v4h5v-4M5 13.5v-4h6v4';

const strokes: Record<string, string> = {
  undo, redo, 'places-undo': undo, 'places-redo': redo,
  add: 'M8 3v10M3 8h10',
  duplicate: 'M2.5 2.5h8v8h-8zM10.5 5.5h3v8h-8v-3',
  array: 'M2.5 2.5h3v3h-3zM10.5 2.5h3v3h-3zM2.5 10.5h3v3h-3zM10.5 10.5h3v3h-3z',
  'move-by': 'M8 1.5v13M1.5 8h13M6 3.5l2-2 2 2M6 12.5l2 2 2-2M3.5 6l-2 2 2 2M12.5 6l2 2-2 2',
  delete: bin, 'places-delete': bin,
  'draw-keep_out': 'M3 3.5 12.5 2l1 9-7 3-5-4zM4.5 11.5l7-8',
  'draw-speed_zone': `M2 12.5a6.5 6.5 0 1 1 12 0zM8 11l3-4`,
  'draw-place': `M8 14.5S3 9.5 3 6a5 5 0 0 1 10 0c0 3.5-5 8.5-5 8.5z${circle(8, 6, 1.6)}`,
  'draw-node': circle(8, 8, 4),
  'draw-edge': `${circle(3.5, 12.5, 2)}M5 11 13 3M9.5 3H13v3.5`,
  snap: 'M3 2.5v5a5 5 0 0 0 10 0v-5h-3v5a2 2 0 0 1-4 0v-5zM3 5.5h3M10 5.5h3',
  align: `M4 2.5v5M1.5 5h5M11.5 8.5v5M9 11h5M8 6c2 0 3 .5 3.4 1.6`,
  measure: 'M1.5 11 11 1.5 14.5 5 5 14.5zM4.5 8 6 9.5M7 5.5 8.5 7M9.5 3 11 4.5',
  coverage: `${circle(6, 8, 4.5)}${circle(10, 8, 4.5)}`,
  'zoom-in': `${lens}M6.5 4.5v4M4.5 6.5h4`,
  'zoom-out': `${lens}M4.5 6.5h4`,
  fit: 'M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10M6 6h4v4H6z',
  import: 'M8 2v7.5M4.5 6.5 8 10l3.5-3.5M2.5 10.5v3h11v-3',
  export: 'M8 10V2M4.5 5.5 8 2l3.5 3.5M2.5 10.5v3h11v-3',
  print: 'M4.5 5.5v-4h7v4M4.5 11.5h-3v-6h13v6h-3M4.5 9.5h7v5h-7z',
  plan: 'M3 1.5h7l3 3v10H3zM10 1.5v3h3M5.5 7.5h5M5.5 10h5M5.5 12.5h3',
  history: clock, 'places-history': clock,
  reload: again, 'places-reload': again,
  save: disk, 'places-save': disk,
  log: 'M2.5 4h1M6 4h7.5M2.5 8h1M6 8h7.5M2.5 12h1M6 12h7.5',
  theme: `${circle(8, 8, 5.5)}M8 2.5v11M8 5h4M8 8h5.5M8 11h4`,
  help: `${circle(8, 8, 6)}M6.2 6.3A1.9 1.9 0 1 1 8.7 8C8.2 8.3 8 8.6 8 9.3M8 11.3v.4`,
};

const svg = 'http://www.w3.org/2000/svg';

/** Its name stands beside it, or is the button's. Nothing for a tool that has none. */
export function icon(tool: string): SVGSVGElement | null {
  const shape = strokes[tool];
  if (shape === undefined) return null;
  const picture = document.createElementNS(svg, 'svg');
  for (const [name, value] of Object.entries({ viewBox: '0 0 16 16', width: '16', height: '16', 'aria-hidden': 'true', class: 'icon' })) picture.setAttribute(name, value);
  const path = document.createElementNS(svg, 'path');
  path.setAttribute('d', shape);
  picture.append(path);
  return picture;
}
