// Goals as set on the map or typed: one or several, each with or without a heading.
import { degrees } from './geometry.js';
import type { Point } from './geometry.js';
import { headOf } from './robot_paint.js';
import type { View } from './view.js';

export interface Goal extends Point { yawDeg: number | null }

const nearPx = 12;
const round = (value: number): number => Math.round(value * 1000) / 1000;

export const goalJson = (goal: Goal): number[] => goal.yawDeg === null ? [goal.x, goal.y] : [goal.x, goal.y, goal.yawDeg];

/** A drag starts on a goal (moves it) or at the end of its arrow (rotates it). */
export class Goals {
  list: Goal[] = [];
  /** The mission that they are of, with what is done at its stops; '' where they were set otherwise. */
  mission = '';
  onChange: () => void = () => {};
  private held: { index: number; turns: boolean } | null = null;

  constructor(private readonly view: View) {}

  set(list: Goal[], mission = ''): void {
    this.list = list;
    this.mission = mission;
    this.onChange();
  }

  click(at: Point, also: boolean): void {
    const goal = { x: round(at.x), y: round(at.y), yawDeg: null };
    this.set(also ? [...this.list, goal] : [goal]);
  }

  press(screen: Point): boolean {
    const near = (p: Point) => Math.hypot(p.x - screen.x, p.y - screen.y) < nearPx;
    const index = this.list.findIndex((goal) => near(this.view.toScreen(goal)) || near(this.arrowEnd(goal)));
    if (index < 0) return false;
    this.held = { index, turns: !near(this.view.toScreen(this.list[index]!)) };
    return true;
  }

  drag(screen: Point): void {
    if (!this.held) return;
    const { index, turns } = this.held;
    const goal = this.list[index]!;
    const at = this.view.toMap(screen);
    const yawDeg = Math.round(degrees(Math.atan2(at.y - goal.y, at.x - goal.x)));
    this.set(this.list.with(index, turns ? { ...goal, yawDeg } : { ...goal, x: round(at.x), y: round(at.y) }));
  }

  release(): void { this.held = null; }

  /** End of a goal's arrow on the screen; without a heading it points along the map's x axis. */
  arrowEnd(goal: Goal): Point { return headOf(this.view, this.view.toScreen(goal), goal.yawDeg ?? 0); }
}
