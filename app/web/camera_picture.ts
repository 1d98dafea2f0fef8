// The camera's picture, with the markers detected in it.
import { el } from './dom.js';
import type { Picture } from './live_socket.js';

export class CameraPicture {
  readonly element = el('canvas', { id: 'camera', role: 'img', 'aria-label': 'Camera picture' });
  readonly words = el('p', { class: 'faint' });
  shown: Picture | null = null;
  private busy = false;

  /** Skips pictures that arrive while another is being decoded. */
  show(picture: Picture): void {
    if (this.busy) return;
    this.busy = true;
    createImageBitmap(picture.jpeg).then((image) => this.draw(picture, image), () => { /* truncated picture */ })
      .finally(() => { this.busy = false; });
  }

  private draw(picture: Picture, image: ImageBitmap): void {
    const canvas = this.element;
    [canvas.width, canvas.height] = [picture.width_px, picture.height_px];
    const c = canvas.getContext('2d')!;
    c.drawImage(image, 0, 0);
    image.close();
    for (const marker of picture.markers) drawMarker(c, marker);
    const ids = picture.markers.map((m) => m.id).join(', ');
    this.words.textContent = ids ? `Sees ${ids}` : 'Sees no marker';
    canvas.setAttribute('aria-label', `Camera picture. ${this.words.textContent}`);
    this.shown = picture;
  }
}

function drawMarker(c: CanvasRenderingContext2D, marker: Picture['markers'][number]): void {
  const pitchPx = Math.hypot(marker.x_px[0] - marker.o_px[0], marker.x_px[1] - marker.o_px[1]) / 3;
  c.lineWidth = 2;
  c.strokeStyle = '#38b6ff';
  for (const [u, v] of marker.dots_px) {
    c.beginPath();
    c.arc(u, v, Math.max(3, 0.42 * pitchPx), 0, 2 * Math.PI);
    c.stroke();
  }
  drawLine(c, marker.o_px, marker.x_px, '#ff5a5a');
  drawLine(c, marker.o_px, marker.y_px, '#62e062');
  c.font = 'bold 20px system-ui, sans-serif';
  const label = `${marker.id}  ${marker.confidence.toFixed(2)}`;
  const x = Math.min(Math.max(4, marker.o_px[0] - 40), c.canvas.width - c.measureText(label).width - 4);
  const y = Math.min(Math.max(20, Math.max(marker.o_px[1], marker.x_px[1], marker.y_px[1]) + 34), c.canvas.height - 6);
  c.strokeStyle = '#000';
  c.lineWidth = 4;
  c.strokeText(label, x, y);
  c.fillStyle = '#ffd84a';
  c.fillText(label, x, y);
}

function drawLine(c: CanvasRenderingContext2D, from: [number, number], to: [number, number], colour: string): void {
  c.strokeStyle = colour;
  c.beginPath();
  c.moveTo(...from); c.lineTo(...to);
  c.stroke();
}
