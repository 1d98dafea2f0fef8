// The map's layers, each of which can be switched off. The floor has one colouring at a time.
import { byId, el } from './dom.js';
import { floorSwatch } from './floor_paint.js';
import type { FloorKey } from './floor_paint.js';
import { inkNow } from './robot_paint.js';
import type { Ink } from './robot_paint.js';
import { zoneInkNow } from './places_paint.js';

export type FloorColour = 'coverage' | 'deviation' | 'plain';
export type LayerName = 'map' | 'markers' | 'ids' | 'reach' | 'route' | 'zones';

const names: [LayerName, string][] = [
  ['map', 'Map'], ['markers', 'Markers'], ['ids', 'IDs'], ['reach', 'Reach of the selection'], ['route', 'Usual route'], ['zones', 'Zones and places']];
const colours: [FloorColour, string][] = [
  ['coverage', 'coverage'], ['deviation', 'deviation'], ['plain', 'nothing']];

const legends: Record<FloorColour, [FloorKey, string][]> = {
  coverage: [['none', 'no marker'], ['one', 'one'], ['more', 'two or more'], ['free', 'cannot stand']],
  deviation: [['good', '5 mm or less'], ['bad', '20 mm or more: standard deviation of a fix'], ['unseen', 'no marker at some heading']],
  plain: [],
};

const lineKeys: Record<string, [keyof Ink, string][]> = {
  live: [['path', 'planned'], ['preview', 'preview'], ['track', 'driven'], ['truth', 'markers in view'], ['goal', 'goal, 3σ of the pose']],
  replay: [['track', 'estimate'], ['truth', 'ground truth (simulation)']],
};

export class Layers {
  shown: Record<LayerName, boolean> = { map: true, markers: true, ids: true, reach: true, route: true, zones: true };
  floor: FloorColour = 'coverage';
  onChange: () => void = () => {};
  private readonly choice = el('select', { id: 'floor-colour' }, ...colours.map(([value, words]) => el('option', { value }, words)));

  constructor() {
    const boxes = names.map(([name, words]) => {
      const input = el('input', { type: 'checkbox', id: `layer-${name}` });
      input.checked = this.shown[name];
      input.addEventListener('change', () => {
        this.shown[name] = input.checked;
        this.onChange();
      });
      return el('label', {}, input, ` ${words}`);
    });
    this.choice.addEventListener('change', () => this.paintFloor(this.choice.value as FloorColour));
    byId('layers').replaceChildren(...boxes, el('label', { for: 'floor-colour' }, 'Floor coloured by'), this.choice);
  }

  paintFloor(colour: FloorColour): void {
    this.floor = colour;
    this.choice.value = colour;
    this.onChange();
  }

  /** The legend of lines and floor colours, for the present mode. */
  showLegend(): void {
    const mode = document.body.dataset['mode'] ?? '';
    const colours = inkNow();
    const lines = (lineKeys[mode] ?? []).map(([kind, words]) => keyOf('', colours[kind], words));
    if (mode === 'live' && document.body.dataset['scanner'] !== undefined)
      lines.push(keyOf('disc', colours.person, 'scanner: person, or moves'), keyOf('', colours.stands, 'stands, not on the map'));
    if (mode === 'places') lines.push(...placesLegend());
    byId('legend').replaceChildren(...(lines.length === 0 ? [el('span', { class: 'key' }, 'From above, as through the ceiling.')] : lines),
      ...legends[this.floor].map(([kind, words]) => keyOf('floor', floorSwatch(kind), words)));
  }
}

function keyOf(shape: string, colour: string, words: string): HTMLElement {
  const swatch = el('span', { class: `swatch ${shape}`.trim() });
  swatch.style.setProperty('--swatch', colour);
  return el('span', { class: 'key' }, swatch, words);
}

function placesLegend(): HTMLElement[] {
  const colours = zoneInkNow();
  return ([['out', 'hatched', 'keep-out'], ['slow', 'tinted', 'speed zone'], ['lane', '', 'lane, arrows: one way'], ['spot', 'disc', 'place']] as const)
    .map(([kind, shape, words]) => keyOf(shape, colours[kind], words));
}
