// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_tracking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "hands/capture/axis_fit.h"
#include "hands/capture/mri/bones/bone_chain.h"
#include "hands/capture/mri/bones/image_registration.h"
#include "hands/capture/mri/bones/reference_hand.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/smooth.h"
#include "palmar/geometry/rotation.h"

namespace palmar::capture {
namespace {

// A bone that is the right one fits within a few tenths of a millimetre and stays in its joint.
constexpr double kGoodMean = 0.8;      // mm
constexpr double kAliasMean = 0.55;    // mm
constexpr double kPoorMean = 1.6;      // mm; beyond, it isn't this bone
constexpr double kLargestGap = 7.0;    // mm that a joint may come apart between two postures
constexpr double kLargestHead = 10.0;  // mm; radius of a metacarpal's head
constexpr double kLargestShift = 7.0;  // mm that a bone of the palm may shift against the others
constexpr double kLargestTurn = 0.6;   // rad; likewise
// Of intensities: a bone in its right place, and the least that distinguishes one from its
// surroundings.
constexpr double kSureCorrelation = 0.93;
constexpr double kLeastCorrelation = 0.8;
constexpr double kLeastOverlap = 0.7;  // share of a bone that the other image shows

/// Size of a bone: root mean square extents along its principal axes, ascending.
Vec3 extents_of(const geometry::TriangleMesh& mesh) {
  const std::array<Vec3, 6> p = moment_points(mesh);
  return 0.5 * Vec3((p[0] - p[1]).norm(), (p[2] - p[3]).norm(), (p[4] - p[5]).norm());
}

/// Direction of a bone's greatest extent, either way.
Vec3 long_axis(const geometry::TriangleMesh& mesh) {
  const std::array<Vec3, 6> p = moment_points(mesh);
  return (p[4] - p[5]).normalized();
}

bool has_size_of(const Vec3& a, const Vec3& b) {
  return ((a - b).cwiseAbs().array() < 0.35 * a.cwiseMax(b).array() + 0.5).all();
}

/// A bone of the posture's scan that may be the one looked for.
struct Target {
  const ScannedBone* bone = nullptr;
  geometry::TriangleMesh mesh;  ///< without the roughness of noise, which registration would lock
                                ///< into
  Vec3 centre = Vec3::Zero();
  Vec3 extents = Vec3::Zero();
};

struct Found {
  geometry::IcpResult fit;
  const Target* target = nullptr;  ///< null: no surface, the image alone shows it
  double gap = 0.0;  ///< how far the joint came apart, or the bone shifted in the palm, mm
  bool is_plausible = false;
  std::optional<ImageFit> image;

  const geometry::Rigid3& motion() const {
    return image ? image->fixed_from_moving : fit.fixed_from_moving;
  }
  double cost() const { return fit.mean + 0.1 * gap; }
};

class BoneTracker {
 public:
  BoneTracker(const ScanSurfaces& reference, const ScanSurfaces& posture,
              const TrackedImages& images, const Progress& progress)
      : reference_(reference), images_(images), progress_(progress) {
    for (ScannedBone& bone : reference_.bones) bone.mesh = geometry::smooth_taubin(bone.mesh);
    for (const ScannedBone& bone : posture.bones) {
      if (!(geometry::surface_area(bone.mesh) > 0.0)) continue;
      geometry::TriangleMesh mesh = geometry::smooth_taubin(bone.mesh);
      const Vec3 centre = geometry::centre_of_volume(mesh), extents = extents_of(mesh);
      targets_.push_back({&bone, std::move(mesh), centre, extents});
    }
  }

  std::vector<BoneMotion> track() {
    progress_.update(0.0, "palm");
    place_palm();
    std::vector<const ScannedBone*> palm;
    for (const ScannedBone& bone : reference_.bones) {
      if (is_palm_bone(bone.name) || is_forearm_bone(bone.name)) palm.push_back(&bone);
    }
    std::vector<std::optional<Found>> in_palm(palm.size());
    parallel_for(static_cast<int>(palm.size()),
                 [&](int k) { in_palm[k] = find_in_palm(*palm[k]); });
    for (std::size_t i = 0; i < palm.size(); ++i) keep(palm[i]->name, in_palm[i]);
    progress_.update(0.4, "fingers");
    std::array<std::vector<std::pair<std::string, std::optional<Found>>>, hand::kFingerCount> rays;
    parallel_for(hand::kFingerCount,
                 [&](int f) { rays[f] = find_ray(static_cast<hand::Finger>(f)); });
    for (const auto& ray : rays) {
      for (const auto& [name, found] : ray) keep(name, found);
    }
    return settle();
  }

 private:
  const Target* target_named(const std::string& name) const {
    for (const Target& target : targets_) {
      if (target.bone->name == name) return &target;
    }
    return nullptr;
  }

  void keep(const std::string& name, const std::optional<Found>& found) {
    if (found) found_.emplace_back(name, *found);
  }

  std::vector<BoneMotion> settle() const;
  void place_palm();
  std::optional<Found> find_in_palm(const ScannedBone& bone) const;
  std::vector<std::pair<std::string, std::optional<Found>>> find_ray(hand::Finger finger) const;
  std::optional<Found> find_distal(const ScannedBone& bone, const ScannedBone* proximal,
                                   const geometry::Rigid3& motion, bool is_next,
                                   double slack) const;
  std::optional<Found> seen_in_image(
      const ScannedBone& bone, std::optional<Found> found,
      const std::function<double(const geometry::Rigid3&)>& gap_of,
      const std::function<std::vector<geometry::Rigid3>()>& starts) const;
  const Target* target_at(const ScannedBone& bone, const geometry::Rigid3& motion) const;

  ScanSurfaces reference_;  ///< smoothed likewise
  const TrackedImages& images_;
  const Progress& progress_;
  std::vector<Target> targets_;
  geometry::Rigid3 palm_;
  std::vector<std::pair<std::string, Found>> found_;
};

/// One bone of the posture is the counterpart of one bone only, and two bones aren't at one place:
/// the one that fits better is.
std::vector<BoneMotion> BoneTracker::settle() const {
  std::vector<BoneMotion> motions;
  for (const auto& [name, mine] : found_) {
    const Vec3 centre = geometry::centre_of_volume(bone_named(reference_, name)->mesh);
    const auto is_better = [&, &name = name, &mine = mine](const auto& entry) {
      const auto& [other_name, other] = entry;
      if (other_name == name) return false;
      constexpr double kSamePlace = 3.0;  // mm between centres
      const bool is_same = mine.target != nullptr && other.target != nullptr
                               ? mine.target == other.target
                               : (other.motion() * geometry::centre_of_volume(
                                                       bone_named(reference_, other_name)->mesh) -
                                  mine.motion() * centre)
                                         .norm() < kSamePlace;
      if (!is_same) return false;
      if (mine.image && other.image) {
        return std::pair(-other.image->correlation, other_name) <
               std::pair(-mine.image->correlation, name);
      }
      if (mine.image.has_value() != other.image.has_value()) return other.image.has_value();
      return std::pair(other.cost(), other_name) < std::pair(mine.cost(), name);
    };
    if (std::any_of(found_.begin(), found_.end(), is_better)) continue;
    BoneMotion motion{name, "", mine.motion(), mine.fit};
    motion.image = mine.image;
    motion.is_cut_out = mine.target != nullptr;
    if (motion.is_cut_out) motion.counterpart = mine.target->bone->name;
    motions.push_back(std::move(motion));
  }
  return motions;
}

/// The posture's bone that a bone moved there would be.
const Target* BoneTracker::target_at(const ScannedBone& bone,
                                     const geometry::Rigid3& motion) const {
  constexpr double kSamePlace = 3.0;  // mm between centres
  const Vec3 centre = motion * geometry::centre_of_volume(bone.mesh),
             extents = extents_of(bone.mesh);
  const Target* nearest = nullptr;
  for (const Target& target : targets_) {
    const double distance = (target.centre - centre).norm();
    if (distance > kSamePlace || !has_size_of(extents, target.extents)) continue;
    if (nearest == nullptr || distance < (nearest->centre - centre).norm()) nearest = &target;
  }
  return nearest;
}

/// What surfaces showed, aligned with the posture's image; what they didn't show or what doesn't
/// look alike there, searched for from `starts`. `gap_of` says how far a motion takes the joint
/// apart.
std::optional<Found> BoneTracker::seen_in_image(
    const ScannedBone& bone, std::optional<Found> found,
    const std::function<double(const geometry::Rigid3&)>& gap_of,
    const std::function<std::vector<geometry::Rigid3>()>& starts) const {
  if (images_.reference == nullptr || images_.posture == nullptr) return found;
  const auto picture = images_.reference->find(bone.name);
  if (picture == images_.reference->end()) return found;
  progress_.throw_if_cancelled();
  std::optional<ImageFit> best;
  const auto take = [&](const ImageFit& fit) {
    const bool is_allowed = fit.overlap >= kLeastOverlap && fit.correlation >= kLeastCorrelation &&
                            gap_of(fit.fixed_from_moving) < kLargestGap;
    if (is_allowed && (!best || fit.correlation > best->correlation)) best = fit;
  };
  if (found) take(picture->second.fit(*images_.posture, found->fit.fixed_from_moving));
  if (!best || best->correlation < kSureCorrelation) {
    const std::vector<geometry::Rigid3> all = starts();
    if (!all.empty()) take(picture->second.find(*images_.posture, all));
  }
  if (!best) return found;
  if (!found) found.emplace();
  found->image = best;
  found->gap = gap_of(best->fixed_from_moving);
  const geometry::Rigid3 correction =
      found->fit.fixed_from_moving.inverse() * best->fixed_from_moving;
  const Vec3 centre = geometry::centre_of_volume(bone.mesh);
  const bool stays = found->target != nullptr && (correction * centre - centre).norm() < 4.0 &&
                     correction.rotation.angularDistance(Quat::Identity()) < kLargestTurn;
  if (!stays) {
    found->target = target_at(bone, best->fixed_from_moving);
    found->fit = {};
  }
  return found;
}

/// Turns of a bone about its joint: to all directions within 110 degrees of where it would go with
/// the proximal bone, turned a little about itself as well.
std::vector<geometry::Rigid3> turns_about(const Vec3& joint, const Vec3& centre,
                                          const geometry::Rigid3& motion) {
  constexpr double kStep = 10.0 * geometry::kDegree,
                   kTwist = 12.0 * geometry::kDegree;  // the strong blur bridges half
  constexpr int kRings = 11;
  std::vector<geometry::Rigid3> turns;
  const Vec3 seat = motion * joint;
  const Vec3 along = (motion.rotation * (centre - joint)).normalized();
  const Vec3 e1 = along.unitOrthogonal(), e2 = along.cross(e1);
  for (int ring = 0; ring <= kRings; ++ring) {
    const double tilt = ring * kStep;
    const int count =
        std::max(1, static_cast<int>(std::ceil(2.0 * std::numbers::pi * std::sin(tilt) / kStep)));
    for (int k = 0; k < count; ++k) {
      const double phase = 2.0 * std::numbers::pi * k / count;
      const Vec3 axis = std::cos(phase) * e1 + std::sin(phase) * e2;
      const Quat swing(Eigen::AngleAxisd(tilt, axis));
      for (const double twist : {-kTwist, 0.0, kTwist}) {
        geometry::Rigid3 turned;
        turned.rotation = swing * Quat(Eigen::AngleAxisd(twist, along)) * motion.rotation;
        turned.translation = seat - turned.rotation * joint;
        turns.push_back(turned);
      }
    }
  }
  return turns;
}

/// A bone's small turns and shifts about where another one's motion has it.
std::vector<geometry::Rigid3> places_near(const Vec3& centre, const geometry::Rigid3& carrier) {
  constexpr double kTurn = 0.17, kShift = 2.0;  // rad, mm
  std::vector<geometry::Rigid3> places;
  for (int k = 0; k < 27; ++k) {
    const Vec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const Vec3 middle = carrier * centre;
    const double turn = kTurn * step.norm();
    const Quat q = turn > 0.0 ? Quat(Eigen::AngleAxisd(turn, step.normalized())) : Quat::Identity();
    const geometry::Rigid3 turned = geometry::Rigid3{q, middle - q * middle} * carrier;
    for (int n = 0; n < 7; ++n) {
      geometry::Rigid3 place = turned;
      if (n < 6) place.translation[n % 3] += n < 3 ? kShift : -kShift;
      places.push_back(place);
    }
  }
  return places;
}

geometry::TriangleMesh joined(const std::vector<const geometry::TriangleMesh*>& meshes) {
  geometry::TriangleMesh all;
  for (const geometry::TriangleMesh* mesh : meshes) {
    const int first = all.vertex_count();
    all.vertices.insert(all.vertices.end(), mesh->vertices.begin(), mesh->vertices.end());
    for (const Triangle& t : mesh->triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

void BoneTracker::place_palm() {
  std::vector<Vec3> from, to;
  std::vector<const geometry::TriangleMesh*> moving, fixed;
  for (const ScannedBone& bone : reference_.bones) {
    if (!is_palm_bone(bone.name) || bone.is_cut) continue;
    moving.push_back(&bone.mesh);
    if (const Target* target = target_named(bone.name)) {
      from.push_back(geometry::centre_of_volume(bone.mesh));
      to.push_back(target->centre);
    }
  }
  for (const Target& target : targets_) {
    if (is_palm_bone(target.bone->name)) fixed.push_back(&target.mesh);
  }
  const bool is_placed = from.size() >= 4;
  if (from.size() < 3) {
    // Hardly a name in common: all bones alike, and a search all round.
    from.clear();
    to.clear();
    for (const ScannedBone& bone : reference_.bones) {
      if (const Target* target = target_named(bone.name)) {
        from.push_back(geometry::centre_of_volume(bone.mesh));
        to.push_back(target->centre);
      }
    }
  }
  constexpr double kTolerance = 4.0;  // mm; centres of the same bone in two scans
  if (!from.empty()) palm_ = align_points_robustly(from, to, kTolerance);
  if (moving.empty() || fixed.empty()) return;
  geometry::IcpOptions options;
  options.samples = 4000;
  options.trim = 0.3;
  options.start_turn = is_placed ? 0.0 : 1.05;
  const geometry::IcpResult fit =
      geometry::register_rigidly(joined(moving), joined(fixed), palm_, options, progress_);
  if (fit.overlap > 0.0) palm_ = fit.fixed_from_moving;
}

std::optional<Found> BoneTracker::find_in_palm(const ScannedBone& bone) const {
  if (!(geometry::surface_area(bone.mesh) > 0.0)) return {};
  const bool is_forearm = is_forearm_bone(bone.name);
  const Vec3 centre = geometry::centre_of_volume(bone.mesh);
  const Vec3 extents = extents_of(bone.mesh);
  std::optional<Found> best;
  const auto attempt = [&](const Target& target) {
    geometry::IcpOptions options;
    // Carpals are nearly round: turned starts would only find their false minima.
    options.start_turn = is_forearm ? 0.6 : 0.0;
    options.trim = bone.is_cut || target.bone->is_cut ? 0.4 : 0.2;
    Found found;
    found.target = &target;
    found.fit = geometry::register_rigidly(bone.mesh, target.mesh, palm_, options, progress_);
    const geometry::Rigid3& motion = found.fit.fixed_from_moving;
    found.gap = is_forearm ? 0.0 : (motion * centre - palm_ * centre).norm();
    const double turn = motion.rotation.angularDistance(palm_.rotation);
    const double error =
        bone.is_cut || target.bone->is_cut ? found.fit.trimmed_rms : found.fit.mean;
    found.is_plausible = found.fit.overlap > 0.3 && error < kPoorMean &&
                         found.gap < kLargestShift && (is_forearm || turn < kLargestTurn);
    if (!found.is_plausible) return;
    if (!best || found.cost() < best->cost()) best = found;
  };
  if (const Target* target = target_named(bone.name)) attempt(*target);
  if (!is_forearm && !(best && best->fit.mean < kGoodMean)) {
    for (const Target& target : targets_) {
      if (target.bone->name == bone.name || target.bone->is_cut) continue;
      if ((target.centre - palm_ * centre).norm() > 1.5 * kLargestShift) continue;
      if (has_size_of(extents, target.extents)) attempt(target);
    }
  }
  if (is_forearm) return best;
  return seen_in_image(
      bone, best,
      [&](const geometry::Rigid3& motion) { return (motion * centre - palm_ * centre).norm(); },
      [&] { return places_near(centre, palm_); });
}

std::vector<std::pair<std::string, std::optional<Found>>> BoneTracker::find_ray(
    hand::Finger finger) const {
  std::vector<std::pair<std::string, std::optional<Found>>> ray;
  const std::vector<std::string> names = ray_of(finger);
  geometry::Rigid3 motion = palm_;
  const ScannedBone* proximal =
      finger == hand::Finger::kThumb ? bone_named(reference_, "trapezium") : nullptr;
  bool is_next = true;  // the bone before this one has been found
  double slack = 0.0;   // or its joint lies that near to where the palm has it, mm
  for (const std::string& name : names) {
    const ScannedBone* bone = bone_named(reference_, name);
    if (is_palm_bone(name)) {
      slack = kLargestShift;
      for (const auto& [found_name, found] : found_) {
        if (found_name != name) continue;
        motion = found.motion();
        slack = 0.0;
      }
      proximal = bone;
      continue;
    }
    if (bone == nullptr || !(geometry::surface_area(bone->mesh) > 0.0)) {
      is_next = false;
      continue;
    }
    const std::optional<Found> found = find_distal(*bone, proximal, motion, is_next, slack);
    ray.emplace_back(name, found);
    proximal = bone;
    is_next = found.has_value();
    if (found) {
      motion = found->motion();
      slack = 0.0;
    }
  }
  return ray;
}

std::optional<Found> BoneTracker::find_distal(const ScannedBone& bone, const ScannedBone* proximal,
                                              const geometry::Rigid3& motion, bool is_next,
                                              double slack) const {
  const Vec3 centre = geometry::centre_of_volume(bone.mesh);
  const Vec3 extents = extents_of(bone.mesh);
  const bool has_joint = proximal != nullptr && geometry::surface_area(proximal->mesh) > 0.0;
  // What stays where it is when the joint turns: the centre of a long bone's head, and of the
  // saddle about its surface.
  const bool is_saddle = has_joint && proximal->name == "trapezium";
  const Vec3 joint = !has_joint  ? centre
                     : is_saddle ? joint_surface_point(bone.mesh, proximal->mesh)
                                 : head_centre(proximal->mesh, bone.mesh);
  const Vec3 seat = motion * joint;
  std::optional<Found> best;
  const auto attempt = [&](const Target& target) {
    std::vector<std::pair<geometry::Rigid3, double>> starts;  // and turns about them
    if (has_joint && is_next) {
      // The joint stays where the proximal bone carries it, and the bone points to where the other
      // scan has it.
      geometry::Rigid3 start = motion;
      start.rotation =
          geometry::shortest_rotation(motion.rotation * (centre - joint), target.centre - seat) *
          motion.rotation;
      start.translation = seat - start.rotation * joint;
      starts = {{start, 0.5}, {start, 1.05}};
    } else {
      // Behind a gap in the chain the bone may lie any way: along the other one, up or down.
      const Vec3 mine = motion.rotation * long_axis(bone.mesh), other = long_axis(target.mesh);
      for (const double sense : {1.0, -1.0}) {
        geometry::Rigid3 start = motion;
        start.rotation = geometry::shortest_rotation(mine, sense * other) * motion.rotation;
        start.translation = target.centre - start.rotation * centre;
        starts.emplace_back(start, 1.05);
      }
    }
    for (const auto& [start, turn] : starts) {
      geometry::IcpOptions options;
      options.start_turn = turn;
      options.samples = 2000;
      options.tolerance = 1e-3;
      Found found;
      found.target = &target;
      found.fit = geometry::register_rigidly(bone.mesh, target.mesh, start, options, progress_);
      found.gap = has_joint && is_next ? (found.fit.fixed_from_moving * joint - seat).norm() : 0.0;
      // One of another name must fit well: neighbours are nearly alike.
      const double limit = target.bone->name == bone.name ? kPoorMean : kAliasMean;
      found.is_plausible =
          found.fit.overlap > 0.3 && found.fit.mean < limit && found.gap < kLargestGap + slack;
      if (found.is_plausible && (!best || found.cost() < best->cost())) best = found;
      if (is_next && found.fit.mean < kGoodMean) return;
    }
  };
  if (const Target* target = target_named(bone.name)) attempt(*target);
  if (!(best && best->fit.mean < kGoodMean)) {
    // Not this one, or there is none of that name: whatever of about that size stands at the joint.
    const double reach = 2.0 * (centre - joint).norm() + kLargestGap;
    for (const Target& target : targets_) {
      if (target.bone->name == bone.name || !has_size_of(extents, target.extents)) continue;
      if (!has_joint || (target.centre - seat).norm() > reach) continue;
      const std::optional<geometry::ClosestPoint> near =
          geometry::ClosestPointQuery(target.mesh).closest(seat, kLargestGap + kLargestHead);
      if (near || !is_next) attempt(target);
    }
  }
  return seen_in_image(
      bone, best,
      [&](const geometry::Rigid3& place) {
        return has_joint && is_next ? std::max(0.0, (place * joint - seat).norm() - slack) : 0.0;
      },
      [&] {
        // Behind a gap in the chain it may have gone along with the last bone that was found.
        if (!has_joint || !is_next) return places_near(centre, motion);
        std::vector<geometry::Rigid3> starts = turns_about(joint, centre, motion);
        if (slack > 0.0) {
          const std::size_t count = starts.size();
          for (int k = 0; k < 6; ++k) {
            const double step = (k < 3 ? 0.6 : -0.6) * slack;
            for (std::size_t n = 0; n < count; ++n) {
              starts.push_back(starts[n]);
              starts.back().translation[k % 3] += step;
            }
          }
        }
        return starts;
      });
}

}  // namespace

std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const TrackedImages& images, const Progress& progress) {
  return BoneTracker(reference, posture, images, progress).track();
}

std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const Progress& progress) {
  return track_bones(reference, posture, {}, progress);
}

}  // namespace palmar::capture
