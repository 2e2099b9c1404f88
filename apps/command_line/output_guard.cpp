// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "output_guard.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/records/product/cad_format.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

}  // namespace

void refuse_same_file(const std::string& input, const std::string& out) {
  std::error_code ignored;
  if (input == out || fs::equivalent(input, out, ignored)) {
    throw UsageError("--out " + out +
                     ": is the product itself; the original stays as it is, name "
                     "another file");
  }
}

void check_shape_output(const std::string& out, bool allows_step) {
  const std::string allowed =
      allows_step ? ".stl, .obj, .ply, or .step if the product is CAD" : ".stl, .obj or .ply";
  std::error_code ignored;
  if (out.ends_with('/') || fs::is_directory(out, ignored)) {
    throw UsageError("--out " + out + ": is a folder; a file is required: " + allowed);
  }
  const std::string suffix = lower_case(fs::path(out).extension().string());
  const bool is_mesh = suffix == ".stl" || suffix == ".obj" || suffix == ".ply";
  const bool is_step = records::cad_format_of_name(out) == records::CadFormat::kStep;
  if (is_mesh || (allows_step && is_step)) return;
  throw UsageError("--out " + out + ": can't be written as \"" + suffix + "\"; allowed are " +
                   allowed);
}

}  // namespace palmar::cli
