// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

std::unique_ptr<tbb::global_control>& thread_limit() {
  static std::unique_ptr<tbb::global_control> limit;
  return limit;
}

}  // namespace

void parallel_for(int count, const std::function<void(int)>& body) {
  if (count == 1) return body(0);  // most of a grasp's queries; nothing to hand out
  std::mutex mutex;
  std::exception_ptr first;
  int first_index = count;
  tbb::parallel_for(0, count, [&](int i) {
    try {
      body(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (i < first_index) {
        first_index = i;
        first = std::current_exception();
      }
    }
  });
  if (first) std::rethrow_exception(first);
}

void run_isolated(const std::function<void()>& body) { tbb::this_task_arena::isolate(body); }

void set_thread_count(int count) {
  if (count < 0) {
    throw UsageError("number of threads is " + std::to_string(count) +
                     "; 0 (all cores) or more is allowed");
  }
  thread_limit().reset();
  if (count > 0) {
    thread_limit() = std::make_unique<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  }
}

int thread_count() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace palmar
