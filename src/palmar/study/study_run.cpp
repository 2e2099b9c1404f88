// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <span>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/study/study_task.h"

namespace palmar::study {
namespace {

struct HandTasks {
  int hand = 0;
  std::span<const std::int64_t> tasks;
};

std::vector<HandTasks> by_hand(const StudyPlan& plan, const std::vector<std::int64_t>& tasks) {
  if (std::adjacent_find(tasks.begin(), tasks.end(), std::greater_equal<>()) != tasks.end()) {
    throw UsageError("study: tasks to run are not ascending, or one appears twice");
  }
  std::vector<HandTasks> result;
  for (std::size_t begin = 0; begin < tasks.size();) {
    const int hand = task_at(plan, tasks[begin]).hand;
    std::size_t end = begin + 1;
    while (end < tasks.size() && task_at(plan, tasks[end]).hand == hand) ++end;
    result.push_back({hand, std::span(tasks).subspan(begin, end - begin)});
    begin = end;
  }
  return result;
}

/// Counts finished grasps and stops everything at the first exception.
class Ledger {
 public:
  Ledger(std::size_t total, const std::function<void(const StudyRecord&)>& keep,
         const Progress& progress)
      : total_(total), keep_(keep), progress_(progress) {}

  void add(const StudyRecord& record) {
    const std::lock_guard<std::mutex> lock(mutex_);
    keep_(record);
    ++done_;
    if (record.outcome == StudyOutcome::kFailed) ++failed_;
    report();
  }
  void report() {
    if (!progress_.report) return;
    std::string text = fmt::format("{} of {} grasps", done_, total_);
    if (failed_ > 0) text += fmt::format(", {} failed", failed_);
    progress_.report(static_cast<double>(done_) / static_cast<double>(total_), text);
  }

 private:
  std::mutex mutex_;
  std::size_t total_, done_ = 0, failed_ = 0;
  const std::function<void(const StudyRecord&)>& keep_;
  const Progress& progress_;
};

}  // namespace

void run_study(const StudyPlan& plan, const StudyInputs& inputs, const StudyRunOptions& options,
               const std::function<void(const StudyRecord&)>& keep, const Progress& progress) {
  if (options.tasks.empty()) return;
  StudyBench bench(plan, inputs);
  run_study(bench, plan, options, keep, progress);
}

void run_study(StudyBench& bench, const StudyPlan& plan, const StudyRunOptions& options,
               const std::function<void(const StudyRecord&)>& keep, const Progress& progress) {
  if (options.tasks.empty()) return;
  const std::vector<HandTasks> hands = by_hand(plan, options.tasks);
  Ledger ledger(options.tasks.size(), keep, progress);
  ledger.report();

  // What a hand does inside asks only whether to stop; the study says how far it is.
  std::atomic<bool> is_stopping{false};
  std::atomic<std::size_t> next{0};
  Progress quiet = progress;
  quiet.report = nullptr;
  bench.prepare(options.tasks, quiet);
  const int workers = std::min(thread_count(), static_cast<int>(hands.size()));
  // Each worker takes the next hand that nobody has: at most as many hands are prepared at a time
  // as there are threads. Isolated: a thread that waits inside one hand must not begin another.
  parallel_for(workers, [&](int) {
    try {
      for (;;) {
        const std::size_t i = next.fetch_add(1);
        if (i >= hands.size() || is_stopping.load()) return;
        run_isolated([&] {
          bench.run_hand(
              hands[i].hand, hands[i].tasks,
              [&](const StudyRecord& record) {
                ledger.add(record);
                if (is_stopping.load()) throw Cancelled("another hand ended the study");
              },
              quiet);
        });
      }
    } catch (...) {
      if (is_stopping.exchange(true)) return;  // a later one is only its consequence
      throw;
    }
  });
}

}  // namespace palmar::study
