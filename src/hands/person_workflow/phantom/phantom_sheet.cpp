// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_sheet.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "hands/capture/sheet/sheet_view.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "hands/images/exif.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/mirror.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar {
namespace {

struct FlatHand {
  SpreadHand spread;
  std::optional<Hand> hand;  ///< if it is one of Palmar's
};

FlatHand make_flat_hand(const PhantomSheetRequest& request) {
  const SpreadOptions options{.dispersion = request.is_free ? kFreePerson : PersonDispersion{},
                              .seed = request.photograph.seed,
                              .together = request.together};
  if (request.hand.empty()) {
    return {spread_person(*load_hand(request.base), request.side, options), {}};
  }
  Hand hand = *load_hand(request.hand);
  if (hand.side != request.side) hand = mirrored(hand);
  return {spread_hand(hand, options), hand};
}

/// What a telephone writes of itself: the lens' focal length as it is sold, rounded, on a sensor of
/// 1.4 micrometres a pixel.
PhotoExif exif_of(const RgbImage& image, const SheetPhotographOptions& photograph) {
  constexpr double kPixelsPerMm = 1.0 / 0.0014;
  const double longer = std::max(image.width, image.height);
  PhotoExif exif;
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
  sheet_format_named(sheet);
}

PhantomSheetOutcome make_phantom_sheet(const PhantomSheetRequest& request,
                                       const Progress& progress) {
  request.check();
  const SheetFormat& format = sheet_format_named(request.sheet);
  SheetPhotographOptions photograph = request.photograph;
  photograph.width = format.width;
  photograph.height = format.height;
  photograph.is_card = format.corner > 0.0;
  photograph.corner = format.corner;
  photograph.thickness = format.thickness;
  progress.update(0.0, "making the hand");
  const FlatHand flat = make_flat_hand(request);
  progress.update(0.4, "photographing");
  const RgbImage image = photograph_on_sheet(flat.spread, photograph);
  progress.update(0.9, "writing");
  const std::filesystem::path out(request.out);
  create_folder(out);
  PhantomSheetOutcome outcome;
  outcome.photograph = (out / "photo.jpg").string();
  outcome.truth = (out / "truth.json").string();
  outcome.shape = (out / (flat.hand ? "truth.hand.glb" : "truth.ply")).string();
  write_file(
      outcome.photograph,
      format_jpeg(image, 92, request.has_exif ? format_exif(exif_of(image, photograph)) : ""));
  nlohmann::ordered_json truth = nlohmann::ordered_json::object();
  for (const HandDimension dimension : all_hand_dimensions()) {
    truth[name_of(dimension) + "_mm"] = value_of(flat.spread.dimensions, dimension);
  }
  write_file(outcome.truth, truth.dump(1) + "\n");
  if (flat.hand) {
    write_hand(outcome.shape, *flat.hand);
  } else {
    write_mesh(outcome.shape, hand_on_sheet(flat.spread, photograph));
  }
  return outcome;
}

}  // namespace palmar
