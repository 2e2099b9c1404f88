// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "palmar/core/progress.h"

namespace palmar::formats {

/// What a child process may use. Beyond it, it is ended and the user is told which limit it was.
struct WorkerLimits {
  double seconds = 60.0;    ///< of wall clock
  double memory_mb = 4096;  ///< of address space
  bool is_fixed = false;    ///< no setting raises them; messages don't say how
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// Exit code of a child when memory was refused to it.
inline constexpr int kWorkerOutOfMemory = 71;

/// A folder of its own for one run of a worker, removed at the end of its life.
class WorkerFolder {
 public:
  WorkerFolder();  ///< throws OutputError
  ~WorkerFolder();
  WorkerFolder(const WorkerFolder&) = delete;
  WorkerFolder& operator=(const WorkerFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A program that Palmar starts as a child, for libraries that it doesn't link itself.
struct Worker {
  std::string program;   ///< file beside this program: "palmar-cad"
  std::string variable;  ///< of the environment, that names another file
  std::string name;      ///< in messages: "the CAD program"
  std::string crashed;   ///< "the CAD kernel crashed on it"
  std::string reason;    ///< why it may: "it is damaged, or holds what the kernel can't handle"
};

/// Where a worker's program is, there or not.
std::filesystem::path program_of(const Worker& worker);

/// Runs `PROGRAM VERB FOLDER` as a child and waits for it.
///
/// `request` is a JSON object that the verb knows (apps/PROGRAM/VERB.cpp); it goes into
/// request.json of the folder. The reply, a JSON object, comes back; files that it speaks of are in
/// the folder. Progress lines of the child become those of `progress`.
///
/// Throws what the child found wrong with the same class and message (InputError, UsageError,
/// NumericalError, OutputError); InputError naming `object` and the limit if it ran out of time or
/// memory, or crashed on its input; Cancelled (the child is ended at once); OutputError if the
/// program isn't there.
std::string run_worker(const Worker& worker, const std::string& verb, const std::string& request,
                       const WorkerFolder& folder, const std::string& object,
                       const WorkerLimits& limits = {}, const Progress& progress = {});

}  // namespace palmar::formats
