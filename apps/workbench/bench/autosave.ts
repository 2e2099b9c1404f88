// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Keeps what stands on the bench with the server, by itself: the newest state is on its way or waits.
import { Api } from "./api";
import { BenchState } from "./bench_state";
import { History, keptText } from "./kept_steps";

export class Autosave {
  private isSending = false;
  private waiting: string | null = null;
  private lastProblem = "";

  /// `told`: "" when it is kept, else what went wrong.
  constructor(private readonly api: Api, readonly key: string, private readonly told: (problem: string) => void) {}

  keep(state: BenchState, history: History): void {
    this.waiting = keptText(state, history);
    if (!this.isSending) void this.send();
  }

  private async send(): Promise<void> {
    this.isSending = true;
    while (this.waiting !== null) {
      const content = this.waiting;
      this.waiting = null;
      let problem = "";
      try {
        await this.api.keepProject(this.key, content);
      } catch (error) {
        problem = error instanceof Error ? error.message : String(error);
      }
      if (problem !== this.lastProblem || problem === "") this.told(problem);
      this.lastProblem = problem;
    }
    this.isSending = false;
  }
}
