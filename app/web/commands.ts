// Commands, each defined once, for buttons and keys alike.

export interface Command {
  name: string;
  title: string;
  key?: string;          // as shown
  button?: string;       // its text in the toolbar; none: a key only
  everywhere?: boolean;  // not only while markers are edited
  mapless?: boolean;     // where the map with its markers is not shown, too
  onMap?: boolean;       // by its key only while the map has the focus: lists and fields use it too
  surveying?: boolean;   // also during a survey, which proposes changes
  placing?: boolean;     // only while zones, lanes and places are drawn
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

/** Is the focus in a text field? Then only keys with Ctrl are commands. */
export function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement || target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}
