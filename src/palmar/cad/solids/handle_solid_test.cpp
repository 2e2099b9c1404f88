// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/handle_solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/product/primitives.h"

namespace palmar::cad {
namespace {

using std::numbers::pi;

/// A bar of 120 mm along (1, 1, 0), about (10, 0, 0).
redesign::HandleShape bar() {
  redesign::HandleShape shape;
  shape.body.is_whole = true;
  shape.body.bottom = -60.0;
  shape.body.top = 60.0;
  shape.body.centre = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  shape.body.product_from_handle = {
      Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(1.0, 1.0, 0.0).normalized()), Vec3(10.0, 0.0, 0.0)};
  shape.features = {.width = 30.0, .depth = 44.0};
  return shape;
}

TEST(HandleSolid, OfAnEllipticBarHasItsVolumeAndItsPlace) {
  const CadModel model = make_handle_solid(bar());
  const double volume = pi * 15.0 * 22.0 * 120.0;
  EXPECT_NEAR(volume_of(model), volume, 1e-3 * volume);
  const Box3 box = box_of(model);
  EXPECT_NEAR(box.center().x(), 10.0, 0.1);
  EXPECT_NEAR(box.center().y(), 0.0, 0.1);
  EXPECT_EQ(model.face_count(), 6);
}

TEST(HandleSolid, ThoroughIsValidWithFewPolesAndNamedFacesAndNearTheShapeForEveryFeature) {
  for (const redesign::HandleFeature& feature : redesign::handle_features()) {
    redesign::HandleShape shape = bar();
    shape.end_radius = 3.0;
    const double usual = feature.unit == "mm" ? 3.0 : feature.unit.empty() ? 0.15 : 8.0;
    if (feature.name != "width" && feature.name != "depth") {
      shape.features.*feature.value = usual / feature.scale;
    }
    const CadModel model = make_handle_solid(shape);
    const CadCheck check = check_cad(model);
    EXPECT_TRUE(check.is_good()) << feature.name << ": "
                                 << (check.findings.empty() ? "" : check.findings.front());
    // A quarter round and along: up to 14 by 24; twice as many along grooves.
    EXPECT_LE(most_poles(model), feature.name == "finger_grooves" ? 680 : 340) << feature.name;
    std::set<std::string> names;
    for (const auto& [number, name] : model.impl().face_name) names.insert(name);
    for (const char* name : {"palm", "fingers", "left", "right", "top", "bottom",
                             "top fillet, palm", "bottom fillet, left"}) {
      EXPECT_EQ(names.count(name), 1U) << feature.name << ": " << name;
    }
    // The solid's side against the shape that hands are to hold.
    const geometry::Rigid3 to_handle = shape.body.product_from_handle.inverse();
    double farthest = 0.0;
    for (const Vec3& vertex : tessellate(model, {.chordal_error = 0.02}).mesh.vertices) {
      const Vec3 x = to_handle * vertex;
      if (std::abs(x.z()) > 56.0) continue;
      farthest = std::max(farthest, std::abs(x.head<2>().norm() -
                                             shape.radius_at(x.z(), std::atan2(x.y(), x.x()))));
    }
    // mm; under the thumb's hollow, which is steeper than sections 7 mm apart can follow, 0.17
    EXPECT_LT(farthest, feature.name == "thumb_rest" ? 0.2 : 0.1) << feature.name;
  }
}

TEST(HandleSolid, IsRoundedUpToFlatEndsThatItMeetsAtAnAngle) {
  redesign::HandleShape shape = bar();
  shape.end_radius = 3.0;
  const CadModel model = make_handle_solid(shape);
  EXPECT_EQ(model.face_count(), 14);  // side and roundings in four, two ends
  // Rounded with r over an angle w the sections shrink inwards by r (1 - cos a) (Steiner: by
  // perimeter times that, less pi times its square); the perimeter by Ramanujan.
  const double h = std::pow((22.0 - 15.0) / 37.0, 2);
  const double perimeter = pi * 37.0 * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
  double lost = 0.0;
  constexpr int kSteps = 10000;
  for (int k = 0; k < kSteps; ++k) {
    const double a = redesign::kEndAngle * (k + 0.5) / kSteps, inset = 3.0 * (1.0 - std::cos(a));
    lost += 2.0 * (perimeter * inset - pi * inset * inset) * 3.0 * std::cos(a) *
            redesign::kEndAngle / kSteps;
  }
  EXPECT_NEAR(volume_of(make_handle_solid(bar())) - volume_of(model), lost, 0.02 * lost);
}

TEST(HandleSolid, OfALeaningHandleEndsInThePlanesOfItsEnds) {
  redesign::HandleShape shape = bar();
  shape.body.product_from_handle = {};
  shape.body.centre[1] = {0.0, 0.3};
  const CadModel model = make_handle_solid(shape);
  const double volume = pi * 15.0 * 22.0 * 120.0;  // Cavalieri
  EXPECT_NEAR(volume_of(model), volume, 1e-3 * volume);
  EXPECT_NEAR(box_of(model).min().z(), -60.0, 1e-3);
  EXPECT_NEAR(box_of(model).max().z(), 60.0, 1e-3);
}

}  // namespace
}  // namespace palmar::cad
