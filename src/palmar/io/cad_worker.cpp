// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/cad_worker.h"

#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/io/external_program.h"
#include "palmar/io/file.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;

fs::path worker_program() {
  if (const char* given = std::getenv("PALMAR_CAD"); given != nullptr && *given != '\0') {
    return given;
  }
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return (error ? fs::path() : self.parent_path()) / "palmar-cad";
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

}  // namespace

void CadLimits::check() const {}

CadFolder::CadFolder() {
  std::string name = (fs::temp_directory_path() / "palmar-cad-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw OutputError(
        name + ": a temporary folder can't be made: " + std::generic_category().message(errno));
  }
  path_ = name;
}

CadFolder::~CadFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string run_cad(const std::string& verb, const std::string& request, const CadFolder& folder,
                    const std::string& object, const CadLimits& limits, const Progress& progress) {
  limits.check();
  progress.throw_if_cancelled();
  write_file(folder.path() / "request.json", request);
  const fs::path program = worker_program();
  const int code =
      run_program(program, {verb, folder.path().string()}, folder.path(), "worker.log");
  if (code == 0) return read_file(folder.path() / "reply.json");
  if (fs::exists(folder.path() / "error.json")) {
    const auto error = nlohmann::json::parse(read_file(folder.path() / "error.json"));
    rethrow(error.at("message").get<std::string>(), error.at("exit_code").get<int>());
  }
  throw InputError(object + ": the CAD program ended with code " + std::to_string(code));
}

}  // namespace palmar
