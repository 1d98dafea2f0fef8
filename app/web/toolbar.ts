// The tools of a mode as buttons with icons, in groups. Commands that have a button's text stand here, once each.
import type { Command } from './commands.js';
import { button, byId, el } from './dom.js';
import { icon } from './icons.js';

const groups: [string, string[]][] = [
  ['Undo and redo', ['undo', 'redo', 'places-undo', 'places-redo']],
  ['Markers', ['add', 'duplicate', 'array', 'move-by', 'delete']],
  ['Draw', ['draw-keep_out', 'draw-speed_zone', 'draw-place', 'draw-node', 'draw-edge', 'places-delete']],
  ['Measuring', ['snap', 'align', 'measure', 'coverage']],
  ['View', ['zoom-in', 'zoom-out', 'fit']],
  ['Files', ['import', 'export', 'print', 'plan']],
  ['Document', ['history', 'reload', 'save', 'places-history', 'places-reload', 'places-save']],
  ['Page', ['log', 'theme', 'help']]];

/** What everybody knows by its icon; the others say their name, too. */
const known = new Set(['undo', 'redo', 'places-undo', 'places-redo', 'delete', 'places-delete', 'zoom-in', 'zoom-out', 'fit', 'print', 'history', 'places-history',
  'reload', 'places-reload', 'log', 'theme', 'help']);

export class Toolbar {
  private readonly tools = new Map<Command, HTMLButtonElement>();
  private readonly groups: HTMLElement[];

  constructor(commands: Command[], run: (command: Command) => void) {
    this.groups = groups.map(([name, tools]) => el('div', { role: 'group', 'aria-label': name, class: 'tool-group' },
      ...tools.flatMap((tool) => commands.filter((c) => c.button && c.name === tool)).map((command) => {
        const words = command.title + (command.key ? ` (${command.key})` : '');
        const made = button('', words, () => run(command), { id: `tool-${command.name}` });
        made.append(icon(command.name) ?? '', el('span', known.has(command.name) ? { class: 'unseen' } : {}, command.button!));
        this.tools.set(command, made);
        return made;
      })));
    byId('tools').append(...this.groups);
  }

  /** A group without a tool of the mode leaves no gap. */
  refresh(isOfMode: (command: Command) => boolean): void {
    for (const [command, tool] of this.tools) {
      tool.hidden = !isOfMode(command);
      tool.disabled = command.possible?.() === false;
      if (command.pressed) tool.setAttribute('aria-pressed', String(command.pressed()));
    }
    for (const group of this.groups) group.hidden = [...group.children].every((tool) => (tool as HTMLElement).hidden);
  }
}
