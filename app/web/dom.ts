// Building pieces of the page. Text only ever becomes text.

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

export const plural = (count: number, word: string): string => `${count} ${word}${count === 1 ? '' : 's'}`;

/** A dialog with a head, contents and buttons; resolves with the name of the button, or '' when it is left. */
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
