// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/replace_handle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <GProp_GProps.hxx>
#include <gp_Ax2.hxx>

#include <cmath>
#include <numbers>
#include <set>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kRadius = 15.0;  // mm

TopoDS_Shape rod() {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -70), gp_Dir(0, 0, 1)), kRadius, 130.0)
      .Shape();
}

/// A hammer: a rod along z from -70 to 60 mm and a head of 60 x 20 x 25 mm from 55 mm on.
TopoDS_Shape hammer() {
  const TopoDS_Shape head = BRepPrimAPI_MakeBox(gp_Pnt(-30, -10, 55), 60, 20, 25).Shape();
  return BRepAlgoAPI_Fuse(rod(), head).Shape();
}

/// Its handle from -50 to 40 mm, `thicker` mm of width and depth more.
redesign::HandleShape handle(double thicker) {
  redesign::HandleShape shape;
  redesign::HandleBody& body = shape.body;
  body.bottom = -50.0;
  body.top = 40.0;
  body.run_out = 14.0;
  body.is_free = {false, false};
  body.centre = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  body.outlines.columns = 144;
  for (int j = 0; j <= 45; ++j) {
    body.outlines.z.push_back(-50.0 + 2.0 * j);
    body.outlines.radius.emplace_back(144, kRadius - 0.02);  // as triangles have it
  }
  shape.features = {.width = 2.0 * kRadius + thicker, .depth = 2.0 * kRadius + thicker};
  return shape;
}

TEST(ReplaceHandle, OnlyTheHandleChangesAndItIsOneValidSolidWithoutSlivers) {
  const TopoDS_Shape before = hammer();
  const double volume = volume_of(make_cad_model(before, "hammer"));
  const CadModel model = replace_handle(make_cad_model(before, "hammer"), handle(8.0));
  const CadCheck check = check_cad(model);
  EXPECT_TRUE(check.is_good()) << (check.findings.empty() ? "" : check.findings.front());
  EXPECT_EQ(check.solids, 1);
  EXPECT_EQ(body_names(model), std::vector<std::string>{"hammer"});
  // Radius 15 + 4 s(z), s = 3 t^2 - 2 t^3 over 14 mm at both ends: integrals of s and s^2 are 1 / 2
  // and 13 / 35 of them.
  const double run_out = 2.0 * 14.0, middle = 90.0 - run_out;
  const double added = pi * (2.0 * kRadius * 4.0 * (middle + run_out / 2.0) +
                             16.0 * (middle + run_out * 13.0 / 35.0));
  EXPECT_NEAR(check.volume - volume, added, 0.01 * added);
  std::set<std::string> names;
  for (const auto& [number, name] : model.impl().face_name) names.insert(name);
  for (const char* name : {"palm", "fingers", "left", "right"}) EXPECT_EQ(names.count(name), 1U);
  const Box3 box = box_of(model);
  EXPECT_NEAR(box.max().z(), 80.0, 1e-3);
  EXPECT_NEAR(box.max().x(), 30.0, 1e-3);
  EXPECT_NEAR(box.min().z(), -70.0, 1e-3);
  // Four of the handle, two steps, the rod's ends beyond them, an end, and the head's.
  EXPECT_LE(check.faces, 20);
  for (int e = 1; e <= model.edge_count(); ++e) {
    GProp_GProps length;
    BRepGProp::LinearProperties(model.impl().edges(e), length);
    EXPECT_GT(length.Mass(), 1.0) << "edge " << e;  // mm
  }
}

TEST(ReplaceHandle, AThinnerOneLeavesNothingOfTheOldOne) {
  const CadModel model = replace_handle(make_cad_model(hammer(), "hammer"), handle(-6.0));
  const CadCheck check = check_cad(model);
  EXPECT_TRUE(check.is_good());
  const double volume = volume_of(make_cad_model(hammer(), "hammer"));
  const double run_out = 2.0 * 14.0, middle = 90.0 - run_out;
  const double taken = pi * (2.0 * kRadius * 3.0 * (middle + run_out / 2.0) -
                             9.0 * (middle + run_out * 13.0 / 35.0));
  EXPECT_NEAR(volume - check.volume, taken, 0.02 * taken);
}

TEST(ReplaceHandle, SeveralBodiesAreRefused) {
  std::vector<CadModel::Impl::Body> bodies = {{rod(), "rod", {}}};
  bodies.push_back({BRepPrimAPI_MakeBox(gp_Pnt(100, 0, 0), 5, 5, 5).Shape(), "box", {}});
  EXPECT_THAT([&] { replace_handle(make_cad_model(bodies), handle(4.0)); },
              ThrowsMessage<NumericalError>(HasSubstr("2 bodies")));
}

}  // namespace
}  // namespace palmar::cad
