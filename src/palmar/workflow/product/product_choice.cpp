// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product/product_choice.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/product/intake/check.h"
#include "palmar/records/product/made_product.h"

namespace palmar::workflow {
namespace {

/// Above this, finding crossing triangles takes more than a few tenths of a second.
constexpr int kMostTrianglesForCrossings = 100'000;

/// Nothing unless the product's source says by which kind and parameters it was made.
std::optional<Vec3> thumb_side_of(const product::Product& product) {
  if (!records::is_made(product.source)) return std::nullopt;
  try {
    return thumb_side_of(records::made_from(product.source));
  } catch (const Error&) {
    return std::nullopt;  // a primitive, which says only its size
  }
}

}  // namespace

std::string ProductChoice::name() const { return value ? value->name : file.string(); }

void ProductChoice::check() const {
  if (!value && file.empty()) {
    throw UsageError("setting \"product\" is empty; a file or a value is required");
  }
  reading.limits.check();
}

product::Product load_product(const ProductChoice& choice, const Progress& progress) {
  choice.check();
  if (choice.value) return *choice.value;
  records::LoadProductOptions options = choice.reading;
  options.progress = progress;
  return load_product(choice.file, options);
}

void add_findings(product::Product& product) {
  const bool is_small = product.mesh.triangle_count() <= kMostTrianglesForCrossings;
  for (const product::Finding& finding : product::check_mesh(product.mesh, is_small).findings) {
    const bool is_known = std::any_of(
        product.notes.begin(), product.notes.end(),
        [&](const std::string& note) { return note.find(finding.text) != std::string::npos; });
    if (finding.severity != product::Severity::kOk && !is_known)
      product.notes.push_back(finding.text);
  }
}

grasp::GraspOptions options_for(const grasp::GraspSettings& settings,
                                const product::Product& product) {
  grasp::GraspOptions result = settings.options();
  if (!result.is_placed() && !result.holds.toward) result.holds.toward = thumb_side_of(product);
  return result;
}

}  // namespace palmar::workflow
