// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/surface_compliance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/bone/contact_test_layer.h"
#include "palmar/contact/bone/mini_element.h"
#include "palmar/contact/response/layered_response.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

using contact_test::BondedLayer;

TEST(MiniElement, UniformStrainHasItsEnergyAndRigidMotionsNone) {
  const std::array<Vec3, 4> corner = {Vec3(0, 0, 0), Vec3(1.5, 0.2, 0), Vec3(0.3, 2, 0.1),
                                      Vec3(0.2, 0.4, 1.1)};
  const MiniElement element = mini_element(corner, 0.5);
  const double v = geometry::tetrahedron_volume(corner[0], corner[1], corner[2], corner[3]);
  const auto field = [&](const Eigen::Matrix3d& gradient) {
    Eigen::Matrix<double, 12, 1> u;
    for (int a = 0; a < 4; ++a) u.segment<3>(3 * a) = gradient * corner[a] + Vec3(3, -1, 2);
    return u;
  };
  Eigen::Matrix3d gradient;
  gradient << 0.1, 0.3, -0.2, 0.0, 0.4, 0.5, -0.1, 0.2, 0.3;
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const auto u = field(gradient);
  EXPECT_NEAR(u.dot(element.stiffness * u), 2.0 * v * strain.squaredNorm(), 1e-12);
  EXPECT_NEAR((element.divergence * u).sum(), v * gradient.trace(), 1e-12);
  Eigen::Matrix3d spin;
  spin << 0, -1, 2, 1, 0, -3, -2, 3, 0;
  EXPECT_LT((element.stiffness * field(spin)).norm(), 1e-12);
  EXPECT_LT((element.divergence * field(spin)).norm(), 1e-12);
  // A uniform pressure doesn't move the bubble.
  EXPECT_LT((element.slack * Eigen::Vector4d::Ones()).norm(), 1e-12);
}

TEST(SurfaceCompliance, IsSymmetricToTheLastBit) {
  const BondedLayer layer(2.0, 5.0, 10.0, 2.3, 6.0);
  const PatchMatrix C = layer.elements(0.5);
  double largest = 0.0;
  for (int i = 0; i < C.size(); ++i) {
    for (int j = 0; j < C.size(); ++j) {
      EXPECT_EQ(C(i, j), C(j, i));
      largest = std::max(largest, std::abs(C(i, j)));
    }
  }
  EXPECT_GT(largest, 0.0);
}

/// Displacement averaged with the Gaussian weights by which the force is spread as well, against
/// the layer's closed form (layered_response.h).
double ratio_to_layer(double edge, double thickness, double poisson, double width) {
  const BondedLayer layer(edge, thickness, 16.0, edge, 4.0 * width);
  const PatchMatrix C = layer.elements(poisson);
  Eigen::VectorXd share(C.size());
  for (int i = 0; i < C.size(); ++i) {
    const double r2 = layer.skin.position[i].squaredNorm();
    share[i] = layer.skin.area[i] * std::exp(-0.5 * r2 / (width * width));
  }
  share /= share.sum();
  // The hats of the skin's vertices widen it.
  const double hat2 = edge * edge / 8.0;
  const double step = 0.002;
  double truth = 0.0;
  for (double k = 0.5 * step; k < 6.0 / width; k += step) {
    truth += (1.0 - layer_kernel(poisson).lack_of_compliance(k * thickness)) *
             std::exp(-k * k * (width * width + hat2)) * step;
  }
  truth *= (1.0 - poisson) / (2.0 * std::numbers::pi);
  return share.dot(C * share) / truth;
}

TEST(SurfaceCompliance, BondedLayerGivesWayAsItsClosedFormSays) {
  EXPECT_NEAR(ratio_to_layer(1.25, 5.0, 0.5, 2.5), 1.0, 0.03);
  EXPECT_NEAR(ratio_to_layer(1.25, 5.0, 0.3, 2.5), 1.0, 0.03);
}

TEST(SurfaceCompliance, ConvergesFromTheStiffSide) {
  const double coarse = 1.0 - ratio_to_layer(2.5, 5.0, 0.5, 2.0);
  const double fine = 1.0 - ratio_to_layer(1.25, 5.0, 0.5, 2.0);
  EXPECT_GT(coarse, 0.0);
  EXPECT_LT(std::abs(fine), 0.5 * coarse);
}

TEST(SurfaceCompliance, IncompressibleLayerUnderEvenPressureDoesNotGiveWay) {
  // Far from its sides such a layer can't be squeezed at all: no locking would show as much, but
  // one of nu = 0.3 must follow p h (1 - 2 nu) / (2 G (1 - nu)).
  for (const double poisson : {0.3, 0.5}) {
    const BondedLayer layer(2.0, 4.0, 18.0, 2.3, 15.0);
    const PatchMatrix C = layer.elements(poisson);
    Eigen::VectorXd force(C.size());
    int middle = 0;
    for (int i = 0; i < C.size(); ++i) {
      force[i] = layer.skin.area[i];
      if (layer.skin.position[i].norm() < layer.skin.position[middle].norm()) middle = i;
    }
    const double u = (C * force)[middle];
    const double truth = 4.0 * (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
    // The sides, 3 mm beyond the load, let some out.
    EXPECT_NEAR(u, truth, 0.05 * 4.0) << poisson;
  }
}

TEST(SurfaceCompliance, LooseBodyIsReported) {
  const BondedLayer layer(2.0, 4.0, 8.0, 2.3, 4.0);
  const std::vector<char> none(layer.mesh.vertices.size(), 0);
  PatchMatrix C(layer.skin.vertex_count());
  try {
    // Rounding may let the last pivot pass; compressible tissue alone has none.
    surface_compliance(layer.mesh, none, layer.loads(), {.poisson = 0.3}, C);
    for (int i = 0; i < C.size(); ++i) EXPECT_GT(std::abs(C(i, i)), 10.0);
  } catch (const NumericalError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("must touch bone"));
  }
  EXPECT_THROW(surface_compliance(layer.mesh, none, layer.loads(), {.poisson = 0.6}, C),
               UsageError);
}

}  // namespace
}  // namespace palmar::contact
