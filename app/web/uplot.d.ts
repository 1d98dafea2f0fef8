// The parts of uPlot that the page uses.
declare module 'uplot' {
  interface Series { label?: string; stroke?: string; width?: number; dash?: number[]; spanGaps?: boolean; points?: { show: boolean } }
  interface Axis { stroke?: string; grid?: { stroke: string; width: number }; ticks?: { stroke: string; width: number }; size?: number; gap?: number; font?: string; space?: number }
  interface Scale { time?: boolean; range?: (plot: uPlot, min: number, max: number) => [number, number] }
  interface Options {
    width: number; height: number; series: Series[]; axes?: Axis[]; scales?: Record<string, Scale>;
    legend?: { show: boolean }; cursor?: { x?: boolean; y?: boolean; drag?: { x: boolean; y: boolean }; points?: { show: boolean } };
    padding?: [number, number, number, number];
  }
  class uPlot {
    constructor(options: Options, data: (number | null)[][], target: HTMLElement);
    readonly over: HTMLElement;
    setData(data: (number | null)[][]): void;
    setSize(size: { width: number; height: number }): void;
    setCursor(at: { left: number; top: number }): void;
    posToVal(position: number, scale: string): number;
    valToPos(value: number, scale: string): number;
    destroy(): void;
  }
  export default uPlot;
}
