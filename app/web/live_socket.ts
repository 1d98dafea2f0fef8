// The connection to the robot, `lodestar.v1`: reconnects by itself, and reports when it is lost.
import type { Survey } from './survey.js';

export interface Estimate {
  x_m: number; y_m: number; yaw_deg: number;
  covariance_m2: [number, number, number];  // xx, xy, yy
  sigma_yaw_deg: number;
}

export interface Velocity { forward_mps: number; turn_degps: number }

export interface State {
  time_s: number; pose: Estimate | null; commanded: Velocity; measured: Velocity | null;
  phase: string; moving: boolean; paused: boolean; goals: number[][]; current: number;
  stop: string | null; field: { state: 'free' | 'slowed' | 'stopped'; why: string | null } | null; base: string; base_ready: boolean; fault: string | null; battery_v: number | null; charging: string;
  markers: number[]; confidence: number; seen_s: number | null; distrusted: number[];
  error_m: number | null; events: { number: number; time_s: number; words: string }[];
  driver: number | null; driver_name: string; viewers: number;
}

export interface Hello { client: number; role: 'view' | 'edit' | 'drive'; robot: boolean; session: number; survey: boolean; dock: string; lease_s: number }

export interface Preview {
  points?: [number, number][]; length_m?: number; time_s?: number; turns?: number;
  why?: string; goal?: number; nearest?: [number, number] | null;
}

/** By the scanner: lists of x, y, x, y, ... in the map; cells along axes turned by cell_yaw_deg. */
export interface Seen {
  mapped: number[]; standing: number[]; person: number[]; hidden: number[];
  cells_standing: number[]; cells_moving: number[]; cell_m?: number; cell_yaw_deg?: number;
}

export interface SeenMarker { id: number; confidence: number; o_px: [number, number]; x_px: [number, number]; y_px: [number, number]; dots_px: [number, number][] }
export interface Picture { time_s: number; width_px: number; height_px: number; markers: SeenMarker[]; jpeg: Blob }

type Message = ({ type: 'hello' } & Hello) | ({ type: 'state' } & State) | { type: 'path'; points: [number, number][] }
  | ({ type: 'seen' } & Seen) | { type: 'asked'; client: number; name: string } | { type: 'control' } | { type: 'saved'; what: 'markers' | 'places' }
  | ({ type: 'preview' } & Preview) | ({ type: 'survey' } & Survey) | { type: 'refused'; what: string; why: string };

export interface Listener {
  onHello(hello: Hello): void;
  onState(state: State): void;
  onPath(points: [number, number][]): void;
  onPreview(preview: Preview): void;
  onSurvey(survey: Survey): void;
  onSeen(seen: Seen): void;
  onAsked(client: number, name: string): void;
  onControl(): void;
  onSaved(what: 'markers' | 'places'): void;
  onRefused(what: string, why: string): void;
  onPicture(picture: Picture): void;
  onGone(): void;
}

const againAfterMs = 1000;

export class LiveSocket {
  private socket: WebSocket | null = null;

  constructor(private readonly listener: Listener) { this.connect(); }

  /** False without a connection. */
  send(message: Record<string, unknown>): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/api/socket`, 'lodestar.v1');
    socket.binaryType = 'arraybuffer';
    socket.onmessage = (e: MessageEvent<string | ArrayBuffer>) => this.take(e.data);
    socket.onclose = () => {
      this.socket = null;
      this.listener.onGone();
      setTimeout(() => this.connect(), againAfterMs);
    };
    this.socket = socket;
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data !== 'string') return this.listener.onPicture(pictureOf(data));
    const message = JSON.parse(data) as Message;
    switch (message.type) {
      case 'hello': return this.listener.onHello(message);
      case 'state': return this.listener.onState(message);
      case 'path': return this.listener.onPath(message.points);
      case 'preview': return this.listener.onPreview(message);
      case 'survey': return this.listener.onSurvey(message);
      case 'seen': return this.listener.onSeen(message);
      case 'asked': return this.listener.onAsked(message.client, message.name);
      case 'control': return this.listener.onControl();
      case 'saved': return this.listener.onSaved(message.what);
      case 'refused': return this.listener.onRefused(message.what, message.why);
    }
  }
}

/** Parses the length of the JSON header, the header, and a JPEG. */
function pictureOf(data: ArrayBuffer): Picture {
  const length = new DataView(data).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length))) as Omit<Picture, 'jpeg'>;
  return { ...head, jpeg: new Blob([new Uint8Array(data, 4 + length)], { type: 'image/jpeg' }) };
}
