// Links to a moment of a run: #run=NAME&at=SECONDS&beside=NAME.

export interface RunLink { run: string; at: number | null; beside: string | null }

export function linkIn(hash: string): RunLink | null {
  const parts = new URLSearchParams(hash.replace(/^#/, ''));
  const run = parts.get('run');
  if (run === null || run === '') return null;
  const at = Number(parts.get('at') ?? NaN);
  return { run, at: Number.isFinite(at) ? at : null, beside: parts.get('beside') };
}

/** Shows the link in the address bar; null takes it away. Going back in the browser's history leaves the page as before. */
export function linkTo(link: RunLink | null): void {
  const parts = new URLSearchParams();
  if (link) parts.set('run', link.run);
  if (link && link.at !== null) parts.set('at', link.at.toFixed(2));
  if (link && link.beside !== null) parts.set('beside', link.beside);
  const text = parts.toString();
  history.replaceState(null, '', location.pathname + (text === '' ? '' : `#${text}`));
}
