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

/** A dialog with a head, contents and buttons; resolves with the name of the button, or '' when it is cancelled. Enter in a
 *  field is the first button. `wrong`: what keeps it from being pressed, if anything. */
export function ask(head: string, contents: Child[], answers: [string, string][], wrong: () => string = () => ''): Promise<string> {
  const dialog = byId('dialog') as HTMLDialogElement;
  const reason = el('p', { class: 'error', id: 'dialog-reason', role: 'alert' });
  const row = el('div', { class: 'row' }, ...answers.map(([name, text], i) =>
    i === 0 ? el('button', { type: 'submit', title: text, class: 'main' }, text) : button(text, text, () => dialog.close(name))));
  const form = el('form', {}, el('h3', { id: 'dialog-head' }, head), ...contents, reason, row);
  form.noValidate = true;
  form.addEventListener('submit', (e) => {
    e.preventDefault();
    reason.textContent = wrong();
    if (reason.textContent === '') dialog.close(answers[0]![0]);
  });
  dialog.replaceChildren(form);
  dialog.setAttribute('aria-labelledby', 'dialog-head');
  dialog.returnValue = '';
  dialog.showModal();
  dialog.scrollTop = 0;
  return new Promise((resolve) => {
    dialog.addEventListener('close', () => resolve(dialog.returnValue), { once: true });
  });
}

export interface NumberField { name: string; label: string; value: number; step: number; least?: number; most?: number }

const farthest = 1e5;

/** A dialog with numbers to fill in, which stays open until all of them are usable; null when it is cancelled. */
export async function askNumbers(head: string, fields: NumberField[], words: string, go: string): Promise<Record<string, number> | null> {
  const inputs = fields.map((field) =>
    ({ field, input: el('input', { type: 'number', id: `ask-${field.name}`, step: String(field.step), value: String(field.value) }) }));
  const grid = el('div', { class: 'fields wide' }, ...inputs.flatMap(({ field, input }) => [el('label', { for: input.id }, field.label), input]));
  const isUsable = ({ field, input }: typeof inputs[number]) => Number.isFinite(input.valueAsNumber) && Math.abs(input.valueAsNumber) <= farthest &&
    input.valueAsNumber >= (field.least ?? -Infinity) && input.valueAsNumber <= (field.most ?? Infinity);
  const wrong = () => {
    for (const one of inputs) one.input.setAttribute('aria-invalid', String(!isUsable(one)));
    const first = inputs.find((one) => !isUsable(one));
    first?.input.focus();
    return first ? `${first.field.label}: wanted a number${first.field.least === undefined ? '' : ` from ${first.field.least} to ${first.field.most}`}` : '';
  };
  if (await ask(head, [el('p', {}, words), grid], [['go', go], ['', 'Cancel']], wrong) !== 'go') return null;
  return Object.fromEntries(inputs.map(({ field, input }) => [field.name, input.valueAsNumber]));
}
