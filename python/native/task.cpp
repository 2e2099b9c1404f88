// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "task.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace palmar::python {
namespace {

constexpr std::chrono::milliseconds kListening{100};

/// What the work says, until Python hears it.
struct News {
  bool has_progress = false;
  double share = 0.0;
  std::string activity;
  std::vector<std::string> notes;
};

bool is_there(const py::object& listener) { return listener && !listener.is_none(); }

void tell(const Listeners& listeners, const News& news) {
  if (is_there(listeners.note)) {
    for (const std::string& text : news.notes) listeners.note(text);
  }
  if (is_there(listeners.progress) && news.has_progress)
    listeners.progress(news.share, news.activity);
}

}  // namespace

void run_watched(const Listeners& listeners,
                 const std::function<void(const Progress&, const workflow::NoteSink&)>& work) {
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  News news;
  std::exception_ptr failure;
  std::atomic<bool> cancel{false};

  Progress progress;
  progress.cancel = &cancel;
  progress.report = [&](double share, const std::string& activity) {
    const std::scoped_lock lock(mutex);
    news.has_progress = true;
    news.share = std::max(news.share, share);  // a part doesn't know where the whole stands
    news.activity = activity;
  };
  const workflow::NoteSink note = [&](const std::string& text) {
    const std::scoped_lock lock(mutex);
    news.notes.push_back(text);
  };

  std::optional<py::error_already_set> interruption;
  const py::gil_scoped_release without_python;
  std::thread worker([&] {
    try {
      work(progress, note);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex);
    is_done = true;
    ended.notify_one();
  });
  std::unique_lock lock(mutex);
  while (true) {
    ended.wait_for(lock, kListening, [&] { return is_done; });
    const bool is_last = is_done;
    News heard = news;
    news.has_progress = false;
    news.notes.clear();
    lock.unlock();
    if (!interruption) {
      const py::gil_scoped_acquire with_python;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        tell(listeners, heard);
      } catch (py::error_already_set& error) {
        interruption.emplace(error);
        cancel = true;
      }
    }
    if (is_last) break;
    lock.lock();
  }
  worker.join();
  if (interruption) {
    const py::gil_scoped_acquire with_python;
    py::error_already_set error = *std::exchange(interruption, std::nullopt);
    throw error;
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace palmar::python
