// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/handle_solid.h"

#include <Standard_Failure.hxx>

#include <cmath>

#include "palmar/cad/solids/finished_solid.h"
#include "palmar/cad/solids/loft.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

constexpr int kRoundColumns = 24;      // through which an elliptic section passes within 0.01 mm
constexpr int kSquareColumns = 24;     // more per unit of squareness
constexpr int kOutlineColumns = 72;    // where the original's outlines are kept
constexpr double kRows = 7.0;          // mm between sections
constexpr double kFirstSplit = 0.125;  // of a turn; half of a face

/// A whole number of columns for each of the four faces.
int columns_for(const HandleShape& shape) {
  const bool keeps = shape.kept_ends > 0.0 || !shape.kept_boxes.empty() || !shape.body.is_whole;
  const double wanted = kRoundColumns + kSquareColumns * shape.features.squareness;
  return keeps ? kOutlineColumns : 8 * static_cast<int>(std::ceil(wanted / 8.0));
}

}  // namespace

CadModel make_handle_solid(const HandleShape& shape) {
  const HandleBody& body = shape.body;
  const auto section = [&](double z, double t) {
    // The surface begins where a face does, so that no face has its seam within.
    const Eigen::Vector2d point = shape.side_point(z, t + kFirstSplit);
    return SectionPoint{point.x(), point.y()};
  };
  try {
    // Ends are rounded in the same surface: rolled by the kernel, their faces have kinks in them
    // and curves beside them that offsets and shells fail on.
    const double radius = body.is_whole ? shape.end_radius : 0.0;
    const NamedSolid solid =
        make_loft(section, {.bottom = body.bottom,
                            .top = body.top,
                            .end_fillet = radius,
                            .columns = columns_for(shape),
                            .row_distance = kRows,
                            .bands = {{body.bottom + radius,
                                       body.top - radius,
                                       {0.0, 0.25, 0.5, 0.75},
                                       {"palm", "left", "fingers", "right"}}}});
    return finished_solid(solid, "handle", body.product_from_handle);
  } catch (const Standard_Failure& failure) {
    throw NumericalError(std::string("the handle's solid can't be made: ") +
                         failure.DynamicType()->Name());
  } catch (const NumericalError& error) {
    throw NumericalError(std::string("the handle's solid can't be made: ") + error.what());
  }
}

}  // namespace palmar
