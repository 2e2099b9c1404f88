// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The fit of the weights of a hold's reasons, as docs/method/holds.md states it: a conditional
// logit over the holds that the hand was closed on, by the products of tests/holds and 16 holds of
// GRAB.
//
// PALMAR_HOLDS_FIT=FILE fits them, in some minutes, and writes weights and likelihoods as Markdown.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "holds/peoples_holds.h"
#include "holds/tried_products.h"
#include "palmar/grasp/holds/hold_terms.h"
#include "palmar/grasp/holds/opposed_holds.h"
#include "palmar/records/product/product_file.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

const std::array<const char*, 7> kTerms = {"handle",           "girth",       "place along it",
                                           "thumb's side",     "palm's side", "trigger",
                                           "room for the hand"};
constexpr int kCount = 7;
using Weights = Eigen::Matrix<double, kCount, 1>;

/// A product's candidates as the fit sees them.
struct Seen {
  std::string name;  ///< products of the same name are left out together
  bool is_grab = false;
  Eigen::Matrix<double, Eigen::Dynamic, kCount> terms;  ///< not weighted
  Eigen::VectorXd fixed;                                ///< what the others add up to
  Eigen::VectorXd right;                                ///< 1 for a hold that people do, else 0
};

void add_candidate(const grasp::RankedHold& hold, Eigen::Index row, Seen& seen) {
  constexpr double kLeast = -12.0;  // what is out of the question is so
  for (const grasp::HoldTerm& term : hold.terms) {
    const auto at = std::find(kTerms.begin(), kTerms.end(), term.name);
    if (at == kTerms.end() || grasp::is_non_prehensile(hold.hold.grip)) {
      seen.fixed[row] += std::max(term.score, kLeast);
    } else {
      seen.terms(row, at - kTerms.begin()) =
          std::max(term.score / grasp::weight_of(term.name), kLeast);
    }
  }
}

Seen seen_of(const std::string& name, const grasp::RankedHolds& found) {
  Seen seen;
  seen.name = name;
  const auto count = static_cast<Eigen::Index>(found.holds.size());
  seen.terms.setZero(count, kCount);
  seen.fixed.setZero(count);
  seen.right.setZero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    add_candidate(found.holds[static_cast<std::size_t>(i)], i, seen);
  }
  return seen;
}

/// Across the fingers' row, along them, and out of the palm, as wrist and fingertips say.
Eigen::Matrix3d axes_of(const grasp::HandPoints& points) {
  const Vec3 tips = (points.tip(1) + points.tip(2) + points.tip(3) + points.tip(4)) / 4.0;
  const Vec3 along = (tips - points.wrist()).normalized();
  Vec3 across = points.tip(1) - points.tip(4);
  across = (across - along * along.dot(across)).normalized();
  Eigen::Matrix3d axes;
  axes << across, along, across.cross(along);
  return axes;
}

/// Within 85 mm, 45 degrees of the fingers' row and 45 of the palm.
bool is_like(const grasp::HandPoints& a, const grasp::HandPoints& b) {
  const Eigen::Matrix3d turned = axes_of(a).transpose() * axes_of(b);
  const double within = std::cos(0.25 * std::numbers::pi);
  return a.distance_to(b) < 85.0 && turned(0, 0) > within && turned(2, 2) > within;
}

/// Turns that change nothing of GRAB's round things, about the axis of their mesh.
std::vector<geometry::Rigid3> turns_of(const std::string& object, const product::Product& product) {
  std::vector<geometry::Rigid3> turns = {{}};
  if (object != "cup" && object != "waterbottle" && object != "wineglass" &&
      object != "flashlight") {
    return turns;
  }
  Vec3 centre = Vec3::Zero();
  for (const Vec3& v : product.mesh.vertices) centre += v;
  centre /= static_cast<double>(product.mesh.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& v : product.mesh.vertices) spread += (v - centre) * (v - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(spread);
  const Vec3 size = solved.eigenvalues();
  const Vec3 axis = solved.eigenvectors().col(size[1] - size[0] < size[2] - size[1] ? 2 : 0);
  for (int k = 1; k < 24; ++k) {
    const Quat turn(Eigen::AngleAxisd(k * std::numbers::pi / 12.0, axis));
    turns.push_back({turn, centre - turn * centre});
  }
  return turns;
}

double likelihood_of(const Seen& seen, const Weights& weights, Eigen::VectorXd* chance = nullptr) {
  const Eigen::VectorXd score = seen.terms * weights + seen.fixed;
  Eigen::VectorXd odds = (score.array() - score.maxCoeff()).exp();
  odds /= odds.sum();
  if (chance != nullptr) *chance = odds;
  return std::log(odds.dot(seen.right));
}

bool is_first_right(const Seen& seen, const Weights& weights) {
  Eigen::Index best = 0;
  (seen.terms * weights + seen.fixed).maxCoeff(&best);
  return seen.right[best] > 0.0;
}

Weights fitted(const std::vector<Seen>& all, const std::string& without) {
  constexpr double kRidge = 2.0;  // towards 1
  Weights weights = Weights::Ones();
  for (int step = 0; step < 80; ++step) {
    Weights gradient = -kRidge * (weights - Weights::Ones());
    Eigen::Matrix<double, kCount, kCount> curvature =
        kRidge * Eigen::Matrix<double, kCount, kCount>::Identity();
    for (const Seen& seen : all) {
      if (seen.name == without) continue;
      Eigen::VectorXd chance;
      likelihood_of(seen, weights, &chance);
      Eigen::VectorXd share = chance.cwiseProduct(seen.right);
      share /= share.sum();
      const Weights mean = seen.terms.transpose() * chance;
      gradient += seen.terms.transpose() * share - mean;
      curvature +=
          seen.terms.transpose() * chance.asDiagonal() * seen.terms - mean * mean.transpose();
    }
    const Weights change = curvature.ldlt().solve(gradient).cwiseMax(-0.3).cwiseMin(0.3);
    weights = (weights + change).cwiseMax(0.0);
    if (change.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  return weights;
}

class HoldsFit : public TemplateTest {
 protected:
  static grasp::RankedHolds ranked(const product::Product& product, std::optional<Vec3> up = {}) {
    grasp::HoldOptions options;
    options.lists_all = true;
    options.up = up;
    return grasp::rank_holds(hand(), product, options);
  }

  static void add_tried(std::vector<Seen>& all) {
    const std::filesystem::path lists = std::filesystem::path(PALMAR_SOURCE_DIR) / "tests/holds";
    std::vector<PeoplesHold> people;
    for (const char* list : {"people.toml", "made.toml", "moved.toml"}) {
      for (PeoplesHold& one : read_peoples_holds(lists / list)) people.push_back(std::move(one));
    }
    for (const std::string& product : tried_products()) {
      std::vector<PeoplesHold> ways;
      for (const PeoplesHold& one : people) {
        if (one.product == product) ways.push_back(one);
      }
      const grasp::RankedHolds found = ranked(tried_product(product));
      Seen seen = seen_of(product, found);
      for (std::size_t i = 0; i < found.holds.size(); ++i) {
        if (objection(ways, found.holds[i]).empty()) seen.right[static_cast<Eigen::Index>(i)] = 1.0;
      }
      if (seen.right.sum() > 0.0) all.push_back(std::move(seen));
    }
  }

  static void add_grab(const std::filesystem::path& folder, std::vector<Seen>& all) {
    std::ifstream table(folder / "about_to_use.csv");
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line)) {
      std::stringstream cells(line);
      std::string task, cell;
      std::getline(cells, task, ',');
      std::vector<double> values;
      while (std::getline(cells, cell, ',')) values.push_back(std::stod(cell));
      grasp::HandPoints person;
      for (std::size_t k = 0; k < grasp::HandPoints::kCount; ++k) {
        person.point[k] = Vec3(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
      }
      const std::size_t last = values.size();
      const std::string object = task.substr(0, task.find('_'));
      const product::Product product = records::load_product(
          folder / "meshes" / (object + ".obj"), {.unit = geometry::LengthUnit::kMillimetre});
      const grasp::RankedHolds found =
          ranked(product, Vec3(values[last - 3], values[last - 2], values[last - 1]));
      Seen seen = seen_of(object, found);
      seen.is_grab = true;
      for (std::size_t i = 0; i < found.holds.size(); ++i) {
        const grasp::Grasp& grasp = found.holds[i].grasp;
        for (const geometry::Rigid3& turn : turns_of(object, product)) {
          const grasp::HandPoints points =
              grasp::hand_points(hand(), grasp.posture, turn * grasp.product_from_hand);
          if (is_like(points, person)) seen.right[static_cast<Eigen::Index>(i)] = 1.0;
        }
      }
      if (seen.right.sum() > 0.0) all.push_back(std::move(seen));
    }
  }
};

TEST_F(HoldsFit, GivesTheWeightsThatAreBuiltIn) {
  const char* file = std::getenv("PALMAR_HOLDS_FIT");
  if (file == nullptr) GTEST_SKIP() << "PALMAR_HOLDS_FIT names no file to write to";
  const std::filesystem::path people =
      std::filesystem::path(PALMAR_SHARED_DIR) / "reference" / "people_holds";
  if (!has_scans() || !std::filesystem::exists(people / "about_to_use.csv")) {
    GTEST_SKIP() << "the scanned products or the table of people's holds aren't there";
  }
  std::vector<Seen> all;
  add_tried(all);
  add_grab(people, all);
  const Weights weights = fitted(all, "");
  std::ofstream out(file);
  out << "| term | weight |\n|---|---|\n";
  for (int k = 0; k < kCount; ++k) out << fmt::format("| {} | {:.2f} |\n", kTerms[k], weights[k]);
  out << "\n| | products | as likely as any | all weights 1 | left out | fitted |\n"
         "|---|---|---|---|---|---|\n";
  for (const bool is_grab : {false, true}) {
    int count = 0;
    double even = 0.0;
    std::array<double, 3> likelihood{};
    std::array<int, 3> right{};
    for (const Seen& seen : all) {
      if (seen.is_grab != is_grab) continue;
      ++count;
      even += std::log(seen.right.mean());
      const std::array<Weights, 3> by = {Weights(Weights::Ones()), fitted(all, seen.name), weights};
      for (std::size_t k = 0; k < by.size(); ++k) {
        likelihood[k] += likelihood_of(seen, by[k]);
        right[k] += is_first_right(seen, by[k]) ? 1 : 0;
      }
    }
    out << fmt::format("| {} | {} | {:.2f} |", is_grab ? "GRAB" : "tests/holds", count,
                       even / count);
    for (std::size_t k = 0; k < 3; ++k) {
      out << fmt::format(" {:.2f}, {} first |", likelihood[k] / count, right[k]);
    }
    out << "\n";
  }
  EXPECT_TRUE(out.good()) << file;
  for (int k = 0; k < kCount; ++k) {
    EXPECT_NEAR(grasp::weight_of(kTerms[k]), weights[k], 0.1) << kTerms[k];
  }
}

}  // namespace
}  // namespace palmar::tests
