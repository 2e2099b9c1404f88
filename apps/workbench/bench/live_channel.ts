// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The live channel: requests with numbers, answers to the latest alone.

import { LiveRequest } from "./bench_state";
import { decodeFrame, Frame } from "./live_frame";
import { MoveQueue } from "./move_queue";

export interface Answer {
  say: "opened" | "progress" | "result" | "error" | "dropped";
  request: number;
  [more: string]: unknown;
}

export interface ChannelEvents {
  frame(frame: Frame): void;
  answer(answer: Answer): void;
  /// The connection is there (again), or lost.
  connected(isConnected: boolean): void;
}

const kRetryMs = 1500;
const kMostMeasured = 2000;

/// Keeps how long something took among the browser's own measures.
export function measured(name: string, start: number): void {
  if (performance.getEntriesByName(name).length >= kMostMeasured) performance.clearMeasures(name);
  performance.measure(name, { start, end: performance.now() });
}

export class LiveChannel {
  private socket: WebSocket | null = null;
  private last = 0;
  private latest = 0; // request whose answers count, but for motions
  private isClosed = false;
  readonly moves = new MoveQueue((request) => {
    const at = performance.now();
    const id = this.send(request);
    this.moveSent = { id, at };
    return id;
  });
  private moveSent = { id: 0, at: 0 };

  constructor(private readonly url: string, private readonly events: ChannelEvents) {
    this.connect();
  }

  private connect(): void {
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => this.events.connected(true);
    socket.onmessage = (message) => this.take(message.data as string | ArrayBuffer);
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = null;
      this.moves.reset();
      if (this.isClosed) return;
      this.events.connected(false);
      setTimeout(() => { if (!this.isClosed && !this.socket) this.connect(); }, kRetryMs);
    };
  }

  close(): void {
    this.isClosed = true;
    this.socket?.close();
  }

  private send(request: LiveRequest): number {
    const id = ++this.last;
    if (this.socket?.readyState === WebSocket.OPEN) {
      this.socket.send(JSON.stringify({ ...request, id }));
    }
    return id;
  }

  /// Asks for something that takes its time; answers to what was asked before don't count any more.
  ask(request: LiveRequest): number {
    this.moves.reset();
    this.latest = this.send(request);
    return this.latest;
  }

  move(request: LiveRequest): void {
    this.moves.move(request);
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data === "string") {
      const answer = JSON.parse(data) as Answer;
      if (answer.say === "dropped") {
        this.moves.answered(answer.request);
        return;
      }
      if (answer.say === "error") this.moves.answered(answer.request);
      if (answer.request === this.latest || answer.request === 0) this.events.answer(answer);
      return;
    }
    const frame = decodeFrame(data);
    if (frame.kind === "moving") {
      this.events.frame(frame);
      if (frame.request === this.moveSent.id) measured("palmar-round-trip", this.moveSent.at);
      this.moves.answered(frame.request);
    } else if (frame.request === this.latest) {
      this.events.frame(frame);
    }
  }
}
