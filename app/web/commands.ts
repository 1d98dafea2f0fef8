// What buttons and keys do, each once: both take them from here.

export interface Command {
  name: string;
  title: string;
  key?: string;          // as shown
  button?: string;       // its text in the toolbar; none: a key only
  everywhere?: boolean;  // not only while markers are edited
  run: () => void;
  pressed?: () => boolean;
  possible?: () => boolean;
}

/** "Ctrl+Shift+Z" for an event; Meta counts as Ctrl, so that it is the same on every keyboard. */
export function keyOf(e: KeyboardEvent): string {
  const name = e.key.length === 1 ? e.key.toUpperCase() : e.key;
  const letter = /^[A-Z0-9]$/.test(name) || name.length > 1;
  return [(e.ctrlKey || e.metaKey) ? 'Ctrl+' : '', e.altKey ? 'Alt+' : '', e.shiftKey && letter ? 'Shift+' : '', name].join('');
}

/** Is someone typing? Then only keys with Ctrl are ours. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement || target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}
