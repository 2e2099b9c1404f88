// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palmar::formats {

/// What a child process may use.
struct ChildLimits {
  double seconds = 60.0;  ///< kept by the parent; wall clock, unless ...
  /// ... it is the processor time of the child's threads: a machine that is busy with other work
  /// ends nothing. By the clock five times as long is allowed, in case that the child only waits.
  bool is_processor_time = false;
  double memory_mb =
      4096.0;               ///< address space; kept by the kernel (resident memory, by the parent,
                            ///< in builds with the address sanitizer, which reserves terabytes)
  double file_mb = 8192.0;  ///< of each file it writes
};

/// How it ended.
struct ChildResult {
  enum class End { kExited, kSignal, kOutOfTime, kOutOfMemory, kCancelled };
  End end = End::kExited;
  int code = 0;                 ///< exit code, or the signal
  double peak_memory_mb = 0.0;  ///< largest address space that was seen
};

/// Starts a program without a shell and waits for it. Its standard output comes line by line to
/// `on_line` (lines beyond 500 bytes are cut), its standard error goes to the file `log`, its
/// standard input is a pipe that ends when this process ends, however that happens, so that the
/// child can end itself too. It inherits no other open file, leads a process group of its own and
/// leaves no core file. When time is over, memory used up, or `is_cancelled` says so (asked every
/// 20 ms), the whole group is killed. Never leaves a zombie, also if `on_line` throws.
///
/// Throws OutputError if it can't be started.
ChildResult run_child(const std::filesystem::path& program,
                      const std::vector<std::string>& arguments, const std::filesystem::path& log,
                      const ChildLimits& limits,
                      const std::function<void(const std::string&)>& on_line,
                      const std::function<bool()>& is_cancelled);

/// "segmentation fault (signal 11)"
std::string words_of_signal(int signal);

}  // namespace palmar::formats
