// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/solids.h"

#include <gmock/gmock.h>

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/product/primitives.h"

namespace palmar::cad {
namespace {

using Given = std::vector<std::pair<std::string, double>>;

CadModel make(const std::string& kind, const Given& given = {}) {
  const product::ParametricKind& known = product::parametric_kind(kind);
  return make_kind_solid(known, product::complete_values(known, given));
}

double volume(const std::string& kind, const Given& given) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(make(kind, given).impl().shape, properties, 1e-7);
  return properties.Mass();
}

Vec3 size_of(const CadModel& model) {
  Box3 box;
  for (const Vec3& v : tessellate(model, {.chordal_error = 0.02}).mesh.vertices) box.extend(v);
  return box.sizes();
}

/// Volume of a section of this area and perimeter, convex and smooth, swept over `length` with both
/// ends rounded with r: the section shrinks by d = r - sqrt(r^2 - x^2), x from 0 to r, to
/// area - perimeter d + pi d^2 (Steiner), and the integrals of d and d^2 are r^2 (1 - pi / 4) and
/// r^3 (5 / 3 - pi / 2).
double rounded_bar(double area, double perimeter, double length, double r) {
  return area * length - 2.0 * perimeter * r * r * (1.0 - std::numbers::pi / 4.0) +
         2.0 * std::numbers::pi * r * r * r * (5.0 / 3.0 - std::numbers::pi / 2.0);
}

TEST(KindSolids, HaveTheVolumesOfTheirClosedForms) {
  const double exact = 5e-5;  // relative; the kernel integrates numerically
  const auto expect = [&](double found, double truth) {
    EXPECT_NEAR(found / truth, 1.0, exact) << found << " for " << truth;
  };
  expect(volume("cylinder", {{"diameter_mm", 35}, {"length_mm", 120}}),
         std::numbers::pi / 4 * 35 * 35 * 120);
  expect(volume("cylinder", {{"diameter_mm", 36}, {"length_mm", 120}, {"end_fillet_mm", 5}}),
         rounded_bar(std::numbers::pi * 18 * 18, std::numbers::pi * 36, 120, 5));
  expect(volume("elliptic_handle",
                {{"width_mm", 28}, {"depth_mm", 40}, {"length_mm", 110}, {"end_fillet_mm", 0}}),
         std::numbers::pi / 4 * 28 * 40 * 110);
  const double thin = 20 - 130 * std::tan(3 * std::numbers::pi / 180);
  expect(volume("tapered_handle",
                {{"diameter_mm", 40}, {"length_mm", 130}, {"taper_deg", 3}, {"end_fillet_mm", 0}}),
         std::numbers::pi * 130 / 3 * (20 * 20 + 20 * thin + thin * thin));
  expect(
      volume("prism", {{"width_mm", 40}, {"depth_mm", 30}, {"length_mm", 150}, {"fillet_mm", 6}}),
      150 * (40 * 30 - (4 - std::numbers::pi) * 36));
  expect(volume("prism", {{"width_mm", 40},
                          {"depth_mm", 30},
                          {"length_mm", 150},
                          {"fillet_mm", 6},
                          {"end_fillet_mm", 4}}),
         rounded_bar(40 * 30 - (4 - std::numbers::pi) * 36, 140 - (8 - 2 * std::numbers::pi) * 6,
                     150, 4));
  expect(volume("bicycle_grip", {{"end_fillet_mm", 0}}),
         std::numbers::pi / 4 * (32 * 32 - 22 * 22) * 136);
  expect(volume("phone", {{"width_mm", 70},
                          {"height_mm", 140},
                          {"thickness_mm", 8},
                          {"corner_mm", 10},
                          {"fillet_mm", 3}}),
         rounded_bar(70 * 140 - (4 - std::numbers::pi) * 100, 420 - (8 - 2 * std::numbers::pi) * 10,
                     8, 3));
  expect(volume("sphere", {{"diameter_mm", 60}}), std::numbers::pi / 6 * 60 * 60 * 60);
  expect(volume("ellipsoid", {{"x_mm", 50}, {"y_mm", 60}, {"z_mm", 120}}),
         std::numbers::pi / 6 * 50 * 60 * 120);
}

TEST(KindSolids, AScrewdriverWithoutNeckAndFlutesIsARoundedBar) {
  // 2e-4: a spline goes through ten points of each rounding.
  EXPECT_NEAR(volume("screwdriver_handle", {{"diameter_mm", 30},
                                            {"neck_diameter_mm", 30},
                                            {"collar_diameter_mm", 30},
                                            {"flute_depth_mm", 0},
                                            {"length_mm", 110},
                                            {"end_fillet_mm", 5}}) /
                  rounded_bar(std::numbers::pi * 15 * 15, std::numbers::pi * 30, 110, 5),
              1.0, 2e-4);
}

TEST(KindSolids, HaveTheSizeThatTheirParametersGive) {
  const double tolerance = 0.06;  // mm; chords of 0.02 on both sides, and splines between points
  const auto expect = [&](const std::string& kind, const Vec3& size) {
    EXPECT_LT((size_of(make(kind)) - size).cwiseAbs().maxCoeff(), tolerance)
        << kind << ": " << size_of(make(kind)).transpose();
  };
  expect("cylinder", {48, 48, 150});
  expect("elliptic_handle", {28, 38, 140});
  expect("prism", {40, 30, 150});
  expect("bottle", {66, 66, 220});
  expect("bicycle_grip", {32, 32, 136});
  expect("phone", {72, 8, 148});
  expect("sphere", {60, 60, 60});
  expect("ellipsoid", {50, 60, 120});
  EXPECT_NEAR(size_of(make("pistol_grip")).x(), 32, tolerance);
  EXPECT_NEAR(size_of(make("pistol_grip")).z(), 105, tolerance);
  EXPECT_NEAR(size_of(make("knife_handle")).x(), 20, tolerance);
  EXPECT_NEAR(size_of(make("knife_handle")).z(), 118, tolerance);
  // Beside a rounding of 6 mm the spline stands out by 0.03 mm.
  EXPECT_NEAR(size_of(make("screwdriver_handle")).x(), 33, 0.1);
  EXPECT_NEAR(size_of(make("screwdriver_handle")).z(), 108, tolerance);
  // Rounding takes the thick end's edge.
  EXPECT_NEAR(size_of(make("tapered_handle", {{"end_fillet_mm", 0}})).x(), 38, tolerance);
}

TEST(KindSolids, EveryFaceHasAName) {
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    const CadModel model = make(kind.name);
    std::set<std::string> names;
    for (const auto& [number, name] : model.impl().face_name) names.insert(name);
    EXPECT_EQ(std::ssize(names), model.face_count()) << kind.name;
  }
}

// What a study says of "face 5" of a made prism is what its STEP file calls face 5.
TEST(KindSolids, CylinderAndPrismNumberTheirFacesAsTheAnalyticOnes) {
  const auto expect_same = [](const CadModel& model, const product::Product& product) {
    ASSERT_NE(product.faces, nullptr);
    ASSERT_EQ(static_cast<std::size_t>(model.face_count()), product.faces->face.size());
    for (const product::ProductFace& face : product.faces->face) {
      EXPECT_EQ(model.impl().face_name.at(face.number), face.name);
    }
  };
  expect_same(make("cylinder"), product::make_cylinder_product({}));
  expect_same(make("prism"), product::make_prism_product({}));
  expect_same(make("prism", {{"fillet_mm", 0}}),
              product::make_prism_product({.fillet_radius = 0.0}));
}

/// Random values within ranges and relations, by rejection.
product::KindValues random_values(const product::ParametricKind& kind, RandomStream& random) {
  for (;;) {
    Given given;
    for (const product::KindParameter& one : kind.parameters) {
      double value = 0.0;
      if (one.highest > 100.0 * std::max(one.lowest, 1.0)) {  // over orders of magnitude
        const double low = std::max(one.lowest, 0.1);
        value = low * std::pow(one.highest / low, random.uniform());
      } else {
        value = one.lowest + (one.highest - one.lowest) * random.uniform();
      }
      if (one.lowest == 0.0 && random.uniform() < 0.2) value = 0.0;
      given.emplace_back(one.name, one.is_whole ? std::round(value) : value);
    }
    try {
      return product::complete_values(kind, given);
    } catch (const UsageError&) {
    }
  }
}

/// `count` draws of each kind's range.
void expect_valid_solids(std::uint64_t seed, int count) {
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    RandomStream random(seed, 0);
    for (int i = 0; i < count; ++i) {
      const product::KindValues values = random_values(kind, random);
      try {
        const CadModel model = make_kind_solid(kind, values);
        const CadCheck check = check_cad(model);
        EXPECT_TRUE(check.is_good())
            << kind.name << ": " << ::testing::PrintToString(check.findings);
        EXPECT_EQ(check.solids, 1) << kind.name;
        for (const char* length : {"length_mm", "height_mm"}) {
          const auto found = values.find(length);
          if (found == values.end()) continue;
          EXPECT_NEAR(size_of(model).z(), found->second, 0.05 + 1e-3 * found->second) << kind.name;
        }
      } catch (const NumericalError& error) {
        ADD_FAILURE() << error.what();
      }
    }
  }
}

TEST(KindSolids, AreValidAndClosedWithinTheirLengths) { expect_valid_solids(6, 1); }

TEST(KindSolids, ThoroughAreValidAndClosedOverTheWholeRange) { expect_valid_solids(7, 6); }

TEST(KindSolids, AreTheSameAfterStepWithNamesAndNumbers) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "palmar_kind_solids";
  std::filesystem::create_directories(folder);
  Message::DefaultMessenger()->ChangePrinters().Clear();  // the STEP writer talks
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    const CadModel model = make(kind.name);
    const std::filesystem::path path = folder / (kind.name + ".step");
    write_step(path, model);
    const CadModel back = read_step(path).model;
    EXPECT_TRUE(check_cad(back).is_good()) << kind.name;
    EXPECT_NEAR(volume_of(back) / volume_of(model), 1.0, 1e-3) << kind.name;
    EXPECT_EQ(back.impl().face_name, model.impl().face_name) << kind.name;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palmar::cad
