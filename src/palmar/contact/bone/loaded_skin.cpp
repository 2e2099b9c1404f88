// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/loaded_skin.h"

#include <algorithm>
#include <cmath>

namespace palmar {

LoadedSkin::LoadedSkin(const SkinGeometry& skin, const SkinCompliance& compliance,
                       const SkinResponse* half_space, const std::vector<double>& scale)
    : skin_(&skin),
      compliance_(&compliance),
      half_space_(half_space),
      root_scale_(static_cast<std::size_t>(skin.vertex_count()), 1.0F),
      row_of_(root_scale_.size(), -1),
      local_(root_scale_.size(), -1) {
  for (std::size_t v = 0; v < scale.size(); ++v) {
    root_scale_[v] = static_cast<float>(1.0 / std::sqrt(scale[v]));
  }
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    row_of_[compliance.vertex[i]] = static_cast<int>(i);
  }
}

void LoadedSkin::set(const std::vector<int>& vertices, const std::vector<Vec3>& directions) {
  for (const int v : vertex_) local_[v] = -1;
  vertex_ = vertices;
  const std::size_t m = vertex_.size();
  scaled_.resize(m);
  cosine_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const int v = vertex_[i];
    local_[v] = static_cast<int>(i);
    scaled_[i] = directions[i].cast<float>() * root_scale_[v];
    cosine_[i] = static_cast<float>(-directions[i].dot(skin_->normal[v]));
  }
  // What is listed for a row stands left of its diagonal; the rest follows by symmetry.
  lower_.begin.assign(1, 0);
  lower_.column.clear();
  lower_.value.clear();
  count_.assign(m, 0);
  const SkinCompliance& C = *compliance_;
  for (std::size_t i = 0; i < m; ++i) {
    const int v = vertex_[i];
    const auto add = [&](int w, const auto& entry) {
      const int j = local_[w];
      if (j < 0) return;
      lower_.column.push_back(j);
      lower_.value.push_back(entry(static_cast<std::size_t>(j)));
      ++count_[i];
      if (static_cast<std::size_t>(j) != i) ++count_[j];
    };
    if (const int row = row_of_[v]; row >= 0) {
      for (std::size_t k = C.begin[row]; k < C.begin[row + 1]; ++k) {
        add(C.vertex[C.other[k]],
            [&](std::size_t j) { return scaled_[i].dot(C.tensor[k] * scaled_[j]); });
      }
    } else {
      for (std::size_t k = half_space_->begin[v]; k < half_space_->begin[v + 1]; ++k) {
        const int w = half_space_->vertex[k];
        if (w > v || row_of_[w] >= 0) continue;
        add(w, [&](std::size_t j) { return half_space_->response[k] * cosine_[i] * cosine_[j]; });
      }
    }
    lower_.begin.push_back(lower_.column.size());
  }
  responses_.begin.assign(1, 0);
  for (std::size_t i = 0; i < m; ++i) {
    responses_.begin.push_back(responses_.begin.back() + count_[i]);
  }
  responses_.column.resize(responses_.begin.back());
  responses_.value.resize(responses_.begin.back());
  // Rows are met in order, so columns come out ascending.
  next_.assign(responses_.begin.begin(), responses_.begin.end() - 1);
  const auto put = [&](std::size_t row, std::size_t column, float value) {
    responses_.column[next_[row]] = static_cast<int>(column);
    responses_.value[next_[row]++] = value;
  };
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t k = lower_.begin[i]; k < lower_.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(lower_.column[k]);
      put(i, j, lower_.value[k]);
      if (j != i) put(j, i, lower_.value[k]);
    }
  }
}

std::vector<double> LoadedSkin::displacement(const std::vector<double>& force,
                                             const std::vector<int>& at,
                                             const std::vector<Vec3>& along) const {
  const auto count = static_cast<std::size_t>(skin_->vertex_count());
  std::vector<Eigen::Vector3f> load(count, Eigen::Vector3f::Zero());
  std::vector<float> normal_load(count, 0.0F);
  for (std::size_t j = 0; j < vertex_.size(); ++j) {
    load[vertex_[j]] = static_cast<float>(force[j]) * scaled_[j];
    normal_load[vertex_[j]] = static_cast<float>(force[j]) * cosine_[j];
  }
  std::vector<char> is_asked(count, 0), is_loaded(count, 0);
  for (const int v : at) is_asked[v] = 1;
  for (std::size_t j = 0; j < vertex_.size(); ++j) is_loaded[vertex_[j]] = force[j] != 0.0;
  std::vector<Eigen::Vector3f> moved(count, Eigen::Vector3f::Zero());
  const SkinCompliance& C = *compliance_;
  const auto visit_row = [&](int v) {
    const auto row = static_cast<std::size_t>(row_of_[v]);
    for (std::size_t k = C.begin[row]; k < C.begin[row + 1]; ++k) {
      const int w = C.vertex[C.other[k]];
      if (is_loaded[w] && is_asked[v]) moved[v] += C.tensor[k] * load[w];
      if (is_loaded[v] && is_asked[w] && w != v) moved[w] += C.tensor[k].transpose() * load[v];
    }
  };
  std::vector<char> is_visited(count, 0);
  for (const std::vector<int>* list : {&at, &vertex_}) {
    for (const int v : *list) {
      if (row_of_[v] < 0 || is_visited[v] || !(is_asked[v] || is_loaded[v])) continue;
      is_visited[v] = 1;
      visit_row(v);
    }
  }
  std::vector<double> result(at.size(), 0.0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int v = at[i];
    if (row_of_[v] >= 0) {
      result[i] = static_cast<double>(root_scale_[v]) * along[i].dot(moved[v].cast<double>());
      continue;
    }
    double sum = 0.0;
    for (std::size_t k = half_space_->begin[v]; k < half_space_->begin[v + 1]; ++k) {
      const int w = half_space_->vertex[k];
      if (row_of_[w] >= 0) continue;
      sum += static_cast<double>(half_space_->response[k]) * static_cast<double>(normal_load[w]);
    }
    result[i] = -along[i].dot(skin_->normal[v]) * sum;
  }
  return result;
}

}  // namespace palmar
