// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Whether the first hold that is found is one that people do, on ten scanned and 34 made products.
// What people do was written down before the choice was run (holds/people.toml, holds/made.toml,
// holds/moved.toml).
//
// PALMAR_HOLDS_TABLE=FILE writes what people do against what is found as a Markdown table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include "holds/made_products.h"
#include "holds/peoples_holds.h"
#include "holds/solid_shapes.h"
#include "holds/tried_products.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/primitives.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

// Products whose first hold isn't one that people do, and why not. A product that is listed here
// and held as people do fails, too: then it is struck off.
const std::map<std::string, std::string>& known_misses() {
  static const std::map<std::string, std::string> misses = {
      {"handheld_console", "fingertips come down where its weight is nearest, at its lower edge"},
      {"large_marker", "its two ends are alike: nothing tells under which cap the tip is"},
      {"palm_sander", "the dome's axis isn't found, so the palm isn't offered over its top"},
      {"tv_remote", "its two ends are alike: nothing tells where the window is"},
      {"flat_mouse", "its two ends are alike: nothing tells where the buttons are"},
  };
  return misses;
}

const std::vector<PeoplesHold>& all_peoples_holds() {
  static const std::vector<PeoplesHold> all = [] {
    const std::filesystem::path folder =
        std::filesystem::path(PALMAR_SOURCE_DIR) / "tests" / "holds";
    std::vector<PeoplesHold> list = read_peoples_holds(folder / "people.toml");
    for (const char* made : {"made.toml", "moved.toml"}) {
      for (PeoplesHold& hold : read_peoples_holds(folder / made)) list.push_back(std::move(hold));
    }
    return list;
  }();
  return all;
}

std::vector<PeoplesHold> peoples_holds(const std::string& product) {
  std::vector<PeoplesHold> ways;
  for (const PeoplesHold& hold : all_peoples_holds()) {
    if (hold.product == product) ways.push_back(hold);
  }
  return ways;
}

// Ranked once for all tests.
const grasp::RankedHolds& ranked(const hand::Hand& hand, const std::string& product) {
  static std::map<std::string, grasp::RankedHolds> known;
  const auto found = known.find(product);
  if (found != known.end()) return found->second;
  return known.emplace(product, grasp::rank_holds(hand, tried_product(product))).first->second;
}

std::string words_of(const grasp::RankedHold& found) {
  const Vec3 centre = centre_of(found);
  return fmt::format("{} ({:.2f}), centre ({:.0f}, {:.0f}, {:.0f}) mm", found.words, found.score,
                     centre.x(), centre.y(), centre.z());
}

class PeoplesHolds : public TemplateTest, public testing::WithParamInterface<std::string> {};

TEST_P(PeoplesHolds, FirstHoldIsOneThatPeopleDo) {
  const std::vector<PeoplesHold> people = peoples_holds(GetParam());
  const grasp::RankedHolds& found = ranked(hand(), GetParam());
  std::string miss = "no hold was found";
  std::string first = "none";
  if (!found.holds.empty()) {
    miss = objection(people, found.holds.front());
    first = words_of(found.holds.front());
  }
  const auto known = known_misses().find(GetParam());
  if (known == known_misses().end()) {
    EXPECT_EQ(miss, "") << GetParam() << " is held so: " << first;
  } else {
    EXPECT_NE(miss, "") << GetParam() << " is held as people do now (" << first
                        << "); strike it off the known misses: " << known->second;
  }
}

/// Every third of the tried products, or the others, which only run before a release.
std::vector<std::string> some_products(bool is_third) {
  std::vector<std::string> some;
  const std::vector<std::string> all = tried_products();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((i % 3 == 0) == is_third) some.push_back(all[i]);
  }
  return some;
}

INSTANTIATE_TEST_SUITE_P(Products, PeoplesHolds, testing::ValuesIn(some_products(true)),
                         [](const auto& one) { return one.param; });
INSTANTIATE_TEST_SUITE_P(ThoroughProducts, PeoplesHolds, testing::ValuesIn(some_products(false)),
                         [](const auto& one) { return one.param; });

class Holds : public TemplateTest {};

TEST_F(Holds, ThoroughIndexFingerLiesOnTheTrigger) {
  for (const PeoplesHold& people : all_peoples_holds()) {
    if (!people.index_fingertip) continue;
    if (people.product == "power_drill" && !has_scans()) continue;
    const grasp::RankedHolds& found = ranked(hand(), people.product);
    ASSERT_FALSE(found.holds.empty()) << people.product;
    const Vec3 tip = index_fingertip(hand(), found.holds.front());
    // Known shortfall: on the drill 13 mm below the trigger, since its tail stops the ball of the
    // thumb before the hand is as high as people have it. The others are within 5 mm.
    const double most = people.product == "power_drill" ? 15.0 : 5.0;
    EXPECT_LT(people.index_fingertip->exteriorDistance(tip), most)
        << people.product << ": the tip of the index finger is at " << tip.transpose() << " mm";
  }
}

TEST_F(Holds, ThoroughScoresFallAndAreTheSumsOfTheirTerms) {
  for (const std::string& product : tried_products()) {
    SCOPED_TRACE(product);
    double before = 0.2;  // such a difference from the best doesn't change the order (hold.h)
    for (const grasp::RankedHold& found : ranked(hand(), product).holds) {
      EXPECT_LE(found.score, before + 1e-9) << found.words;
      before = before == 0.2 ? found.score + 0.2 : std::min(before, found.score);
      double sum = 0.0;
      for (const grasp::HoldTerm& term : found.terms) {
        EXPECT_LE(term.score, 1e-12) << term.name;
        EXPECT_FALSE(term.words.empty()) << term.name;
        sum += term.score;
      }
      EXPECT_NEAR(sum, found.score, 1e-9) << found.words;
    }
  }
}

// A head across the end of a handle is what it works with: wherever its weight is, in the handle,
// where both meet or in the head, the hand is on the handle.
TEST_F(Holds, OfAHeadAcrossTheEndOfAHandleAreByTheHandle) {
  for (const double thick : {9.0, 13.0, 17.0}) {
    for (const double length : {90.0, 110.0, 130.0}) {
      const product::Sdf handle = sdf_bar({{0, 0, 0}, {0, 190, 0}}, {12, 12});
      const product::Sdf head =
          sdf_bar({{-0.5 * length, 190, 0}, {0.5 * length, 190, 0}}, {thick, thick});
      const Lattice lattice = {Box3(Vec3(-90, -15, -22), Vec3(90, 215, 22)), Vec3(3, 3, 3), {}};
      const product::Product hammer =
          product::make_product("hammer", net_mesh_of(product::sdf_union(handle, head), lattice),
                                product::UnitDecision{}, "made for a test");
      const grasp::RankedHolds found = grasp::rank_holds(hand(), hammer);
      ASSERT_FALSE(found.holds.empty());
      const Vec3 centre = centre_of(found.holds.front());
      EXPECT_LT(centre.y(), 160.0) << "head " << length << " mm long, " << 2.0 * thick
                                   << " mm thick: " << words_of(found.holds.front());
      EXPECT_LT(std::abs(centre.x()), 15.0) << words_of(found.holds.front());
    }
  }
}

// Bars that look alike from the other side or are round are taken from the side from which the hand
// came to the one before, however their meshes begin.
TEST_F(Holds, OfSymmetricProductsAreTakenLikeThoseOfAnotherOne) {
  const auto prism = [](double width, double depth) {
    return product::make_prism_product({.width = width, .depth = depth, .length = 150.0});
  };
  const auto cylinder = [&](double diameter, double turn) {
    const Quat about(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    return moved(product::make_cylinder_product({.diameter = diameter, .length = 130.0}),
                 {about, Vec3::Zero()});
  };
  for (const double other_way : {0.0, 1.0, 2.0, 3.0}) {
    const Quat way(Eigen::AngleAxisd(0.5 * std::numbers::pi * other_way, Vec3::UnitZ()));
    for (const product::Product& product : {prism(45.0, 20.0), prism(40.0, 30.0), prism(30.0, 30.0),
                                            cylinder(40.0, 0.0), cylinder(43.0, 0.6)}) {
      grasp::HoldOptions options;
      const grasp::RankedHolds first = grasp::rank_holds(hand(), product, options);
      ASSERT_FALSE(first.holds.empty());
      // Half turns of a prism are the same to it, all turns of a cylinder.
      const bool is_round = product.name == "cylinder";
      if (!is_round && std::fmod(other_way, 2.0) != 0.0) continue;
      options.like = way * first.holds[0].grasp.product_from_hand.rotation;
      const grasp::RankedHolds like = grasp::rank_holds(hand(), product, options);
      EXPECT_LT(like.holds[0].grasp.product_from_hand.rotation.angularDistance(*options.like),
                10.0 * std::numbers::pi / 180.0)
          << product.name << ", turned by " << 90.0 * other_way;
    }
  }
}

TEST_F(Holds, TableOfWhatPeopleDoAndWhatIsFound) {
  const char* file = std::getenv("PALMAR_HOLDS_TABLE");
  if (file == nullptr) GTEST_SKIP() << "PALMAR_HOLDS_TABLE names no file to write to";
  std::ofstream out(file);
  out << "| product | what people do | first hold found (score), centre | as people? | rank of "
         "people's "
         "hold |\n|---|---|---|---|---|\n";
  int hits = 0, products = 0;
  for (const std::string& product : tried_products()) {
    const std::vector<PeoplesHold> people = peoples_holds(product);
    const grasp::RankedHolds& found = ranked(hand(), product);
    std::string what;
    for (const PeoplesHold& way : people) {
      what += (what.empty() ? "" : "; or ") + way.part + " (" + fmt::format("{}", way.grips[0]);
      for (std::size_t g = 1; g < way.grips.size(); ++g) what += ", " + way.grips[g];
      what += ")";
    }
    std::string rank = fmt::format("not among {}", found.holds.size());
    for (std::size_t i = found.holds.size(); i-- > 0;) {
      if (objection(people, found.holds[i]).empty()) rank = fmt::format("{}", i + 1);
    }
    const std::string miss =
        found.holds.empty() ? "no hold was found" : objection(people, found.holds.front());
    ++products;
    hits += miss.empty() ? 1 : 0;
    out << "| " << product << " | " << what << " | "
        << (found.holds.empty() ? "none" : words_of(found.holds.front())) << " | "
        << (miss.empty() ? "yes" : "no: " + miss) << " | " << rank << " |\n";
  }
  out << "\n" << hits << " of " << products << " products are first held as people hold them.\n";
  EXPECT_TRUE(out.good()) << file;
}

TEST(MadeProducts, AreClosedManifoldsAndHaveAnEntryOfWhatPeopleDo) {
  // One tunnel for each opening that a hand, a finger or a ring goes through, none besides.
  const std::map<std::string, int> tunnels = {
      {"kettle", 1}, {"jug", 1}, {"suitcase", 1},       {"scissors", 2},     {"bucket", 1},
      {"spade", 1},  {"key", 1}, {"tailors_shears", 2}, {"nail_scissors", 2}};
  std::set<std::string> made;
  for (const MadeShape& shape : made_shapes()) {
    SCOPED_TRACE(shape.name);
    made.insert(shape.name);
    const geometry::TriangleMesh mesh = net_mesh_of(shape.solid, shape.lattice);
    const geometry::TopologyReport report = geometry::examine_topology(mesh);
    EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
    EXPECT_EQ(report.components, 1);
    const auto tunnel = tunnels.find(shape.name);
    EXPECT_EQ(report.euler_number, 2 - 2 * (tunnel == tunnels.end() ? 0 : tunnel->second));
    EXPECT_GT(mesh.triangle_count(), 5000);
    EXPECT_LT(mesh.triangle_count(), 40000);
    EXPECT_FALSE(peoples_holds(shape.name).empty()) << "made.toml and moved.toml lack it";
  }
  EXPECT_EQ(made.size(), made_shapes().size()) << "two have the same name";
}

TEST(MadeProducts, HaveTheSizesThatTheyAreSaidToHave) {
  // Closed forms: the cube, its edges rounded by 2 mm; the tumbler's and bottle's height and width.
  const geometry::TriangleMesh cube =
      net_mesh_of(made_shape("cube_60mm").solid, made_shape("cube_60mm").lattice);
  double volume = 0.0;
  for (const auto& [a, b, c] : cube.triangles) {
    volume += cube.vertices[a].dot(cube.vertices[b].cross(cube.vertices[c])) / 6.0;
  }
  // 60^3 less (4 - pi) r^2 for each of the 12 edges' quarter: 3 directions x (4 - pi) 4 mm^2 x 60.
  EXPECT_NEAR(volume, 216000.0 - 3.0 * 0.858 * 4.0 * 60.0, 0.003 * 216000.0);
  struct Size {
    const char* name;
    Vec3 size;
  };
  for (const Size& s : {Size{"tumbler", {80, 80, 110}}, Size{"beer_bottle", {61, 61, 229}},
                        Size{"wine_glass", {80, 80, 210}}, Size{"dinner_plate", {260, 260, 22}},
                        Size{"computer_mouse", {116, 62, 39}}}) {
    Box3 box;
    const MadeShape& shape = made_shape(s.name);
    for (const Vec3& p : net_mesh_of(shape.solid, shape.lattice).vertices) box.extend(p);
    EXPECT_LT((box.sizes() - s.size).cwiseAbs().maxCoeff(), 1.5) << s.name;  // mm, half a cell
  }
}

}  // namespace
}  // namespace palmar::tests
