// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/process/worker.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/core/program_folder.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/child_process.h"

namespace palmar::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestReply = std::uint64_t{256} << 20;  // bytes of reply.json
/// So near the limit of memory a crash is one for want of memory.
constexpr double kNearLimit = 0.9;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// "0.3500 tessellating": share and activity, of a child that isn't trusted.
void report_line(const std::string& line, const Progress& progress, std::string& last) {
  char* end = nullptr;
  const double share = std::strtod(line.c_str(), &end);
  if (end == line.c_str() || *end != ' ' || !(share >= 0.0 && share <= 1.0)) return;
  std::string activity = end + 1;
  for (char& c : activity) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  last = activity;
  if (progress.report) progress.report(share, activity);
}

[[noreturn]] void rethrow(const std::string& message, int code) {
  switch (code) {
    case 2:
      throw UsageError(message);
    case 3:
      throw InputError(message);
    case 4:
      throw NumericalError(message);
    default:
      throw OutputError(message);
  }
}

[[noreturn]] void fail_memory(const std::string& object, const WorkerLimits& limits) {
  throw InputError(object + ": needs more than " + number(limits.memory_mb) +
                   " MB of memory, the limit" +
                   (limits.is_fixed ? "" : " (setting \"memory limit\" raises it)"));
}

[[noreturn]] void fail_time(const std::string& object, const WorkerLimits& limits) {
  throw InputError(object + ": took longer than " + number(limits.seconds) +
                   " s of processor time, the limit" +
                   (limits.is_fixed ? "" : " (setting \"time limit\" raises it)"));
}

/// What the child left behind when it ended with an error; nothing if it couldn't.
void rethrow_reported_error(const Worker& worker, const fs::path& folder,
                            const std::string& object) {
  const fs::path path = folder / "error.json";
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  std::string message;
  int code = 0;
  try {
    const auto reported = nlohmann::json::parse(read_file(path, kLargestReply));
    message = reported.at("message").get<std::string>();
    code = reported.at("exit_code").get<int>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(object + ": " + worker.name + " failed and what it says is damaged");
  }
  rethrow(message, code);
}

}  // namespace

fs::path program_of(const Worker& worker) {
  if (const char* given = std::getenv(worker.variable.c_str());
      given != nullptr && *given != '\0') {
    return given;
  }
  return program_folder() / worker.program;
}

void WorkerLimits::check() const {
  if (!(seconds >= 0.1 && seconds <= 86400.0)) {
    throw UsageError("time limit " + number(seconds) + " s; 0.1 to 86400 s is allowed");
  }
  if (!(memory_mb >= 256.0 && memory_mb <= 1048576.0)) {
    throw UsageError("memory limit " + number(memory_mb) + " MB; 256 to 1048576 MB is allowed");
  }
}

WorkerFolder::WorkerFolder() {
  std::error_code error;
  const fs::path base = fs::temp_directory_path(error);
  std::string name = (error ? fs::path("/tmp") : base) / "palmar-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw OutputError(
        name + ": a temporary folder can't be made: " + std::generic_category().message(errno));
  }
  path_ = name;
}

WorkerFolder::~WorkerFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string run_worker(const Worker& worker, const std::string& verb, const std::string& request,
                       const WorkerFolder& folder, const std::string& object,
                       const WorkerLimits& limits, const Progress& progress) {
  limits.check();
  progress.throw_if_cancelled();
  for (const char* const old : {"reply.json", "error.json"}) {
    std::error_code ignored;
    fs::remove(folder.path() / old, ignored);
  }
  write_file(folder.path() / "request.json", request);
  std::string activity;
  const ChildResult result = run_child(
      program_of(worker), {verb, folder.path().string()}, folder.path() / "worker.log",
      {.seconds = limits.seconds, .is_processor_time = true, .memory_mb = limits.memory_mb},
      [&](const std::string& line) { report_line(line, progress, activity); },
      [&progress] { return progress.is_cancelled(); });
  switch (result.end) {
    case ChildResult::End::kCancelled:
      progress.throw_if_cancelled();
      throw Cancelled("cancelled");
    case ChildResult::End::kOutOfTime:
      fail_time(object, limits);
    case ChildResult::End::kOutOfMemory:
      fail_memory(object, limits);
    case ChildResult::End::kSignal:
      if (result.code == SIGXCPU) fail_time(object, limits);
      if (result.code == SIGKILL || result.peak_memory_mb > kNearLimit * limits.memory_mb) {
        fail_memory(object, limits);  // the system, short of memory, ends programs by SIGKILL
      }
      throw InputError(object + ": " + worker.crashed +
                       (activity.empty() ? "" : " while " + activity) + ": " +
                       words_of_signal(result.code) + "; " + worker.reason);
    case ChildResult::End::kExited:
      break;
  }
  if (result.code == kWorkerOutOfMemory) fail_memory(object, limits);
  if (result.code == 0) return read_file(folder.path() / "reply.json", kLargestReply);
  rethrow_reported_error(worker, folder.path(), object);
  throw InputError(object + ": " + worker.name + " ended with code " + std::to_string(result.code) +
                   " and said nothing");
}

}  // namespace palmar::formats
