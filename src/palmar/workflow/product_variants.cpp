// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/toml_section.h"

namespace palmar::workflow {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kStudyFile = "study.toml";
constexpr const char* kHeading = "# Written by `palmar product make`";

std::string suffix_of(const std::string& path) {
  return lower_case(fs::path(path).extension().string());
}

bool is_step(const std::string& path) {
  return suffix_of(path) == ".step" || suffix_of(path) == ".stp";
}

void check_suffixes(const ProductVariantsRequest& files) {
  std::set<std::string> seen;
  for (const ProductVariantsRequest::Entry& entry : files.products) {
    for (const std::string& path : entry.files) {
      const std::string suffix = suffix_of(path);
      if (!is_step(path) && suffix != ".stl" && suffix != ".obj" && suffix != ".ply") {
        throw UsageError("setting \"files\" is " + path +
                         "; .step, .stp, .stl, .obj or .ply is allowed, or a "
                         "folder that ends with /");
      }
      if (!seen.insert(path).second) throw UsageError("two products would be written to " + path);
    }
  }
}

/// Text that is a file's name everywhere.
std::string as_file_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool is_kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    if (is_kept) {
      result += c;
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result.empty() ? "product" : result;
}

std::string study_text(const ProductVariantsRequest& files) {
  const std::string name = fs::path(files.folder + "/.").parent_path().filename().string();
  std::string text = fmt::format(
      "{}:\n# {}\n\n[study]\nname = {}\n\n[[population]]\npreset = \"xie2014\"\nhands = 30\n",
      kHeading, files.command, formats::toml_string(name.empty() ? "products" : name));
  for (const ProductVariantsRequest::Entry& entry : files.products) {
    const std::string file = fs::path(entry.files.front()).filename().string();
    text += fmt::format("\n[[product]]\nname = {}\nfile = {}\n", formats::toml_string(entry.name),
                        formats::toml_string(file));
    if (!is_step(file)) text += "unit = \"mm\"\n";
    if (const auto side = records::thumb_side_of(entry.product)) {
      text += fmt::format("axis = [{:.6g}, {:.6g}, {:.6g}]\n", side->x(), side->y(), side->z());
    }
    if (!entry.family.empty()) text += "family = " + formats::toml_string(entry.family) + "\n";
  }
  return text;
}

/// A study file that somebody has written stays as it is.
void check_study_file(const fs::path& path) {
  if (!fs::exists(path) || formats::read_file(path).rfind(kHeading, 0) == 0) return;
  throw UsageError(path.string() +
                   " is there and isn't one that `palmar product make` wrote; another folder, or "
                   "another name for it, is needed");
}

std::string volume_words(double volume) {
  const bool is_small = volume != 0.0 && std::abs(volume) < 10.0;
  return is_small ? fmt::format("{:.3g} mm3", volume) : fmt::format("{:.0f} mm3", volume);
}

Json write_one(const ProductVariantsRequest::Entry& entry, double chordal_error,
               const std::function<void(const std::string&)>& note) {
  const bool step = std::any_of(entry.files.begin(), entry.files.end(), is_step);
  const bool mesh = !std::all_of(entry.files.begin(), entry.files.end(), is_step);
  const bool is_exact = records::is_analytic(entry.product);
  Json result = {{"name", entry.name}, {"kind", entry.product.kind}};
  for (const auto& [name, value] : entry.product.given) result["parameters"][name] = value;
  std::optional<records::MadeCad> cad;
  if (step || !is_exact) {
    cad = records::make_cad(
        entry.product, {.step = step, .mesh = mesh && !is_exact, .chordal_error = chordal_error});
    for (const std::string& text : cad->notes) note(entry.name + ": " + text);
    result["volume_mm3"] = cad->volume;
  }
  std::optional<geometry::TriangleMesh> triangles;
  if (mesh) {
    triangles = is_exact ? records::make_solid(entry.product, {.chordal_error = chordal_error}).mesh
                         : cad->mesh.mesh;
    result["triangles"] = triangles->triangle_count();
  }
  result["files"] = Json::array();
  for (const std::string& path : entry.files) {
    if (is_step(path)) {
      formats::write_file(path, cad->step);
      note(fmt::format("wrote {} (STEP, {}, unit: mm)", path, volume_words(cad->volume)));
    } else {
      formats::write_mesh(path, *triangles);
      note(fmt::format("wrote {} ({} triangles, unit: mm)", path, triangles->triangle_count()));
    }
    result["files"].push_back(path);
  }
  return result;
}

}  // namespace

std::vector<std::string> files_in_folder(const std::string& folder, const std::string& name,
                                         const std::string& formats) {
  std::vector<std::string> files;
  std::size_t begin = 0;
  while (begin <= formats.size()) {
    const std::size_t end = std::min(formats.find(',', begin), formats.size());
    const std::string format = formats.substr(begin, end - begin);
    if (format != "step" && format != "stp" && format != "stl" && format != "obj" &&
        format != "ply") {
      throw UsageError("setting \"formats\" is \"" + formats +
                       "\"; step, stl, obj and ply are allowed, as "
                       "step,stl");
    }
    files.push_back((fs::path(folder) / (as_file_name(name) + "." + format)).string());
    begin = end + 1;
  }
  return files;
}

void ProductVariantsRequest::check() const {
  check_suffixes(*this);
  if (!folder.empty()) check_study_file(fs::path(folder) / kStudyFile);
}

ProductVariantsOutcome write_variants(const ProductVariantsRequest& request,
                                      const Progress& progress) {
  request.check();
  ProductVariantsOutcome outcome;
  const auto note = [&](const std::string& text) {
    outcome.notes.push_back(text);
    if (request.on_note) request.on_note(text);
  };
  if (!request.folder.empty()) formats::create_folder(request.folder);
  Json made = Json::array();
  for (const ProductVariantsRequest::Entry& entry : request.products) {
    progress.update(static_cast<double>(made.size()) / static_cast<double>(request.products.size()),
                    "making " + entry.name);
    made.push_back(write_one(entry, request.chordal_error, note));
  }
  Json result = {{"products", std::move(made)}};
  if (!request.folder.empty()) {
    outcome.study = fs::path(request.folder) / kStudyFile;
    const std::string study = outcome.study.string();
    formats::write_file(outcome.study, study_text(request));
    note(fmt::format("wrote {}: {} products in 30 hands; continue with\n  palmar study run {}",
                     study, request.products.size(), study));
    result["study"] = study;
  }
  outcome.json = result.dump();
  return outcome;
}

}  // namespace palmar::workflow
