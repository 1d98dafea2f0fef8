// Commands for the page: documents, tools, the view. Those for markers are in marker_commands.ts.
import { alignByPairs } from './alignment.js';
import type { Site } from './api.js';
import type { Command } from './commands.js';
import { exportTo, importFrom, pickFile, printChosen, showHelp } from './dialogs.js';
import type { Documents } from './documents.js';
import type { Floor } from './floor.js';
import { offerPlan } from './installation_plan.js';
import { openLog } from './log_dialog.js';
import { openHistory } from './marker_history.js';
import type { Layers } from './layers.js';
import { markerCommands } from './marker_commands.js';
import type { MarkerTools } from './marker_commands.js';
import type { Stage } from './stage.js';
import { attempt, say } from './words.js';

export interface Page extends MarkerTools {
  readonly floor: Floor;
  readonly site: Site;
  readonly documents: Documents;
  readonly layers: Layers;
  readonly stage: Stage;
  readonly commands: Command[];
  fit(): void;
  turnView(deg: number): void;
  zoom(factor: number): void;
  changeTheme(): void;
}

export function pageCommands(page: Page): Command[] {
  const { editor, layers } = page;
  return [
    { name: 'undo', surveying: true, button: 'Undo', key: 'Ctrl+Z', title: 'undo', run: () => editor.undo(), possible: () => editor.canUndo },
    { name: 'redo', surveying: true, button: 'Redo', key: 'Ctrl+Shift+Z', title: 'redo', run: () => editor.redo(), possible: () => editor.canRedo },
    { name: 'redo2', key: 'Ctrl+Y', title: 'redo', run: () => editor.redo() },
    ...markerCommands(page, attempt),
    { name: 'coverage', everywhere: true, button: 'Coverage', key: 'C', title: 'show the coverage of the markers', run: () => layers.paintFloor(layers.floor === 'coverage' ? 'plain' : 'coverage'), pressed: () => layers.floor === 'coverage' },
    { name: 'measure', everywhere: true, button: 'Measure', key: 'T', title: 'tape measure between two points', run: () => page.measure.toggle(), pressed: () => page.measure.on },
    { name: 'deviation', everywhere: true, key: 'V', title: 'show the expected standard deviation of a fix', run: () => layers.paintFloor(layers.floor === 'deviation' ? 'coverage' : 'deviation') },
    { name: 'turn-view', everywhere: true, key: '.', title: 'turn the view by 15° clockwise', run: () => page.turnView(-15) },
    { name: 'turn-view-back', everywhere: true, key: ',', title: 'turn the view by 15° counter-clockwise', run: () => page.turnView(15) },
    { name: 'north', everywhere: true, key: '0', title: 'reset the rotation of the view', run: () => page.turnView(-page.view.turnDeg) },
    { name: 'zoom-in', everywhere: true, button: '+', key: '+', title: 'zoom in', run: () => page.zoom(1.5) },
    { name: 'zoom-out', everywhere: true, button: '−', key: '-', title: 'zoom out', run: () => page.zoom(1 / 1.5) },
    { name: 'fit', everywhere: true, button: 'Fit', key: 'F', title: 'show the whole map', run: () => page.fit() },
    { name: 'align', button: 'Align', title: 'align all markers to the map by pairs of points', run: () => alignByPairs(editor, page.pointer, page.stage, say) },
    { name: 'import', button: 'Import', title: 'read markers of another format', run: () => pickFile((file) => attempt(() => importFrom(editor, file))) },
    { name: 'export', button: 'Export', title: 'write markers in another format', run: () => attempt(() => exportTo(editor, page.site.formats)) },
    { name: 'print', button: 'Print', key: 'Ctrl+P', title: 'print sheets of the selected markers', run: () => attempt(() => printChosen(editor)) },
    { name: 'plan', button: 'Plan', title: 'where to hang the markers, with distances to the walls', run: () => attempt(() => offerPlan(editor, page.floor, page.site.name)) },
    { name: 'history', button: 'History', title: 'restore an earlier version', run: () => attempt(() => openHistory(editor, page.floor)) },
    { name: 'reload', button: 'Reload', title: 'reload the markers; unsaved changes are lost', run: () => attempt(() => page.documents.reload()) },
    { name: 'save', surveying: true, button: 'Save', key: 'Ctrl+S', title: 'save', run: () => attempt(() => page.documents.save()), possible: () => editor.dirty },
    { name: 'log', everywhere: true, mapless: true, button: 'Log', title: 'who drove and who saved', run: () => attempt(() => openLog()) },
    { name: 'theme', everywhere: true, mapless: true, button: 'Light/dark', title: 'light or dark', run: () => page.changeTheme() },
    { name: 'help', everywhere: true, mapless: true, button: 'Help', key: '?', title: 'this help', run: () => attempt(() => showHelp(page.commands)) },
  ];
}
