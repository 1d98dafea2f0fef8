// Who is at the wheel: this page's lease, when it ends, and requests for it.
import { button, byId } from './dom.js';
import type { State } from './live_socket.js';
import { keepName, myName } from './my_name.js';

const startsWithinMs = 3000;  // after an order; else the robot has not taken it

interface Wheel {
  readonly atWheel: boolean;
  send(message: Record<string, unknown>): boolean;
  say(words: string, bad?: boolean): void;
  /** The drive ordered here is over. */
  driveOver(): void;
}

/** Programs have numbers below 0, which say nothing to people. */
export const nameOf = (client: number, name: string): string => client < 0 ? name : name === '' ? `client ${client}` : `${name} (client ${client})`;

export class Control {
  private wanted = false;
  private givenBack = false;  // the newest state may not know it yet
  private hasDriven = false;
  private orderedAt = 0;

  constructor(private readonly wheel: Wheel) {}

  get name(): string { return myName(); }
  set name(name: string) {
    keepName(name);
    this.wheel.send({ type: 'name', name });
  }

  /** An order of a drive: takes the wheel for as long as the drive lasts. */
  order(message: Record<string, unknown>): void {
    if (!this.wheel.atWheel || this.givenBack) this.wheel.send({ type: 'take' });
    this.givenBack = false;
    this.wanted = true;
    this.hasDriven = false;
    this.orderedAt = performance.now();
    this.once(message);
  }

  /** An order that needs nobody at the wheel. */
  once(message: Record<string, unknown>): void {
    if (!this.wheel.send(message)) this.wheel.say('No connection to the robot: nothing was sent', true);
  }

  release(): void {
    this.lose();
    this.givenBack = true;
    this.wheel.send({ type: 'release' });
  }

  /** Without a message: the wheel is gone already. */
  lose(): void { this.wanted = this.hasDriven = false; }

  /** Another driver has handed over. */
  receive(): void {
    this.wanted = true;
    this.hasDriven = false;
    this.orderedAt = performance.now();
    this.wheel.say('You are at the wheel');
  }

  /** Renews the lease while this page is visible. */
  beat(): void { if (this.wanted && !document.hidden) this.wheel.send({ type: 'hold' }); }

  /** Releases the wheel when the drive is over, or has not begun. */
  watch(state: State, byHand: boolean): void {
    if (state.moving) this.hasDriven = true;
    if (!this.wanted || byHand || state.moving) return;
    const waits = !this.hasDriven && performance.now() - this.orderedAt < startsWithinMs;
    if (waits) return;
    const drove = this.hasDriven;
    this.release();
    if (drove) this.wheel.driveOver();
  }

  /** Asks this page's user, who drives, for the wheel. */
  showRequest(client: number, name: string): void {
    const box = byId('asked');
    const answer = (type: string) => () => {
      box.hidden = true;
      if (type === 'hand_over') this.lose();
      this.wheel.send({ type, client });
    };
    box.replaceChildren(`${nameOf(client, name)} asks for the wheel. `,
      button('Hand over', 'They drive on from here', answer('hand_over'), { id: 'hand-over' }),
      button('Keep', 'Stay at the wheel', answer('keep'), { id: 'keep-wheel' }));
    box.hidden = false;
  }
}
