// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/self/meeting_loads.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::contact {
namespace {

// mm; skin that bulges less than this into other skin is left, as it is far below what the mesh
// shows of either. Ours.
constexpr double kLeastBulge = 0.05;

Eigen::Matrix3d axes_of(const Vec3& normal, const Vec3& edge) {
  Eigen::Matrix3d axes;
  axes.col(0) = normal;
  axes.col(1) = (edge - edge.dot(normal) * normal).normalized();
  axes.col(2) = normal.cross(axes.col(1));
  return axes;
}

}  // namespace

MeetingLoads::MeetingLoads(const SkinGeometry& reference, const SkinCompliance& compliance,
                           const std::vector<double>& scale)
    : reference_(&reference),
      compliance_(&compliance),
      root_scale_(static_cast<std::size_t>(reference.vertex_count()), 1.0),
      row_of_(root_scale_.size(), -1),
      last_force_(root_scale_.size(), 0.0),
      slot_(root_scale_.size(), -1) {
  for (std::size_t v = 0; v < scale.size(); ++v) root_scale_[v] = 1.0 / std::sqrt(scale[v]);
  for (std::size_t i = 0; i < compliance.vertex.size(); ++i) {
    row_of_[compliance.vertex[i]] = static_cast<int>(i);
  }
}

/// Turns vectors at a vertex from the reference posture into the posed skin's frame.
Eigen::Matrix3d MeetingLoads::to_posed(int vertex) const {
  const int next = reference_->neighbours(vertex).front();
  const Eigen::Matrix3d before = axes_of(reference_->normal[vertex],
                                         reference_->position[next] - reference_->position[vertex]);
  const Eigen::Matrix3d after = axes_of((*normal_)[vertex], (*posed_)[next] - (*posed_)[vertex]);
  return after * before.transpose();
}

void MeetingLoads::set(const std::vector<SkinMeeting>& meetings, const std::vector<Vec3>& posed,
                       const std::vector<Vec3>& normal) {
  for (const Meeting& old : meeting_) last_force_[old.at.vertex] = old.force;
  std::vector<Meeting> taken;
  near_.clear();
  posed_ = &posed;
  normal_ = &normal;
  for (const SkinMeeting& at : meetings) {
    Meeting meeting;
    meeting.at = at;
    meeting.vertex = {at.vertex, at.on[0], at.on[1], at.on[2]};
    const bool is_known = std::all_of(meeting.vertex.begin(), meeting.vertex.end(),
                                      [&](int v) { return row_of_[v] >= 0; });
    if (!is_known) continue;
    for (std::size_t c = 0; c < kCorners; ++c) {
      const double weight = c == 0 ? 1.0 : -at.weight[c - 1];
      meeting.share[c] = weight * (to_posed(meeting.vertex[c]).transpose() * at.normal);
    }
    meeting.force = last_force_[at.vertex];
    meeting.in_contact = at.distance < 0.0;
    (at.distance < 0.0 || meeting.force > 0.0 ? taken : near_).push_back(meeting);
  }
  for (const Meeting& old : meeting_) last_force_[old.at.vertex] = 0.0;
  meeting_ = std::move(taken);
}

void MeetingLoads::join(const std::vector<int>& vertices, const std::vector<Vec3>& directions) {
  for (const int v : vertex_) slot_[v] = -1;
  vertex_.clear();
  load_.clear();
  tensor_.clear();
  product_rows_ = vertices.size();
  const auto slot_of = [&](int v) {
    if (slot_[v] < 0) {
      slot_[v] = static_cast<int>(vertex_.size());
      vertex_.push_back(v);
      load_.emplace_back();
    }
    return static_cast<std::size_t>(slot_[v]);
  };
  for (std::size_t k = 0; k < meeting_.size(); ++k) {
    for (std::size_t c = 0; c < kCorners; ++c) {
      const int v = meeting_[k].vertex[c];
      load_[slot_of(v)].push_back(
          {static_cast<int>(product_rows_ + k), root_scale_[v] * meeting_[k].share[c]});
    }
  }
  const auto own = static_cast<int>(vertex_.size());  // slots with a meeting's load
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (row_of_[v] < 0) continue;
    load_[slot_of(v)].push_back({static_cast<int>(i), root_scale_[v] * directions[i]});
  }
  const SkinCompliance& C = *compliance_;
  for (std::size_t a = 0; a < vertex_.size(); ++a) {
    const auto row = static_cast<std::size_t>(row_of_[vertex_[a]]);
    for (std::size_t e = C.begin[row]; e < C.begin[row + 1]; ++e) {
      const int b = slot_[C.vertex[C.other[e]]];
      if (b < 0 || (static_cast<int>(a) >= own && b >= own)) continue;
      tensor_.push_back({static_cast<int>(a), b, e});
    }
  }
  // From every slot with a meeting's load to those that it moves.
  link_begin_.assign(static_cast<std::size_t>(own) + 1, 0);
  const auto for_links = [&](const auto& visit) {
    for (const Tensor& tensor : tensor_) {
      if (tensor.b < own) visit(tensor.b, Link{tensor.a, false, tensor.entry});
      if (tensor.a < own && tensor.a != tensor.b)
        visit(tensor.a, Link{tensor.b, true, tensor.entry});
    }
  };
  for_links([&](int from, const Link&) { ++link_begin_[static_cast<std::size_t>(from) + 1]; });
  for (std::size_t a = 0; a + 1 < link_begin_.size(); ++a) link_begin_[a + 1] += link_begin_[a];
  link_.resize(link_begin_.back());
  std::vector<std::size_t> next(link_begin_.begin(), link_begin_.end() - 1);
  for_links(
      [&](int from, const Link& link) { link_[next[static_cast<std::size_t>(from)]++] = link; });
}

/// q of a load's row times this is the force in it, over the root of the vertex' modulus.
double MeetingLoads::factor(const Load& load, int vertex) const {
  if (load.row < static_cast<int>(product_rows_)) return 1.0;
  const Meeting& meeting = meeting_[static_cast<std::size_t>(load.row) - product_rows_];
  return root_[meeting.at.vertex] / root_[vertex];
}

const SparseRows& MeetingLoads::responses(const SparseRows& of_product,
                                          const std::vector<double>& root) {
  root_ = root;
  const std::size_t p = product_rows_;
  const std::size_t all = p + meeting_.size();
  std::vector<double> dense(meeting_.size() * all, 0.0);
  std::vector<Vec3> moved(vertex_.size(), Vec3::Zero());
  std::vector<char> is_moved(vertex_.size(), 0);
  std::vector<int> reached;
  for (std::size_t k = 0; k < meeting_.size(); ++k) {
    const Meeting& meeting = meeting_[k];
    reached.clear();
    for (std::size_t c = 0; c < kCorners; ++c) {
      const int v = meeting.vertex[c];
      const auto from = static_cast<std::size_t>(slot_[v]);
      const Vec3 load = root_scale_[v] * root_[meeting.at.vertex] / root_[v] * meeting.share[c];
      for (std::size_t e = link_begin_[from]; e < link_begin_[from + 1]; ++e) {
        const Link& link = link_[e];
        const Eigen::Matrix3f& C = compliance_->tensor[link.entry];
        const Eigen::Vector3f x = load.cast<float>();
        moved[link.slot] +=
            (link.is_other ? Eigen::Vector3f(C.transpose() * x) : Eigen::Vector3f(C * x))
                .cast<double>();
        if (is_moved[link.slot] == 0) reached.push_back(link.slot);
        is_moved[link.slot] = 1;
      }
    }
    // Of two meetings each pair once, so that both entries are the same to the last bit.
    for (const int o : reached) {
      for (const Load& load : load_[o]) {
        const auto row = static_cast<std::size_t>(load.row);
        if (row > p + k) continue;
        dense[k * all + row] += factor(load, vertex_[o]) * load.vector.dot(moved[o]);
      }
      moved[o].setZero();
      is_moved[o] = 0;
    }
    for (std::size_t l = 0; l < k; ++l) dense[l * all + p + k] = dense[k * all + p + l];
  }
  responses_.begin.assign(1, 0);
  responses_.column.clear();
  responses_.value.clear();
  const auto put = [&](std::size_t column, double value) {
    if (value == 0.0) return;
    responses_.column.push_back(static_cast<int>(column));
    responses_.value.push_back(static_cast<float>(value));
  };
  for (std::size_t i = 0; i < p; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(of_product.begin[i]);
    const auto last = static_cast<std::ptrdiff_t>(of_product.begin[i + 1]);
    responses_.column.insert(responses_.column.end(), of_product.column.begin() + first,
                             of_product.column.begin() + last);
    responses_.value.insert(responses_.value.end(), of_product.value.begin() + first,
                            of_product.value.begin() + last);
    for (std::size_t k = 0; k < meeting_.size(); ++k) put(p + k, dense[k * all + i]);
    responses_.begin.push_back(responses_.column.size());
  }
  for (std::size_t k = 0; k < meeting_.size(); ++k) {
    for (std::size_t j = 0; j < all; ++j) put(j, dense[k * all + j]);
    responses_.begin.push_back(responses_.column.size());
  }
  return responses_;
}

std::vector<int> MeetingLoads::rows(const std::vector<int>& of_product) const {
  std::vector<int> result = of_product;
  for (const Meeting& meeting : meeting_) result.push_back(meeting.at.vertex);
  return result;
}

void MeetingLoads::append(std::vector<double>& b, std::vector<char>& in_contact,
                          std::vector<double>& q) const {
  for (const Meeting& meeting : meeting_) {
    const double root = root_[meeting.at.vertex];
    b.push_back(root * meeting.at.distance);
    in_contact.push_back(meeting.in_contact ? 1 : 0);
    // Tissue of another modulus, moved alike, has forces in proportion.
    const double was = meeting.was_root;
    q.push_back(meeting.force * (was > 0.0 ? root / (was * was) : 1.0 / root));
  }
}

void MeetingLoads::take_off(std::vector<double>& b, std::vector<char>& in_contact,
                            std::vector<double>& q, std::vector<double>& gap) {
  const std::size_t p = product_rows_;
  for (std::size_t k = 0; k < meeting_.size(); ++k) {
    Meeting& meeting = meeting_[k];
    const double root = root_[meeting.at.vertex];
    meeting.was_root = root;
    meeting.force = root * q[p + k];
    meeting.gap = gap[p + k] / root;
    meeting.in_contact = in_contact[p + k] != 0;
  }
  b.resize(p);
  in_contact.resize(p);
  q.resize(p);
  gap.resize(p);
}

std::vector<char> MeetingLoads::with_contact(const std::vector<char>& of_product) const {
  std::vector<char> result = of_product;
  for (const Meeting& meeting : meeting_) result.push_back(meeting.in_contact ? 1 : 0);
  return result;
}

double MeetingLoads::complementarity() const {
  double most = 0.0;
  for (const Meeting& meeting : meeting_) {
    most = std::max(most, std::abs(meeting.force * meeting.gap));
  }
  return most;
}

std::vector<double> MeetingLoads::meeting_q() const {
  std::vector<double> q;
  for (const Meeting& meeting : meeting_) {
    q.push_back(meeting.force / root_[meeting.at.vertex]);
  }
  return q;
}

/// Displacement of each slot times the root of its modulus over root_scale_ (reference posture).
std::vector<Vec3> MeetingLoads::slot_displacement(const std::vector<double>& product_q,
                                                  const std::vector<double>& meeting_q) const {
  std::vector<Vec3> load(vertex_.size(), Vec3::Zero());
  for (std::size_t a = 0; a < vertex_.size(); ++a) {
    for (const Load& one : load_[a]) {
      const auto row = static_cast<std::size_t>(one.row);
      const double q = row < product_rows_ ? product_q[row] : meeting_q[row - product_rows_];
      if (q != 0.0) load[a] += q * factor(one, vertex_[a]) * one.vector;
    }
  }
  std::vector<Vec3> moved(vertex_.size(), Vec3::Zero());
  for (const Tensor& tensor : tensor_) {
    const Eigen::Matrix3d C = compliance_->tensor[tensor.entry].cast<double>();
    moved[tensor.a] += C * load[tensor.b];
    if (tensor.a != tensor.b) moved[tensor.b] += C.transpose() * load[tensor.a];
  }
  return moved;
}

void MeetingLoads::add_work(const std::vector<double>& product_force, std::vector<int>& vertex,
                            std::vector<double>& force, std::vector<double>& displacement) const {
  std::vector<double> product_q(product_force.size(), 0.0);
  for (std::size_t a = 0; a < vertex_.size(); ++a) {
    for (const Load& load : load_[a]) {
      const auto row = static_cast<std::size_t>(load.row);
      if (row < product_rows_) product_q[row] = product_force[row] / root_[vertex_[a]];
    }
  }
  const std::vector<Vec3> moved = slot_displacement(product_q, meeting_q());
  for (const Meeting& meeting : meeting_) {
    if (!(meeting.force > 0.0)) continue;
    for (std::size_t c = 0; c < kCorners; ++c) {
      const int v = meeting.vertex[c];
      vertex.push_back(v);
      force.push_back(meeting.force);
      displacement.push_back(root_scale_[v] / root_[v] * meeting.share[c].dot(moved[slot_[v]]));
    }
  }
}

void MeetingLoads::add_slopes(const std::vector<double>& product_q, const std::vector<double>& y,
                              const std::vector<hand::Region>& region,
                              std::array<double, hand::kRegionCount>& slope) const {
  const auto p = static_cast<std::ptrdiff_t>(product_rows_);
  const std::vector<double> own_q = meeting_q();
  const std::vector<double> product_y(y.begin(), y.begin() + p);
  const std::vector<double> own_y(y.begin() + p, y.end());
  const std::vector<Vec3> moved_q = slot_displacement(product_q, own_q);
  const std::vector<Vec3> moved_y = slot_displacement(product_y, own_y);
  for (std::size_t a = 0; a < vertex_.size(); ++a) {
    for (const Load& load : load_[a]) {
      const auto row = static_cast<std::size_t>(load.row);
      if (row < product_rows_) continue;
      const Vec3 vector = factor(load, vertex_[a]) * load.vector;
      slope[index_of(region[vertex_[a]])] +=
          0.5 * (own_y[row - product_rows_] * vector.dot(moved_q[a]) +
                 own_q[row - product_rows_] * vector.dot(moved_y[a]));
    }
  }
}

MeetingLoads::Field MeetingLoads::field_of_meetings() const {
  Field field{
      std::vector<Vec3>(row_of_.size(), Vec3::Zero()), std::vector<char>(row_of_.size(), 0), {}};
  for (const Meeting& meeting : meeting_) {
    if (!(meeting.force > 0.0)) continue;
    for (std::size_t c = 0; c < kCorners; ++c) {
      const int v = meeting.vertex[c];
      if (field.is_loaded[v] == 0) field.vertex.push_back(v);
      field.is_loaded[v] = 1;
      field.load[v] += meeting.force * root_scale_[v] / root_[v] * meeting.share[c];
    }
  }
  return field;
}

void MeetingLoads::add_product(const std::vector<int>& vertices,
                               const std::vector<Vec3>& directions,
                               const std::vector<double>& force, Field& field) const {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const int v = vertices[i];
    if (!(force[i] > 0.0) || row_of_[v] < 0) continue;
    if (field.is_loaded[v] == 0) field.vertex.push_back(v);
    field.is_loaded[v] = 1;
    field.load[v] += force[i] * root_scale_[v] / root_[v] * directions[i];
  }
}

/// Displacements in the reference posture, mm.
std::vector<Vec3> MeetingLoads::moved_by(const Field& field, const std::vector<int>& at) const {
  std::vector<char> is_asked(row_of_.size(), 0);
  std::vector<int> rows = field.vertex;
  for (const int v : at) {
    if (row_of_[v] < 0 || is_asked[v] != 0) continue;
    is_asked[v] = 1;
    if (field.is_loaded[v] == 0) rows.push_back(v);
  }
  std::vector<Vec3> moved(row_of_.size(), Vec3::Zero());
  const SkinCompliance& C = *compliance_;
  for (const int v : rows) {
    const auto row = static_cast<std::size_t>(row_of_[v]);
    for (std::size_t e = C.begin[row]; e < C.begin[row + 1]; ++e) {
      const int w = C.vertex[C.other[e]];
      if (field.is_loaded[w] != 0 && is_asked[v] != 0) {
        moved[v] += C.tensor[e].cast<double>() * field.load[w];
      }
      if (field.is_loaded[v] != 0 && is_asked[w] != 0 && w != v) {
        moved[w] += C.tensor[e].cast<double>().transpose() * field.load[v];
      }
    }
  }
  std::vector<Vec3> result;
  result.reserve(at.size());
  for (const int v : at) {
    const bool has_tissue = row_of_[v] >= 0;
    result.push_back(has_tissue ? Vec3(root_scale_[v] / root_[v] * moved[v]) : Vec3(Vec3::Zero()));
  }
  return result;
}

bool MeetingLoads::extend(const std::vector<int>& vertices, const std::vector<Vec3>& directions,
                          const std::vector<double>& force, const std::vector<double>& root) {
  if (near_.empty()) return false;
  root_ = root;
  Field field = field_of_meetings();
  add_product(vertices, directions, force, field);
  std::vector<int> at;
  for (const Meeting& meeting : near_) {
    at.insert(at.end(), meeting.vertex.begin(), meeting.vertex.end());
  }
  const std::vector<Vec3> moved = moved_by(field, at);
  std::vector<Meeting> still;
  const std::size_t before = meeting_.size();
  for (std::size_t k = 0; k < near_.size(); ++k) {
    double gap = near_[k].at.distance;
    for (std::size_t c = 0; c < kCorners; ++c) {
      gap += near_[k].share[c].dot(moved[kCorners * k + c]);
    }
    if (!(gap < -kLeastBulge)) {
      still.push_back(near_[k]);
      continue;
    }
    near_[k].in_contact = true;
    meeting_.push_back(near_[k]);
  }
  near_ = std::move(still);
  std::sort(meeting_.begin(), meeting_.end(),
            [](const Meeting& a, const Meeting& b) { return a.at.vertex < b.at.vertex; });
  return meeting_.size() > before;
}

std::vector<int> MeetingLoads::corners() const {
  std::vector<int> result;
  for (const std::vector<Meeting>* list : {&meeting_, &near_}) {
    for (const Meeting& meeting : *list) {
      result.insert(result.end(), meeting.vertex.begin(), meeting.vertex.end());
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<Vec3> MeetingLoads::whole_displacement(const std::vector<int>& at,
                                                   const std::vector<int>& vertices,
                                                   const std::vector<Vec3>& directions,
                                                   const std::vector<double>& force) const {
  Field field = field_of_meetings();
  add_product(vertices, directions, force, field);
  std::vector<Vec3> result = moved_by(field, at);
  for (std::size_t k = 0; k < at.size(); ++k) result[k] = to_posed(at[k]) * result[k];
  return result;
}

std::vector<Vec3> MeetingLoads::reference_displacement(const std::vector<int>& at) const {
  return moved_by(field_of_meetings(), at);
}

std::vector<Vec3> MeetingLoads::displacement(const std::vector<int>& at) const {
  std::vector<Vec3> result = reference_displacement(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    if (!result[k].isZero(0.0)) result[k] = to_posed(at[k]) * result[k];
  }
  return result;
}

std::vector<SkinTouch> MeetingLoads::touches() const {
  std::vector<SkinTouch> result;
  for (const Meeting& meeting : meeting_) {
    if (meeting.force > 0.0) result.push_back({meeting.at, meeting.force});
  }
  return result;
}

}  // namespace palmar::contact
