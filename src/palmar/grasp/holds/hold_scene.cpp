// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_scene.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/holds/hold_site.h"
#include "palmar/grasp/holds/twin_handles.h"
#include "palmar/product/mass.h"
#include "palmar/product/parts/part_place.h"

namespace palmar::grasp {
namespace {

constexpr double kThinnestHandle = 14.0;  // mm; thinner bars are shafts and stems
constexpr double kShortestHandle = 45.0;  // mm; two fingers and a half
constexpr double kHandleRamp = 0.15;      // of both, to either side; choice
constexpr double kAcross = 0.25;     // of a crosspiece's length from its end to its stem; choice
constexpr double kShortStem = 0.4;   // of a crosspiece's length: shorter ones are no stems; choice
constexpr double kWeightRamp = 5.0;  // mm that a part is nearer to the middle of the weight; choice
constexpr double kBent = 0.8;        // distance of the ends over length: choice
constexpr double kInLine = 0.95;     // cosine of the angle between a neck and its bottle
constexpr double kLargestKnob = 80.0;  // mm; as wide as hands span with ease; choice
constexpr double kHollow = 0.7;        // volume over that with its hollow: less is a vessel; choice
constexpr double kEvenShare = 0.01;    // of the length; nearer to the middle says nothing; choice

double diagonal_of(const product::ProductPart& part) { return std::max(part.length, part.width); }

// A knob on something larger, which fingertips or the whole hand go round.
bool is_knob(const product::ProductPart& part, const product::ProductParts& parts) {
  if (part.joined.size() != 1 || diagonal_of(part) > kLargestKnob) return false;
  // On its base, or on a stem between the two.
  return std::any_of(parts.parts.begin(), parts.parts.end(), [&](const product::ProductPart& base) {
    return base.number != part.number && base.kind != product::PartKind::kBar &&
           (base.kind == product::PartKind::kPlate || diagonal_of(base) > 2.0 * diagonal_of(part));
  });
}

// The bent free end of a stick or an umbrella.
bool is_crook(const product::ProductPart& part) {
  return part.kind == product::PartKind::kBar && !part.joined.empty() &&
         (!part.ends[0].joined || !part.ends[1].joined) && part.straightness < kBent &&
         part.diameter() >= kThinnestHandle && part.length >= kShortestHandle;
}

// How much a bar is as thick and long as a handle.
double handle_size(const product::ProductPart& bar) {
  return smooth_step(bar.diameter(), (1.0 - kHandleRamp) * kThinnestHandle,
                     (1.0 + kHandleRamp) * kThinnestHandle) *
         smooth_step(bar.length, (1.0 - kHandleRamp) * kShortestHandle,
                     (1.0 + kHandleRamp) * kShortestHandle);
}

// How much a bar lies across the end of a handle: a hammer's head, a rake's teeth.
double across_handle(const product::ProductPart& part, const product::ProductParts& parts) {
  if (part.ends[0].joined || part.ends[1].joined) return 0.0;
  double most = 0.0;
  for (const int number : part.joined) {
    const product::ProductPart& stem = parts.parts[static_cast<std::size_t>(number) - 1];
    if (stem.kind != product::PartKind::kBar) continue;
    for (const product::PartEnd& end : stem.ends) {
      if (end.joined != part.number) continue;
      const double along = std::clamp(product::place_of(part, end.point).along, 0.0, 1.0);
      const double from_end = std::min(along, 1.0 - along);
      most =
          std::max(most, smooth_step(from_end, 0.0, kAcross) * handle_size(stem) *
                             smooth_step(stem.length / part.length, kShortStem, 2.0 * kShortStem));
    }
  }
  return most;
}

// How much a part is a handle, 0 to 1.
double handle_of(const product::ProductPart& part, const product::ProductParts& parts,
                 bool is_beside_loop) {
  if (part.kind == product::PartKind::kLoop) return parts.parts.size() > 1 ? 1.0 : 0.0;
  const bool is_stub = part.kind == product::PartKind::kBar &&
                       part.length < kStubShare * part.diameter() &&
                       (!part.ends[0].joined || !part.ends[1].joined);
  if (part.kind == product::PartKind::kBall || part.kind == product::PartKind::kBody || is_stub) {
    return is_knob(part, parts) ? 1.0 : 0.0;
  }
  // Beside a loop that is there for the hand a bar is a spout.
  if (part.kind != product::PartKind::kBar || is_beside_loop || part.joined.empty() ||
      is_neck(part, parts)) {
    return 0.0;
  }
  return handle_size(part) * (1.0 - across_handle(part, parts));
}

// How much of the weight is in each part, by how much nearer it is to the middle of it.
std::vector<double> weight_shares(const product::Product& product,
                                  const product::ProductParts& parts, const Vec3& gravity) {
  std::vector<double> squared(parts.parts.size(), 1e12);
  const geometry::TriangleMesh& mesh = product.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int part = parts.part_of_triangle[t];
    if (part < 0) continue;
    const Triangle& corners = mesh.triangles[t];
    double& least = squared[static_cast<std::size_t>(part)];
    least = std::min(least, geometry::closest_point_on_triangle(gravity, mesh.vertices[corners[0]],
                                                                mesh.vertices[corners[1]],
                                                                mesh.vertices[corners[2]])
                                .squared_distance);
  }
  std::vector<double> shares;
  double nearest = 1e12, sum = 0.0;
  for (const double d : squared) nearest = std::min(nearest, std::sqrt(d));
  for (const double d : squared) {
    shares.push_back(std::exp((nearest - std::sqrt(d)) / kWeightRamp));
    sum += shares.back();
  }
  for (double& share : shares) share /= sum;
  return shares;
}

// A vessel has its mouth up: where its hollow reaches out. A solid body stands on its heavier end.
struct Upright {
  std::optional<Vec3> up;
  bool is_vessel = false;  ///< with a hollow
};

Upright upright(const product::ProductParts& parts, const geometry::TriangleMesh& mesh,
                const Vec3& gravity) {
  if (parts.parts.empty() || parts.parts.front().kind != product::PartKind::kBody) return {};
  const product::ProductPart& body = parts.parts.front();
  const Vec3 start = body.line.front().centre;
  const Vec3 axis = (body.line.back().centre - start).normalized();
  double filled = 0.0, filled_moment = 0.0;  // of the body with its hollow, about `start`
  for (const product::PartSection& section : body.sections) {
    filled += section.area;
    filled_moment += section.area * axis.dot(section.centre - start);
  }
  if (filled <= 0.0) return {};
  const double filled_centre = filled_moment / filled;
  const double filled_volume = filled * body.length / static_cast<double>(body.sections.size());
  double volume = geometry::signed_volume(mesh);
  for (const product::ProductPart& other : parts.parts) {
    if (other.number != body.number) volume -= other.volume;
  }
  if (volume > 0.0 && volume < kHollow * filled_volume) {
    const double hollow = filled_volume - volume;
    const double solid_centre = axis.dot(gravity - start);
    const double hollow_centre = (filled_volume * filled_centre - volume * solid_centre) / hollow;
    const double off = (hollow_centre - filled_centre) / body.length;
    if (std::abs(off) > kEvenShare) return {off > 0.0 ? axis : Vec3(-axis), true};
  }
  double low = 0.0, high = 0.0;
  for (const Vec3& v : mesh.vertices) {
    low = std::min(low, axis.dot(v - start));
    high = std::max(high, axis.dot(v - start));
  }
  const double off = (axis.dot(gravity - start) - 0.5 * (low + high)) / (high - low);
  if (std::abs(off) < 2.0 * kEvenShare) return {};
  return {off < 0.0 ? axis : Vec3(-axis), false};
}

}  // namespace

bool is_neck(const product::ProductPart& part, const product::ProductParts& parts) {
  const Vec3 line = part.line.back().centre - part.line.front().centre;
  for (const int number : part.joined) {
    const product::ProductPart& body = parts.parts[number - 1];
    if (body.kind != product::PartKind::kBody || body.line.size() < 2) continue;
    const Vec3 axis = body.line.back().centre - body.line.front().centre;
    const bool is_in_line = std::abs(line.normalized().dot(axis.normalized())) > kInLine;
    if (is_in_line && body.length > part.length && body.length > kShortestHandle) return true;
  }
  return false;
}

HoldScene hold_scene(const hand::Hand& hand, const product::Product& product,
                     const product::ProductParts& parts, const HoldOptions& options) {
  HoldScene scene;
  scene.hand = &hand;
  scene.product = &product;
  scene.parts = &parts;
  scene.gravity_centre = geometry::centre_of_volume(product.mesh);
  constexpr double kWater = 1.0;  // g/cm^3
  scene.weight = options.mass
                     ? *options.mass * product::kStandardGravity
                     : product::weight_of(std::abs(geometry::signed_volume(product.mesh)), kWater);
  scene.is_up_given = options.up.has_value();
  const Upright guess = upright(parts, product.mesh, scene.gravity_centre);
  scene.up = options.up ? std::optional<Vec3>(options.up->normalized()) : guess.up;
  scene.is_vessel = guess.is_vessel;
  if (options.up) scene.lay = standing_with(product.mesh, *options.up);
  scene.weight_share = weight_shares(product, parts, scene.gravity_centre);
  const bool has_loop_on_body =
      std::any_of(parts.parts.begin(), parts.parts.end(), [&](const product::ProductPart& part) {
        return part.kind == product::PartKind::kLoop && part.opening &&
               part.opening->width > kFewestFingers * fingers_breadth(hand) &&
               parts.parts.front().kind == product::PartKind::kBody;
      });
  const bool has_crook = std::any_of(parts.parts.begin(), parts.parts.end(), is_crook);
  for (const product::ProductPart& part : parts.parts) {
    const bool is_on_body =
        std::find(part.joined.begin(), part.joined.end(), 1) != part.joined.end();
    double handle = handle_of(part, parts, has_loop_on_body && is_on_body);
    // A stick is held by its crook, and what has a trigger by what is behind it.
    if (has_crook && part.kind == product::PartKind::kBar) handle = is_crook(part) ? 1.0 : 0.0;
    if (!parts.triggers.empty()) handle = trigger_of(scene, part) != nullptr ? 1.0 : 0.0;
    scene.handle.push_back(handle);
  }
  // Both of two alike are one handle, however thin, unless there is a better one.
  double best = 0.0;
  for (const double share : scene.handle) best = std::max(best, share);
  const std::vector<double> alone = scene.weight_share;
  for (const product::ProductPart& part : parts.parts) {
    const product::ProductPart* twin = twin_of(part, parts);
    if (twin == nullptr || !parts.triggers.empty()) continue;
    const auto index = static_cast<std::size_t>(part.number) - 1;
    scene.handle[index] = std::max(scene.handle[index], 1.0 - best);
    scene.weight_share[index] += alone[static_cast<std::size_t>(twin->number) - 1];
  }
  return scene;
}

double HoldScene::passed_over(int number) const {
  if (handle.empty()) return 0.0;
  return *std::max_element(handle.begin(), handle.end()) -
         handle[static_cast<std::size_t>(number) - 1];
}

bool HoldScene::has_handle() const {
  return std::any_of(handle.begin(), handle.end(), [](double share) { return share > 0.5; });
}

const product::PartTrigger* trigger_of(const HoldScene& scene, const product::ProductPart& part) {
  for (const product::PartTrigger& trigger : scene.parts->triggers) {
    if (trigger.part == part.number) return &trigger;
  }
  return nullptr;
}

}  // namespace palmar::grasp
