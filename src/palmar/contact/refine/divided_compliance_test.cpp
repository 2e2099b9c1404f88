// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/divided_compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

#include "palmar/contact/bone/contact_test_skin.h"
#include "palmar/contact/bone/half_space_tensor.h"
#include "palmar/contact/bone/loaded_skin.h"
#include "palmar/contact/refine/skin_division.h"

namespace palmar::contact {
namespace {

using contact_test::half_space_compliance;

constexpr double kSpacing = 2.5;  // mm

SkinGeometry flat_skin() { return skin_geometry(geometry::make_lattice_patch(12.0, kSpacing)); }

SkinDivision divided_patch(int times) {
  const geometry::TriangleMesh patch = geometry::make_lattice_patch(12.0, kSpacing);
  SkinDivision division(patch.triangles, patch.vertices, patch.vertices,
                        std::vector<char>(patch.vertices.size(), 1));
  for (int i = 0; i < times; ++i) {
    std::vector<char> chosen;
    for (const Vec3& x : division.at_rest()) chosen.push_back(std::abs(x.x()) < 1.0 ? 1 : 0);
    division.divide(chosen);
  }
  return division;
}

Eigen::MatrixXd along_normals(const SkinGeometry& skin, const SkinCompliance& compliance) {
  std::vector<int> all(compliance.vertex.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Vec3> inwards(all.size(), -Vec3::UnitZ());
  LoadedSkin loaded(skin, compliance, nullptr, {});
  loaded.set(all, inwards);
  const SparseRows& rows = loaded.responses();
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
      result(i, rows.column[k]) = static_cast<double>(rows.value[k]);
    }
  }
  return result;
}

/// On a half-space, whose response every pair of patches has in closed form.
TEST(DividedCompliance, IsThatOfTheSmallPatchesOnAHalfSpace) {
  const SkinGeometry before = flat_skin();
  const SkinDivision division = divided_patch(3);
  const SkinGeometry after = skin_geometry({division.at_rest(), division.triangles()});
  ASSERT_GT(division.ends().size(), 400u);
  const std::vector<char> all(division.at_rest().size(), 1);
  const SkinCompliance divided = divided_compliance(half_space_compliance(before), {}, before,
                                                    after, division.shares(), all, 100.0);
  const Eigen::MatrixXd truth = along_normals(after, half_space_compliance(after));
  const Eigen::MatrixXd found = along_normals(after, divided);
  ASSERT_EQ(found.rows(), truth.rows());
  const double own = truth.topLeftCorner(30, 30).diagonal().mean();  // of the skin before
  for (Eigen::Index i = 0; i < truth.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double r = (after.position[i] - after.position[j]).norm();
      const double allowed = r < 3.0 * kSpacing ? 0.01 * truth(i, j) : 0.004 * own;
      ASSERT_NEAR(found(i, j), truth(i, j), allowed) << i << " " << j << " " << r << " mm";
    }
  }
}

TEST(DividedCompliance, IsReciprocalAndDefinite) {
  const SkinGeometry before = flat_skin();
  const SkinDivision division = divided_patch(2);
  const SkinGeometry after = skin_geometry({division.at_rest(), division.triangles()});
  const std::vector<char> all(division.at_rest().size(), 1);
  const Eigen::MatrixXd found =
      along_normals(after, divided_compliance(half_space_compliance(before), {}, before, after,
                                              division.shares(), all, 100.0));
  EXPECT_EQ((found - found.transpose()).cwiseAbs().maxCoeff(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(found);
  EXPECT_GT(solver.eigenvalues().minCoeff(), 0.0);
}

TEST(DividedCompliance, StaysWhereNothingIsDividedAndScales) {
  const SkinGeometry skin = flat_skin();
  const SkinDivision undivided = divided_patch(0);
  const SkinCompliance compliance = half_space_compliance(skin);
  const std::vector<char> all(skin.position.size(), 1);
  const SkinCompliance same =
      divided_compliance(compliance, {}, skin, skin, undivided.shares(), all);
  ASSERT_EQ(same.tensor.size(), compliance.tensor.size());
  for (std::size_t k = 0; k < same.tensor.size(); ++k) {
    EXPECT_EQ(same.tensor[k], compliance.tensor[k]);
  }
  // Of a hand twice as large: half of it.
  const std::vector<double> twice(skin.position.size(), 2.0);
  const SkinCompliance scaled =
      divided_compliance(compliance, twice, skin, skin, undivided.shares(), all);
  EXPECT_NEAR(scaled.tensor[0](2, 2), 0.5F * compliance.tensor[0](2, 2), 1e-7F);
}

TEST(DividedCompliance, SkinWithoutComplianceHasNone) {
  const SkinGeometry before = flat_skin();
  const SkinDivision division = divided_patch(1);
  const SkinGeometry after = skin_geometry({division.at_rest(), division.triangles()});
  SkinCompliance half = half_space_compliance(before);
  // Only the first vertex has any.
  half.vertex.resize(1);
  half.begin.resize(2);
  half.other.resize(1);
  half.tensor.resize(1);
  const std::vector<char> all(division.at_rest().size(), 1);
  const SkinCompliance divided =
      divided_compliance(half, {}, before, after, division.shares(), all);
  EXPECT_EQ(divided.vertex, std::vector<int>{0});
}

}  // namespace
}  // namespace palmar::contact
