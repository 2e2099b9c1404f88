// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
import { LiveRequest } from "./bench_state";

/// Of motions one is on its way at a time; when it has come, the newest that was wanted meanwhile goes.
export class MoveQueue {
  private inFlight = 0;
  private wanted: LiveRequest | null = null;

  /// `send` gives the number under which a request went.
  constructor(private readonly send: (request: LiveRequest) => number) {}

  move(request: LiveRequest): void {
    if (this.inFlight !== 0) this.wanted = request;
    else this.inFlight = this.send(request);
  }
  /// An answer to that request, a frame or a word that it was dropped, has come.
  answered(request: number): void {
    if (request !== this.inFlight) return;
    this.inFlight = 0;
    const next = this.wanted;
    this.wanted = null;
    if (next) this.inFlight = this.send(next);
  }
  /// Something else was asked for: what was wanted is stale.
  reset(): void {
    this.inFlight = 0;
    this.wanted = null;
  }
}
