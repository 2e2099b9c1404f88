// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

/// A step as it can be kept elsewhere: a state, and a small picture of it ("" if there is none).
export interface Step<T> {
  state: T;
  picture: string;
}

/// What was done and can be taken back: whole states, one after the other. What isn't different from
/// what stands there is no step.
export class UndoStack<T> {
  private states: { text: string; picture: string }[] = [];
  private index = -1;

  constructor(private readonly most = 300) {}

  /// A new state; what had been taken back is gone. `picture` is made only for what is a step.
  push(state: T, picture: () => string = () => ""): boolean {
    const text = JSON.stringify(state);
    if (this.index >= 0 && this.states[this.index].text === text) return false;
    this.states.splice(this.index + 1);
    this.states.push({ text, picture: picture() });
    if (this.states.length > this.most) this.states.shift();
    this.index = this.states.length - 1;
    return true;
  }
  undo(): T | null { return this.goTo(this.index - 1); }
  redo(): T | null { return this.goTo(this.index + 1); }
  /// The step of that number, from 0; nothing if there is none.
  goTo(index: number): T | null {
    if (index < 0 || index >= this.states.length) return null;
    this.index = index;
    return this.parsed(index);
  }
  canUndo(): boolean { return this.index > 0; }
  canRedo(): boolean { return this.index + 1 < this.states.length; }
  current(): T | null { return this.index < 0 ? null : this.parsed(this.index); }
  get at(): number { return this.index; }
  get pictures(): string[] { return this.states.map((one) => one.picture); }

  /// The latest `most` steps up to and after where one is.
  steps(most: number): { at: number; steps: Step<T>[] } {
    const from = Math.max(0, Math.min(this.states.length - most, this.index));
    return { at: this.index - from, steps: this.states.slice(from, from + most).map((one) => ({ state: JSON.parse(one.text) as T, picture: one.picture })) };
  }
  restore(steps: Step<T>[], at: number): void {
    this.states = steps.slice(-this.most).map((one) => ({ text: JSON.stringify(one.state), picture: one.picture }));
    this.index = Math.max(-1, Math.min(this.states.length - 1, at - Math.max(0, steps.length - this.most)));
  }

  private parsed(index: number): T {
    return JSON.parse(this.states[index].text) as T;
  }
}
