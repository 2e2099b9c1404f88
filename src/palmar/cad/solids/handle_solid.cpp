// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/handle_solid.h"

#include <Standard_Failure.hxx>

#include <cmath>

#include "palmar/cad/solids/finished_solid.h"
#include "palmar/cad/solids/loft.h"
#include "palmar/core/error.h"

namespace palmar::cad {
CadModel make_handle_solid(const redesign::HandleShape& shape) {
  const redesign::HandleBody& body = shape.body;
  const auto section = [&](double z, double t) {
    // The surface begins where a face does, so that no face has its seam within.
    const Eigen::Vector2d point = shape.side_point(z, t + redesign::HandleRows::kFirstTurn);
    return SectionPoint{point.x(), point.y()};
  };
  try {
    // Ends are rounded in the same surface: rolled by the kernel, their faces have kinks in them
    // and curves beside them that offsets and shells fail on. Parted as the side they have no seam,
    // beside which offsets stray.
    const redesign::HandleRows rows = redesign::rows_for(shape);
    const double height = rows.end_radius * std::sin(redesign::kEndAngle);
    const NamedSolid solid =
        make_loft(section, {.bottom = body.bottom,
                            .top = body.top,
                            .end_fillet = rows.end_radius,
                            .end_angle = redesign::kEndAngle,
                            .splits_fillets = true,
                            .columns = rows.columns,
                            .row_distance = rows.distance,
                            .bands = {{body.bottom + height,
                                       body.top - height,
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

}  // namespace palmar::cad
