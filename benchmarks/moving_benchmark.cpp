// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// moving_benchmark: the contact of a hand that is dragged over a product of 50 000 triangles, as
// the workbench does it: 100 steps of a scripted drag from a hold at rest. Prints the median and
// the 95th percentile of a step, beside the same steps by ContactSolver, from one run. The
// workbench's round trip also sends, decodes and colours; it must stay below 33 and 60 ms.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/footprint/footprint.h"
#include "palmar/contact/footprint/moving_footprint.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/workflow/live/live_session.h"

namespace {

constexpr int kSteps = 100;
constexpr double kGripForce = 120.0;  // N, that of a firm grip

/// Diameter 40 mm, length 130 mm, axis along z.
palmar::geometry::TriangleMesh fine_cylinder(int triangles) {
  const int around = static_cast<int>(std::lround(std::sqrt(0.6 * triangles)));
  const int along = triangles / 2 / around;
  palmar::geometry::TriangleMesh mesh;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle),
                                 -65.0 + 130.0 * j / along);
    }
  }
  const int low = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, -65.0);
  mesh.vertices.emplace_back(0.0, 0.0, 65.0);
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    for (int j = 0; j < along; ++j) {
      const int a = j * around + i, b = j * around + next;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
    mesh.triangles.push_back({low, next, i});
    mesh.triangles.push_back({low + 1, along * around + i, along * around + next});
  }
  return mesh;
}

palmar::workflow::LivePose step(const palmar::workflow::LivePose& start, int k) {
  palmar::workflow::LivePose pose = start;
  const palmar::Vec3 way(1.5 * std::sin(0.06 * k), 0.0, 1.2 * std::sin(0.11 * k));
  const double turn = 3.0 * std::sin(0.05 * k) * std::numbers::pi / 180.0;
  pose.product_from_hand.translation += way;
  pose.product_from_hand.rotation = palmar::Quat(Eigen::AngleAxisd(turn, palmar::Vec3::UnitY())) *
                                    pose.product_from_hand.rotation;
  return pose;
}

struct Times {
  double median = 0.0, p95 = 0.0;  // ms
};

template <typename Act>
Times measure(const palmar::workflow::LivePose& start, const Act& act) {
  std::vector<double> all;
  for (int k = -10; k < kSteps; ++k) {
    const palmar::workflow::LivePose pose = step(start, k + 10);
    const auto begin = std::chrono::steady_clock::now();
    act(pose);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (k >= 0) all.push_back(took.count());
  }
  std::sort(all.begin(), all.end());
  return {all[all.size() / 2], all[all.size() * 95 / 100]};
}

void print(const char* name, const Times& times) {
  std::printf("%-28s median %6.2f ms, 95th percentile %6.2f ms\n", name, times.median, times.p95);
}

}  // namespace

int main() {
  const auto product = std::make_shared<palmar::product::Product>(
      palmar::product::make_product("cylinder", fine_cylinder(50000), {}, {}));
  palmar::workflow::LiveHand hand = palmar::workflow::prepare_live_hand({});
  palmar::workflow::LiveSession session(hand, product);
  palmar::workflow::LiveTask task;
  task.rest.grip_force = kGripForce;
  const palmar::study::AssessmentSet set = session.take_hold(1, task);
  const palmar::grasp::Grasp& grasp = set.assessments.front().assessment.grasp;
  const palmar::workflow::LivePose start{grasp.posture, grasp.product_from_hand};
  std::printf("%zu vertices of skin, %d triangles, %.1f N\n", hand.hand->skin.vertices.size(),
              product->mesh.triangle_count(),
              set.assessments.front().assessment.contact.total.force);

  const auto begin = std::chrono::steady_clock::now();
  session.prepare_to_move();
  const std::chrono::duration<double, std::milli> prepared =
      std::chrono::steady_clock::now() - begin;
  std::printf("prepared in %.0f ms\n", prepared.count());
  double force = 0.0, reference_force = 0.0;
  const Times moving = measure(start, [&](const palmar::workflow::LivePose& pose) {
    force += session.move(pose).total.force;
  });
  palmar::contact::ContactSolver solver(*hand.prepared, {});
  palmar::contact::ContactResult contact;
  const Times reference = measure(start, [&](const palmar::workflow::LivePose& pose) {
    solver.solve(palmar::hand::pose_skin(*hand.hand, pose.posture), pose.product_from_hand,
                 *product->distance, contact);
    reference_force += contact.total.force;
  });
  palmar::contact::MovingFootprint footprint(
      palmar::contact::surface_for_moving(product->mesh, 120000));
  std::size_t pressed = 0;
  const Times on_product = measure(start, [&](const palmar::workflow::LivePose&) {
    pressed += footprint.under(*hand.hand, contact).vertex.size();
  });
  print("LiveSession::move", moving);
  print("MovingFootprint::under", on_product);
  print("ContactSolver::solve", reference);
  std::printf("ratio %.2f; force %.2f %% off\n", moving.median / reference.median,
              100.0 * (force / reference_force - 1.0));
  std::printf("%zu vertices of the product are pressed on\n", pressed / (kSteps + 10));
}
