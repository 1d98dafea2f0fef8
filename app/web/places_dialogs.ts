// Questions about places and zones.
import { changeList } from './dialogs.js';
import { ask, el } from './dom.js';
import type { PlacesDocument } from './places_doc.js';
import { bothChanged, placesDifferences } from './places_merge.js';

/** 'merge', 'theirs', 'mine', or nothing. Shows what each side changed, item by item. */
export function askAboutPlaces(base: PlacesDocument, mine: PlacesDocument, theirs: PlacesDocument): Promise<string> {
  const both = bothChanged(base, mine, theirs);
  return ask('Another user saved first', [el('p', {}, 'They changed:'), ...changeList(placesDifferences(base, theirs)), el('p', {}, 'You changed:'), ...changeList(placesDifferences(base, mine)),
    el('p', both.length > 0 ? { class: 'error' } : {}, both.length > 0 ? `Changed by both, a merge takes yours: ${both.join(', ')}.` : 'Nothing was changed by both.')],
  [['merge', 'Merge and save'], ['theirs', 'Take theirs'], ['mine', 'Overwrite theirs'], ['', 'Cancel']]);
}

/** Who closes the question has not said to throw them away. */
export async function offerPlacesDraft(saved: PlacesDocument, left: PlacesDocument, sinceWhen: string): Promise<boolean> {
  return await ask('Places that were not saved', [el('p', {}, `This browser kept changes of ${sinceWhen}.`), ...changeList(placesDifferences(saved, left))],
    [['go', 'Bring them back'], ['no', 'Throw them away']]) !== 'no';
}
