// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/study/study_options.h"

#include <filesystem>

#include "palmar/core/text.h"

namespace palmar::report {
namespace {

std::string file_ending(const study::StudyProduct& product) {
  return lower_case(std::filesystem::path(product.file).extension().string());
}

}  // namespace

bool is_mesh_file(const study::StudyProduct& product) {
  const std::string end = file_ending(product);
  return end == ".stl" || end == ".obj" || end == ".ply";
}

bool is_plain_product(const study::StudyProduct& product) {
  const std::string end = file_ending(product);
  const bool is_known = is_mesh_file(product) || end == ".step" || end == ".stp" ||
                        end == ".iges" || end == ".igs" || end == ".3mf" || end == ".glb" ||
                        end == ".gltf" || product.file.starts_with("made: ");
  return is_known && product.size == 1.0 && product.posture_of.empty();
}

std::string product_options(const study::StudyPlan& plan) {
  std::string line, unit;
  for (const study::StudyProduct& one : plan.products) {
    if (!is_plain_product(one)) return "";
    line += (line.empty() ? "" : " ") + ("--product " + shell_word(one.file));
    if (is_mesh_file(one)) unit = one.unit;
  }
  return unit.empty() ? line : line + " --unit " + unit;
}

std::string mass_option(const study::StudyPlan& plan) {
  const double first = plan.products.front().mass;
  for (const study::StudyProduct& one : plan.products) {
    if (one.mass != first) return "";
  }
  return first > 0.0 ? " --mass-kg " + significant(first, 4) : "";
}

}  // namespace palmar::report
