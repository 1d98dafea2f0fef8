// What has been seen of a drive so far: the track on the map and a minute of plots.
import { byId } from './dom.js';
import type { Point } from './geometry.js';
import type { State } from './live_socket.js';
import { DrivePlots } from './plots.js';
import { ellipseOf } from './robot_paint.js';

const keptRows = 1200;       // a minute
const plotEveryMs = 200;
const trackStepM = 0.02;
const mostTrack = 5000;

export class LiveTrace {
  track: Point[] = [];
  private plots: DrivePlots | null = null;
  private columns = emptyColumns();
  private plottedAt = 0;

  /** Another run of the robot's program: its clock begins anew. */
  reset(): void {
    this.track = [];
    this.columns = emptyColumns();
    this.plots?.set(this.columns);
  }

  add(state: State, shown: boolean): void {
    if (state.time_s < (this.columns[0]!.at(-1) ?? 0)) this.reset();
    if (state.pose) this.addToTrack({ x: state.pose.x_m, y: state.pose.y_m });
    this.addRow(state);
    if (shown) this.show();
  }

  show(): void {
    this.plots ??= new DrivePlots(byId('live-plots'));
    if (performance.now() - this.plottedAt < plotEveryMs) return;
    this.plottedAt = performance.now();
    this.plots.set(this.columns);
    this.plots.tell(this.columns[0]!.length - 1);
  }

  private addToTrack(at: Point): void {
    const last = this.track.at(-1);
    if (last && Math.hypot(at.x - last.x, at.y - last.y) < trackStepM) return;
    this.track.push(at);
    if (this.track.length > mostTrack) this.track.splice(0, mostTrack / 10);
  }

  private addRow(state: State): void {
    const sigmaMm = state.pose ? 1000 * ellipseOf(state.pose.covariance_m2, 3).long : null;
    const errorMm = state.error_m === null ? null : 1000 * state.error_m;
    const sees = state.seen_s !== null && state.time_s - state.seen_s < 0.5;
    const row = [state.time_s, sigmaMm, errorMm, state.commanded.forward_mps, state.measured?.forward_mps ?? null,
      sees ? state.confidence : null, sees ? state.markers.length : 0];
    this.columns.forEach((column, i) => {
      column.push(row[i]!);
      if (column.length > keptRows) column.shift();
    });
  }
}

const emptyColumns = (): (number | null)[][] => Array.from({ length: 7 }, () => []);
