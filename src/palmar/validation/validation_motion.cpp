// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Force along a closing motion, and laws that hold whatever the tissue.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "palmar/contact/press/press.h"
#include "palmar/core/parallel.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/validation/validation_cases.h"

namespace palmar::validation {
namespace {

constexpr double kStep = 0.05;  // mm

/// The solid shrunk by `gap` on all sides, its outside only.
class ShrunkField : public geometry::DistanceField {
 public:
  ShrunkField(const DistanceField& field, double gap) : field_(&field), gap_(gap) {}
  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    field_->sample(points, range, samples);
    for (geometry::DistanceSample& s : samples) {
      const bool is_far = std::abs(s.distance) >= range;
      s.distance = is_far ? s.distance : std::min(range, s.distance + gap_);
      if (!is_far) s.closest -= gap_ * s.normal;
    }
  }
  Box3 bounding_box() const override { return field_->bounding_box(); }

 private:
  const DistanceField* field_;
  double gap_;
};

/// What a row of forces in equal steps says about its smoothness, where more than 1 N is held.
struct Smoothness {
  double least_growth = 0.0;  ///< of a step, share; negative: the force fell
  double jump = 0.0;          ///< growth of a step beyond the mean of both its neighbours, share
};

Smoothness smoothness(const std::vector<double>& force) {
  Smoothness result;
  std::vector<double> growth;
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (!(force[i - 1] > 1.0)) continue;
    growth.push_back(std::log(force[i] / force[i - 1]));
    if (growth.size() == 1) result.least_growth = growth[0];
    result.least_growth = std::min(result.least_growth, growth.back());
  }
  for (std::size_t i = 1; i + 1 < growth.size(); ++i) {
    const double beyond = growth[i] - 0.5 * (growth[i - 1] + growth[i + 1]);
    result.jump = std::max(result.jump, std::abs(beyond));
  }
  return result;
}

void add_smoothness(ValidationRows& rows, const std::string& motion,
                    const std::vector<double>& force, bool is_judged) {
  const Smoothness s = smoothness(force);
  const std::string source = "issue 3; steps of 0.05 mm from 1 N on";
  rows.push_back(judge(motion + ", growth of a step beyond its neighbours', largest", "%",
                       100.0 * s.jump,
                       is_judged ? at_most(2.0, source) : information(std::nullopt, source)));
  rows.push_back(judge(motion + ", growth of a step, least", "%", 100.0 * s.least_growth,
                       is_judged ? at_least(0.0, source) : information(std::nullopt, source)));
}

/// All skin closes in at once: the cylinder grows to its size.
std::vector<double> closing_everywhere(ValidationBench& bench, const HeldCylinder& held,
                                       const contact::ContactModel& model, double from) {
  contact::ContactSolver solver(bench.prepared(model));
  contact::ContactResult contact;
  std::vector<double> force;
  for (int k = static_cast<int>(std::lround(from / kStep)); k >= 0; --k) {
    bench.progress().throw_if_cancelled();
    const ShrunkField field(*held.product.distance, k * kStep);
    solver.solve(held.posed_skin, held.grasp.product_from_hand, field, contact);
    force.push_back(contact.total.force);
  }
  return force;
}

/// Fingers close from some degrees further open; the fingertips move 0.05 mm per step.
std::vector<double> closing_fingers(ValidationBench& bench, const HeldCylinder& held) {
  contact::ContactSolver solver(bench.prepared(contact::palmar_model()));
  contact::ContactResult contact;
  std::vector<double> force;
  constexpr double path = 4.0;    // mm of the fingertips
  constexpr double lever = 80.0;  // mm from the knuckle to the fingertip, about
  const int steps = static_cast<int>(path / kStep);
  for (int k = steps; k >= 0; --k) {
    bench.progress().throw_if_cancelled();
    hand::Posture posture = held.grasp.posture;
    for (const hand::Dof dof :
         {hand::Dof::kIndexMcpFlexion, hand::Dof::kMiddleMcpFlexion, hand::Dof::kRingMcpFlexion,
          hand::Dof::kLittleMcpFlexion, hand::Dof::kThumbMpFlexion}) {
      posture[dof] -= k * kStep / lever;
    }
    solver.solve(hand::pose_skin(bench.hand(), posture), held.grasp.product_from_hand,
                 *held.product.distance, contact);
    force.push_back(contact.total.force);
  }
  return force;
}

/// The product moves into the palm, against the force with which the palm holds it off.
std::vector<double> closing_palm(ValidationBench& bench, const HeldCylinder& held) {
  contact::ContactSolver solver(bench.prepared(contact::palmar_model()));
  contact::ContactResult contact = bench.contact(held, contact::palmar_model());
  Vec3 push = Vec3::Zero();
  for (const contact::RegionContact& region : contact.regions) {
    if (hand::segment_of(region.region) == hand::Segment::kPalm) push += region.force_vector;
  }
  push.normalize();
  std::vector<double> force;
  for (int k = 80; k >= 0; --k) {
    bench.progress().throw_if_cancelled();
    geometry::Rigid3 place = held.grasp.product_from_hand;
    place.translation -= k * kStep * push;
    solver.solve(held.posed_skin, place, *held.product.distance, contact);
    double palm = 0.0;
    for (const contact::RegionContact& region : contact.regions) {
      if (hand::segment_of(region.region) == hand::Segment::kPalm) palm += region.force;
    }
    force.push_back(palm);
  }
  return force;
}

/// Threads as they were, also when a case throws.
class ThreadCountGuard {
 public:
  ~ThreadCountGuard() { set_thread_count(before_); }

 private:
  int before_ = thread_count();
};

int differing_bits(const contact::ContactResult& a, const contact::ContactResult& b) {
  int count = 0;
  const auto differs = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y);
  };
  for (std::size_t v = 0; v < a.force.size(); ++v) {
    count += differs(a.force[v], b.force[v]) || differs(a.pressure[v], b.pressure[v]) ||
                     differs(a.displacement[v], b.displacement[v]) || a.deformed[v] != b.deformed[v]
                 ? 1
                 : 0;
  }
  return count;
}

void add_threads(ValidationRows& rows, ValidationBench& bench, const HeldCylinder& held) {
  const ThreadCountGuard guard;
  const auto solved = [&](int threads) {
    set_thread_count(threads);
    const contact::PreparedHand prepared(bench.shared_hand(), contact::palmar_model(),
                                         bench.compliance());
    return contact::solve_hand_contact(prepared, held.posed_skin, held.grasp.product_from_hand,
                                       *held.product.distance);
  };
  const contact::ContactResult one = solved(1), two = solved(2);
  rows.push_back(judge("vertices whose result differs, 1 or 2 threads", "",
                       differing_bits(one, two), at_most(0.0, "same input, same bits")));
}

void add_rigid_motion(ValidationRows& rows, ValidationBench& bench, const HeldCylinder& held) {
  const contact::ContactResult here = bench.contact(held, contact::palmar_model());
  const geometry::Rigid3 motion{Quat(Eigen::AngleAxisd(0.8, Vec3(0.3, -0.5, 0.7).normalized())),
                                Vec3(120.0, -40.0, 75.0)};
  std::vector<Vec3> skin = held.posed_skin;
  for (Vec3& v : skin) v = motion * v;
  const contact::ContactResult there = contact::solve_hand_contact(
      bench.prepared(contact::palmar_model()), skin,
      held.grasp.product_from_hand * motion.inverse(), *held.product.distance);
  double difference = 0.0, largest = 0.0, depth = 0.0;
  for (std::size_t v = 0; v < here.force.size(); ++v) {
    difference = std::max(difference, std::abs(here.force[v] - there.force[v]));
    largest = std::max(largest, here.force[v]);
    if (here.force[v] > 0.0) depth = std::max(depth, -here.distance[v]);
  }
  rows.push_back(judge("hand and product moved together, change of a vertex' force / largest", "",
                       difference / largest, at_most(1e-6, "rigid motion changes nothing")));
  rows.push_back(judge("largest |s p| / (depth x largest force), whole hand", "",
                       here.complementarity_error / (depth * largest),
                       at_most(1e-6, "definition of the problem")));
}

void add_scaled_hand(ValidationRows& rows, ValidationBench& bench) {
  constexpr double factor = 1.2;
  const auto pressed = [](const contact::PreparedHand& hand, double depth) {
    contact::PressOptions options;
    options.specimen.kind = contact::PressSpecimen::Kind::kHandRegion;
    options.indenter.kind = contact::PressIndenter::Kind::kPlane;
    options.shear_modulus = 0.05;
    options.depths = {depth};
    return contact::press(options, &hand).front();
  };
  const contact::PreparedHand larger(
      std::make_shared<const hand::Hand>(scaled(bench.hand(), factor)));
  const contact::PressStep one = pressed(bench.prepared(contact::ContactModel{}), 2.0);
  const contact::PressStep two = pressed(larger, factor * 2.0);
  const std::string law = "square of the scale at the same G";
  rows.push_back(judge("hand and depth scaled by 1.2, force of a fingertip", "",
                       two.force / one.force, near_value(factor * factor, 0.005, law)));
  rows.push_back(judge("hand and depth scaled by 1.2, area of a fingertip", "", two.area / one.area,
                       near_value(factor * factor, 0.005, law)));
}

}  // namespace

ValidationRows validate_motion(ValidationBench& bench) {
  ValidationRows rows;
  const HeldCylinder& held = bench.cylinder(51.0);
  add_smoothness(rows, "palmar, all skin closing in over 6 mm",
                 closing_everywhere(bench, held, {}, 6.0), true);
  bench.update(0.4, "case motion, fingers");
  add_smoothness(rows, "palmar, fingers closing over 4 mm", closing_fingers(bench, held), true);
  bench.update(0.6, "case motion, palm");
  add_smoothness(rows, "palmar, product into the palm over 4 mm", closing_palm(bench, held), true);
  // That skin stiffens by its local depth, not by the region's, was chosen so that nothing jumps.
  set_history(rows, "dc20bd8", "b06f877");
  bench.update(0.8, "case motion, xie2014");
  add_smoothness(rows, "xie2014, all skin closing in over 6 mm",
                 closing_everywhere(bench, held, contact::xie2014_model(), 6.0), false);
  set_history(rows, "dc20bd8");
  return rows;
}

ValidationRows validate_structure(ValidationBench& bench) {
  ValidationRows rows;
  const HeldCylinder& held = bench.cylinder(51.0);
  add_threads(rows, bench, held);
  bench.update(0.6, "case structure, motion and scale");
  add_rigid_motion(rows, bench, held);
  add_scaled_hand(rows, bench);
  set_history(rows, "dc20bd8");
  return rows;
}

}  // namespace palmar::validation
