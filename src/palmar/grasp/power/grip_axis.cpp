// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/grip_axis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/grasp/power/section_stack.h"

namespace palmar::grasp {
namespace {

constexpr double kLargestTaper = 0.6;  // radius per length; a steeper cone slips out
constexpr double kLargestLean = 0.6;   // sideways step of the centre line per length (31 deg)
constexpr double kRoundEnough = 0.5;   // thickness / width from which a handle counts as round
constexpr double kKeyed = 0.8;         // ... and up to which it keys the tool against turning
constexpr double kRoundLoss = 0.2;     // loss of a quite round one: more often a barrel or a shaft
constexpr double kSmallestScore = 1e-12;  // below: not a handle in any sense
constexpr int kDirections = 16;           // with the principal axes they cover the half sphere
constexpr int kRefinements = 2;
constexpr double kBridged = 24.0;        // mm of a bar that something beside it may hide
constexpr double kLargestLug = 1.4;      // area of the section with what hides it
constexpr double kFingersBreadth = 0.8;  // four fingers round a handle / palm breadth
constexpr double kWorthwhile = 0.15;     // share of the best score below which a site is dropped
constexpr std::size_t kKept = 4;

// A run of outlines that follow each other.
struct Bar {
  std::vector<double> station;
  std::vector<SectionOutline> outline;
  int missed = 0;  // sections in a row without a successor
};

// Outlines between two of a bar, where something else hid it.
void bridge(Bar& bar, double station, const SectionOutline& next, double spacing) {
  const SectionOutline last = bar.outline.back();
  const double from = bar.station.back();
  for (int k = 1; k <= bar.missed; ++k) {
    const double share = k * spacing / (station - from);
    SectionOutline between = share < 0.5 ? last : next;
    between.centroid = (1.0 - share) * last.centroid + share * next.centroid;
    bar.station.push_back(from + k * spacing);
    bar.outline.push_back(between);
  }
  bar.missed = 0;
}

double diameter(const SectionOutline& outline) { return outline.girth / std::numbers::pi; }

bool follows(const SectionOutline& a, const SectionOutline& b, const Vec3& axis,
             double step_length) {
  const Vec3 step = b.centroid - a.centroid;
  const double sideways = (step - axis * axis.dot(step)).norm();
  const double taper = std::abs(diameter(a) - diameter(b)) / 2.0;
  return sideways <= kLargestLean * step_length && taper <= kLargestTaper * step_length;
}

// Beyond a lug (where a mug's handle begins) a body goes on as it was before.
bool resumes(const SectionOutline& a, const SectionOutline& b) {
  return std::abs(a.girth - b.girth) < 0.15 * a.girth &&
         (a.centroid - b.centroid).norm() < kBridged + 0.1 * diameter(a);
}

// Whether an outline could be a bar with a lug at its side.
bool hides(const SectionOutline& outline, const SectionOutline& bar) {
  return outline.area > bar.area && outline.area < kLargestLug * bar.area &&
         (outline.centroid - bar.centroid).norm() < kBridged + 0.25 * diameter(bar);
}

std::vector<Bar> bars_in(const std::vector<Section>& sections, const Vec3& axis, double spacing) {
  std::vector<Bar> done;
  std::vector<Bar> open;
  for (const Section& section : sections) {
    std::vector<Bar> still_open;
    std::vector<char> taken(section.outlines.size(), 0);
    for (Bar& bar : open) {
      std::optional<std::size_t> best;
      double best_distance = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < section.outlines.size(); ++i) {
        if (taken[i] != 0) continue;
        const double gap = section.station - bar.station.back();
        if (!follows(bar.outline.back(), section.outlines[i], axis, gap)) continue;
        if (bar.missed > 0 && !resumes(bar.outline.back(), section.outlines[i])) continue;
        const double distance = (section.outlines[i].centroid - bar.outline.back().centroid).norm();
        if (distance < best_distance) {
          best_distance = distance;
          best = i;
        }
      }
      if (best) {
        taken[*best] = 1;
        if (bar.missed > 0) bridge(bar, section.station, section.outlines[*best], spacing);
        bar.station.push_back(section.station);
        bar.outline.push_back(section.outlines[*best]);
        still_open.push_back(std::move(bar));
      } else if ((bar.missed + 1) * spacing <= kBridged && bar.station.size() >= 3 &&
                 std::any_of(
                     section.outlines.begin(), section.outlines.end(),
                     [&](const SectionOutline& o) { return hides(o, bar.outline.back()); })) {
        ++bar.missed;
        still_open.push_back(std::move(bar));
      } else {
        done.push_back(std::move(bar));
      }
    }
    for (std::size_t i = 0; i < section.outlines.size(); ++i) {
      if (taken[i] == 0) still_open.push_back({{section.station}, {section.outlines[i]}});
    }
    open = std::move(still_open);
  }
  for (Bar& bar : open) done.push_back(std::move(bar));
  std::erase_if(done, [](const Bar& bar) { return bar.station.size() < 3; });
  return done;
}

double girth_score(double girth, double hand_length) {
  const double ratio = std::log(girth / std::numbers::pi / (kBestDiameter * hand_length));
  const double z = ratio / (ratio < 0.0 ? kThinSpread : kThickSpread);
  return std::exp(-0.5 * z * z);
}

// Best window of one palm breadth on a bar.
struct Window {
  double score = 0.0;
  double centre = 0.0;  // station, mm
  double length = 0.0;  // of the whole bar, mm
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
  SectionOutline outline;
};

Window score_window(const Bar& bar, std::size_t first, std::size_t last, double spacing,
                    const Vec3& axis, const Vec3& gravity, const GripSearchOptions& options) {
  Window window;
  const double count = static_cast<double>(last - first + 1);
  double fit = 0.0;
  Vec3 mean = Vec3::Zero();
  double mean_diameter = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const SectionOutline& o = bar.outline[k];
    const double ratio = o.thickness / o.width;
    const double roundness = std::min(1.0, ratio / kRoundEnough);
    const double keyed =
        ratio < kKeyed ? 1.0 : 1.0 - kRoundLoss * (ratio - kKeyed) / (1.0 - kKeyed);
    fit += girth_score(o.girth, options.hand_length) * roundness * roundness * keyed;
    mean += o.centroid;
    mean_diameter += diameter(o);
  }
  mean /= count;
  mean_diameter /= count;
  // Least-squares line through the centroids over the station.
  double spread = 0.0;
  Vec3 slope = Vec3::Zero();
  const double mean_station = axis.dot(mean);
  for (std::size_t k = first; k <= last; ++k) {
    const double s = bar.station[k] - mean_station;
    spread += s * s;
    slope += s * (bar.outline[k].centroid - mean);
  }
  window.direction = spread > 0.0 ? slope.normalized() : axis;
  double bend = 0.0;
  for (std::size_t k = first; k <= last; ++k) {
    const Vec3 r = bar.outline[k].centroid - mean;
    bend += (r - window.direction * window.direction.dot(r)).squaredNorm();
  }
  bend = std::sqrt(bend / count) / (0.25 * mean_diameter);
  const double straight = std::exp(-bend * bend);
  const double filled = std::min(1.0, count * spacing / (kFingersBreadth * options.palm_breadth));
  const double coverage = filled * filled;

  const double low = bar.station.front() - 0.5 * spacing;
  const double high = bar.station.back() + 0.5 * spacing;
  const double gravity_station = axis.dot(gravity);
  const double centre = 0.5 * (bar.station[first] + bar.station[last]);
  const double away = std::abs(centre - gravity_station);
  const bool is_balanced = gravity_station > low && gravity_station < high;
  const double place = is_balanced ? 1.0 - 0.3 * std::min(1.0, away / options.palm_breadth)
                                   : 0.7 + 0.3 * std::min(1.0, away / (high - low + away) * 2.0);
  window.score = fit / count * straight * coverage * place;
  window.centre = centre;
  window.length = high - low;
  const std::size_t middle = (first + last) / 2;
  window.outline = bar.outline[middle];
  window.point =
      mean + window.direction * (centre - mean_station) / std::max(0.5, window.direction.dot(axis));
  return window;
}

std::optional<Window> best_window(const Bar& bar, double spacing, const Vec3& axis,
                                  const Vec3& gravity, const GripSearchOptions& options) {
  const std::size_t count = bar.station.size();
  const auto span = std::min<std::size_t>(
      count, static_cast<std::size_t>(std::lround(options.palm_breadth / spacing)));
  std::optional<Window> best;
  for (std::size_t first = 0; first + span <= count; ++first) {
    Window window = score_window(bar, first, first + span - 1, spacing, axis, gravity, options);
    const std::optional<Vec3>& place = options.at ? options.at : options.near;
    if (place && std::abs(axis.dot(*place) - window.centre) > 0.75 * spacing && count > span) {
      // Asked for a place: the window nearest to it, whatever its neighbours score.
      window.score *= std::exp(-std::abs(axis.dot(*place) - window.centre) / spacing);
    }
    if (!best || window.score > best->score) best = window;
  }
  return best;
}

double spacing_for(const geometry::TriangleMesh& mesh, const Vec3& axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& v : mesh.vertices) {
    low = std::min(low, axis.dot(v));
    high = std::max(high, axis.dot(v));
  }
  // About 25 planes, but not so far apart that a palm breadth holds fewer than ten.
  return std::clamp((high - low) / 25.0, 3.0, 8.0);
}

// Straightens a window along its own centre line by cutting again across it.
struct Straightened {
  Window window;
  Vec3 axis;
};

Straightened straighten(const geometry::TriangleMesh& mesh, Window window, Vec3 axis,
                        const Vec3& gravity, const GripSearchOptions& options) {
  for (int round = 0; round < kRefinements; ++round) {
    const Vec3 next = options.axis ? *options.axis : window.direction;
    const double spacing = spacing_for(mesh, next);
    std::optional<Window> best;
    for (const Bar& bar : bars_in(sections_along(mesh, next, spacing), next, spacing)) {
      auto candidate = best_window(bar, spacing, next, gravity, options);
      if (!candidate) continue;
      const Vec3 gap = candidate->point - window.point;
      const double sideways = (gap - next * next.dot(gap)).norm();
      if (sideways > 0.5 * diameter(window.outline)) continue;
      if (!best || candidate->score > best->score) best = candidate;
    }
    if (!best) break;
    window = *best;
    axis = next;
  }
  return {window, axis};
}

// Third moment of the surface about a point along a direction: a sign that turns with the product.
double third_moment(const geometry::TriangleMesh& mesh, const Vec3& point, const Vec3& direction) {
  double moment = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const double s = direction.dot((a + b + c) / 3.0 - point);
    moment += (b - a).cross(c - a).norm() * s * s * s;
  }
  return moment;
}

std::vector<Vec3> directions(const geometry::TriangleMesh& mesh, const PrincipalFrame& frame) {
  // A mirrored product must be looked at from mirrored directions: the third axis has its own sign.
  Eigen::Matrix3d axes = frame.axes;
  if (third_moment(mesh, frame.centre, axes.col(2)) < 0.0) axes.col(2) = -axes.col(2);
  std::vector<Vec3> list = {axes.col(0), axes.col(1), axes.col(2)};
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {  // Fibonacci spiral on the half sphere
    const double z = (i + 0.5) / kDirections;
    const double r = std::sqrt(1.0 - z * z);
    list.push_back(axes * Vec3(r * std::cos(golden * i), r * std::sin(golden * i), z));
  }
  return list;
}

// Mean distance of the surface from the axis beyond the site less that on the other side, mm.
double flare_of(const geometry::TriangleMesh& mesh, const GripSite& site) {
  std::array<double, 2> moment = {0.0, 0.0}, area = {0.0, 0.0};
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const Vec3 r = (a + b + c) / 3.0 - site.point;
    const double along = site.axis.dot(r);
    const std::size_t side = along > 0.0 ? 0 : 1;
    const double weight = (b - a).cross(c - a).norm();
    moment[side] += weight * (r - along * site.axis).norm();
    area[side] += weight;
  }
  if (area[0] <= 0.0 || area[1] <= 0.0) return 0.0;
  return moment[0] / area[0] - moment[1] / area[1];
}

// Turns the axis to the working end and finds where that end sticks out.
void find_working_end(const geometry::TriangleMesh& mesh, const Vec3& gravity, double palm_breadth,
                      bool is_fixed, GripSite& site) {
  double low = 0.0, high = 0.0;
  for (const Vec3& v : mesh.vertices) {
    const double t = site.axis.dot(v - site.point);
    low = std::min(low, t);
    high = std::max(high, t);
  }
  const double longer = high + low;  // > 0: more length beyond the positive end
  const double heavier = site.axis.dot(gravity - site.point);
  const bool is_even = std::abs(longer) < 0.1 * (high - low);
  // Of even length: a vessel stands on its heavier end and is held with the mouth, as a rule the
  // wider end, at the thumb.
  double forward = longer;
  if (is_even) {
    forward = std::abs(heavier) > 0.03 * (high - low) ? -heavier : flare_of(mesh, site);
  }
  site.ahead = high;
  if (!is_fixed && forward < 0.0) {
    site.axis = -site.axis;
    site.ahead = -low;
  }

  Vec3 moment = Vec3::Zero();
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const Vec3 r = (a + b + c) / 3.0 - site.point;
    if (site.axis.dot(r) < 0.45 * palm_breadth) continue;
    const double weight = 0.5 * (b - a).cross(c - a).norm();
    moment += weight * (r - site.axis * site.axis.dot(r));
    area += weight;
  }
  if (area > 0.0 && moment.norm() / area > 0.25 * site.girth / std::numbers::pi) {
    site.nose = moment.normalized();
  }
}

}  // namespace

PrincipalFrame principal_frame(const geometry::TriangleMesh& mesh) {
  PrincipalFrame frame;
  if (mesh.triangles.empty()) return frame;
  Vec3 surface_moment = Vec3::Zero(), volume_moment = Vec3::Zero();
  double area = 0.0, volume = 0.0;
  const Vec3 origin = mesh.vertices.front();
  std::vector<Vec3> centre;
  std::vector<double> weight;
  centre.reserve(mesh.triangles.size());
  weight.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin;
    const Vec3 b = mesh.vertices[t[1]] - origin;
    const Vec3 c = mesh.vertices[t[2]] - origin;
    const double w = 0.5 * (b - a).cross(c - a).norm();
    const double six_volumes = a.dot(b.cross(c));
    centre.push_back((a + b + c) / 3.0);
    weight.push_back(w);
    surface_moment += w * centre.back();
    area += w;
    volume_moment += six_volumes * (a + b + c) / 4.0;
    volume += six_volumes;
  }
  if (area <= 0.0) return frame;
  const Vec3 mean = surface_moment / area;
  // A mesh that encloses next to nothing is a sheet; then the surface's centre is the better one.
  const bool has_volume = volume > 1e-6 * std::pow(area, 1.5);
  frame.centre = origin + (has_volume ? Vec3(volume_moment / volume) : mean);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const Vec3 r = centre[i] - mean;
    spread += weight[i] * r * r.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  for (int k = 0; k < 2; ++k) {
    Vec3 axis = solver.eigenvectors().col(2 - k);
    double third = 0.0;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const double s = axis.dot(centre[i] - mean);
      third += weight[i] * s * s * s;
    }
    if (third < 0.0) axis = -axis;
    frame.axes.col(k) = axis;
  }
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  return frame;
}

std::vector<GripSite> find_grip_sites(const geometry::TriangleMesh& mesh,
                                      const GripSearchOptions& options) {
  if (mesh.triangles.empty()) return {};
  const PrincipalFrame frame = principal_frame(mesh);
  struct Candidate {
    Window window;
    Vec3 axis;
  };
  std::vector<Candidate> candidates;
  const std::vector<Vec3> tried =
      options.axis ? std::vector<Vec3>{*options.axis} : directions(mesh, frame);
  for (const Vec3& axis : tried) {
    const double spacing = spacing_for(mesh, axis);
    for (const Bar& bar : bars_in(sections_along(mesh, axis, spacing), axis, spacing)) {
      const auto window = best_window(bar, spacing, axis, frame.centre, options);
      if (!window || window->score < kSmallestScore) continue;
      if (options.at || options.near) {
        const Vec3 gap = (options.at ? *options.at : *options.near) - window->point;
        const double sideways = (gap - axis * axis.dot(gap)).norm();
        if (sideways > diameter(window->outline)) continue;
        if (options.near && std::abs(axis.dot(gap)) > 0.5 * options.palm_breadth) continue;
      }
      candidates.push_back({*window, axis});
    }
  }
  const auto by_score = [](const auto& a, const auto& b) { return a.score > b.score; };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.window.score > b.window.score; });

  std::vector<GripSite> sites;
  for (const Candidate& candidate : candidates) {
    if (sites.size() >= kKept) break;
    if (!sites.empty() && candidate.window.score < kWorthwhile * sites.front().score) break;
    const auto is_near = [&](const GripSite& site) {
      const Vec3 gap = candidate.window.point - site.point;
      return gap.norm() < 0.4 * options.palm_breadth &&
             std::abs(candidate.window.direction.dot(site.axis)) > 0.9;
    };
    if (std::any_of(sites.begin(), sites.end(), is_near)) continue;
    const Straightened best =
        straighten(mesh, candidate.window, candidate.axis, frame.centre, options);
    GripSite site;
    site.axis = best.axis;
    site.point = options.at ? *options.at : best.window.point;
    if (options.near) site.point += site.axis * site.axis.dot(*options.near - site.point);
    site.girth = best.window.outline.girth;
    site.thickness = best.window.outline.thickness;
    site.width = best.window.outline.width;
    site.wide = best.window.outline.wide;
    site.length = best.window.length;
    site.score = best.window.score;
    const auto is_same = [&](const GripSite& other) {
      return (other.point - site.point).norm() < 0.3 * options.palm_breadth &&
             std::abs(other.axis.dot(site.axis)) > 0.95;
    };
    if (std::any_of(sites.begin(), sites.end(), is_same)) continue;
    if (third_moment(mesh, site.point, site.wide) < 0.0) site.wide = -site.wide;
    find_working_end(mesh, frame.centre, options.palm_breadth, options.axis.has_value(), site);
    sites.push_back(site);
  }
  std::stable_sort(sites.begin(), sites.end(), by_score);
  return sites;
}

}  // namespace palmar::grasp
