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

constexpr int kRoundColumns = 24;    // through which an elliptic section passes within 0.01 mm
constexpr int kSquareColumns = 24;   // more per unit of squareness
constexpr int kOutlineColumns = 72;  // where the original's outlines are kept
constexpr double kRows = 7.0;        // mm between sections

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
    const Eigen::Vector2d point = shape.side_point(z, t);
    return SectionPoint{point.x(), point.y()};
  };
  try {
    NamedSolid solid = make_loft(section, {.bottom = body.bottom,
                                           .top = body.top,
                                           .columns = columns_for(shape),
                                           .row_distance = kRows,
                                           .bands = {{body.bottom,
                                                      body.top,
                                                      {0.125, 0.375, 0.625, 0.875},
                                                      {"palm", "left", "fingers", "right"}}}});
    const double radius = body.is_whole ? shape.end_radius : 0.0;
    solid = round_face(solid, "bottom", radius, "bottom fillet");
    solid = round_face(solid, "top", radius, "top fillet");
    return finished_solid(solid, "handle", body.product_from_handle);
  } catch (const Standard_Failure& failure) {
    throw NumericalError(std::string("the handle's solid can't be made: ") +
                         failure.DynamicType()->Name());
  } catch (const NumericalError& error) {
    throw NumericalError(std::string("the handle's solid can't be made: ") + error.what());
  }
}

}  // namespace palmar
