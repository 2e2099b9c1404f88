// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/feature_edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopoDS_Edge.hxx>
#include <cmath>
#include <numbers>

#include "palmar/cad/edits/feature_choice.h"
#include "palmar/cad/edits/surface_change.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

using ::testing::HasSubstr;
constexpr double kLength = 130, kWidth = 35;  // mm; the prism of Xie 2014

CadModel box() {
  return make_cad_model(
      BRepPrimAPI_MakeBox(gp_Pnt(-kWidth / 2, -kWidth / 2, -kLength / 2), kWidth, kWidth, kLength)
          .Shape(),
      "box");
}

CadModel cylinder(double radius, double length) {
  return make_cad_model(
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -length / 2), gp_Dir(0, 0, 1)), radius, length)
          .Shape(),
      "cylinder");
}

/// V = L (w^2 - (4 - pi) r^2)
double prism_volume(double radius, double width = kWidth) {
  return kLength * (width * width - (4 - std::numbers::pi) * radius * radius);
}

EditedModel fillet(const CadModel& model, const std::string& edges, double radius) {
  return edit_features(model, {.fillets = {{edges, radius}}});
}

template <typename Exception, typename Function>
std::string message_of(const Function& function) {
  try {
    function();
  } catch (const Exception& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(EditFeatures, LongEdgesOfABoxAreRoundedToTheClosedFormVolume) {
  for (const double radius : {0.5, 3.0, 10.0, 17.0}) {
    const EditedModel edited = fillet(box(), "long", radius);
    EXPECT_NEAR(edited.volume, prism_volume(radius), 1e-6 * edited.volume) << radius;
    EXPECT_NEAR(edited.volume_before, prism_volume(0), 1e-6 * edited.volume);
    EXPECT_EQ(edited.model.solid_count(), 1);
    EXPECT_EQ(edited.model.face_count(), 10);
  }
}

TEST(EditFeatures, AFilletThatIsThereTakesAnotherRadiusAsIfItHadBeenMadeWithIt) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  EXPECT_NEAR(fillet(r3, "long", 10).volume, prism_volume(10), 1e-6 * prism_volume(10));
  EXPECT_NEAR(fillet(r3, "long", 1).volume, prism_volume(1), 1e-6 * prism_volume(1));
  const EditedModel sharp = fillet(r3, "long", 0);
  EXPECT_NEAR(sharp.volume, prism_volume(0), 1e-6 * prism_volume(0));
  EXPECT_EQ(sharp.model.face_count(), 6);
}

TEST(EditFeatures, OneOfFourFilletsChangesAlone) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  const EdgeChoice all = choose_edges(r3, "long");
  ASSERT_EQ(all.rounded.size(), 4U);
  EXPECT_TRUE(all.sharp.empty());
  const EditedModel one = fillet(r3, "face=" + std::to_string(all.rounded.front()), 10);
  const double expected = kLength * (kWidth * kWidth - (4 - std::numbers::pi) * (3 * 9 + 100) / 4);
  EXPECT_NEAR(one.volume, expected, 1e-6 * expected);
}

TEST(EditFeatures, AFullyRoundedBoxIsRolledAgainDownToItsCorners) {
  // Volume of a box rounded all over by r (Steiner): core + 6 slabs + quarter cylinders + a ball.
  const auto steiner = [](double r) {
    const double a = kWidth - 2 * r, l = kLength - 2 * r;
    return a * a * l + 2 * r * (a * a + 2 * a * l) + std::numbers::pi * r * r * (2 * a + l) +
           4 * std::numbers::pi / 3 * r * r * r;
  };
  const EditedModel r3 = fillet(box(), "convex", 3);
  EXPECT_NEAR(r3.volume, steiner(3), 1e-6 * steiner(3));
  const EditedModel r5 = fillet(r3.model, "convex", 5);
  EXPECT_NEAR(r5.volume, steiner(5), 1e-6 * steiner(5));
}

TEST(EditFeatures, OffsetOfACylindersSideChangesItsDiameter) {
  const EditedModel thicker = edit_features(cylinder(16, 100), {.offsets = {{"sides", 2.0}}});
  EXPECT_NEAR(thicker.volume, std::numbers::pi * 18 * 18 * 100, 1e-6 * thicker.volume);
  const EditedModel thinner = edit_features(cylinder(16, 100), {.offsets = {{"sides", -3.5}}});
  EXPECT_NEAR(thinner.volume, std::numbers::pi * 12.5 * 12.5 * 100, 1e-6 * thicker.volume);
}

TEST(EditFeatures, AFaceThatMovesTakesItsFilletsWithIt) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  const EditedModel wider = edit_features(r3, {.offsets = {{"sides", 1.5}}});
  EXPECT_NEAR(wider.volume, prism_volume(3, kWidth + 3), 1e-6 * wider.volume);
  const EditedModel both =
      edit_features(r3, {.fillets = {{"long", 8}}, .offsets = {{"sides", 1.5}}});
  EXPECT_NEAR(both.volume, prism_volume(8, kWidth + 3), 1e-6 * both.volume);
}

TEST(EditFeatures, FacesThatRunIntoOneAnotherMoveTogetherOrNotAtAll) {
  // A bar of two half rounds: its four sides are one smooth surface.
  TopoDS_Shape bar = BRepPrimAPI_MakeBox(gp_Pnt(-10, -20, -50), 20, 40, 100).Shape();
  for (const double y : {-20.0, 20.0}) {
    const gp_Ax2 end(gp_Pnt(0, y, -50), gp_Dir(0, 0, 1));
    bar = BRepAlgoAPI_Fuse(bar, BRepPrimAPI_MakeCylinder(end, 10, 100).Shape()).Shape();
  }
  ShapeUpgrade_UnifySameDomain whole(bar);
  whole.Build();
  const CadModel rounded = make_cad_model(whole.Shape(), "bar");
  ASSERT_EQ(rounded.face_count(), 6);
  const EditedModel thicker = edit_features(rounded, {.offsets = {{"sides", 1.0}}});
  const double expected = 100 * (40 * 22 + std::numbers::pi * 11 * 11);
  EXPECT_NEAR(thicker.volume, expected, 1e-6 * expected);
}

TEST(EditFeatures, RoundedRimsOfAHandleComeBackAfterItsDiameterChanged) {
  const CadModel rimmed = fillet(cylinder(16, 100), "convex", 3).model;
  const EditedModel thicker = edit_features(rimmed, {.offsets = {{"sides", 2.0}}});
  const EditedModel made = fillet(cylinder(18, 100), "convex", 3);
  EXPECT_NEAR(thicker.volume, made.volume, 1e-6 * made.volume);
}

TEST(EditFeatures, TaperedSidesMakeAFrustum) {
  // Square frustum about its middle: V = L (w^2 + (L tan a)^2 / 3).
  const double angle = 3 * std::numbers::pi / 180;
  const EditedModel frustum = edit_features(box(), {.tapers = {{.angle = angle}}});
  const double lean = kLength * std::tan(angle);
  const double expected = kLength * (kWidth * kWidth + lean * lean / 3);
  EXPECT_NEAR(frustum.volume, expected, 1e-6 * expected);
  // A cone's edges still count as long, so its fillets can be chosen.
  EXPECT_EQ(choose_edges(frustum.model, "long").sharp.size(), 4U);
}

TEST(EditFeatures, TaperedSidesKeepTheirFillets) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  const EditedModel tapered = edit_features(r3, {.tapers = {{.angle = std::numbers::pi / 180}}});
  EXPECT_EQ(tapered.model.face_count(), 10);
  EXPECT_EQ(choose_edges(tapered.model, "long").rounded.size(), 4U);
}

TEST(EditFeatures, ARingGrooveTakesAwayWhatPappusSays) {
  // Section: the part of a disk of radius R that dips by d below the line: circular segment.
  const double r = 16, R = 8, d = 1.5;
  const GrooveEdit groove{.ring_at = 10, .radius = R, .depth = d};
  const EditedModel grooved = edit_features(cylinder(r, 100), {.grooves = {groove}});
  const double half = std::acos((R - d) / R);  // half the segment's angle
  const double area = R * R * (half - std::sin(half) * std::cos(half));
  const double centroid = 2 * R * std::pow(std::sin(half), 3) /
                          (3 * (half - std::sin(half) * std::cos(half)));  // from the centre
  const double from_axis = r - d + R - centroid;
  const double expected = std::numbers::pi * r * r * 100 - 2 * std::numbers::pi * from_axis * area;
  EXPECT_NEAR(grooved.volume, expected, 1e-6 * expected);
  GrooveEdit rounded = groove;
  rounded.rim = 2.0;
  const EditedModel soft = edit_features(cylinder(r, 100), {.grooves = {rounded}});
  EXPECT_LT(soft.volume, grooved.volume);
}

TEST(EditFeatures, ARingFindsTheAxisOfATurnedBodyWhoseBoxIsOblique) {
  const TopoDS_Shape cone =
      BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(5, 5, -50), gp_Dir(0, 0, 1)), 19, 14, 100).Shape();
  const CadModel rimmed = fillet(make_cad_model(cone, "cone"), "convex", 4).model;
  const GrooveEdit groove{.ring_at = 0, .radius = 10, .depth = 1.5};
  const EditedModel grooved = edit_features(rimmed, {.grooves = {groove}});
  // About that of a cylinder of its mean radius.
  const double half = std::acos(8.5 / 10);
  const double segment = 100 * (half - std::sin(half) * std::cos(half));
  EXPECT_NEAR(grooved.volume_before - grooved.volume, 2 * std::numbers::pi * 16 * segment,
              0.05 * 2 * std::numbers::pi * 16 * segment);
}

TEST(EditFeatures, AGrooveThatIsLongerByATakesAwayASegmentTimesAMore) {
  const double R = 8, d = 1.5;
  const auto cut_by = [&](int points) {
    GrooveEdit groove{.radius = R, .depth = d};
    for (int i = 0; i <= points; ++i) groove.points.push_back({kWidth / 2, 0, -30.0 + i * 10.0});
    const EditedModel grooved = edit_features(box(), {.grooves = {groove}});
    return grooved.volume_before - grooved.volume;
  };
  const double half = std::acos((R - d) / R);
  const double segment = R * R * (half - std::sin(half) * std::cos(half));
  const double longer = cut_by(6), shorter = cut_by(4);
  // Both ends run out alike, but for how the kernel approximates them.
  EXPECT_NEAR(longer - shorter, segment * 20, 2e-3 * segment * 20);
  EXPECT_GT(shorter, segment * 40);
}

TEST(EditFeatures, NamesAndBodiesRemain) {
  auto impl = CadModel::Impl(box().impl());
  impl.face_name[1] = "left";
  const CadModel named(std::make_shared<const CadModel::Impl>(impl));
  const CadModel after = fillet(named, "long", 3).model;
  ASSERT_EQ(after.impl().face_name.size(), 1U);
  EXPECT_EQ(after.impl().face_name.begin()->second, "left");
  EXPECT_EQ(after.impl().bodies.front().name, "box");
}

TEST(EditFeatures, WhatCannotBeMadeIsReportedWithFeatureAndValue) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  EXPECT_THAT(message_of<NumericalError>([&] { fillet(r3, "long", 18); }),
              HasSubstr("fillet of 18 mm on fillets"));
  EXPECT_THAT(message_of<NumericalError>([&] {
                edit_features(cylinder(16, 100), {.offsets = {{"sides", -17.0}}});
              }),
              HasSubstr("offset of -17 mm of face"));
  EXPECT_THAT(message_of<NumericalError>([&] {
                edit_features(box(), {.offsets = {{"sides", -20.0}}});
              }),
              HasSubstr("offset of -20 mm of faces"));
  EXPECT_THAT(message_of<NumericalError>([&] {
                edit_features(cylinder(16, 100),
                              {.grooves = {{.ring_at = 90, .radius = 5, .depth = 1}}});
              }),
              HasSubstr("doesn't reach 90 mm"));
}

TEST(EditFeatures, UnknownEdgesFacesAndWordsAreReportedWithWhatThereIs) {
  EXPECT_EQ(message_of<UsageError>([] { fillet(box(), "edge=99", 3); }),
            "edge 99: the product has edges 1 to 12");
  EXPECT_EQ(message_of<UsageError>([] { fillet(box(), "face=0", 3); }),
            "face 0: the product has faces 1 to 6");
  EXPECT_THAT(message_of<UsageError>([] { fillet(box(), "longest", 3); }),
              HasSubstr("allowed are long, convex"));
  EXPECT_THAT(message_of<UsageError>([] { fillet(box(), "name=grip", 3); }),
              HasSubstr("no face is named \"grip\""));
  EXPECT_THAT(message_of<UsageError>([] { fillet(box(), "concave", 3); }),
              HasSubstr("the product has none"));
  EXPECT_THAT(message_of<UsageError>([] { fillet(box(), "long", -1); }),
              HasSubstr("a radius of -1 mm"));
  EXPECT_THAT(message_of<UsageError>([] { fillet(CadModel(), "long", 1); }), HasSubstr("no faces"));
  const TopoDS_Edge line = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Edge();
  EXPECT_THAT(message_of<UsageError>([&] { fillet(make_cad_model(line, "wire"), "long", 1); }),
              HasSubstr("no faces"));
}

TEST(SurfaceChange, IsTheDistanceBetweenTheSurfacesBothWays) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  // An edge of 90 degrees: (sqrt 2 - 1) times the change of its radius.
  const double root = std::sqrt(2.0) - 1;
  EXPECT_NEAR(surface_change(r3, fillet(r3, "long", 10).model).largest, 7 * root, 0.02);
  EXPECT_NEAR(surface_change(r3, box()).largest, 3 * root, 0.02);
  EXPECT_NEAR(surface_change(r3, r3).largest, 0.0, 1e-9);
  const CadModel bar = cylinder(16, 100);
  const CadModel thicker = edit_features(bar, {.offsets = {{"sides", 2.0}}}).model;
  EXPECT_NEAR(surface_change(bar, thicker).largest, 2.0, 0.03);
  // Ends that must stay: their own points do, though they grow.
  const std::vector<int> ends = choose_faces(bar, "ends"), sides = choose_faces(bar, "sides");
  EXPECT_NEAR(surface_change(bar, thicker, ends).of_faces, 0.0, 0.02);
  EXPECT_NEAR(surface_change(bar, thicker, sides).of_faces, 2.0, 0.03);
}

TEST(ChooseEdges, KnowFilletsByTheirCurvatureAndDirection) {
  const CadModel r3 = fillet(box(), "long", 3).model;
  EXPECT_EQ(choose_edges(r3, "long").rounded.size(), 4U);
  EXPECT_EQ(choose_edges(r3, "convex").sharp.size(), 16U);  // rims of both ends
  // A whole cylinder rounds nothing, even if both of its rims are rounded smoothly into it.
  const CadModel rimmed = fillet(cylinder(16, 100), "convex", 3).model;
  EXPECT_EQ(choose_edges(rimmed, "convex").rounded.size(), 2U);
  EXPECT_THROW(choose_edges(rimmed, "long"), UsageError);
}

TEST(ChooseEdges, ATurnedBodyGivesTheSameChoice) {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(3, 2, 1), gp_Dir(1, 2, 3)), 0.7);
  const CadModel turned =
      make_cad_model(BRepBuilderAPI_Transform(box().impl().shape, turn).Shape(), "turned");
  EXPECT_EQ(choose_edges(turned, "long").sharp, choose_edges(box(), "long").sharp);
  EXPECT_EQ(choose_faces(turned, "sides"), choose_faces(box(), "sides"));
  EXPECT_EQ(choose_faces(turned, "ends").size(), 2U);
}

}  // namespace
}  // namespace palmar::cad
