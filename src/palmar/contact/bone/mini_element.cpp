// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/mini_element.h"

#include <Eigen/LU>

namespace palmar::contact {
namespace {

// Integrals over the tetrahedron divided by its volume, from Int xi^a = 6 V a! / (|a| + 3)!.
constexpr double kBubble = 256.0 * 6.0 / 5040.0;            // of the bubble
constexpr double kBubbleSlope = 65536.0 * 24.0 / 362880.0;  // of its gradient's square

}  // namespace

MiniElement mini_element(const std::array<Vec3, 4>& corner, double poisson) {
  Eigen::Matrix3d edge;
  for (int k = 0; k < 3; ++k) edge.col(k) = corner[k + 1] - corner[0];
  const double volume = edge.determinant() / 6.0;
  // Gradients of the barycentric coordinates, one per column.
  Eigen::Matrix<double, 3, 4> slope;
  slope.rightCols<3>() = edge.inverse().transpose();
  slope.col(0) = -slope.rightCols<3>().rowwise().sum();

  MiniElement element;
  // 2 eps(u) : eps(v) = grad u : grad v + grad u : (grad v)^T.
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      element.stiffness.block<3, 3>(3 * a, 3 * b) =
          volume * (slope.col(a).dot(slope.col(b)) * Eigen::Matrix3d::Identity() +
                    slope.col(b) * slope.col(a).transpose());
    }
  }
  for (int a = 0; a < 4; ++a) {
    element.divergence.block<4, 3>(0, 3 * a) =
        Eigen::Vector4d::Constant(0.25 * volume) * slope.col(a).transpose();
  }
  const Eigen::Matrix3d square = kBubbleSlope * volume * slope * slope.transpose();
  const Eigen::Matrix3d bubble = square.trace() * Eigen::Matrix3d::Identity() + square;
  const double share = kBubble * volume;
  element.slack = share * share * slope.transpose() * bubble.inverse() * slope;
  // Compressibility: 1 / lambda, lambda = 2 nu / (1 - 2 nu) at a shear modulus of 1.
  const double per_lambda = poisson > 0.0 ? (1.0 - 2.0 * poisson) / (2.0 * poisson) : 1e6;
  element.slack +=
      per_lambda * volume / 20.0 * (Eigen::Matrix4d::Ones() + Eigen::Matrix4d::Identity());
  return element;
}

}  // namespace palmar::contact
