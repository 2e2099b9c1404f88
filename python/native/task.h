// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

#include "palmar/core/progress.h"
#include "palmar/workflow/note/note.h"

namespace palmar::python {

namespace py = pybind11;

/// Who listens to a task: callables, null or None.
struct Listeners {
  py::object progress;  ///< of (share, activity)
  py::object note;      ///< of (text)
};

/// Runs `work` on a thread of its own without Python's lock, while this one listens for Ctrl-C and
/// calls the listeners, some ten times a second. Ctrl-C, or an exception of a listener, asks the
/// work to stop; once it has, that exception goes on. Else what `work` throws.
void run_watched(const Listeners& listeners,
                 const std::function<void(const Progress&, const workflow::NoteSink&)>& work);

/// The same with a result: `work` is called with Progress and NoteSink.
template <typename Work>
auto run_task(const Listeners& listeners, const Work& work) {
  std::optional<decltype(work(Progress{}, workflow::NoteSink{}))> result;
  run_watched(listeners, [&](const Progress& progress, const workflow::NoteSink& note) {
    result.emplace(work(progress, note));
  });
  return std::move(*result);
}

}  // namespace palmar::python
