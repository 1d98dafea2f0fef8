// The page without a site: from a plan, or from nothing, to a site folder with its first markers. Each step says what it lacks.
import * as api from './api.js';
import type { NewMap, Plan } from './api.js';
import { base64, bytesOf } from './base64.js';
import { ask, button, byId, el, plural } from './dom.js';
import { MapPaint } from './map_paint.js';
import { MapTools } from './map_tools.js';
import { NewSiteRuns } from './new_site_runs.js';
import { NewStage } from './new_stage.js';
import { attempt, say } from './words.js';

const waitMs = 200;

interface NumberOf { input: HTMLInputElement; label: string; low: number; high: number }

export class NewSitePage {
  readonly stage = new NewStage();
  private plan: Plan | null = null;
  private picture: ImageBitmap | null = null;  // of the plan
  private map: NewMap | null = null;
  paint: MapPaint | null = null;
  private from = '';  // what the map is of, where it is of no plan
  private readonly file = el('input', { id: 'new-plan', type: 'file', accept: '.png,.jpg,.jpeg,.pgm,.bmp,.pdf,.dxf' });
  private readonly unit = this.number('new-unit', 'Metres for a unit of a DXF that does not say', '', 1e-6, 1000);
  private readonly hallWidth = this.number('new-width', 'Width (m)', '10', 1, 1000);
  private readonly hallHeight = this.number('new-height', 'Height (m)', '6', 1, 1000);
  private readonly distance = this.number('new-distance', 'Metres between the two points', '', 0.01, 10000);
  private readonly scale = this.number('new-scale', 'Metres for a pixel', '', 1e-6, 1000);
  private readonly turn = this.number('new-turn', 'Turn it by (°)', '0', -360, 360);
  private readonly dark = this.number('new-dark', 'Darker than this is wall (1 to 255)', '128', 1, 255);
  private readonly cell = this.number('new-cell', 'Side of a cell (m)', '0.05', 0.005, 1);
  private readonly ceiling = this.number('new-ceiling', 'Ceiling above the floor (m)', '2.6', 1.5, 30);
  private readonly radius = this.number('new-radius', 'Radius of the robot (m)', '0.25', 0.05, 5);
  private readonly camera = this.number('new-camera-height', 'Camera above the floor (m)', '1.1', 0.05, 10);
  private readonly base = this.choice('new-base', 'Base', [['agilex', 'AgileX'], ['odrive', 'ODrive']]);
  private readonly lens = this.choice('new-lens', 'Lens', [['wide', 'Wide'], ['paper', 'Of the paper']]);
  private readonly fills = el('input', { type: 'checkbox', id: 'new-fill', checked: '' });
  private readonly tools = new MapTools(this.stage, () => this.paint);
  private readonly runs = new NewSiteRuns((names) => attempt(() => this.mapOfRuns(names)));
  private readonly lacks: Record<string, HTMLElement> = {};
  private readonly makeMap = button('Make the map', 'Cells of walls and floor from the plan', () => attempt(() => this.mapOfPlan()), { id: 'new-make-map' });
  private readonly make = button('Make the site', 'Writes the folder and opens its console', () => attempt(() => this.makeSite()), { id: 'new-make', class: 'main' });

  constructor(folder: string) {
    document.body.dataset['mode'] = 'new';
    byId('title').textContent = `Lodestar: new site ${folder}`;
    document.title = `New site ${folder}`;
    byId('stage').setAttribute('aria-label', 'The plan, then the map. The fields beside it do the same with the keyboard.');
    this.buildSteps();
    this.stage.onPoints = () => this.refresh();
    this.file.addEventListener('change', () => attempt(() => this.openPlan()));
    addEventListener('keydown', (e) => this.tools.key(e));
    addEventListener('beforeunload', (e) => { if (this.paint?.canUndo) e.preventDefault(); });
    this.refresh();
  }

  // -- the panel ------------------------------------------------------------------------------------------------

  private number(id: string, label: string, value: string, low: number, high: number): NumberOf {
    const input = el('input', { id, type: 'number', step: 'any', value });
    input.addEventListener('input', () => this.refresh());
    return { input, label, low, high };
  }

  private choice(id: string, label: string, words: [string, string][]): { select: HTMLSelectElement; label: string } {
    return { select: el('select', { id }, ...words.map(([value, text]) => el('option', { value }, text))), label };
  }

  private fields(...list: NumberOf[]): HTMLElement {
    return el('div', { class: 'fields wide' }, ...list.flatMap(({ input, label }) => [el('label', { for: input.id }, label), input]));
  }

  private step(name: string, head: string, ...contents: (Node | string)[]): HTMLElement {
    this.lacks[name] = el('p', { role: 'status', id: `new-lacks-${name}` });
    return el('section', { 'aria-labelledby': `new-head-${name}` },
      el('details', { open: '', id: `new-step-${name}` }, el('summary', {}, el('h2', { id: `new-head-${name}` }, head)), ...contents), this.lacks[name]);
  }

  /** What is done makes room for what comes next. */
  private open(names: string[], isOpen: boolean): void {
    for (const name of names) (byId(`new-step-${name}`) as HTMLDetailsElement).open = isOpen;
  }

  private buildSteps(): void {
    byId('new-steps').append(
      this.step('plan', '1. A plan, an empty hall, or a drive', el('p', {}, el('label', { for: 'new-plan' }, 'Picture, PDF (first page) or DXF '), this.file), this.fields(this.unit),
        el('p', {}, 'Without a plan: the inside of the outer walls.'), this.fields(this.hallWidth, this.hallHeight),
        el('div', { class: 'row' }, button('Empty hall', 'A hall of this size', () => attempt(() => this.mapOfHall()), { id: 'new-hall' })), this.runs.element),
      this.step('scale', '2. Its scale', el('p', {}, 'Click two points on the plan whose distance you know. The wheel zooms, the right button moves the plan.'), this.fields(this.distance, this.scale)),
      this.step('map', '3. The map', this.fields(this.turn, this.dark, this.cell), el('div', { class: 'row' }, this.makeMap,
        button('Back to the plan', 'To measure again', () => attempt(() => this.backToPlan()), { id: 'new-back' })), this.tools.element),
      this.step('robot', '4. Ceiling and robot', this.fields(this.ceiling, this.camera, this.radius),
        el('div', { class: 'fields wide' }, ...[this.base, this.lens].flatMap(({ select, label }) => [el('label', { for: select.id }, label), select])),
        el('p', {}, el('label', { for: 'new-fill' }, this.fills, ' Hang markers wherever the robot needs them'))),
      this.step('site', '5. The site', el('div', { class: 'row' }, this.make)));
  }

  /** What a field lacks, in words; empty when it is usable. */
  private wrong({ input, label, low, high }: NumberOf): string {
    const value = input.valueAsNumber;
    const isGood = value >= low && value <= high;
    input.setAttribute('aria-invalid', String(!isGood));
    return isGood ? '' : `${label}: wanted a number from ${low} to ${high}`;
  }

  /** Metres for a pixel: by two points, as typed, or as the plan says. */
  get metresPerPx(): number | null {
    const [a, b] = this.stage.points;
    const apart = a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
    if (apart > 0 && this.distance.input.valueAsNumber > 0) return this.distance.input.valueAsNumber / apart;
    if (this.scale.input.valueAsNumber > 0) return this.scale.input.valueAsNumber;
    return this.plan?.metres_per_px ?? null;
  }

  private lack(name: string, missing: string, good: string): boolean {
    const place = this.lacks[name]!;
    place.textContent = missing !== '' ? missing : good;
    place.className = missing !== '' ? 'warning' : 'fine';
    return missing === '';
  }

  private refresh(): void {
    const { plan, map } = this;
    this.lack('plan', plan || map ? '' : 'Missing: a plan, a hall, or a drive',
      plan ? `${plan.name}: ${plan.width_px} x ${plan.height_px} pixels` : this.from);
    const scale = this.metresPerPx;
    const points = this.stage.points.length;
    const measured = points === 2 && !(this.distance.input.valueAsNumber > 0) ? 'Missing: the metres between the two points'
      : plan && scale === null ? `Missing: ${points === 1 ? 'the second point' : 'two points'} and the metres between them, or the metres for a pixel` : '';
    const size = plan && scale !== null ? `The plan is ${(plan.width_px * scale).toFixed(2)} x ${(plan.height_px * scale).toFixed(2)} m` : '';
    const isScaled = this.lack('scale', measured, plan ? size : `Nothing to do: ${this.from.toLowerCase()}`);
    const first = [this.turn, this.dark, this.cell].map((field) => this.wrong(field)).find((words) => words !== '') ?? '';
    this.makeMap.disabled = !plan || !isScaled || first !== '';
    this.tools.element.hidden = !map;
    byId('new-back').hidden = !plan || !map;
    const hasMap = this.lack('map', first !== '' ? first : map ? '' : 'Missing: the map',
      map ? `${(map.columns * map.resolution_m).toFixed(2)} x ${(map.rows * map.resolution_m).toFixed(2)} m. ${map.warnings.join(' ')}` : '');
    const robot = [this.ceiling, this.camera, this.radius].map((field) => this.wrong(field)).find((words) => words !== '')
      ?? (this.ceiling.input.valueAsNumber < this.camera.input.valueAsNumber + 0.3 ? 'The ceiling must be 0.3 m above the camera at least' : '');
    const hasRobot = this.lack('robot', robot, 'Limits, calibration and the bus are set in the files later');
    this.make.disabled = !hasMap || !hasRobot;
    this.lack('site', hasMap && hasRobot ? '' : 'Missing: see above', 'Nothing has been written yet');
  }

  // -- from step to step ----------------------------------------------------------------------------------------

  /** Strokes on the map end with it. */
  private async mayDiscard(): Promise<boolean> {
    if (!this.paint?.canUndo) return true;
    return await ask('Draw the map anew?', [el('p', {}, 'What you have drawn on the present one is lost.')], [['go', 'Go on'], ['', 'Keep it']]) === 'go';
  }

  private async openPlan(): Promise<string | void> {
    const file = this.file.files?.[0];
    if (!file || !await this.mayDiscard()) return;
    say(`Reading ${file.name} ...`);
    const unit = this.unit.input.valueAsNumber;
    const plan = await api.readPlan(file.name, base64(new Uint8Array(await file.arrayBuffer())), unit > 0 ? unit : null);
    const picture = await createImageBitmap(new Blob([bytesOf(plan.png) as BlobPart], { type: 'image/png' }));
    [this.plan, this.map, this.paint] = [plan, null, null];
    this.stage.showPlan(picture, plan.width_px, plan.height_px);
    this.picture = picture;
    this.refresh();
    return `${file.name} is read`;
  }
  private async backToPlan(): Promise<void> {
    if (!this.plan || !this.picture || !await this.mayDiscard()) return;
    const { points } = this.stage;
    [this.map, this.paint] = [null, null];
    this.stage.showPlan(this.picture, this.plan.width_px, this.plan.height_px);
    this.stage.points = points;
    this.stage.redraw();
    this.open(['plan', 'scale'], true);
    this.refresh();
  }

  private async mapOfPlan(): Promise<string | void> {
    if (!await this.mayDiscard()) return;
    return this.showMap(await api.makeMap({ metres_per_px: this.metresPerPx!, rotate_deg: this.turn.input.valueAsNumber,
      threshold: Math.round(this.dark.input.valueAsNumber), cell_m: this.cell.input.valueAsNumber }));
  }

  private async mapOfHall(): Promise<string | void> {
    if (!await this.mayDiscard()) return;
    const wrong = [this.hallWidth, this.hallHeight, this.cell].map((field) => this.wrong(field)).find((words) => words !== '');
    if (wrong) throw new Error(wrong);
    this.plan = null;
    return this.showMap(await api.makeMap({ hall_m: [this.hallWidth.input.valueAsNumber, this.hallHeight.input.valueAsNumber], cell_m: this.cell.input.valueAsNumber }));
  }

  /** It has the markers that the robot saw: no others are hung unless somebody asks for them. */
  private async mapOfRuns(names: string[]): Promise<string | void> {
    const wrong = this.wrong(this.cell);
    if (wrong) throw new Error(wrong);
    if (!await this.mayDiscard()) return;
    say('Building the map from scans ...');
    const made = await api.makeMap({ runs: names, cell_m: this.cell.input.valueAsNumber });
    this.plan = null;
    this.fills.checked = made.markers === 0;
    return this.showMap(made, `Of ${plural(names.length, 'drive')}, with ${plural(made.markers, 'marker')}`);
  }

  private showMap(made: NewMap, from = 'An empty hall'): string {
    this.from = from;
    this.map = made;
    this.paint = new MapPaint(made.columns, made.rows, bytesOf(made.cells));
    this.stage.showMap(this.paint);
    this.tools.pick('line', 'wall');
    this.open(['plan', 'scale'], false);
    this.refresh();
    return 'Draw what the plan lacks, and take out what is no wall: doors, furniture, dimensions, text';
  }

  private async makeSite(): Promise<void> {
    const { map, paint } = this;
    if (!map || !paint) return;
    this.make.disabled = true;
    say(this.fills.checked ? 'Placing markers ...' : 'Making the site ...');
    try {
      const made = await api.makeSite({ map: { ...map, cells: base64(paint.cells) }, base: this.base.select.value, camera: this.lens.select.value,
        radius_m: this.radius.input.valueAsNumber, camera_height_m: this.camera.input.valueAsNumber, ceiling_m: this.ceiling.input.valueAsNumber, fill: this.fills.checked });
      sessionStorage.setItem('lodestar-made', `The site is made, with ${plural(made.markers, 'marker')}${made.why === '' ? '' : `: ${made.why}`}. `
        + 'Look at the coverage, print the markers and hang them, then survey.');
    } catch (error) {
      this.refresh();
      throw error;
    }
    this.paint = null;  // nothing is lost by leaving
    while (!await api.isSiteThere()) await new Promise((done) => setTimeout(done, waitMs));
    location.reload();
  }
}
