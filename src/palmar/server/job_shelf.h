// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "palmar/server/job_request.h"
#include "palmar/server/product_shelf.h"

namespace palmar::server {

/// kNew: how long it takes is known or not, it wasn't started; kWaiting: for another one to end.
enum class JobState { kEstimating, kNew, kWaiting, kRunning, kStopped, kFailed, kDone };
std::string_view name_of(JobState state);  ///< "estimating", "new", ...

/// A study, comparison, redesign or person's hand, as it stands.
struct Job {
  std::string key;
  std::string title;  ///< "old and new"
  JobRequest request;
  std::vector<ShelvedProduct> products;  ///< with its own copies of their files
  std::int64_t created = 0;              ///< ms since 1970
  JobState state = JobState::kNew;
  std::string message;                     ///< what went wrong
  std::optional<double> estimate_seconds;  ///< of a study on this machine
  std::int64_t grasps = 0;                 ///< of a study; 0: not known yet
  double share = 0.0;                      ///< while it runs
  std::string doing;
  std::vector<std::string> commands;  ///< that do the same, as people type them
  bool has_report = false;
  bool has_preview = false;  ///< of a redesign: its shape, to be looked at before it is started
  bool has_hand = false;     ///< of a person's hand: it can be used
};

/// Heavy jobs: one runs at a time, in a child process of low priority (`palmar study run` and the
/// like), so that the live channel goes on; the others wait. Each has a folder of the user's,
/// FOLDER/KEY, with `job.json`, copies of its products, what its commands write and their log.
/// What was finished stays whatever ends: a study goes on with start() where it was stopped; others
/// begin anew. Thread-safe.
class JobShelf {
 public:
  /// Jobs that were running when another server ended are stopped ones. `program` is this one's
  /// executable. No folder: nothing can be added.
  JobShelf(std::optional<std::filesystem::path> folder, std::filesystem::path program);
  JobShelf(const JobShelf&) = delete;
  JobShelf& operator=(const JobShelf&) = delete;
  ~JobShelf();  ///< stops what runs

  /// At most this many are kept; then one has to be removed.
  static constexpr std::size_t kMost = 100;

  /// What is tried first (is_tried_first()) is, and waits for start(); others start. `products` in
  /// the order of the request; `sources`: folder with the files of a person's hand, which become
  /// the job's. Throws UsageError, OutputError, InputError.
  Job add(const JobRequest& request, const std::vector<ShelvedProduct>& products,
          const std::filesystem::path& sources = {});
  /// A person's hand again, from the same files with other settings or corrections. Throws
  /// UsageError, also while it runs.
  void revise(const std::string& key, const JobRequest& request);
  std::vector<Job> list() const;  ///< the newest first
  std::optional<Job> find(const std::string& key) const;
  /// Starts, or goes on with, what doesn't run. Throws UsageError for an unknown key.
  void start(const std::string& key);
  void cancel(const std::string& key);
  /// With all its files; not while it runs. Throws UsageError.
  void remove(const std::string& key);

  /// Names of the files for other programs, and where one of them, or the report, is. Nothing for a
  /// name that isn't among them.
  std::vector<std::string> files(const Job& job) const;
  std::optional<std::filesystem::path> file(const Job& job, const std::string& name) const;
  std::filesystem::path report(const Job& job) const;
  std::filesystem::path store(const Job& job) const;  ///< of a study
  /// What can be looked at: files of a preview, and of what was found of a hand, as paths in the
  /// job's folder with '/'; and where one of them is.
  std::vector<std::string> made(const Job& job) const;
  std::optional<std::filesystem::path> made_file(const Job& job, const std::string& name) const;
  /// The *.hand.glb that job `key` made; nothing if there is none.
  std::optional<std::filesystem::path> hand_file(const std::string& key) const;

 private:
  void load();
  void run();
  void work(const std::string& key);
  void estimate(const Job& job);
  /// The words of its error; empty if it went well.
  std::string run_command(const std::string& key, const JobCommand& command, double from,
                          std::string* said);
  Job* at(const std::string& key);
  void look(Job& job) const;  ///< what is there of it
  void change(const std::string& key, JobState state, const std::string& message = {});
  void save(const Job& job) const;
  void remove_place(const std::string& key) const;
  std::filesystem::path hand_place(const Job& job) const;
  /// What was sent for a hand becomes the job's; of a file that says what is known of the person,
  /// its content.
  void take_sources(Job& job, const std::filesystem::path& sources) const;
  void write_known(const Job& job) const;
  std::vector<std::string> shown_commands(const Job& job) const;  ///< with `mutex_` held
  std::string own_hand_of(const JobRequest& request) const;       ///< its file; with `mutex_` held
  JobPlaces places(const Job& job) const;                         ///< the same
  JobPlaces locked_places(const Job& job) const;
  std::filesystem::path place(const std::string& key) const { return *folder_ / key; }

  std::optional<std::filesystem::path> folder_;
  std::filesystem::path program_;
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  std::vector<Job> jobs_;
  std::deque<std::string> queue_;
  std::string running_;  ///< key; "" if nothing runs
  std::atomic<bool> cancel_{false};
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace palmar::server
