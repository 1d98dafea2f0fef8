// Stop, which is always there while a robot is connected: the button in the head of the page, one in each dialog, and the
// space bar wherever the focus is, but where a space is typed.
import { button, byId } from './dom.js';

const whole = new Set(['number', 'range', 'checkbox', 'radio', 'button', 'submit', 'file', 'color']);

/** Is it a field in which a space may be meant as text? Numbers have none. */
function takesSpaces(target: EventTarget | null): boolean {
  if (target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && !whole.has(target.type) && target.inputMode !== 'decimal';
}

const hasRobot = (): boolean => document.body.dataset['robot'] !== undefined;

/** Before all other listeners, so that no button takes the key for a press of its own. */
export function stopAlways(stop: () => void): void {
  let isOurs = false;  // the press under way: its release must not press the button in focus either
  addEventListener('keydown', (e) => {
    if (e.key === 'Escape') return leaveField(e.target);
    if (!hasRobot() || e.ctrlKey || e.altKey || e.metaKey) return;
    if (e.key === 'Enter' && e.target instanceof HTMLInputElement && e.target.type === 'checkbox') return e.target.click();
    if (e.key !== ' ' || takesSpaces(e.target)) return;
    isOurs = true;
    e.preventDefault();
    e.stopImmediatePropagation();
    if (!e.repeat) stop();
  }, { capture: true });
  addEventListener('keyup', (e) => {
    if (e.key !== ' ' || !isOurs) return;
    isOurs = false;
    e.preventDefault();
    e.stopImmediatePropagation();
  }, { capture: true });
  standInDialogs(stop);
}

/** Escape leaves a field for the map, where the next space stops; a dialog it closes. */
function leaveField(target: EventTarget | null): void {
  if (target instanceof HTMLElement && target.matches('input, select, textarea') && !target.closest('dialog')) byId('stage').focus({ preventScroll: true });
}

/** An open dialog makes the rest of the page inert, also its Stop. */
function standInDialogs(stop: () => void): void {
  const dialog = byId('dialog') as HTMLDialogElement;
  new MutationObserver(() => {
    if (dialog.open && hasRobot() && !dialog.querySelector('.stop')) dialog.append(button('Stop', 'Stop the robot (space bar)', stop, { class: 'stop' }));
  }).observe(dialog, { attributes: true, attributeFilter: ['open'] });
}
