// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
import { Job } from "./api";
import { say } from "./say";

/// "3 min", "40 s", "2 h".
export function durationText(seconds: number): string {
  if (seconds < 60) return say("time.seconds", { count: Math.max(1, Math.round(seconds)) });
  if (seconds < 5400) return say("time.minutes", { count: Math.round(seconds / 60) });
  return say("time.hours", { count: Math.round(seconds / 3600) });
}

export function jobStateWords(job: Job): string {
  return job.state === "running" ? say("job.state.running", { percent: Math.floor(100 * job.share) }) : say(`job.state.${job.state}`);
}

/// What becomes of it, in a sentence.
export function jobSentence(job: Job): string {
  if (job.state === "new" && job.estimate_seconds !== null) {
    return say("job.estimate", { grasps: job.grasps, time: durationText(job.estimate_seconds) });
  }
  if (job.state === "failed") return say("bench.failed", { message: job.message });
  if (job.state === "running") return say("job.running", { percent: Math.floor(100 * job.share), doing: job.doing });
  if (job.state === "stopped") return say(job.kind === "study" ? "job.stopped_study" : "job.stopped");
  if (job.kind === "redesign" && (job.state === "estimating" || job.state === "new")) return say(`job.says.${job.state}_redesign`);
  if (job.kind === "hand" && job.state === "done") return say("job.says.done_hand");
  return say(`job.says.${job.state}`);
}
