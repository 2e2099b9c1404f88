// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/grasp_holds.h"

#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/hold/hold_file.h"
#include "palmar/report/picture/holds_picture.h"

namespace palmar::workflow {
namespace {

constexpr double kHoldsRead = 0.05, kHoldsRanked = 0.8;  // shares of the whole

void write_holds(const GraspHoldsRequest& request, GraspHoldsOutcome& outcome,
                 const std::string& sheet) {
  if (!request.picture.empty()) {
    formats::write_file(request.picture, sheet);
    outcome.files.push_back(request.picture);
  }
  if (request.out.empty()) return;
  const std::filesystem::path folder = request.out;
  formats::create_folder(folder);
  for (std::size_t k = 0; k < outcome.ranked.holds.size(); ++k) {
    const std::string file = (folder / ("hold-" + std::to_string(k + 1) + ".toml")).string();
    records::write_hold(file, {outcome.ranked.holds[k].hold, outcome.product.name});
    outcome.files.push_back(file);
  }
  const std::string picture = (folder / "sheet.png").string();
  formats::write_file(picture, sheet);
  outcome.files.push_back(picture);
}

}  // namespace

void GraspHoldsRequest::check() const {
  product.check();
  options.check();
  if (!picture.empty() && !picture.ends_with(".png")) {
    throw UsageError("setting \"picture\" is " + picture +
                     "; a name that ends with .png is required");
  }
}

GraspHoldsOutcome find_holds(const GraspHoldsRequest& request, const Progress& progress) {
  request.check();
  GraspHoldsOutcome outcome;
  outcome.product = load_product(request.product, part_of(progress, 0.0, kHoldsRead));
  for (const std::string& text : outcome.product.notes) note_to(request.note, text);
  outcome.hand = load_hand(request.hand);
  outcome.ranked = grasp::rank_holds(*outcome.hand, outcome.product, request.options,
                                     part_of(progress, kHoldsRead, kHoldsRanked));
  if (request.picture.empty() && request.out.empty()) return outcome;
  report::HoldsPictureOptions drawing;
  drawing.up = request.options.up;
  const report::Image sheet = report::holds_picture(*outcome.hand, outcome.product, outcome.ranked,
                                                    drawing, part_of(progress, kHoldsRanked, 1.0));
  write_holds(request, outcome, report::encode_png(sheet, report::PngEffort::kSmall));
  return outcome;
}

}  // namespace palmar::workflow
