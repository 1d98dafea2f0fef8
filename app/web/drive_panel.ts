// The panel beside the map: the robot's state in words and numbers, and the goals as input fields.
import { button, byId, el, positive } from './dom.js';
import type { Goal } from './goals.js';
import type { Live } from './live.js';
import { ellipseOf } from './robot_paint.js';

export class DrivePanel {
  private listed = '';
  private readonly summary = el('p', { id: 'preview-words', role: 'status' });

  constructor(private readonly live: Live) {
    byId('drive').append(el('div', { id: 'goal-list' }), this.summary, el('div', { class: 'row' },
      button('Drive', 'Drive to the goals', () => live.drive(), { id: 'drive-go', class: 'main' }),
      button('Clear', 'Remove the goals', () => live.goals.set([]), { id: 'drive-clear' }),
      button('Set robot pose', 'Set the robot\'s initial pose to the first goal', () => live.placeRobot(), { id: 'drive-place' })));
  }

  refresh(): void {
    this.showRobot();
    this.showGoals();
    this.showControls();
    this.showEvents();
  }

  private showRobot(): void {
    const state = this.live.state;
    byId('live-phase').textContent = this.live.words();
    if (!state) return;
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
    rows.push(['May move', state.stop ?? (state.base_ready ? 'yes' : 'no'), state.stop !== null]);
    rows.push(['Base', state.fault ? `${state.base}: ${state.fault}` : state.base, !state.base_ready]);
    if (state.battery_v !== null) rows.push(['Battery', `${state.battery_v.toFixed(1)} V`]);
    rows.push(['Driver', state.driver === null ? 'nobody' : this.live.atWheel ? 'you' : `client ${state.driver}`]);
    byId('robot').replaceChildren(el('dl', {}, ...rows.flatMap(([name, words, bad]) =>
      [el('dt', {}, name), el('dd', bad ? { class: 'error' } : {}, words.replaceAll(/ (?=mm|m\b|m\/s|°|V)/g, '\u00a0'))])));
  }

  private showGoals(): void {
    const { goals } = this.live;
    const key = JSON.stringify(goals.list);
    if (key !== this.listed && !byId('goal-list').contains(document.activeElement)) {
      this.listed = key;
      byId('goal-list').replaceChildren(...(goals.list.length === 0
        ? [el('p', {}, 'Click on the map for a goal, Shift+click for more; drag the end of its arrow for a heading.'),
          button('Goal by numbers', 'A goal at the middle of the view', () => this.live.goals.click(this.live.middle(), false), { id: 'goal-numbers' })]
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

  private row(goal: Goal, index: number): HTMLElement {
    const field = (name: string, value: string, change: (text: string) => Partial<Goal> | null) => {
      const input = el('input', { value, inputmode: 'decimal', 'aria-label': `Goal ${index + 1}, ${name}` });
      input.addEventListener('change', () => {
        const changed = change(input.value.trim());
        if (!changed) return input.setAttribute('aria-invalid', 'true');
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
        (t) => { const yawDeg = number(t); return t === '' ? { yawDeg: null } : yawDeg === null ? null : { yawDeg }; }));
  }

  private showControls(): void {
    const { live } = this;
    const state = live.state;
    const enable = (id: string, possible: boolean) => { (byId(id) as HTMLButtonElement).disabled = !possible; };
    const free = live.canDrive && state !== null && (state.driver === null || live.atWheel);
    enable('live-stop', live.hello?.robot === true);
    live.hand.enable(free);
    enable('live-pause', free && state!.moving && !state!.paused);
    enable('live-resume', free && state!.paused);
    enable('live-clear', free && state!.fault !== null);
    enable('drive-go', free && live.preview?.points !== undefined);
    enable('drive-clear', live.goals.list.length > 0);
    enable('drive-place', free && !state!.moving && live.goals.list[0]?.yawDeg != null);
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
