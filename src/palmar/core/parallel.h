// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace palmar {

/// Runs body(i) for i in [0, count) on the threads allowed by set_thread_count(). Bodies must write
/// to separate places; then results don't depend on the number of threads. An exception of the
/// smallest index wins and is rethrown.
void parallel_for(int count, const std::function<void(int)>& body);

/// Runs `body`; a thread that waits for a parallel_for() in it only takes up work of that body
/// meanwhile, so no second large piece of work begins on top of the first.
void run_isolated(const std::function<void()>& body);

/// Largest number of threads that parallel_for() uses from now on; 0 = all cores. Throws UsageError
/// below 0.
void set_thread_count(int count);

/// Threads that parallel_for() uses at most.
int thread_count();

}  // namespace palmar
