// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/pressed_solid.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/product/cad_handle.h"
#include "palmar/workflow/redesign/feature_settings.h"
#include "palmar/workflow/redesign/shape_files.h"

namespace palmar {
namespace {

constexpr double kWithin = 0.05;                   // mm, root mean square; then no finer grid
constexpr double kOfTightest = 0.7;                // of an end's outline: the rounding of its edge
constexpr double kDistances[] = {3.5, 2.5, 1.75};  // mm, of grids

/// The handle of the pressed product, with its ends' edges as those of the original, or rounder.
HandleShape pressed_handle(const HeldOriginal& original, const Hold& hold, const Product& pressed,
                           const PressedShapeOptions& options) {
  const HandsOnHandle hands = hands_in_hold(original, hold);
  const ProductPart& part = original.part_of(hold);
  const MeasureHandleOptions all{.takes_all = true, .smooths_scans = false};
  HandleShape shape{.body = measure_handle(pressed, part, hands, all)};
  if (!shape.body.is_whole) return shape;
  shape.body.end_radius = measure_handle(original.product(), part, hands, all).end_radius;
  // What must stay as it is may be an end.
  shape.end_radius = options.keep_out.is_empty() ? std::max(kLeastEndRadius, shape.body.end_radius)
                                                 : shape.body.end_radius;
  return shape;
}

}  // namespace

std::variant<PressedSolid, std::string> write_pressed_solid(const RedesignRequest& request,
                                                            const HeldOriginal& original,
                                                            const Product& pressed,
                                                            const PressedShapeOptions& options,
                                                            const Progress& progress) {
  const Product& product = original.product();
  const std::optional<Hold> hold = original.hold();
  if (!hold) return product.name + ": held at given coordinates, so that no part is its handle";
  try {
    HandleShape shape = pressed_handle(original, *hold, pressed, options);
    const bool is_whole = shape.body.is_whole;
    std::optional<CadSource> source;
    if (!is_whole && product.faces != nullptr) source = cad_source_of(request);
    PressedSolid solid;
    const double end_radius = shape.end_radius;
    for (const double distance : kDistances) {
      shape.follows = outline_grid(shape.body.outlines, distance);
      shape.end_radius = std::min(end_radius, kOfTightest * tightest_at_ends(shape));
      const MadeHandle made = make_handle(shape, product.name, source, 0.01, {}, progress);
      const Deviation deviation = kept_deviation(shape, made.handle.mesh.mesh, pressed);
      if (!solid.file.empty() && deviation.rms >= solid.deviation) break;
      const HandleSolid& written = made.whole ? *made.whole : made.handle;
      solid.file = request.out / (is_whole || made.whole ? "pressed.step" : "pressed-handle.step");
      solid.volume = written.volume;
      solid.end_radius = shape.end_radius;
      solid.largest_deviation = deviation.largest;
      solid.deviation = deviation.rms;
      solid.faces = made.handle.faces;
      solid.poles = made.handle.poles;
      write_file(solid.file, written.step);
      if (solid.deviation <= kWithin) break;
    }
    return solid;
  } catch (const UsageError& error) {
    return error.what();
  } catch (const NumericalError& error) {
    return error.what();
  }
}

}  // namespace palmar
