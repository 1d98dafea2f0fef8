// What this page's user goes by, kept in the browser: shown to others at the wheel, and in the log of who saved.
const nameKey = 'lodestar-name';

export const myName = (): string => localStorage.getItem(nameKey) ?? '';
export const keepName = (name: string): void => localStorage.setItem(nameKey, name);
