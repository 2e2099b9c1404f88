// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study_estimate.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "palmar/study/study_task.h"

namespace palmar::workflow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostSampled = 24;  // grasps of the sample; some seconds

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// MB that the process holds now.
double resident_memory() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// MB that it held at most.
double largest_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

}  // namespace

double StudyEstimate::seconds(std::int64_t hands, int threads) const {
  const std::int64_t rounds = (hands + threads - 1) / threads;
  return seconds_once + static_cast<double>(rounds) * seconds_per_hand;
}

double StudyEstimate::memory(int threads) const {
  return memory_once + threads * memory_per_thread;
}

StudyEstimate estimate_study(const records::LoadedStudy& study, const Progress& progress) {
  const study::StudyPlan& plan = study.plan;
  const std::vector<std::int64_t> all = study::tasks_of(plan);
  const std::size_t per_hand = all.size() / plan.hands.size();
  std::vector<std::int64_t> tasks(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(per_hand));
  StudyEstimate estimate;
  estimate.sample = static_cast<int>(std::min(per_hand, kMostSampled));
  tasks.resize(static_cast<std::size_t>(estimate.sample));

  const auto start = Clock::now();
  progress.update(0.1, "measuring a few grasps");
  study::StudyInputs inputs = study.inputs;
  inputs.compliance = tissue_on_bone(*inputs.base, plan);
  study::StudyBench bench(plan, inputs);
  bench.prepare(tasks, progress);
  estimate.seconds_once = seconds_since(start);
  estimate.memory_once = resident_memory();
  const auto grasps = Clock::now();
  int done = 0;
  bench.run_hand(
      0, tasks,
      [&](const study::StudyRecord&) {
        progress.update(0.1 + 0.9 * ++done / estimate.sample, "measuring a few grasps");
      },
      progress);
  // Hand and grasps: what one hand costs once is in the sample once.
  estimate.seconds_per_hand =
      seconds_since(grasps) * static_cast<double>(per_hand) / static_cast<double>(estimate.sample);
  estimate.memory_per_thread = std::max(20.0, largest_memory() - estimate.memory_once);
  // Places of products that the sample left out.
  estimate.seconds_once *= static_cast<double>(per_hand) / static_cast<double>(estimate.sample);
  return estimate;
}

}  // namespace palmar::workflow
