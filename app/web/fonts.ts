// Text on canvases, in the size of the page's: style.css makes it larger on a wall, people make it larger in their browser.
const usualPx = 16;
const measured = (): number => parseFloat(getComputedStyle(document.documentElement).fontSize) / usualPx;
let growth = measured();
addEventListener('resize', () => { growth = measured(); });

/** A canvas's font, `px` high where the page's text has its usual size. */
export const font = (px: number, weight: '' | 'bold' | '600' = ''): string => `${weight} ${Math.round(px * growth)}px system-ui, sans-serif`.trim();
