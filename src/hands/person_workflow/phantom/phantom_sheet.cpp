// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_sheet.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "hands/capture/sheet/sheet_view.h"
#include "hands/images/exif.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/mirror.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::person_workflow {
namespace {

struct FlatHand {
  phantom::SpreadHand spread;
  std::optional<hand::Hand> hand;  ///< if it is one of Palmar's
};

FlatHand make_flat_hand(const PhantomSheetRequest& request) {
  const phantom::SpreadOptions options{
      .dispersion = request.is_free ? phantom::kFreePerson : phantom::PersonDispersion{},
      .seed = request.photograph.seed,
      .together = request.together};
  if (request.hand.empty()) {
    return {phantom::spread_person(*workflow::load_hand(request.base), request.side, options), {}};
  }
  hand::Hand hand = *workflow::load_hand(request.hand);
  if (hand.side != request.side) hand = hand::mirrored(hand);
  return {phantom::spread_hand(hand, options), hand};
}

/// What a telephone writes of itself: the lens' focal length as it is sold, rounded, on a sensor of
/// 1.4 micrometres a pixel.
images::PhotoExif exif_of(const geometry::RgbImage& image,
                          const phantom::SheetPhotographOptions& photograph) {
  constexpr double kPixelsPerMm = 1.0 / 0.0014;
  const double longer = std::max(image.width, image.height);
  images::PhotoExif exif;
  exif.camera = "Phantom";
  exif.focal_mm = std::round(100.0 * photograph.focal * longer / kPixelsPerMm) / 100.0;
  exif.focal_35mm = std::round(photograph.focal * longer * std::hypot(36.0, 24.0) /
                               std::hypot(image.width, image.height));
  exif.pixels_per_mm = kPixelsPerMm;
  exif.width = image.width;
  exif.height = image.height;
  return exif;
}

}  // namespace

void PhantomSheetRequest::check() const {
  if (out.empty()) throw UsageError("setting \"out\" is empty; a folder to write to is required");
  photograph.check();
  capture::sheet_format_named(sheet);
}

PhantomSheetOutcome make_phantom_sheet(const PhantomSheetRequest& request,
                                       const Progress& progress) {
  request.check();
  const capture::SheetFormat& format = capture::sheet_format_named(request.sheet);
  phantom::SheetPhotographOptions photograph = request.photograph;
  photograph.width = format.width;
  photograph.height = format.height;
  photograph.is_card = format.corner > 0.0;
  photograph.corner = format.corner;
  photograph.thickness = format.thickness;
  progress.update(0.0, "making the hand");
  const FlatHand flat = make_flat_hand(request);
  progress.update(0.4, "photographing");
  const geometry::RgbImage image = phantom::photograph_on_sheet(flat.spread, photograph);
  progress.update(0.9, "writing");
  const std::filesystem::path out(request.out);
  formats::create_folder(out);
  PhantomSheetOutcome outcome;
  outcome.photograph = (out / "photo.jpg").string();
  outcome.truth = (out / "truth.json").string();
  outcome.shape = (out / (flat.hand ? "truth.hand.glb" : "truth.ply")).string();
  formats::write_file(
      outcome.photograph,
      formats::format_jpeg(
          image, 92, request.has_exif ? images::format_exif(exif_of(image, photograph)) : ""));
  nlohmann::ordered_json truth = nlohmann::ordered_json::object();
  for (const hand::HandDimension dimension : hand::all_hand_dimensions()) {
    truth[name_of(dimension) + "_mm"] = hand::value_of(flat.spread.dimensions, dimension);
  }
  formats::write_file(outcome.truth, truth.dump(1) + "\n");
  if (flat.hand) {
    records::write_hand(outcome.shape, *flat.hand);
  } else {
    formats::write_mesh(outcome.shape, phantom::hand_on_sheet(flat.spread, photograph));
  }
  return outcome;
}

}  // namespace palmar::person_workflow
