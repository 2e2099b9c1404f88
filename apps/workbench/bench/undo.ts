// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

/// What was done and can be taken back: whole states, one after the other. What isn't different from
/// what stands there is no step.
export class UndoStack<T> {
  private states: string[] = [];
  private at = -1;

  constructor(private readonly most = 300) {}

  /// A new state; what had been taken back is gone.
  push(state: T): boolean {
    const text = JSON.stringify(state);
    if (this.at >= 0 && this.states[this.at] === text) return false;
    this.states.splice(this.at + 1);
    this.states.push(text);
    if (this.states.length > this.most) this.states.shift();
    this.at = this.states.length - 1;
    return true;
  }
  undo(): T | null {
    return this.canUndo() ? this.parsed(--this.at) : null;
  }
  redo(): T | null {
    return this.canRedo() ? this.parsed(++this.at) : null;
  }
  canUndo(): boolean { return this.at > 0; }
  canRedo(): boolean { return this.at + 1 < this.states.length; }
  current(): T | null { return this.at < 0 ? null : this.parsed(this.at); }
  clear(): void {
    this.states = [];
    this.at = -1;
  }

  private parsed(index: number): T {
    return JSON.parse(this.states[index]) as T;
  }
}
