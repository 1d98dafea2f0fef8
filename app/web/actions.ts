// The user's actions on markers, each as one undoable step.
import { arrayOffsets, distributed, movedBy, toWall } from './arrange.js';
import type { CountedCoverage } from './counted.js';
import { ask, askNumbers, el, plural } from './dom.js';
import type { Editor } from './editor.js';
import { idCount, sideM } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { IdPicker } from './ids.js';
import { turned } from './pointer.js';

const usualHeightM = 2.6;
const proposedIds = 8;

export class Actions {
  constructor(private readonly editor: Editor, private readonly coverage: CountedCoverage, private readonly say: (words: string, bad?: boolean) => void) {}

  private picker(): IdPicker { return new IdPicker([...this.editor.markers.values()].map((m) => m.id)); }

  private usualHeight(): number {
    const heights = [...this.editor.markers.values()].map((m) => m.z).sort((a, b) => a - b);
    return heights[heights.length >> 1] ?? usualHeightM;
  }

  /** Adds markers with their centres above these points. */
  private addAll(middles: Point[]): void {
    const picker = this.picker();
    const z = this.usualHeight();
    const round = (value: number) => Math.round(value * 1000) / 1000;
    this.editor.add(middles.map((middle) => this.editor.fromMap(
      this.editor.fresh(picker.next(), round(middle.x - sideM / 2), round(middle.y + sideM / 2), z, 0))));
  }

  addAt(middle: Point): void { this.addAll([middle]); }

  async suggest(): Promise<string> {
    const place = await this.coverage.suggestion(this.usualHeight(), (share) => this.saySearched(share));
    if (!place) return 'The robot sees a marker from every position where it can be';
    this.addAll([place]);
    return 'Placed a marker where it closes most of the gaps';
  }

  /** A marker that the robot sees at this spot, and at as many badly covered ones as possible. */
  async suggestNear(spot: Point): Promise<void> {
    const place = await this.coverage.suggestionNear(spot, this.usualHeight());
    if (!place) return this.say('No position on the ceiling is seen from there at the height of the other markers', true);
    this.addAll([place]);
    this.say('Placed a marker that the robot sees there; undo takes it away, Save keeps it');
  }

  private saySearched(share: number): void { this.say(`Searching positions: ${(100 * share).toFixed(0)} %`); }

  /** Adds markers, few by a greedy search, until every position sees the wanted number. */
  async fill(): Promise<string> {
    const numbers = await askNumbers('Fill the gaps', [{ name: 'wanted', label: 'Markers in view from every position', value: 1, least: 1, most: 4, step: 1 }],
      'Adds as few markers as a greedy search needs, at the height of the others; one undo removes all of them.', 'Fill');
    if (!numbers) return '';
    const z = this.usualHeight();
    const { places, blindM2 } = await this.coverage.fillGaps(z, Math.round(numbers['wanted']!), (share) => this.saySearched(share));
    const rest = blindM2 > 0 ? `; ${blindM2.toFixed(2)} m² cannot see any marker at this height` : '';
    if (places.length === 0) return `Nothing to add${rest}`;
    this.addAll(places);
    return `Added ${plural(places.length, 'marker')}${rest}`;
  }

  private copies(markers: Marker[], offsets: Point[]): Marker[] {
    const picker = this.picker();
    return offsets.flatMap((by) => markers.map((m) =>
      this.editor.fromMap(this.editor.fresh(picker.next(), m.x + by.x, m.y + by.y, m.z, m.yawDeg))));
  }

  duplicate(): void { this.editor.add(this.copies(this.editor.chosen(), [{ x: 0.3, y: -0.3 }])); }

  /** Copies the selection in rows and columns. */
  async array(): Promise<string> {
    const chosen = this.editor.chosen();
    const shape = await askNumbers('Array', [
      { name: 'columns', label: 'Columns', value: 3, least: 1, most: 200, step: 1 }, { name: 'rows', label: 'Rows', value: 2, least: 1, most: 200, step: 1 },
      { name: 'stepX', label: 'Between columns (m)', value: 1.2, step: 0.05 }, { name: 'stepY', label: 'Between rows (m)', value: 1.2, step: 0.05 },
      { name: 'turnDeg', label: 'Turned by (°)', value: 0, step: 1 }],
    'Copies the selection, with the safest free IDs. The selection itself stays as the first.', 'Paste');
    if (!shape) return '';
    const offsets = arrayOffsets({ columns: Math.round(shape['columns']!), rows: Math.round(shape['rows']!),
      stepX: shape['stepX']!, stepY: shape['stepY']!, turnDeg: shape['turnDeg']! });
    if (offsets.length * chosen.length + this.editor.markers.size > idCount) return `More than ${idCount} markers, as many as there are IDs: nothing pasted`;
    const copies = this.copies(chosen, offsets);
    if (copies.length > 0) this.editor.add(copies);
    return `Pasted ${plural(copies.length, 'marker')}`;
  }

  distribute(): void { this.editor.change(distributed(this.editor.chosen())); }

  async wall(): Promise<string> {
    const numbers = await askNumbers('To the wall', [{ name: 'distance', label: 'Distance from wall to marker centre (m)', value: 0.5, least: 0, most: 20, step: 0.05 }],
      'Moves each selected marker straight to this distance from the nearest wall, and aligns it with the wall.', 'Move');
    if (!numbers) return '';
    const chosen = this.editor.chosen();
    this.editor.change(chosen.map((m) => toWall(this.coverage.floor, m, numbers['distance']!)));
    return `${plural(chosen.length, 'marker')} ${numbers['distance']!.toFixed(2)} m from the wall`;
  }

  async moveBy(): Promise<string> {
    const by = await askNumbers('Move by', [
      { name: 'x', label: 'x (m)', value: 0, step: 0.01 }, { name: 'y', label: 'y (m)', value: 0, step: 0.01 },
      { name: 'z', label: 'z (m)', value: 0, step: 0.01 }, { name: 'yawDeg', label: 'Turn (°)', value: 0, step: 1 }],
    'Moves the selection and rotates it about its centre; a single marker about its dot O.', 'Move');
    if (!by) return '';
    const chosen = this.editor.chosen();
    this.editor.change(movedBy(chosen, { x: by['x']!, y: by['y']!, z: by['z']!, yawDeg: by['yawDeg']! }, this.editor.pivot(chosen)));
    return `Moved ${plural(chosen.length, 'marker')}`;
  }

  nudge(x: number, y: number): void {
    const chosen = this.editor.chosen();
    this.editor.change(movedBy(chosen, { x, y, z: 0, yawDeg: 0 }, { x: 0, y: 0 }));
  }

  turn(byDeg: number): void {
    const chosen = this.editor.chosen();
    if (chosen.length > 0) this.editor.change(turned(chosen, this.editor.pivot(chosen), byDeg));
  }

  /** Offers free IDs for the selected marker, the safest first, each with its distance to all others. */
  async pickId(): Promise<string> {
    const [marker] = this.editor.chosen();
    if (!marker || this.editor.selection.size !== 1) return 'Select one marker first';
    const others = [...this.editor.markers.values()].filter((m) => m.key !== marker.key).map((m) => m.id);
    const answers = new IdPicker(others).proposals(proposedIds).map(({ id, distance }): [string, string] =>
      [String(id), `${id}: ${distance} apart`]);
    const answer = await ask(`Another ID for marker ${marker.id}`, [el('p', {}, 'The number of the sixteen cells (dots missed or glints added) that must be misread to take it for any other ID here, or for ' +
      'itself, with either rotated or mirrored. Three or more is safe.')],
    [...answers, ['', 'Cancel']]);
    if (answer === '') return '';
    this.editor.change([{ ...marker, id: Number(answer) }]);
    return `Marker ${marker.id} is ${answer} now`;
  }
}
