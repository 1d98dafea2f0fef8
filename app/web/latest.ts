// Debounced work that follows edits: at most once every afterMs milliseconds, one run at a time, and always
// once more after the last change.
export class Latest {
  private timer = 0;
  private busy = false;
  private again = false;

  constructor(private readonly afterMs: number, private readonly work: () => Promise<void>, private readonly fail: (error: unknown) => void) {}

  want(): void {
    if (this.busy) this.again = true;
    else if (this.timer === 0) this.timer = setTimeout(() => void this.run(), this.afterMs);
  }

  private async run(): Promise<void> {
    this.timer = 0;
    this.busy = true;
    await this.work().catch(this.fail);
    this.busy = false;
    if (!this.again) return;
    this.again = false;
    this.want();
  }
}
