// Builds elements of the page. Text is only ever inserted as text, never as HTML.

type Child = Node | string;

export function el<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {},
  ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export function button(text: string, title: string, action: () => void, attributes: Record<string, string> = {}): HTMLButtonElement {
  const made = el('button', { type: 'button', title, ...attributes }, text);
  made.addEventListener('click', action);
  return made;
}

export const byId = (id: string): HTMLElement => document.getElementById(id)!;

/** No minus before zero. */
export const positive = (text: string): string => text.replace(/^-(0(\.0*)?)$/, '$1');

export const plural = (count: number, word: string): string => `${count} ${word}${count === 1 ? '' : 's'}`;

/** A dialog with a head, contents and buttons; resolves with the name of the button, or '' when it is cancelled. */
export function ask(head: string, contents: Child[], answers: [string, string][]): Promise<string> {
  const dialog = byId('dialog') as HTMLDialogElement;
  const row = el('div', { class: 'row' }, ...answers.map(([name, text], i) =>
    button(text, text, () => dialog.close(name), i === 0 ? { class: 'main' } : {})));
  dialog.replaceChildren(el('h3', { id: 'dialog-head' }, head), ...contents, row);
  dialog.setAttribute('aria-labelledby', 'dialog-head');
  dialog.returnValue = '';
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener('close', () => resolve(dialog.returnValue), { once: true });
  });
}

export interface NumberField { name: string; label: string; value: number; step: number; least?: number; most?: number }

/** A dialog with numbers to fill in; null when it is cancelled. Throws for an unusable number. */
export async function askNumbers(head: string, fields: NumberField[], words: string, go: string): Promise<Record<string, number> | null> {
  const inputs = fields.map((field) => {
    const input = el('input', { type: 'number', id: `ask-${field.name}`, step: String(field.step), value: String(field.value) });
    input.addEventListener('keydown', (e) => { if (e.key === 'Enter') (byId('dialog') as HTMLDialogElement).close('go'); });
    return { field, input };
  });
  const grid = el('div', { class: 'fields wide' }, ...inputs.flatMap(({ field, input }) => [el('label', { for: input.id }, field.label), input]));
  if (await ask(head, [el('p', {}, words), grid], [['go', go], ['', 'Cancel']]) !== 'go') return null;
  const usable = ({ field, input }: typeof inputs[number]) => Number.isFinite(input.valueAsNumber) && Math.abs(input.valueAsNumber) <= 1e5 &&
    input.valueAsNumber >= (field.least ?? -Infinity) && input.valueAsNumber <= (field.most ?? Infinity);
  const wrong = inputs.find((i) => !usable(i));
  if (wrong) throw new Error(`${wrong.field.label}: found '${wrong.input.value}', wanted a number${wrong.field.least === undefined ? '' : ` in ${wrong.field.least}..${wrong.field.most}`}`);
  return Object.fromEntries(inputs.map(({ field, input }) => [field.name, input.valueAsNumber]));
}
