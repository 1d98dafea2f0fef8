// Commands that edit markers.
import type { Actions } from './actions.js';
import type { Command } from './commands.js';
import type { Editor } from './editor.js';
import type { Measure } from './measure.js';
import type { Pointer } from './pointer.js';
import type { View } from './view.js';

export interface MarkerTools {
  readonly editor: Editor;
  readonly actions: Actions;
  readonly pointer: Pointer;
  readonly measure: Measure;
  readonly view: View;
}

/** `attempt`: runs an action that may fail, and reports the error. */
export function markerCommands(page: MarkerTools, attempt: (action: () => Promise<string | void>) => void): Command[] {
  const { editor } = page;
  const any = () => editor.selection.size > 0;
  const { snap } = page.pointer;
  const nudges: Command[] = ([['', 0.01, '1 cm'], ['Shift+', 0.1, '10 cm'], ['Alt+', 0.001, '1 mm']] as const).flatMap(([mod, by, words]) =>
    ([['ArrowLeft', -1, 0], ['ArrowRight', 1, 0], ['ArrowUp', 0, 1], ['ArrowDown', 0, -1]] as const).map(([key, x, y]): Command =>
      ({ name: `${mod}${key}`, key: `${mod}${key}`, title: `move by ${words} (with the map in focus)`, onMap: true, run: () => page.actions.nudge(x * by, y * by), possible: any })));
  return [
    { name: 'add', button: 'Add', key: 'N', title: 'new marker at the centre of the view', run: () => page.actions.addAt(page.view.center) },
    { name: 'duplicate', button: 'Duplicate', key: 'Ctrl+D', title: 'duplicate, with the safest free IDs', run: () => page.actions.duplicate(), possible: any },
    { name: 'array', button: 'Array', key: 'A', title: 'copies in rows and columns', run: () => attempt(() => page.actions.array()), possible: any },
    { name: 'move-by', button: 'Move by', key: 'M', title: 'move and rotate the selection by numbers', run: () => attempt(() => page.actions.moveBy()), possible: any },
    { name: 'distribute', key: 'D', title: 'distribute three or more evenly on a line', run: () => page.actions.distribute(), possible: () => editor.selection.size > 2 },
    { name: 'wall', key: 'W', title: 'move the selection straight to a distance from the nearest wall', run: () => attempt(() => page.actions.wall()), possible: any },
    { name: 'pick-id', key: 'I', title: 'another ID, the safest free ones first', run: () => attempt(() => page.actions.pickId()), possible: () => editor.selection.size === 1 },
    { name: 'delete', button: 'Delete', key: 'Delete', title: 'delete', run: () => editor.remove(editor.selection), possible: any },
    { name: 'all', key: 'Ctrl+A', title: 'select all', run: () => editor.select(editor.markers.keys()) },
    { name: 'none', key: 'Escape', everywhere: true, title: 'end measuring or aligning; cancel a drag; clear the selection', run: () => { page.pointer.endPick(); page.pointer.cancel(); editor.select([]); } },
    { name: 'ccw', key: '[', title: 'turn by 1° counter-clockwise', run: () => page.actions.turn(1), possible: any },
    { name: 'cw', key: ']', title: 'turn by 1° clockwise', run: () => page.actions.turn(-1), possible: any },
    { name: 'quarter', key: 'R', title: 'turn by 90°', run: () => page.actions.turn(90), possible: any },
    { name: 'snap', button: 'Snap', key: 'G', title: 'snap to 5 cm and 15° while dragging', run: () => { snap.on = !snap.on; }, pressed: () => snap.on },
    { name: 'fill', key: 'K', title: 'fill the gaps', run: () => attempt(() => page.actions.fill()) },
    ...nudges,
  ];
}
