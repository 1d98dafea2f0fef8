// Driving by hand: keys, a pad for mouse or finger, or a game controller. The robot moves only while one of them
// is held: each order lasts a moment and is renewed, so a lost connection lets it come to rest.
import { button, el } from './dom.js';

const renewEveryMs = 100;
const forwardMps = 0.3;
const turnDegps = 28;
const deadZone = 0.12;
const keys: Record<string, [number, number]> = {
  ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1], w: [1, 0], s: [-1, 0], a: [0, 1], d: [0, -1],
};

/** Shares of the greatest speeds: ahead, and to the left. */
interface Stick { ahead: number; left: number }
const atRest: Stick = { ahead: 0, left: 0 };

export class HandDrive {
  readonly element: HTMLElement;
  on = false;
  private readonly toggle: HTMLButtonElement;
  private readonly knob = el('div', { class: 'knob' });
  private readonly pad: HTMLElement;
  private readonly held = new Set<string>();
  private finger: Stick | null = null;
  private moved = false;

  /** `send`: an order to the robot; `end`: gives up control. */
  constructor(private readonly send: (order: Record<string, unknown>) => void, private readonly end: () => void) {
    this.toggle = button('Drive by hand', 'With the arrow keys or W A S D, the pad below, or a game controller', () => this.set(!this.on), { id: 'hand-toggle' });
    this.pad = el('div', { class: 'pad', id: 'hand-pad', role: 'img', 'aria-label': 'Drag from the middle to drive: up is ahead, to the side turns' }, this.knob);
    this.element = el('div', { class: 'hand' }, this.toggle, this.pad,
      el('p', { class: 'hint' }, 'Keep the robot in sight: by hand it does not look for obstacles that the map lacks.'));
    this.listen();
    this.set(false);
    setInterval(() => this.renew(), renewEveryMs);
  }

  set(on: boolean): void {
    const ends = this.on && !on;
    if (ends) this.rest();
    this.on = on;
    this.toggle.setAttribute('aria-pressed', String(on));
    this.pad.hidden = !on;
    if (ends) this.end();
  }

  enable(possible: boolean): void {
    this.toggle.disabled = !possible;
    if (!possible && this.on) this.set(false);
  }

  private rest(): void {
    this.held.clear();
    this.finger = null;
    this.renew();
  }

  private listen(): void {
    addEventListener('keydown', (e) => {
      if (!this.on || e.target instanceof HTMLInputElement || !(keyName(e) in keys)) return;
      e.preventDefault();
      this.held.add(keyName(e));
    });
    addEventListener('keyup', (e) => this.held.delete(keyName(e)));
    addEventListener('blur', () => { this.held.clear(); this.finger = null; });
    this.pad.addEventListener('pointerdown', (e) => { this.pad.setPointerCapture(e.pointerId); this.point(e); });
    this.pad.addEventListener('pointermove', (e) => { if (this.finger) this.point(e); });
    for (const over of ['pointerup', 'pointercancel', 'lostpointercapture']) this.pad.addEventListener(over, () => { this.finger = null; });
  }

  private point(e: PointerEvent): void {
    const box = this.pad.getBoundingClientRect();
    const share = (at: number, low: number, size: number) => Math.max(-1, Math.min(1, 2 * (at - low) / size - 1));
    this.finger = { ahead: -share(e.clientY, box.top, box.height), left: -share(e.clientX, box.left, box.width) };
  }

  private stick(): Stick {
    if (this.finger) return this.finger;
    if (this.held.size > 0) {
      const [ahead, left] = [...this.held].reduce<[number, number]>(([x, y], key) => [x + keys[key]![0], y + keys[key]![1]], [0, 0]);
      return { ahead: Math.sign(ahead), left: Math.sign(left) };
    }
    return controllerStick();
  }

  /** Sends what is held; a zero once when all is released. */
  private renew(): void {
    if (!this.on) return;
    const { ahead, left } = this.stick();
    this.knob.style.transform = `translate(${-50 - 40 * left}%, ${-50 - 40 * ahead}%)`;
    const moves = ahead !== 0 || left !== 0;
    if (moves || this.moved) this.send({ type: 'steer', forward_mps: ahead * forwardMps, turn_degps: left * turnDegps });
    this.moved = moves;
  }
}

const keyName = (e: KeyboardEvent): string => e.key.length === 1 ? e.key.toLowerCase() : e.key;

/** The first controller's left stick. */
function controllerStick(): Stick {
  const pad = navigator.getGamepads().find((p) => p !== null && p.axes.length >= 2);
  if (!pad) return atRest;
  const clean = (share: number) => Math.abs(share) < deadZone ? 0 : Math.max(-1, Math.min(1, share));
  return { ahead: -clean(pad.axes[1]!), left: -clean(pad.axes[0]!) };
}
