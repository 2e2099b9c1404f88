// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/pressed_solid.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/product/cad_handle.h"
#include "palmar/workflow/redesign/feature_settings.h"
#include "palmar/workflow/redesign/shape_files.h"

namespace palmar::workflow {
namespace {

constexpr double kWithin = 0.05;                   // mm, root mean square; then no finer grid
constexpr double kOfTightest = 0.7;                // of an end's outline: the rounding of its edge
constexpr double kDistances[] = {3.5, 2.5, 1.75};  // mm, of grids

/// The handle of the pressed product, with its ends' edges as those of the original, or rounder.
redesign::HandleShape pressed_handle(const HeldOriginal& original, const grasp::Hold& hold,
                                     const product::Product& pressed,
                                     const redesign::PressedShapeOptions& options) {
  const redesign::HandsOnHandle hands = hands_in_hold(original, hold);
  const product::ProductPart& part = original.part_of(hold);
  const redesign::MeasureHandleOptions all{.takes_all = true, .smooths_scans = false};
  redesign::HandleShape shape{.body = redesign::measure_handle(pressed, part, hands, all)};
  if (!shape.body.is_whole) return shape;
  shape.body.end_radius = redesign::measure_handle(original.product(), part, hands, all).end_radius;
  // What must stay as it is may be an end.
  shape.end_radius = options.keep_out.is_empty()
                         ? std::max(redesign::kLeastEndRadius, shape.body.end_radius)
                         : shape.body.end_radius;
  return shape;
}

}  // namespace

std::variant<PressedSolid, std::string> write_pressed_solid(
    const RedesignRequest& request, const HeldOriginal& original, const product::Product& pressed,
    const redesign::PressedShapeOptions& options, const Progress& progress) {
  const product::Product& product = original.product();
  const std::optional<grasp::Hold> hold = original.hold();
  if (!hold) return product.name + ": held at given coordinates, so that no part is its handle";
  PressedSolid solid;
  // A grid that can't be made ends the search; a coarser one that was written before it stays.
  const auto ended = [&](const Error& error) -> std::variant<PressedSolid, std::string> {
    if (solid.file.empty()) return error.what();
    return solid;
  };
  try {
    redesign::HandleShape shape = pressed_handle(original, *hold, pressed, options);
    const bool is_whole = shape.body.is_whole;
    std::optional<records::CadSource> source;
    if (!is_whole && product.faces != nullptr) source = cad_source_of(request);
    const double end_radius = shape.end_radius;
    for (const double distance : kDistances) {
      shape.follows = redesign::outline_grid(shape.body.outlines, distance);
      shape.end_radius = std::min(end_radius, kOfTightest * redesign::tightest_at_ends(shape));
      const records::MadeHandle made =
          records::make_handle(shape, product.name, source, 0.01, {}, progress);
      const Deviation deviation = kept_deviation(shape, made.handle.mesh.mesh, pressed);
      if (!solid.file.empty() && deviation.rms >= solid.deviation) break;
      const records::HandleSolid& written = made.whole ? *made.whole : made.handle;
      PressedSolid next;
      next.file = request.out / (is_whole || made.whole ? "pressed.step" : "pressed-handle.step");
      next.volume = written.volume;
      next.end_radius = shape.end_radius;
      next.largest_deviation = deviation.largest;
      next.deviation = deviation.rms;
      next.faces = made.handle.faces;
      next.poles = made.handle.poles;
      formats::write_file(next.file, written.step);
      if (!solid.file.empty() && solid.file != next.file) std::filesystem::remove(solid.file);
      solid = next;
      if (solid.deviation <= kWithin) break;
    }
    return solid;
  } catch (const UsageError& error) {
    return ended(error);
  } catch (const NumericalError& error) {
    return ended(error);
  }
}

}  // namespace palmar::workflow
