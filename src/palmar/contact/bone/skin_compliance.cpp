// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/skin_compliance.h"

#include <algorithm>
#include <numeric>

#include "palmar/contact/bone/half_space_tensor.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

constexpr double kMostAway = 1.0;  // mm from the skin to the tissue's surface; else unattached

using Eigen::Index;
using Rows3 = Eigen::Matrix<float, 3, Eigen::Dynamic>;

double mean_edge(const SkinGeometry& skin) {
  return std::accumulate(skin.edge_length.begin(), skin.edge_length.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(skin.edge_length.size(), 1));
}

/// w H between two vertices of the skin; `tensor` takes what separates them, two lengths and their
/// normals.
template <typename Tensor>
Eigen::Matrix3d half_space_between(const SkinGeometry& skin, int v, int w, double sigma_v,
                                   double sigma_w, const Tensor& tensor) {
  const Vec3 between = skin.position[v] - skin.position[w];
  const double share = near_share(between.norm(), sigma_v, sigma_w);
  if (share == 0.0) return Eigen::Matrix3d::Zero();
  return share * tensor(between, v, w);
}

/// R less w S H S^T, with all of its columns.
Eigen::MatrixXf dense(const SkinGeometry& skin, const NodeCompliance& nodes) {
  const PatchMatrix& R = nodes.smooth;
  Eigen::MatrixXf result = Eigen::MatrixXf::Zero(R.size(), R.size());
  std::vector<int> row_of(static_cast<std::size_t>(skin.vertex_count()), -1);
  for (std::size_t i = 0; i < nodes.vertex.size(); ++i) {
    row_of[nodes.vertex[i]] = static_cast<int>(i);
  }
  parallel_for(R.patch_count(), [&](int I) {
    for (std::size_t k = 0; k < R.near(I).size(); ++k) {
      const std::vector<int>& rows = R.rows_of(I);
      const std::vector<int>& columns = R.rows_of(R.near(I)[k]);
      const Eigen::MatrixXd& block = R.block(I, k);
      for (std::size_t b = 0; b < columns.size(); b += 3) {
        for (std::size_t a = 0; a < rows.size(); a += 3) {
          if (rows[a] < columns[b] && R.near(I)[k] == I) continue;
          Eigen::Matrix3d part = block.block<3, 3>(static_cast<Index>(a), static_cast<Index>(b));
          const int from = rows[a] / 3;
          const int to = columns[b] / 3;
          const double sigma_from = nodes.sigma[row_of[nodes.node[from]]];
          const double sigma_to = nodes.sigma[row_of[nodes.node[to]]];
          part -= half_space_between(skin, nodes.node[from], nodes.node[to], sigma_from, sigma_to,
                                     [&](const Vec3& between, int v, int w) {
                                       return spread_tensor(between, sigma_from, sigma_to,
                                                            skin.normal[v], skin.normal[w]);
                                     });
          const Eigen::Matrix3f rounded = part.cast<float>();
          result.block<3, 3>(rows[a], columns[b]) = rounded;
          result.block<3, 3>(columns[b], rows[a]) = rounded.transpose();
        }
      }
    }
  });
  return result;
}

}  // namespace

SkinCompliance skin_compliance(const SkinGeometry& skin, const NodeCompliance& nodes,
                               double reach) {
  SkinCompliance result;
  result.vertex = nodes.vertex;
  const auto count = static_cast<int>(nodes.vertex.size());
  std::vector<Vec3> at;
  for (const int v : nodes.vertex) at.push_back(skin.position[v]);
  result.begin.push_back(0);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j <= i; ++j) {
      if ((at[i] - at[j]).squaredNorm() < reach * reach) result.other.push_back(j);
    }
    result.begin.push_back(result.other.size());
  }
  result.tensor.resize(result.other.size());
  const Eigen::MatrixXf R = dense(skin, nodes);
  parallel_for(count, [&](int i) {
    Rows3 moved = Rows3::Zero(3, R.cols());  // of vertex i, by forces on the nodes
    for (std::size_t a = nodes.support_begin[i]; a < nodes.support_begin[i + 1]; ++a) {
      // Columns of R are its rows, and lie together.
      moved += static_cast<float>(nodes.weight[a]) *
               R.middleCols<3>(Index{3} * nodes.support[a]).transpose();
    }
    const int v = nodes.vertex[i];
    for (std::size_t k = result.begin[i]; k < result.begin[i + 1]; ++k) {
      const int j = result.other[k];
      const int w = nodes.vertex[j];
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (std::size_t b = nodes.support_begin[j]; b < nodes.support_begin[j + 1]; ++b) {
        sum += nodes.weight[b] * moved.middleCols<3>(Index{3} * nodes.support[b]).cast<double>();
      }
      sum += half_space_between(skin, v, w, nodes.sigma[i], nodes.sigma[j],
                                [&](const Vec3& between, int, int) {
                                  return disc_tensor(between, skin.radius[v], skin.radius[w],
                                                     skin.normal[v], skin.normal[w]);
                                });
      if (i == j) sum = 0.5 * (sum + sum.transpose()).eval();
      result.tensor[k] = sum.cast<float>();
    }
  });
  return result;
}

SkinCompliance mirrored(const SkinCompliance& compliance) {
  SkinCompliance result = compliance;
  for (Eigen::Matrix3f& tensor : result.tensor) {
    tensor.row(0) *= -1.0F;
    tensor.col(0) *= -1.0F;
  }
  return result;
}

SkinCompliance skin_compliance(const hand::Hand& hand, const SkinGeometry& skin,
                               const SkinComplianceOptions& options) {
  const hand::TissueMesh tissue = hand::make_tissue_mesh(hand, options.mesh);
  std::vector<int> palmar;
  std::vector<char> is_used(hand.region.size(), 0);
  for (std::size_t v = 0; v < hand.region.size(); ++v) {
    if (hand.region[v] != hand::Region::kDorsum) palmar.push_back(static_cast<int>(v));
    if (hand.segment[v] != hand::Segment::kPalm) is_used[v] = 1;
  }
  for (const GrownVertex& g : grow(skin, palmar, kBackOfHand)) is_used[g.vertex] = 1;
  const std::vector<hand::SkinAttachment> at = tissue.attach(skin.position);
  std::vector<int> vertex;
  std::vector<double> sigma;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (!is_used[v] || at[v].distance > kMostAway) continue;
    vertex.push_back(static_cast<int>(v));
    sigma.push_back(smoothing_width(skin, static_cast<int>(v), at[v].edge));
  }
  const HatPoints points = hat_points(skin, hand.skin.triangles,
                                      divisions_for(mean_edge(skin), options.mesh.finger_edge));
  const ElasticBody body{&tissue.mesh, &tissue.is_on_bone, &points, tissue.attach(points.point)};
  SkinCompliance result = skin_compliance(
      skin, node_compliance(skin, hand.skin.triangles, body, vertex, sigma), options.reach);
  result.volume = tissue.volume_by_region();
  return result;
}

}  // namespace palmar::contact
