// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/sensors/sensor_reading.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "palmar/contact/response/response.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/core/error.h"
#include "palmar/geometry/convex_hull.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/study/sensors/cell_grid.h"

namespace palmar::study {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kOnEnd = 0.8;     // cosine of normal and axis; beyond, it is an end. Our choice
constexpr double kMatReach = 2.0;  // cells; how far a mat stands off hollows. Our choice

/// Axes of a mat's sheet: x and y across the axis, z along it.
struct MatFrame {
  Vec3 origin, axis, first, second;
  Vec2 across(const Vec3& x) const { return {(x - origin).dot(first), (x - origin).dot(second)}; }
};

MatFrame mat_frame(const SensorLayout& layout, const grasp::Grasp& grasp) {
  MatFrame frame;
  frame.origin = layout.origin.value_or(grasp.grip_point);
  frame.axis = layout.axis.value_or(grasp.grip_axis).normalized();
  Vec3 seam = layout.seam.value_or(Vec3::UnitX());
  if (!layout.seam && std::abs(frame.axis.x()) > 0.9) seam = Vec3::UnitY();
  seam -= seam.dot(frame.axis) * frame.axis;
  if (seam.norm() < 1e-6) {
    throw UsageError("sensor layout \"" + layout.name +
                     "\": the seam lies along the axis; a direction across it is required");
  }
  frame.first = seam.normalized();
  frame.second = frame.axis.cross(frame.first);
  return frame;
}

/// The convex outline of a section, by its length from the seam on.
class Wrap {
 public:
  Wrap() = default;
  explicit Wrap(std::vector<Vec2> corners) : corner_(std::move(corners)) {
    if (corner_.size() < 3) {
      corner_.clear();
      return;
    }
    way_.push_back(0.0);
    for (std::size_t i = 0; i < corner_.size(); ++i) {
      way_.push_back(way_.back() + (next(i) - corner_[i]).norm());
    }
    seam_ = place_of_seam();
  }
  bool is_empty() const { return corner_.empty(); }
  double girth() const { return way_.empty() ? 0.0 : way_.back(); }

  struct Place {
    double way = 0.0;   ///< from the seam, against the clock, mm
    double away = 0.0;  ///< from the outline, mm
  };
  Place nearest(const Vec2& x) const {
    Place best{0.0, 1e300};
    for (std::size_t i = 0; i < corner_.size(); ++i) {
      const Vec2 side = next(i) - corner_[i];
      const double t = std::clamp((x - corner_[i]).dot(side) / side.squaredNorm(), 0.0, 1.0);
      const double away = (x - corner_[i] - t * side).norm();
      if (away < best.away) best = {way_[i] + t * side.norm(), away};
    }
    best.way -= seam_;
    if (best.way < 0.0) best.way += girth();
    return best;
  }

 private:
  const Vec2& next(std::size_t i) const { return corner_[(i + 1) % corner_.size()]; }

  /// Where the ray from the axis along x leaves the outline; of an axis outside it, the corner that
  /// is farthest along x.
  double place_of_seam() const {
    double way = 0.0;
    double farthest = -1e300;
    for (std::size_t i = 0; i < corner_.size(); ++i) {
      const Vec2 side = next(i) - corner_[i];
      if (corner_[i].y() <= 0.0 && next(i).y() > 0.0) {
        const double t = -corner_[i].y() / side.y();
        const double x = corner_[i].x() + t * side.x();
        if (x > farthest) {
          farthest = x;
          way = way_[i] + t * side.norm();
        }
      }
    }
    return way;
  }

  std::vector<Vec2> corner_;
  std::vector<double> way_;
  double seam_ = 0.0;
};

/// The outline round the axis at a height along it: of the section's closed curves the one whose
/// outline holds the axis, else the nearest.
Wrap wrap_at(const product::Product& product, const MatFrame& frame, double height) {
  const std::vector<geometry::SectionCurve> curves =
      geometry::plane_section(product.mesh, frame.origin + height * frame.axis, frame.axis);
  Wrap best;
  double nearest = 1e300;
  for (const geometry::SectionCurve& curve : curves) {
    if (!curve.is_closed) continue;
    std::vector<Vec2> points;
    for (const Vec3& p : curve.point) points.push_back(frame.across(p));
    const std::vector<Vec2> hull = geometry::convex_hull(std::move(points));
    if (hull.size() < 3) continue;
    double away = -1e300;  // of the axis from the hull; negative inside
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec2 side = hull[(i + 1) % hull.size()] - hull[i];
      away = std::max(away, (side.y() * -hull[i].x() - side.x() * -hull[i].y()) / side.norm());
    }
    Wrap wrap(hull);
    // Of several that hold it (a tube has two) the outermost.
    const double rank = away < 0.0 ? -wrap.girth() : away;
    if (rank < nearest) {
      nearest = rank;
      best = std::move(wrap);
    }
  }
  return best;
}

/// The cell with the forces of the regions that press it.
void add_cell(SensorCell cell, const std::array<double, hand::kRegionCount>& share,
              SensorReading& reading) {
  double most = 0.0;
  for (int r = 0; r < hand::kRegionCount; ++r) {
    cell.force += share[r];
    if (share[r] <= most) continue;
    most = share[r];
    cell.region = static_cast<hand::Region>(r);
  }
  if (cell.area > 0.0) cell.mean_pressure = cell.force / cell.area;
  reading.force += cell.force;
  reading.peak_pressure = std::max(reading.peak_pressure, cell.mean_pressure);
  if (cell.force > 0.0) reading.area += cell.area;
  reading.cells.push_back(std::move(cell));
}

void add_cells(const CellGrid& grid, const std::string& patch, SensorReading& reading,
               const std::vector<double>& widths = {}) {
  const double pitch = reading.layout.pitch;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      SensorCell cell;
      cell.patch = patch;
      cell.row = row + 1;
      cell.column = column + 1;
      // The last column of a sheet that has come round is as wide as there is room for.
      const double room = widths.empty() ? pitch : widths[row] - column * pitch;
      cell.area = pitch * std::clamp(room, 0.0, pitch);
      add_cell(std::move(cell), grid.share(row, column), reading);
    }
  }
}

void read_mat(const hand::Hand& hand, const product::Product& product, const grasp::Grasp& grasp,
              const contact::ContactResult& contact, SensorReading& reading) {
  const SensorLayout& layout = reading.layout;
  const MatFrame frame = mat_frame(layout, grasp);
  const double pitch = layout.pitch;
  const double bottom = -0.5 * layout.rows * pitch;
  std::vector<Wrap> wraps;
  std::vector<double> girths;
  double longest = 0.0;
  for (int row = 0; row < layout.rows; ++row) {
    wraps.push_back(wrap_at(product, frame, bottom + (row + 0.5) * pitch));
    girths.push_back(wraps.back().girth());
    longest = std::max(longest, girths.back());
  }
  if (longest == 0.0) {
    throw UsageError("sensor layout \"" + layout.name +
                     "\": the mat's rows don't meet the product; another origin or axis is "
                     "required");
  }
  reading.rows = layout.rows;
  const double most = std::ceil(longest / pitch);
  if (layout.columns == 0 && most > kMostSensorRows) {
    throw UsageError("sensor layout \"" + layout.name + "\": " + std::to_string(int(most)) +
                     " columns would go round the product; at most " +
                     std::to_string(kMostSensorRows) +
                     " are allowed, so a wider pitch is required");
  }
  reading.columns = layout.columns > 0 ? layout.columns : static_cast<int>(most);
  CellGrid grid(reading.rows, reading.columns, pitch);
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    const double force = contact.force[v];
    if (!(force > 0.0)) continue;
    const Vec3& x = contact.deformed[v];
    const double along = (x - frame.origin).dot(frame.axis) - bottom;
    const int row = static_cast<int>(std::floor(along / pitch));
    const Vec3 normal = product.distance->at(x).normal;
    const bool is_beside = row < 0 || row >= reading.rows || wraps[row].is_empty() ||
                           std::abs(normal.dot(frame.axis)) > kOnEnd;
    if (is_beside) {
      reading.force_beside += force;
      continue;
    }
    const Wrap::Place place = wraps[row].nearest(frame.across(x));
    if (place.away > kMatReach * pitch) {
      reading.force_beside += force;
      continue;
    }
    const double area = contact.pressure[v] > 0.0 ? force / contact.pressure[v] : 0.0;
    reading.force_beside += grid.spread(along, place.way, std::max(area, 1e-3), force,
                                        hand.region[v], wraps[row].girth());
  }
  add_cells(grid, "mat", reading, girths);
}

/// Where a patch's cells lie on the skin of its region, in the open hand.
class PatchFrame {
 public:
  PatchFrame(const hand::Hand& hand, const contact::SkinGeometry& skin, hand::Region region) {
    Vec3 normal = Vec3::Zero();
    Vec3 middle = Vec3::Zero();
    double area = 0.0;
    std::vector<int> own;
    for (int v = 0; v < skin.vertex_count(); ++v) {
      if (hand.region[v] != region) continue;
      own.push_back(v);
      normal += skin.area[v] * skin.normal[v];
      middle += skin.area[v] * skin.position[v];
      area += skin.area[v];
    }
    if (own.empty()) {
      throw UsageError("hand \"" + hand.name + "\" has no skin on " + std::string(name_of(region)) +
                       ", where the glove has a patch");
    }
    middle_ = middle / area;
    const hand::Segment segment = hand::segment_of(region).value_or(hand::Segment::kPalm);
    along_ = along_of(hand, segment);
    normal_ = (normal - normal.dot(along_) * along_).normalized();
    across_ = along_.cross(normal_) * (hand.side == hand::Side::kRight ? 1.0 : -1.0);
    if (segment != hand::Segment::kPalm) {
      bone_ = hand.skeleton.joint(hand::joint_of(segment)).centre;
      for (const int v : own) radius_ += skin.area[v] * away_from_bone(skin.position[v]);
      radius_ /= area;
    }
    // Cells lie about the middle of what they are to cover.
    const Vec2 offset = place(middle_);
    double low = 1e300, high = -1e300, left = 1e300, right = -1e300;
    for (const int v : own) {
      const Vec2 at = place(skin.position[v]);
      low = std::min(low, at.x());
      high = std::max(high, at.x());
      left = std::min(left, at.y());
      right = std::max(right, at.y());
    }
    zero_ = Vec2(0.5 * (low + high), radius_ > 0.0 ? 0.5 * (left + right) : offset.y());
  }

  /// Along and across from the patch's middle, mm.
  Vec2 at(const Vec3& x) const { return place(x) - zero_; }

 private:
  static Vec3 along_of(const hand::Hand& hand, hand::Segment segment) {
    if (segment == hand::Segment::kPalm) return Vec3::UnitY();  // hand frame: distal
    const Vec3 proximal = hand.skeleton.joint(hand::joint_of(segment)).centre;
    const hand::Finger finger = *hand::finger_of(segment);
    const auto segments = hand::segments_of(finger);
    Vec3 distal = hand.skeleton.fingertips[index_of(finger)];
    for (std::size_t k = 0; k + 1 < segments.size(); ++k) {
      if (segments[k] == segment && segments[k + 1]) {
        distal = hand.skeleton.joint(hand::joint_of(*segments[k + 1])).centre;
      }
    }
    return (distal - proximal).normalized();
  }
  Vec3 from_bone(const Vec3& x) const {
    const Vec3 way = x - bone_;
    return way - way.dot(along_) * along_;
  }
  double away_from_bone(const Vec3& x) const { return from_bone(x).norm(); }
  Vec2 place(const Vec3& x) const {
    const double along = (x - middle_).dot(along_);
    if (radius_ == 0.0) return {along, (x - middle_).dot(across_)};
    const Vec3 out = from_bone(x);
    return {along, radius_ * std::atan2(out.dot(across_), out.dot(normal_))};
  }

  Vec3 middle_ = Vec3::Zero(), along_ = Vec3::UnitY(), across_ = Vec3::UnitX(),
       normal_ = Vec3::UnitZ(), bone_ = Vec3::Zero();
  double radius_ = 0.0;  // of the skin round the bone, mm; 0: flat
  Vec2 zero_ = Vec2::Zero();
};

void read_glove(const hand::Hand& hand, const contact::ContactResult& contact,
                SensorReading& reading) {
  const SensorLayout& layout = reading.layout;
  const contact::SkinGeometry skin = contact::skin_geometry(hand.skin);
  std::array<bool, hand::kRegionCount> is_covered{};
  for (const SensorPatch& patch : layout.patches) {
    is_covered[index_of(patch.region)] = true;
    const PatchFrame frame(hand, skin, patch.region);
    CellGrid grid(patch.rows, patch.columns, layout.pitch);
    const Vec2 corner(0.5 * patch.rows * layout.pitch, 0.5 * patch.columns * layout.pitch);
    for (std::size_t v = 0; v < contact.force.size(); ++v) {
      if (!(contact.force[v] > 0.0) || hand.region[v] != patch.region) continue;
      const Vec2 at = frame.at(skin.position[v]) + corner;
      reading.force_beside +=
          grid.spread(at.x(), at.y(), skin.area[v], contact.force[v], patch.region);
    }
    add_cells(grid, std::string(name_of(patch.region)), reading);
  }
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (!is_covered[index_of(hand.region[v])]) reading.force_beside += contact.force[v];
  }
}

void read_free(const hand::Hand& hand, const product::Product& product,
               const contact::ContactResult& contact, SensorReading& reading) {
  std::vector<double> left = contact.force;
  for (const FreeSensor& one : reading.layout.sensors) {
    const double radius = std::sqrt(one.area / std::numbers::pi);
    const Vec3 normal = product.distance->at(one.at).normal;
    std::array<double, hand::kRegionCount> share{};
    for (std::size_t v = 0; v < left.size(); ++v) {
      if (!(contact.force[v] > 0.0 && contact.pressure[v] > 0.0)) continue;
      const double area = contact.force[v] / contact.pressure[v];
      const double own = std::sqrt(area / std::numbers::pi);
      const double away = (contact.deformed[v] - one.at).norm();
      if (away >= radius + own) continue;
      // Not what presses a thin wall's other side.
      if (product.distance->at(contact.deformed[v]).normal.dot(normal) < 0.0) continue;
      const double part =
          std::min(left[v], contact.pressure[v] * contact::disc_overlap(away, radius, own));
      left[v] -= part;
      share[index_of(hand.region[v])] += part;
    }
    SensorCell cell;
    cell.patch = one.name;
    cell.area = one.area;
    add_cell(std::move(cell), share, reading);
  }
  for (const double rest : left) reading.force_beside += rest;
}

}  // namespace

SensorReading sensor_reading(const hand::Hand& hand, const product::Product& product,
                             const grasp::Grasp& grasp, const contact::ContactResult& contact,
                             const SensorLayout& layout) {
  layout.check();
  if (contact.force.size() != hand.region.size()) {
    throw UsageError("sensor: contact of " + std::to_string(contact.force.size()) +
                     " vertices for a hand of " + std::to_string(hand.region.size()));
  }
  SensorReading reading;
  reading.layout = layout;
  switch (layout.kind) {
    case SensorKind::kMat:
      read_mat(hand, product, grasp, contact, reading);
      break;
    case SensorKind::kGlove:
      read_glove(hand, contact, reading);
      break;
    case SensorKind::kFree:
      read_free(hand, product, contact, reading);
      break;
  }
  return reading;
}

}  // namespace palmar::study
