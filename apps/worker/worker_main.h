// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the main functions of the programs have in common that Palmar starts as children
// (formats/process/worker.h).
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/core/progress.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/worker.h"

namespace palmar::worker {

using Json = nlohmann::ordered_json;
/// What request.json asks for becomes reply.json, beside files in the folder.
using Verb = std::function<Json(const Json&, const std::filesystem::path&, const Progress&)>;

/// Progress as lines on stdout: share and activity.
inline Progress line_progress() {
  Progress progress;
  progress.report = [](double share, const std::string& activity) {
    std::printf("%.4f %s\n", std::clamp(share, 0.0, 1.0), activity.c_str());
    std::fflush(stdout);
  };
  return progress;
}

/// Leaves error.json; returns the code.
inline int fail(const std::filesystem::path& folder, const std::string& message, int code) {
  formats::write_file(folder / "error.json",
                      Json{{"message", message}, {"exit_code", code}}.dump());
  return code;
}

/// When the parent ends, however that happens, its end of our standard input closes: nobody waits
/// for the work any more, nor will anybody remove the folder.
inline void end_with_parent(const std::filesystem::path& folder) {
  struct stat input {};
  if (::fstat(STDIN_FILENO, &input) != 0 || !S_ISFIFO(input.st_mode)) return;  // started by hand
  std::thread([folder] {
    char byte = 0;
    while (::read(STDIN_FILENO, &byte, 1) < 0 && errno == EINTR) {
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    ::_exit(1);
  }).detach();
}

/// Reads request.json in the folder, leaves reply.json or error.json there; returns the code of the
/// program.
inline int answer(const std::filesystem::path& folder, const Verb& verb) {
  end_with_parent(folder);
  try {
    const Json request = Json::parse(formats::read_file(folder / "request.json"));
    formats::write_file(folder / "reply.json", verb(request, folder, line_progress()).dump());
    return 0;
  } catch (const Error& error) {
    return fail(folder, error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    ::_exit(formats::kWorkerOutOfMemory);
  } catch (const std::exception& error) {
    return fail(folder, error.what(), 1);
  }
}

}  // namespace palmar::worker
