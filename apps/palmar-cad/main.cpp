// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// palmar-cad VERB FOLDER: does what FOLDER/request.json asks for with OpenCASCADE and leaves
// FOLDER/reply.json, or FOLDER/error.json and Palmar's exit code. Started by Palmar
// (io/cad_worker.h), not by people: OpenCASCADE may crash or never end on hostile files.
#include <sys/stat.h>
#include <unistd.h>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <system_error>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/io/cad_worker.h"
#include "palmar/io/file.h"
#include "verbs.h"

namespace {

namespace fs = std::filesystem;
using palmar::cad_worker::Json;
using Verb = std::function<Json(const Json&, const fs::path&, const palmar::Progress&)>;

/// Progress as lines on stdout: share and activity.
palmar::Progress line_progress() {
  palmar::Progress progress;
  progress.report = [](double share, const std::string& activity) {
    std::printf("%.4f %s\n", std::clamp(share, 0.0, 1.0), activity.c_str());
    std::fflush(stdout);
  };
  return progress;
}

int fail(const fs::path& folder, const std::string& message, int code) {
  palmar::write_file(folder / "error.json", Json{{"message", message}, {"exit_code", code}}.dump());
  return code;
}

/// When the parent ends, however that happens, its end of our standard input closes: nobody waits
/// for the work any more, nor will anybody remove the folder.
void end_with_parent(const fs::path& folder) {
  struct stat input {};
  if (::fstat(STDIN_FILENO, &input) != 0 || !S_ISFIFO(input.st_mode)) return;  // started by hand
  std::thread([folder] {
    char byte = 0;
    while (::read(STDIN_FILENO, &byte, 1) < 0 && errno == EINTR) {
    }
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    ::_exit(1);
  }).detach();
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, Verb> verbs = {
      {"check", palmar::cad_worker::check},       {"convert", palmar::cad_worker::convert},
      {"features", palmar::cad_worker::features}, {"import", palmar::cad_worker::import},
      {"make", palmar::cad_worker::make},         {"region", palmar::cad_worker::region},
      {"version", palmar::cad_worker::version}};
  if (argc != 3 || verbs.count(argv[1]) == 0) {
    std::fprintf(stderr, "palmar-cad is started by palmar; see `palmar product -h`\n");
    return 2;
  }
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const fs::path folder = argv[2];
  // In whatever thread it happens, and whoever would catch it: the parent says it by name.
  std::set_new_handler([] { ::_exit(palmar::kCadOutOfMemory); });
  end_with_parent(folder);
  try {
    const Json request = Json::parse(palmar::read_file(folder / "request.json"));
    const Json reply = verbs.at(argv[1])(request, folder, line_progress());
    palmar::write_file(folder / "reply.json", reply.dump());
    return 0;
  } catch (const palmar::Error& error) {
    return fail(folder, error.what(), error.exit_code());
  } catch (const Standard_OutOfMemory&) {
    ::_exit(palmar::kCadOutOfMemory);
  } catch (const Standard_Failure& failure) {
    const char* const text = failure.GetMessageString();
    return fail(folder,
                std::string("OpenCASCADE gave up: ") + failure.DynamicType()->Name() +
                    (text != nullptr && *text != '\0' ? std::string(", ") + text : ""),
                palmar::NumericalError("").exit_code());
  } catch (const std::bad_alloc&) {
    ::_exit(palmar::kCadOutOfMemory);
  } catch (const std::exception& error) {
    return fail(folder, error.what(), 1);
  }
}
