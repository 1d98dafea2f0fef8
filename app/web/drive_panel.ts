// The panel beside the map: the robot's state in words and numbers, and the goals as input fields.
import { button, byId, el, positive } from './dom.js';
import type { Goal } from './goals.js';
import { nameOf } from './control.js';
import type { Live } from './live.js';
import { ellipseOf } from './robot_paint.js';
import { fieldWords } from './seen_paint.js';

export class DrivePanel {
  private listed = '';
  private readonly whyNot = el('p', { id: 'drive-why' });
  private readonly ask = button('Ask for the wheel', 'The driver is asked to hand over', () => this.live.ask(), { id: 'ask-wheel' });
  private readonly lanes = el('input', { type: 'checkbox', id: 'along-lanes', checked: '' });
  private readonly alongLanes = el('p', { hidden: '' }, el('label', { for: 'along-lanes', title: 'One-way lanes are driven their way only, and at their speed' }, this.lanes, ' Along the lanes'));
  private readonly more = button('Drive there next', 'When the present drive is done, without a stop in between', () => this.live.driveNext(), { id: 'drive-more', hidden: '' });
  private readonly charge = button('Charge', 'Drive onto the dock and charge', () => this.live.charge(), { id: 'drive-charge', hidden: '' });
  private readonly summary = el('p', { id: 'preview-words', role: 'status' });

  constructor(private readonly live: Live) {
    this.lanes.addEventListener('change', () => this.live.useLanes(this.lanes.checked));
    byId('drive').append(this.whyNot, el('div', { id: 'goal-list' }), this.alongLanes, this.summary, el('div', { class: 'row' },
      button('Drive', 'Drive to the goals', () => live.drive(), { id: 'drive-go', class: 'main' }),
      this.more,
      button('Clear', 'Remove the goals', () => live.goals.set([]), { id: 'drive-clear' }),
      button('Set robot pose', 'Set the robot\'s initial pose to the first goal and its heading: drag its arrow', () => live.placeRobot(), { id: 'drive-place' }), this.charge), this.nameField());
  }

  private nameField(): HTMLElement {
    const input = el('input', { id: 'my-name', maxlength: '20', autocomplete: 'name', value: this.live.control.name });
    input.addEventListener('change', () => { this.live.control.name = input.value.trim(); });
    return el('p', { class: 'row' }, el('label', { for: 'my-name' }, 'Shown to others as '), input);
  }

  /** `shown`: else only what stands in the head of the page, in every mode. */
  refresh(shown = true): void {
    byId('live-phase').textContent = this.live.words();
    this.showControls();
    if (!shown) return;
    this.showRobot();
    this.showGoals();
    this.showEvents();
  }

  private showRobot(): void {
    const state = this.live.state;
    if (!state) return byId('robot').replaceChildren(this.live.words());
    const rows: [string, string, boolean?][] = [];
    const pose = state.pose;
    rows.push(['Pose', pose ? `${pose.x_m.toFixed(3)}, ${pose.y_m.toFixed(3)} m, ${pose.yaw_deg.toFixed(1)}°` : 'not known', !pose]);
    if (pose) rows.push(['3σ', `${(1000 * ellipseOf(pose.covariance_m2, 3).long).toFixed(1)} mm, ${(3 * pose.sigma_yaw_deg).toFixed(2)}°`]);
    if (state.error_m !== null) rows.push(['Error', `${(1000 * state.error_m).toFixed(1)} mm`]);
    const speed = state.measured ?? state.commanded;
    rows.push(['Speed', `${positive(speed.forward_mps.toFixed(2))} m/s, ${positive(speed.turn_degps.toFixed(0))} °/s`]);
    const age = state.seen_s === null ? null : state.time_s - state.seen_s;
    rows.push(['Markers', age === null ? 'none seen yet' : `${state.markers.join(', ')}${age > 0.5 ? ` (${age.toFixed(1)} s ago)` : ''}`, age === null || age > 2]);
    if (state.distrusted.length > 0) rows.push(['Not trusted', state.distrusted.join(', '), true]);
    if (this.live.isStale) rows.push(['Last known', `${this.live.silentS.toFixed(0)} s ago`, true]);
    if (state.field !== null) rows.push(['Scanner', fieldWords(state.field) || 'the way is clear', state.field.state !== 'free']);
    rows.push(['May move', state.stop ?? (state.base_ready ? 'yes' : 'no'), state.stop !== null]);
    rows.push(['Base', state.fault ? `${state.base}: ${state.fault}` : state.base, !state.base_ready]);
    if (state.battery_v !== null) rows.push(['Battery', `${state.battery_v.toFixed(1)} V${state.charging === '' ? '' : `, ${state.charging}`}`]);
    rows.push(['Driver', state.driver === null ? 'nobody' : this.live.atWheel ? 'you' : nameOf(state.driver, state.driver_name)]);
    byId('robot').replaceChildren(el('dl', {}, ...rows.flatMap(([name, words, bad]) =>
      [el('dt', {}, name), el('dd', bad ? { class: 'error' } : {}, words.replaceAll(/ (?=mm|m\b|m\/s|°|V)/g, '\u00a0'))])));
  }

  private showGoals(): void {
    const { goals } = this.live;
    this.alongLanes.hidden = !this.live.hasLanes;
    const key = JSON.stringify(goals.list);
    const isTyping = document.activeElement instanceof HTMLInputElement && byId('goal-list').contains(document.activeElement);
    if (key !== this.listed && !isTyping) {
      this.listed = key;
      byId('goal-list').replaceChildren(...(goals.list.length === 0
        ? [el('p', {}, 'Click on the map for a goal, Shift+click for more; drag the end of its arrow for a heading.'),
          button('Goal by numbers', 'A goal at the middle of the view', () => this.byNumbers(), { id: 'goal-numbers' })]
        : goals.list.map((goal, i) => this.row(goal, i))));
    }
    const { preview } = this.live;
    const reach = preview?.points
      ? `${preview.length_m!.toFixed(2)} m, about ${preview.time_s!.toFixed(0)} s, ${preview.turns} turns`
      : preview?.why ? `No path: ${preview.why}` : goals.list.length > 0 && this.live.canDrive ? 'Planning ...' : '';
    this.summary.textContent = reach;
    this.summary.className = preview?.why ? 'error' : '';
    const nearest = preview?.nearest;
    if (nearest && preview.goal === goals.list.length - 1) this.summary.append(' ', button('Nearest position instead', 'Use the nearest reachable position', () => {
      goals.set(goals.list.with(-1, { x: nearest[0], y: nearest[1], yawDeg: goals.list.at(-1)!.yawDeg }));
    }));
  }

  private byNumbers(): void {
    this.live.goals.click(this.live.middle(), false);
    byId('goal-list').querySelector('input')?.select();
  }

  private row(goal: Goal, index: number): HTMLElement {
    const reason = el('p', { class: 'error', role: 'alert' });
    const field = (name: string, value: string, change: (text: string) => Partial<Goal> | null) => {
      const input = el('input', { value, inputmode: 'decimal', 'aria-label': `Goal ${index + 1}, ${name}` });
      input.addEventListener('change', () => {
        const changed = change(input.value.trim());
        reason.textContent = changed ? '' : `${name}: '${input.value}' is not a number; the goal stays where it was`;
        if (!changed) return input.setAttribute('aria-invalid', 'true');
        input.removeAttribute('aria-invalid');
        this.listed = '';
        this.live.goals.set(this.live.goals.list.with(index, { ...this.live.goals.list[index]!, ...changed }));
      });
      return input;
    };
    const number = (text: string): number | null => text !== '' && Number.isFinite(Number(text)) ? Number(text) : null;
    return el('div', { class: 'goal-row' },
      el('span', {}, 'x'), field('x in metres', String(goal.x), (t) => { const x = number(t); return x === null ? null : { x }; }),
      el('span', {}, 'y'), field('y in metres', String(goal.y), (t) => { const y = number(t); return y === null ? null : { y }; }),
      el('span', {}, '°'), field('heading in degrees, or nothing', goal.yawDeg === null ? '' : String(goal.yawDeg),
        (t) => { const yawDeg = number(t); return t === '' ? { yawDeg: null } : yawDeg === null ? null : { yawDeg }; }), reason);
  }

  private showControls(): void {
    const { live } = this;
    const state = live.state;
    const enable = (id: string, possible: boolean) => { (byId(id) as HTMLButtonElement).disabled = !possible; };
    const free = live.canDrive && !live.isStale && state !== null && (state.driver === null || live.atWheel);
    enable('live-stop', live.hello?.robot === true);
    this.showWhyNot(free);
    live.hand.enable(free);
    enable('live-pause', free && state!.moving && !state!.paused);
    enable('live-resume', free && state!.paused);
    enable('live-clear', free && state!.fault !== null);
    enable('drive-go', free && live.preview?.points !== undefined);
    this.more.hidden = !live.hasNext;
    enable('drive-more', free && live.preview?.points !== undefined);
    this.charge.hidden = !live.hello?.dock;
    enable('drive-charge', free && state!.base_ready);
    enable('drive-clear', live.goals.list.length > 0);
    enable('drive-place', free && !state!.moving && live.goals.list[0]?.yawDeg != null);
  }

  /** Why there is no driving from here, and what can be done about it. */
  private showWhyNot(free: boolean): void {
    const { live } = this;
    const { state } = live;
    const isTaken = live.canDrive && !live.isStale && state !== null && !free;
    const lost = live.canDrive && state !== null && !state.moving && state.stop !== null;
    const words = !live.hello?.robot ? '' : !live.mayDrive ? 'This page may watch and stop; driving needs the token to drive.'
      : isTaken ? `${nameOf(state!.driver!, state!.driver_name)} is at the wheel. `
        : lost ? 'If the robot stands elsewhere than shown here: set a goal where it truly is, drag its arrow to its heading, and press Set robot pose.' : '';
    if (this.whyNot.dataset['words'] === words) return;
    this.whyNot.dataset['words'] = words;
    this.whyNot.replaceChildren(words, ...(isTaken ? [this.ask] : []));
  }

  private showEvents(): void {
    const events = this.live.state?.events ?? [];
    const box = byId('events');
    const newest = String(events.at(-1)?.number ?? 0);
    if (box.dataset['newest'] === newest) return;
    box.dataset['newest'] = newest;
    box.replaceChildren(...[...events].reverse().map((e) => el('li', {}, el('time', {}, `${e.time_s.toFixed(1)} s`), ` ${e.words}`)));
  }
}
