// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/contact_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "palmar/contact/response/response.h"
#include "palmar/contact/solve/lemke.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::contact {
namespace {

/// A flat square of skin with the responses of a half-space up to 12 mm; the product is a ball
/// above its middle and a second one beside it.
struct Square {
  Square() {
    mesh = geometry::make_grid_patch(20, 20, 1.1);
    skin = skin_geometry(mesh);
    patches = skin_patches(skin, 24);
    response.begin.push_back(0);
    const int n = skin.vertex_count();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double r = (skin.position[i] - skin.position[j]).norm();
        if (r > 12.0) continue;
        // Cubically faded: the matrix stays positive definite.
        const double fade = 1.0 - std::pow(r / 12.0, 3);
        response.vertex.push_back(i);
        response.distance.push_back(static_cast<float>(r));
        response.response.push_back(static_cast<float>(
            fade * boussinesq_response(Kernel::kPatch, r, skin.radius[i], skin.radius[j])));
      }
      response.begin.push_back(response.vertex.size());
    }
    all.resize(n);
    std::iota(all.begin(), all.end(), 0);
  }

  /// G d for two balls that dip into the square.
  std::vector<double> penetration(double depth) const {
    std::vector<double> b;
    for (const Vec3& x : skin.position) {
      const double one = (x - Vec3(6.0, 8.0, 0.0)).squaredNorm() / 30.0 - depth;
      const double two = (x - Vec3(16.0, 13.0, 0.0)).squaredNorm() / 20.0 - 0.7 * depth;
      b.push_back(0.03 * std::min(one, two));
    }
    return b;
  }

  geometry::TriangleMesh mesh;
  SkinGeometry skin;
  SkinPatches patches;
  SkinResponse response;
  std::vector<int> all;
};

const Square& square() {
  static const Square made;
  return made;
}

TEST(SkinPatches, CoverEveryVertexWithConnectedParts) {
  const SkinPatches& patches = square().patches;
  std::vector<int> members(patches.count, 0);
  for (const int p : patches.patch) {
    ASSERT_GE(p, 0);
    ASSERT_LT(p, patches.count);
    ++members[p];
  }
  for (int p = 0; p < patches.count; ++p) {
    EXPECT_LE(members[p], 24);
    std::vector<int> own;
    for (const int v : square().all) {
      if (patches.patch[v] == p) own.push_back(v);
    }
    EXPECT_EQ(connected_parts(square().skin, own).size(), 1U);
  }
}

TEST(ContactSystem, AgreesWithLemke) {
  const Square& s = square();
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  for (const double depth : {0.2, 0.8, 2.0}) {
    const std::vector<double> b = s.penetration(depth);
    std::vector<char> in_contact(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) in_contact[i] = b[i] < 0.0;
    std::vector<double> force, gap;
    const ContactSystem::Outcome outcome = system.solve(b, in_contact, force, gap);
    ASSERT_TRUE(outcome.is_solved);
    EXPECT_LT(outcome.relative_residual, 1e-9);

    ContactProblem problem;
    problem.response = dense_response(s.response, s.all, {}, true);
    problem.distance =
        Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
    const ContactSolution lemke = solve_contact_lemke(problem);
    ASSERT_EQ(lemke.status, LcpStatus::kSolved);
    const double scale = lemke.force.maxCoeff();
    for (std::size_t i = 0; i < b.size(); ++i) {
      EXPECT_NEAR(force[i], lemke.force[static_cast<Eigen::Index>(i)], 1e-9 * scale);
    }
  }
}

TEST(ContactSystem, EndsInTheSameFromAnyGuess) {
  const Square& s = square();
  const std::vector<double> b = s.penetration(1.2);
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  std::vector<double> reference, force, gap;
  std::vector<char> in_contact(b.size(), 0);
  ASSERT_TRUE(system.solve(b, in_contact, reference, gap).is_solved);
  const double most = *std::max_element(reference.begin(), reference.end());
  EXPECT_GT(most, 0.0);
  std::vector<char> everywhere(b.size(), 1);
  std::vector<char> striped(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) striped[i] = i % 3 == 0;
  for (std::vector<char> guess : {everywhere, striped, in_contact}) {
    force.assign(b.size(), 0.01);
    ASSERT_TRUE(system.solve(b, guess, force, gap).is_solved);
    EXPECT_EQ(guess, in_contact);
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(force[i], reference[i], 1e-10 * most);
  }
}

TEST(ContactSystem, LeavesRegionsAloneWhenAsked) {
  const Square& s = square();
  std::vector<hand::Region> region;
  for (const Vec3& x : s.skin.position) {
    region.push_back(x.x() < 11.0 ? hand::Region::kThenar : hand::Region::kCentralPalm);
  }
  const std::vector<double> b = s.penetration(1.5);
  const auto total = [&](const std::vector<hand::Region>* by) {
    ContactSystem system(s.patches);
    system.assemble(s.response, s.all, by);
    std::vector<char> in_contact(b.size(), 1);
    std::vector<double> force, gap;
    EXPECT_TRUE(system.solve(b, in_contact, force, gap).is_solved);
    return std::accumulate(force.begin(), force.end(), 0.0);
  };
  // Without the lift that neighbours give, more force is needed.
  EXPECT_GT(total(&region), 1.02 * total(nullptr));
}

TEST(ContactSystem, AddedComplianceTakesForce) {
  const Square& s = square();
  const std::vector<double> b = s.penetration(1.0);
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  std::vector<char> in_contact(b.size(), 0);
  std::vector<double> rigid, soft, gap;
  ASSERT_TRUE(system.solve(b, in_contact, rigid, gap).is_solved);
  // Twice the whole matrix: half the force.
  const Eigen::MatrixXd R = dense_response(s.response, s.all, {}, true);
  std::vector<double> diagonal;
  std::vector<ContactSystem::Entry> entries;
  for (int i = 0; i < static_cast<int>(R.rows()); ++i) {
    diagonal.push_back(R(i, i));
    for (int j = 0; j < i; ++j) {
      if (R(i, j) != 0.0) entries.push_back({i, j, R(i, j)});
    }
  }
  system.add(diagonal, entries);
  ASSERT_TRUE(system.solve(b, in_contact, soft, gap).is_solved);
  const double most = *std::max_element(rigid.begin(), rigid.end());
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(soft[i], 0.5 * rigid[i], 1e-9 * most);
}

TEST(ContactSystem, SolvesOnTheContactSet) {
  const Square& s = square();
  const std::vector<double> b = s.penetration(1.0);
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  std::vector<char> in_contact(b.size(), 0);
  std::vector<double> force, gap;
  ASSERT_TRUE(system.solve(b, in_contact, force, gap).is_solved);
  const auto x = system.solve_on(in_contact, std::vector<double>(b.size(), 1.0));
  ASSERT_TRUE(x);
  const Eigen::MatrixXd R = dense_response(s.response, s.all, {}, true);
  const Eigen::VectorXd product =
      R * Eigen::Map<const Eigen::VectorXd>(x->data(), static_cast<Eigen::Index>(x->size()));
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (in_contact[i]) {
      EXPECT_NEAR(product[static_cast<Eigen::Index>(i)], 1.0, 1e-9);
    } else {
      EXPECT_EQ((*x)[i], 0.0);
    }
  }
}

TEST(ContactSystem, SolvesSeveralRightSidesAtOnceAsOneByOne) {
  const Square& s = square();
  const std::vector<double> b = s.penetration(1.0);
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  std::vector<char> in_contact(b.size(), 0);
  std::vector<double> force, gap;
  ASSERT_TRUE(system.solve(b, in_contact, force, gap).is_solved);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(b.size()), 3);
  for (Eigen::Index i = 0; i < right.rows(); ++i) {
    right(i, 0) = 1.0;
    right(i, 1) = std::sin(0.1 * static_cast<double>(i));  // column 2: nothing
  }
  const auto all = system.solve_roughly_on(in_contact, right, 1e-4);
  ASSERT_TRUE(all);
  for (Eigen::Index c = 0; c < right.cols(); ++c) {
    const std::vector<double> column(right.col(c).begin(), right.col(c).end());
    const auto one = system.solve_on(in_contact, column);
    ASSERT_TRUE(one);
    const Eigen::VectorXd exact =
        Eigen::Map<const Eigen::VectorXd>(one->data(), static_cast<Eigen::Index>(one->size()));
    EXPECT_LE((all->col(c) - exact).norm(), 1e-3 * exact.norm()) << c;
  }
}

TEST(ContactSystem, SaysWhenAMatrixHasNoAnswer) {
  // Responses with a negative diagonal: nothing can push the skin out.
  Square s;
  for (std::size_t j = 0; j + 1 < s.response.begin.size(); ++j) {
    for (std::size_t k = s.response.begin[j]; k < s.response.begin[j + 1]; ++k) {
      s.response.response[k] = s.response.vertex[k] == static_cast<int>(j) ? -1.0F : 0.0F;
    }
  }
  ContactSystem system(s.patches);
  system.assemble(s.response, s.all, nullptr);
  const std::vector<double> b(s.all.size(), -0.1);
  std::vector<char> in_contact(b.size(), 1);
  std::vector<double> force, gap;
  const ContactSystem::Outcome outcome = system.solve(b, in_contact, force, gap);
  EXPECT_FALSE(outcome.is_solved);
  EXPECT_EQ(outcome.fallbacks, ContactFallbacks{.refused_matrices = 1});
  for (const double p : force) EXPECT_EQ(p, 0.0);
}

TEST(ContactSystem, CountsWhatTheDenseMethodsSolve) {
  // One vertex' response to its neighbour is so large that the matrix is indefinite, but both
  // penetrate alike and R p = -d has the positive solution p = 0.1 / 4.
  Square s;
  const std::vector<int> two = {0, 1};
  const SparseRows R{{0, 2, 4}, {0, 1, 0, 1}, {1.0F, 3.0F, 3.0F, 1.0F}};
  ContactSystem system(s.patches);
  system.assemble(R, two);
  std::vector<char> in_contact(2, 1);
  std::vector<double> force, gap;
  const ContactSystem::Outcome outcome = system.solve({-0.1, -0.1}, in_contact, force, gap);
  EXPECT_TRUE(outcome.is_solved);
  EXPECT_EQ(outcome.fallbacks, (ContactFallbacks{.refused_matrices = 1, .dense_solutions = 1}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(force[i], 0.0);
    EXPECT_GE(gap[i], -1e-9);
    EXPECT_NEAR(force[i] * gap[i], 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace palmar::contact
