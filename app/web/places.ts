// Places and routes of the site, by name.
import { getRoutes, putRoutes } from './api.js';
import type { Routes } from './api.js';
import { ask, button, byId, el } from './dom.js';
import type { Goal, Goals } from './goals.js';
import { missionWords, stopsOf } from './places_doc.js';

export class Places {
  private routes: Routes = { format: 'lodestar-routes', version: 1, places: [], routes: [] };
  private etag = '';
  private asked = false;
  /** Of the last save of this list, and its tag: other parts of the page need not be told who saved. */
  saving: Promise<unknown> = Promise.resolve();
  savedAs = '';

  constructor(private readonly goals: Goals, private readonly say: (words: string, bad?: boolean) => void) {}

  open(): void {
    if (!this.asked) this.refresh();
  }

  /** Reads them again: somebody has saved. */
  refresh(): void {
    this.asked = true;
    this.attempt(async () => {
      ({ routes: this.routes, etag: this.etag } = await getRoutes());
      this.show();
    });
  }

  private attempt(action: () => Promise<void>): void {
    action().catch((error: unknown) => this.say(error instanceof Error ? error.message : String(error), true));
  }

  private show(): void {
    const goalOf = (name: string): Goal | undefined => {
      const place = this.routes.places.find((p) => p.name === name);
      return place && { x: place.x_m, y: place.y_m, yawDeg: place.yaw_deg ?? null };
    };
    const line = (name: string, words: string, goals: (Goal | undefined)[], remove: () => void, mission = '') => el('li', { class: 'place' },
      button(name, words, () => this.goals.set(goals.filter((g) => g !== undefined), mission)),
      button('×', `Remove ${name}`, () => this.attempt(() => this.removeIfWanted(name, remove)), { 'aria-label': `Remove ${name}` }));
    byId('places').replaceChildren(
      el('ul', { class: 'plain' },
        ...this.routes.places.map((p) => line(p.name, 'Use this place as the goal', [goalOf(p.name)], () => this.forgetPlace(p.name))),
        ...this.routes.routes.map((r) => line(`${r.name}: ${missionWords(r)}`, 'Set the goals of this mission; Drive also waits and acts at its stops', stopsOf(r).map((stop) => goalOf(stop.place)),
          () => { this.routes.routes = this.routes.routes.filter((other) => other !== r); }, r.name))),
      el('div', { class: 'row' },
        button('Keep as place', 'Keep the last goal under a name', () => this.attempt(() => this.keepPlace()), { id: 'place-keep' }),
        button('Keep as mission', 'Keep all goals, in order, under a name; Zones has waits, actions and repetitions', () => this.attempt(() => this.keepRoute()), { id: 'route-keep' })));
  }

  /** Saved at once, so it is asked for. */
  private async removeIfWanted(name: string, remove: () => void): Promise<void> {
    const routes = this.routes.routes.filter((r) => stopsOf(r).some((stop) => stop.place === name)).map((r) => r.name);
    const words = routes.length > 0 ? `The missions over it go too: ${routes.join(', ')}.` : 'Earlier states of all places stay in the history (Zones).';
    if (await ask(`Remove ${name}?`, [el('p', {}, words)], [['go', 'Remove'], ['', 'Keep']]) !== 'go') return;
    remove();
    this.save();
  }

  private forgetPlace(name: string): void {
    this.routes.places = this.routes.places.filter((p) => p.name !== name);
    this.routes.routes = this.routes.routes.filter((r) => !stopsOf(r).some((stop) => stop.place === name));
  }

  private async nameFor(what: string): Promise<string> {
    const field = el('input', { 'aria-label': 'Name', id: 'place-name', maxlength: '80' });
    const answer = await ask(`Keep this ${what}`, [el('p', {}, 'Under which name?'), field], [['keep', 'Keep'], ['', 'Cancel']], () => field.value.trim() === '' ? 'Wanted a name' : '');
    return answer === 'keep' ? field.value.trim() : '';
  }

  private async keepPlace(): Promise<void> {
    const goal = this.goals.list.at(-1);
    if (!goal) return this.say('Set a goal on the map first', true);
    const name = await this.nameFor('place');
    if (!name) return;
    this.addPlace(name, goal);
    this.save();
  }

  private addPlace(name: string, goal: Goal): void {
    const place = { name, x_m: goal.x, y_m: goal.y, ...(goal.yawDeg === null ? {} : { yaw_deg: goal.yawDeg }) };
    const at = this.routes.places.findIndex((p) => p.name === name);
    if (at < 0) this.routes.places.push(place);
    else this.routes.places[at] = place;
  }

  private async keepRoute(): Promise<void> {
    if (this.goals.list.length < 2) return this.say('Set two or more goals first: Shift+click on the map', true);
    const name = await this.nameFor('mission');
    if (!name) return;
    const same = (g: Goal) => this.routes.places.find((p) => p.x_m === g.x && p.y_m === g.y && (p.yaw_deg ?? null) === g.yawDeg);
    const places = this.goals.list.map((goal, i) => {
      const known = same(goal)?.name ?? `${name} ${i + 1}`;
      if (!same(goal)) this.addPlace(known, goal);
      return known;
    });
    this.routes.routes = [...this.routes.routes.filter((r) => r.name !== name), { name, places }];
    this.save();
  }

  private save(): void {
    this.attempt(async () => {
      try {
        const put = putRoutes(this.routes, this.etag);
        this.saving = put.catch(() => undefined);
        ({ routes: this.routes, etag: this.etag } = await put);
        this.savedAs = this.etag;
        this.say('Saved the places');
      } catch (error) {
        ({ routes: this.routes, etag: this.etag } = await getRoutes());
        this.show();
        throw error;
      }
      this.show();
    });
  }
}
