// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/loaded_skin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/contact/bone/half_space_tensor.h"

namespace palmar {
namespace {

constexpr double kFar = 6.0;  // radii; beyond, a disc is a point (half_space_tensor.h)

using Eigen::Index;

}  // namespace

LoadedSkin::LoadedSkin(const SkinGeometry& skin, const SkinCompliance& compliance,
                       const std::vector<double>& node_scale)
    : skin_(&skin),
      compliance_(&compliance),
      node_scale_(&node_scale),
      row_of_(static_cast<std::size_t>(skin.vertex_count()), -1),
      local_node_(compliance.node.size(), -1) {
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    row_of_[compliance.vertex[i]] = static_cast<int>(i);
  }
}

double LoadedSkin::half_space(int v, const Vec3& along_v, int w, const Vec3& along_w) const {
  const Vec3 between = skin_->position[v] - skin_->position[w];
  const double far = kFar * std::max(skin_->radius[v], skin_->radius[w]);
  const double r2 = between.squaredNorm();
  if (r2 > far * far) {
    return (along_v.dot(along_w) + along_v.dot(between) * along_w.dot(between) / r2) /
           (4.0 * std::numbers::pi * std::sqrt(r2));
  }
  return along_v.dot(
      disc_tensor(between, skin_->radius[v], skin_->radius[w], skin_->normal[v], skin_->normal[w]) *
      along_w);
}

/// R among the nodes that the vertices hang on.
void LoadedSkin::set_smooth_part() {
  const PatchMatrix& R = compliance_->smooth;
  for (const int node : active_) local_node_[node] = -1;
  active_.clear();
  for (const int v : vertex_) {
    if (row_of_[v] < 0) continue;
    const auto row = static_cast<std::size_t>(row_of_[v]);
    for (std::size_t k = compliance_->support_begin[row]; k < compliance_->support_begin[row + 1];
         ++k) {
      int& local = local_node_[compliance_->support[k]];
      if (local >= 0) continue;
      local = 0;
      active_.push_back(compliance_->support[k]);
    }
  }
  std::sort(active_.begin(), active_.end());
  for (std::size_t a = 0; a < active_.size(); ++a) {
    local_node_[active_[a]] = static_cast<int>(a);
  }
  const auto size = static_cast<Index>(3 * active_.size());
  smooth_.setZero(size, size);
  std::vector<std::vector<int>> of_patch(static_cast<std::size_t>(R.patch_count()));
  std::vector<int> met;
  for (const int node : active_) {
    const int I = R.patch_of(3 * node);
    if (of_patch[I].empty()) met.push_back(I);
    of_patch[I].push_back(node);
  }
  const auto scale = [&](int a, int b) {
    if (node_scale_->empty()) return 1.0F;
    return static_cast<float>(1.0 / std::sqrt((*node_scale_)[a] * (*node_scale_)[b]));
  };
  for (const int I : met) {
    for (std::size_t k = 0; k < R.near(I).size(); ++k) {
      const int J = R.near(I)[k];
      const Eigen::MatrixXd& block = R.block(I, k);
      for (const int b : of_patch[J]) {
        for (const int a : of_patch[I]) {
          const Eigen::Matrix3f part =
              scale(a, b) * block.block<3, 3>(R.place_of(3 * a), R.place_of(3 * b)).cast<float>();
          smooth_.block<3, 3>(3 * local_node_[a], 3 * local_node_[b]) = part;
          smooth_.block<3, 3>(3 * local_node_[b], 3 * local_node_[a]) = part.transpose();
        }
      }
    }
  }
}

void LoadedSkin::set(const std::vector<int>& vertices, const std::vector<Vec3>& directions) {
  vertex_ = vertices;
  direction_ = directions;
  set_smooth_part();
  const auto m = static_cast<Index>(vertices.size());
  matrix_.setZero(m, m);
  // R P^T, one column per vertex, its direction included.
  Eigen::MatrixXf moved(smooth_.rows(), m);
  moved.setZero();
  const auto for_support = [&](Index i, const auto& visit) {
    const int row = row_of_[vertex_[i]];
    if (row < 0) return;
    for (std::size_t k = compliance_->support_begin[row]; k < compliance_->support_begin[row + 1];
         ++k) {
      visit(3 * local_node_[compliance_->support[k]],
            (compliance_->weight[k] * direction_[i]).cast<float>().eval());
    }
  };
  for (Index j = 0; j < m; ++j) {
    for_support(j, [&](Index node, const Eigen::Vector3f& share) {
      moved.col(j) += share[0] * smooth_.col(node) + share[1] * smooth_.col(node + 1) +
                      share[2] * smooth_.col(node + 2);
    });
  }
  const Eigen::MatrixXf turned = moved.transpose();  // vertices along memory
  for (Index i = 0; i < m; ++i) {
    const bool is_on_bone = row_of_[vertex_[i]] >= 0;
    auto column = matrix_.col(i).head(i + 1);
    for_support(i, [&](Index node, const Eigen::Vector3f& share) {
      column += share[0] * turned.col(node).head(i + 1) +
                share[1] * turned.col(node + 1).head(i + 1) +
                share[2] * turned.col(node + 2).head(i + 1);
    });
    for (Index j = 0; j <= i; ++j) {
      if ((row_of_[vertex_[j]] >= 0) != is_on_bone) continue;
      column[j] +=
          static_cast<float>(half_space(vertex_[j], direction_[j], vertex_[i], direction_[i]));
    }
  }
  matrix_.triangularView<Eigen::StrictlyLower>() = matrix_.transpose();
}

std::vector<double> LoadedSkin::displacement(const std::vector<double>& force,
                                             const std::vector<int>& at,
                                             const std::vector<Vec3>& along) const {
  // Forces on the active nodes; nodes that are not active, under `at`, don't move by R.
  Eigen::VectorXf on_node = Eigen::VectorXf::Zero(smooth_.rows());
  for (std::size_t j = 0; j < vertex_.size(); ++j) {
    const int row = row_of_[vertex_[j]];
    if (row < 0 || force[j] == 0.0) continue;
    for (std::size_t k = compliance_->support_begin[row]; k < compliance_->support_begin[row + 1];
         ++k) {
      on_node.segment<3>(3 * local_node_[compliance_->support[k]]) +=
          (force[j] * compliance_->weight[k] * direction_[j]).cast<float>();
    }
  }
  const PatchMatrix& R = compliance_->smooth;
  std::vector<Vec3> moved(compliance_->node.size(), Vec3::Zero());
  std::vector<char> is_known(moved.size(), 0);
  const auto motion_of = [&](int node) -> const Vec3& {
    if (is_known[node]) return moved[node];
    is_known[node] = 1;
    for (std::size_t b = 0; b < active_.size(); ++b) {
      const int other = active_[b];
      const bool is_first = R.patch_of(3 * node) >= R.patch_of(3 * other);
      const int I = R.patch_of(3 * (is_first ? node : other));
      const int J = R.patch_of(3 * (is_first ? other : node));
      const std::vector<int>& near = R.near(I);
      const auto found = std::lower_bound(near.begin(), near.end(), J);
      if (found == near.end() || *found != J) continue;
      const Eigen::MatrixXd& block = R.block(I, static_cast<std::size_t>(found - near.begin()));
      const Vec3 f = on_node.segment<3>(static_cast<Index>(3 * b)).cast<double>();
      double scale = 1.0;
      if (!node_scale_->empty()) {
        scale = 1.0 / std::sqrt((*node_scale_)[node] * (*node_scale_)[other]);
      }
      if (is_first) {
        moved[node] += scale * (block.block<3, 3>(R.place_of(3 * node), R.place_of(3 * other)) * f);
      } else {
        moved[node] +=
            scale *
            (block.block<3, 3>(R.place_of(3 * other), R.place_of(3 * node)).transpose() * f);
      }
    }
    return moved[node];
  };
  std::vector<double> result(at.size(), 0.0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int row = row_of_[at[i]];
    if (row >= 0) {
      for (std::size_t k = compliance_->support_begin[row]; k < compliance_->support_begin[row + 1];
           ++k) {
        result[i] += compliance_->weight[k] * along[i].dot(motion_of(compliance_->support[k]));
      }
    }
    for (std::size_t j = 0; j < vertex_.size(); ++j) {
      if (force[j] == 0.0 || (row_of_[vertex_[j]] >= 0) != (row >= 0)) continue;
      result[i] += force[j] * half_space(at[i], along[i], vertex_[j], direction_[j]);
    }
  }
  return result;
}

}  // namespace palmar
