// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/refine/divided_compliance.h"

#include <algorithm>
#include <cmath>

#include "palmar/contact/bone/half_space_tensor.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

/// Of near_share() over the mean edge: 1 up to 3.6 edges, 0 from 7.2 on. Our choice.
constexpr double kNearWidth = 1.2;

using Tensor = Eigen::Matrix3d;
using VertexShares = std::vector<std::pair<int, double>>;

double edge_of(const SkinGeometry& skin) {
  double sum = 0.0;
  for (const double length : skin.edge_length) sum += length;
  return sum / static_cast<double>(std::max<std::size_t>(skin.edge_length.size(), 1));
}

/// w H between two vertices.
Tensor near_half_space(const SkinGeometry& skin, int v, int w, double width) {
  const Vec3 between = skin.position[v] - skin.position[w];
  const double share = near_share(between.norm(), width, width);
  if (share == 0.0) return Tensor::Zero();
  return share *
         disc_tensor(between, skin.radius[v], skin.radius[w], skin.normal[v], skin.normal[w]);
}

/// A listed compliance with both of its halves: per row the entries, `is_mirrored` where the other
/// row lists it.
struct FullRow {
  int column = 0;
  std::size_t entry = 0;
  bool is_mirrored = false;
};
std::vector<std::vector<FullRow>> full_rows(const SkinCompliance& compliance) {
  std::vector<std::vector<FullRow>> rows(compliance.vertex.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = compliance.begin[i]; k < compliance.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(compliance.other[k]);
      rows[i].push_back({static_cast<int>(j), k, false});
      if (j != i) rows[j].push_back({static_cast<int>(i), k, true});
    }
  }
  return rows;
}

}  // namespace

SkinCompliance divided_compliance(const SkinCompliance& compliance,
                                  const std::vector<double>& scale, const SkinGeometry& before,
                                  const SkinGeometry& after, const std::vector<VertexShares>& share,
                                  const std::vector<char>& wanted, double reach) {
  const double width = kNearWidth * edge_of(before);
  const auto old_rows = compliance.vertex.size();
  std::vector<int> row_of(before.position.size(), -1);
  std::vector<double> root(old_rows, 1.0);
  for (std::size_t i = 0; i < old_rows; ++i) {
    row_of[compliance.vertex[i]] = static_cast<int>(i);
    if (!scale.empty()) root[i] = 1.0 / std::sqrt(scale[compliance.vertex[i]]);
  }
  SkinCompliance result;
  result.volume = compliance.volume;
  result.vertex = compliance.vertex;
  for (std::size_t v = before.position.size(); v < share.size(); ++v) {
    const bool has_all = std::all_of(share[v].begin(), share[v].end(),
                                     [&](const auto& one) { return row_of[one.first] >= 0; });
    if (has_all) result.vertex.push_back(static_cast<int>(v));
  }
  const std::size_t rows = result.vertex.size();
  result.begin.assign(compliance.begin.begin(), compliance.begin.end());
  result.other = compliance.other;
  for (std::size_t a = old_rows; a < rows; ++a) {
    const Vec3& at = after.position[result.vertex[a]];
    for (std::size_t b = 0; b <= a; ++b) {
      if (b != a && wanted[result.vertex[b]] == 0) continue;
      const Vec3& other = after.position[result.vertex[b]];
      if ((at - other).squaredNorm() < reach * reach) result.other.push_back(static_cast<int>(b));
    }
    result.begin.push_back(result.other.size());
  }
  result.tensor.resize(result.other.size());

  // C_0 - w H_0, of the pairs that are asked for.
  const auto smooth = [&](std::size_t i, std::size_t k) -> Tensor {
    const auto j = static_cast<std::size_t>(compliance.other[k]);
    return root[i] * root[j] * compliance.tensor[k].cast<double>() -
           near_half_space(before, compliance.vertex[i], compliance.vertex[j], width);
  };
  const auto is_as_before = [&](int v) {
    return after.radius[v] == before.radius[v] && after.normal[v] == before.normal[v];
  };
  parallel_for(static_cast<int>(old_rows), [&](int row) {
    const auto i = static_cast<std::size_t>(row);
    const int v = compliance.vertex[i];
    for (std::size_t k = compliance.begin[i]; k < compliance.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(compliance.other[k]);
      const int w = compliance.vertex[j];
      if (is_as_before(v) && is_as_before(w)) {
        result.tensor[k] = static_cast<float>(root[i] * root[j]) * compliance.tensor[k];
        continue;
      }
      const Tensor sum = smooth(i, k) + near_half_space(after, v, w, width);
      result.tensor[k] = sum.cast<float>();
    }
  });

  std::vector<char> is_parent(old_rows, 0);
  for (std::size_t a = old_rows; a < rows; ++a) {
    for (const auto& [parent, weight] : share[result.vertex[a]]) is_parent[row_of[parent]] = 1;
  }
  std::vector<Eigen::Matrix3f> between(compliance.tensor.size());
  parallel_for(static_cast<int>(old_rows), [&](int row) {
    const auto i = static_cast<std::size_t>(row);
    for (std::size_t k = compliance.begin[i]; k < compliance.begin[i + 1]; ++k) {
      if (is_parent[i] == 0 && is_parent[compliance.other[k]] == 0) continue;
      between[k] = smooth(i, k).cast<float>();
    }
  });
  const std::vector<std::vector<FullRow>> full = full_rows(compliance);
  constexpr std::size_t kBlock = 32;  // new vertices with one scratch
  const std::size_t blocks = (rows - old_rows + kBlock - 1) / kBlock;
  parallel_for(static_cast<int>(blocks), [&](int block) {
    // What moves a vertex, vertex by vertex of the skin before.
    std::vector<Tensor> moved(old_rows, Tensor::Zero());
    std::vector<std::size_t> met;
    const std::size_t first = old_rows + kBlock * static_cast<std::size_t>(block);
    for (std::size_t a = first; a < std::min(rows, first + kBlock); ++a) {
      const int v = result.vertex[a];
      for (const auto& [parent, weight] : share[v]) {
        const auto i = static_cast<std::size_t>(row_of[parent]);
        for (const FullRow& one : full[i]) {
          const auto j = static_cast<std::size_t>(one.column);
          const Tensor part = between[one.entry].cast<double>();
          moved[j] += weight * (one.is_mirrored ? Tensor(part.transpose()) : part);
          met.push_back(j);
        }
      }
      for (std::size_t k = result.begin[a]; k < result.begin[a + 1]; ++k) {
        const int w = result.vertex[result.other[k]];
        Tensor sum = near_half_space(after, v, w, width);
        for (const auto& [parent, weight] : share[w]) sum += weight * moved[row_of[parent]];
        if (w == v) sum = 0.5 * (sum + sum.transpose()).eval();
        result.tensor[k] = sum.cast<float>();
      }
      for (const std::size_t j : met) moved[j].setZero();
      met.clear();
    }
  });
  return result;
}

}  // namespace palmar::contact
