// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/loaded_skin.h"

#include <algorithm>
#include <cmath>

namespace palmar::contact {

LoadedSkin::LoadedSkin(const SkinGeometry& skin, const SkinCompliance& compliance,
                       const SkinResponse* half_space, const std::vector<double>& scale)
    : compliance_(&compliance),
      half_space_(half_space),
      root_scale_(static_cast<std::size_t>(skin.vertex_count()), 1.0F),
      row_of_(root_scale_.size(), -1),
      local_(root_scale_.size(), -1),
      local_of_row_(compliance.vertex.size(), -1) {
  for (std::size_t v = 0; v < scale.size(); ++v) {
    root_scale_[v] = static_cast<float>(1.0 / std::sqrt(scale[v]));
  }
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    row_of_[compliance.vertex[i]] = static_cast<int>(i);
  }
}

void LoadedSkin::set(const std::vector<int>& vertices, const std::vector<Vec3>& directions) {
  const auto set_local = [&](int v, int local) {
    local_[v] = local;
    if (row_of_[v] >= 0) local_of_row_[row_of_[v]] = local;
  };
  for (const int v : vertex_) set_local(v, -1);
  vertex_ = vertices;
  const std::size_t m = vertex_.size();
  scaled_.resize(m);
  direction_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const int v = vertex_[i];
    set_local(v, static_cast<int>(i));
    direction_[i] = directions[i].cast<float>();
    scaled_[i] = direction_[i] * root_scale_[v];
  }
  // What is listed for a row stands left of its diagonal; the rest follows by symmetry.
  lower_.begin.assign(1, 0);
  lower_.column.clear();
  lower_.value.clear();
  count_.assign(m, 0);
  const SkinCompliance& C = *compliance_;
  for (std::size_t i = 0; i < m; ++i) {
    const int v = vertex_[i];
    const auto add = [&](int j, const auto& entry) {
      if (j < 0) return;
      lower_.column.push_back(j);
      lower_.value.push_back(entry(static_cast<std::size_t>(j)));
      ++count_[i];
      if (static_cast<std::size_t>(j) != i) ++count_[j];
    };
    if (const int row = row_of_[v]; row >= 0) {
      const std::size_t first = C.begin[row];
      const std::size_t length = C.begin[row + 1] - first;
      met_.resize(std::max(met_.size(), length));
      std::size_t met = 0;
      for (std::size_t k = 0; k < length; ++k) {
        // Written in any case, kept only if the vertex takes part: no branch.
        const int j = local_of_row_[C.other[first + k]];
        met_[met] = {j, static_cast<int>(k)};
        met += j >= 0 ? 1 : 0;
      }
      for (std::size_t k = 0; k < met; ++k) {
        const auto [j, entry] = met_[k];
        const Eigen::Matrix3f& tensor = C.tensor[first + static_cast<std::size_t>(entry)];
        add(j, [&](std::size_t place) { return scaled_[i].dot(tensor * scaled_[place]); });
      }
    } else {
      for (std::size_t k = half_space_->begin[v]; k < half_space_->begin[v + 1]; ++k) {
        const int w = half_space_->vertex[k];
        if (w > v || row_of_[w] >= 0) continue;
        add(local_[w], [&](std::size_t j) {
          return half_space_->response[k] * direction_[i].dot(direction_[j]);
        });
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

/// What moves the rows that are asked for, per row of the compliance.
std::vector<Eigen::Vector3f> LoadedSkin::moved_rows(const std::vector<double>& force,
                                                    const std::vector<int>& at) const {
  const SkinCompliance& C = *compliance_;
  const std::size_t rows = C.vertex.size();
  std::vector<Eigen::Vector3f> load(rows, Eigen::Vector3f::Zero());
  std::vector<Eigen::Vector3f> moved(rows, Eigen::Vector3f::Zero());
  constexpr char kLoaded = 1, kAsked = 2;
  std::vector<char> is(rows, 0);
  for (std::size_t j = 0; j < vertex_.size(); ++j) {
    const int row = row_of_[vertex_[j]];
    if (row < 0) continue;
    load[row] = static_cast<float>(force[j]) * scaled_[j];
    if (force[j] != 0.0) is[row] |= kLoaded;
  }
  for (const int v : at) {
    if (row_of_[v] >= 0) is[row_of_[v]] |= kAsked;
  }
  std::vector<std::size_t> met;
  for (std::size_t i = 0; i < rows; ++i) {
    if (is[i] == 0) continue;
    // What a row that is asked for gets from one that is loaded, and the other way.
    const char other = static_cast<char>(((is[i] & kAsked) != 0 ? kLoaded : 0) |
                                         ((is[i] & kLoaded) != 0 ? kAsked : 0));
    met.resize(std::max(met.size(), C.begin[i + 1] - C.begin[i]));
    std::size_t count = 0;
    for (std::size_t k = C.begin[i]; k < C.begin[i + 1]; ++k) {
      met[count] = k;  // written in any case, kept only if it takes part: no branch
      count += (is[C.other[k]] & other) != 0 ? 1 : 0;
    }
    for (std::size_t m = 0; m < count; ++m) {
      const Eigen::Matrix3f& tensor = C.tensor[met[m]];
      const auto j = static_cast<std::size_t>(C.other[met[m]]);
      if ((is[i] & kAsked) != 0) moved[i] += tensor * load[j];
      if ((is[j] & kAsked) != 0 && j != i) moved[j] += tensor.transpose() * load[i];
    }
  }
  return moved;
}

std::vector<double> LoadedSkin::displacement(const std::vector<double>& force,
                                             const std::vector<int>& at,
                                             const std::vector<Vec3>& along) const {
  const std::vector<Eigen::Vector3f> moved = moved_rows(force, at);
  std::vector<Eigen::Vector3f> load(row_of_.size(), Eigen::Vector3f::Zero());  // per vertex
  for (std::size_t j = 0; j < vertex_.size(); ++j) {
    load[vertex_[j]] = static_cast<float>(force[j]) * direction_[j];
  }
  std::vector<double> result(at.size(), 0.0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int v = at[i];
    if (row_of_[v] >= 0) {
      result[i] =
          static_cast<double>(root_scale_[v]) * along[i].dot(moved[row_of_[v]].cast<double>());
      continue;
    }
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = half_space_->begin[v]; k < half_space_->begin[v + 1]; ++k) {
      const int w = half_space_->vertex[k];
      if (row_of_[w] >= 0) continue;
      sum += static_cast<double>(half_space_->response[k]) * load[w].cast<double>();
    }
    result[i] = along[i].dot(sum);
  }
  return result;
}

Eigen::MatrixXd LoadedSkin::turned(const std::vector<double>& force, const Turns& turns,
                                   int columns) const {
  const SkinCompliance& C = *compliance_;
  const std::size_t m = vertex_.size();
  // Per vertex its force, and how that turns: (column, force times change), one after the other.
  std::vector<Eigen::Vector3f> load(m, Eigen::Vector3f::Zero()), moved = load;
  std::vector<std::size_t> begin{0};
  std::vector<std::pair<int, Eigen::Vector3f>> turn;
  for (std::size_t i = 0; i < m; ++i) {
    load[i] = static_cast<float>(force[i]) * scaled_[i];
    for (const auto& [column, change] : turns[i]) {
      if (row_of_[vertex_[i]] < 0) break;
      turn.emplace_back(column, change.cast<float>() * root_scale_[vertex_[i]]);
    }
    begin.push_back(turn.size());
  }
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows result = Rows::Zero(static_cast<Eigen::Index>(m), columns);
  const auto add = [&](std::size_t to, const Eigen::Vector3f& row, std::size_t from) {
    float* const sum = result.data() + to * static_cast<std::size_t>(columns);
    const Eigen::Vector3f pressed = static_cast<float>(force[from]) * row;
    for (std::size_t t = begin[from]; t < begin[from + 1]; ++t) {
      sum[turn[t].first] += pressed.dot(turn[t].second);
    }
  };
  for (std::size_t i = 0; i < m; ++i) {
    const int row = row_of_[vertex_[i]];
    if (row < 0) continue;
    for (std::size_t k = C.begin[row]; k < C.begin[row + 1]; ++k) {
      const int other = local_of_row_[C.other[k]];
      if (other < 0) continue;
      const auto j = static_cast<std::size_t>(other);
      const Eigen::Matrix3f& tensor = C.tensor[k];
      moved[i] += tensor * load[j];
      add(i, tensor.transpose() * scaled_[i], j);
      if (i == j) continue;
      moved[j] += tensor.transpose() * load[i];
      add(j, tensor * scaled_[j], i);
    }
  }
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t t = begin[i]; t < begin[i + 1]; ++t) {
      result(static_cast<Eigen::Index>(i), turn[t].first) += moved[i].dot(turn[t].second);
    }
  }
  return result.cast<double>();
}

std::vector<Vec3> LoadedSkin::motion(const std::vector<double>& force,
                                     const std::vector<int>& at) const {
  const std::vector<Eigen::Vector3f> moved = moved_rows(force, at);
  std::vector<Vec3> result;
  result.reserve(at.size());
  for (const int v : at) {
    const int row = row_of_[v];
    result.emplace_back(row < 0 ? Vec3(Vec3::Zero())
                                : Vec3((root_scale_[v] * moved[row]).cast<double>()));
  }
  return result;
}

}  // namespace palmar::contact
