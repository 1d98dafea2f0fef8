// The tools by which a person draws on a map.
import { button, el } from './dom.js';
import type { MapPaint } from './map_paint.js';
import { valueNamed } from './new_stage.js';
import type { NewStage, Tool } from './new_stage.js';

export class MapTools {
  readonly element = el('div', { class: 'row', role: 'toolbar', 'aria-label': 'Draw on the map' });

  constructor(private readonly stage: NewStage, private readonly paint: () => MapPaint | null) {
    const tool = (text: string, title: string, name: Tool, cell: string) =>
      button(text, title, () => this.pick(name, cell), { id: `map-tool-${name}-${cell}`, 'aria-pressed': 'false' });
    this.element.append(tool('Wall', 'Draw walls, one cell wide', 'line', 'wall'), tool('Erase', 'Floor, three cells wide', 'line', 'floor'),
      tool('Block', 'A rectangle of wall: furniture, a shaft', 'rectangle', 'wall'), tool('Clear', 'A rectangle of floor', 'rectangle', 'floor'),
      tool('Fill floor', 'All that hangs together becomes floor', 'fill', 'floor'), tool('Fill outside', 'All that hangs together is outside: no robot drives there', 'fill', 'outside'),
      button('Undo', 'Undo (Ctrl+Z)', () => this.paint()?.undo(), { id: 'map-undo' }), button('Redo', 'Redo (Ctrl+Shift+Z)', () => this.paint()?.redo(), { id: 'map-redo' }));
  }

  pick(tool: Tool, cell: string): void {
    [this.stage.tool, this.stage.value] = [tool, valueNamed(cell)];
    for (const one of this.element.querySelectorAll('[aria-pressed]')) one.setAttribute('aria-pressed', String(one.id === `map-tool-${tool}-${cell}`));
  }

  /** Undo and redo by the keyboard; true when the key was one of them. */
  key(e: KeyboardEvent): boolean {
    if (!(e.ctrlKey || e.metaKey) || e.key.toLowerCase() !== 'z' || e.target instanceof HTMLInputElement) return false;
    e.preventDefault();
    if (e.shiftKey) this.paint()?.redo();
    else this.paint()?.undo();
    return true;
  }
}
