// The colours of the map, in the light and in the dark.

export interface Colours { free: number[]; wall: number[]; unknown: number[]; marker: string; dot: string; chosen: string; ink: string; paper: string; route: string }
const light: Colours = { free: [255, 255, 255], wall: [52, 60, 72], unknown: [205, 210, 217], marker: '#1c2430', dot: '#ffffff', chosen: '#0b5fce', ink: '#1c2430', paper: '#ffffff', route: '#7a3fb0' };
const dark: Colours = { free: [40, 47, 58], wall: [150, 161, 176], unknown: [22, 27, 34], marker: '#0a0d12', dot: '#dfe6f0', chosen: '#7fb2ff', ink: '#e7ebf2', paper: '#12161d', route: '#d9a8ff' };

export const coloursNow = (): Colours => document.documentElement.dataset['theme'] === 'dark' ? dark : light;

/** A pixel of an image. Opaque; the bytes are in the order of an image's on whatever machine. */
export const pixelOf = (colour: number[]): number => new Uint32Array(Uint8ClampedArray.from([...colour.slice(0, 3), 255]).buffer)[0]!;
