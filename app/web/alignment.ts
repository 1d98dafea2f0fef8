// Aligns the registry as a whole to the map: least squares over pairs of a marker and its true position, with
// residuals.
import { ask, el, plural } from './dom.js';
import type { Editor } from './editor.js';
import { fitPairs } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { Pointer } from './pointer.js';
import type { Stage } from './stage.js';

interface Pair { marker: Marker; to: Point }

export function alignByPairs(editor: Editor, pointer: Pointer, stage: Stage, say: (words: string) => void): void {
  const pairs: Pair[] = [];
  let open: Marker | null = null;
  const over = () => {
    stage.pins = [];
    stage.redraw();
  };
  say('Align: click a marker, then the place on the map where its dot O truly is. Escape cancels.');
  pointer.beginPick((at, marker) => {
    if (!open) {
      open = marker;
      say(marker ? `Now the position of marker ${marker.id}'s dot O` : 'No marker there; click one');
      return;
    }
    pairs.push({ marker: open, to: at });
    stage.pins.push({ at, label: String(open.id) });
    stage.redraw();
    open = null;
    if (pairs.length < 2) return say('One pair; one more at least: click another marker');
    void propose(editor, pairs).then((answer) => {
      if (answer === 'more') return say(`${plural(pairs.length, 'pair')}; click another marker`);
      pointer.endPick();
      say(answer === 'go' ? 'Aligned; undo restores the previous alignment' : 'Nothing aligned');
    });
  }, over);
}

async function propose(editor: Editor, pairs: Pair[]): Promise<string> {
  const found = fitPairs(pairs.map(({ marker, to }) => ({ from: editor.markers.get(marker.key)!, to })));
  if (!found) return await ask('Align', [el('p', {}, 'These markers are at one position.')], [['more', 'Another pair'], ['', 'Cancel']]);
  const { pose, residualsM } = found;
  const rows = pairs.map(({ marker }, i) => el('li', {}, `marker ${marker.id}: ${(1000 * residualsM[i]!).toFixed(0)} mm residual`));
  const answer = await ask('Align the markers to the map', [
    el('p', {}, `Moved by ${pose.x.toFixed(3)}, ${pose.y.toFixed(3)} m, turned by ${pose.yawDeg.toFixed(2)}°.`),
    el('ul', {}, ...rows)], [['go', 'Align'], ['more', 'Another pair'], ['', 'Cancel']]);
  if (answer === 'go') editor.align(pose);
  return answer;
}
