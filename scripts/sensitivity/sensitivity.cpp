// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// sensitivity SHARE: holds eight products with the hand of the folder SHARE, then reads a line per
// constant from standard input and writes what comes of changing it, a line of JSON each. Built in
// the copy of scripts/sensitivity.mjs alone. A line: what is done anew, and the constant.
//   tight ID FACTOR   changed in every search that goes on from a product at rest; before all else
//   hold              holds the products; writes how
//   rest ID           from the product at rest
//   steering ID       the same, also of what is nothing to the product at rest
//   prepared ID       the same with a hand that is prepared anew
//   compliance ID     the same with a hand whose tissue is computed anew, too
//   closed ID         the hand is closed anew, in the same hold; the search goes on from there,
//   moved as
//                     hand and product had moved from the closed hand to rest
//   fingertips ID     the same with the products that are held between fingertips
//   searched ID       from the closed hand, as in use
//   ranked ID         the holds are ranked anew
//
// A search that begins exactly where it ended before stays there, whatever a small change asks for.
// So every search begins a little beside that, once on one side and once on another: figures that
// both agree on are no chance. What doesn't change a digit of the problem at the product at rest
// isn't searched for.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/core/parallel.h"
#include "palmar/core/varied.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/equilibrium/least_effort.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/precision/precision_shape.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_file.h"

namespace palmar {
namespace {

using Json = nlohmann::json;

constexpr double kChange = 1.05;  // factor of a constant, and of it 1 over that
constexpr double kNudge = 0.05;   // mm and, over 50 mm, rad; by which searches begin beside
constexpr int kStarts = 2;
constexpr double kAtOnce = 1e9;  // times the gain that steps have to promise: none does

struct Task {
  std::string name;
  product::Product product;
  grasp::Grip grip;
  double force;  // N
};

product::Product elliptic_handle() {
  geometry::CylinderOptions round;
  round.radius = 22.0;
  round.length = 130.0;
  round.segments = 96;
  round.rings = 50;
  geometry::TriangleMesh mesh = geometry::make_cylinder(round);
  for (Vec3& v : mesh.vertices) v.y() *= 32.0 / 44.0;
  return product::make_product("elliptic handle", mesh, product::UnitDecision{}, "made");
}

std::vector<Task> tasks() {
  const auto bar = [](double diameter, double length) {
    return product::make_cylinder_product({.diameter = diameter, .length = length});
  };
  const auto prism = [](double width, double depth, double length, double fillet) {
    return product::make_prism_product(
        {.width = width, .depth = depth, .length = length, .fillet_radius = fillet});
  };
  using grasp::Grip;
  return {{"bar of 35 mm", bar(35.0, 130.0), Grip::kMediumWrap, 107.0},
          {"bar of 50 mm", bar(50.0, 160.0), Grip::kMediumWrap, 107.0},
          {"prism", prism(40.0, 30.0, 120.0, 4.0), Grip::kMediumWrap, 107.0},
          {"ball", product::make_sphere_product({.diameter = 70.0}), Grip::kPowerSphere, 60.0},
          {"can", bar(66.0, 120.0), Grip::kMediumWrap, 5.0},
          {"elliptic handle", elliptic_handle(), Grip::kMediumWrap, 60.0},
          {"pen", bar(10.0, 140.0), Grip::kWritingTripod, 5.0},
          {"phone", prism(71.0, 8.0, 147.0, 3.0), Grip::kPalmarPinch, 10.0}};
}

std::vector<std::pair<std::uint64_t, double>>& tight() {
  static std::vector<std::pair<std::uint64_t, double>> factors;
  return factors;
}

/// While it exists, searches end as late as `tight` says, or at once.
class TightSearch {
 public:
  enum class End { kLate, kAtOnce };
  explicit TightSearch(End end) {
    auto lasting = tight();
    if (end == End::kAtOnce) {
      for (auto& [id, factor] : lasting) factor = kAtOnce;
    }
    set(lasting);
  }
  ~TightSearch() { set({}); }
  TightSearch(const TightSearch&) = delete;
  TightSearch& operator=(const TightSearch&) = delete;

 private:
  static void set(const std::vector<std::pair<std::uint64_t, double>>& lasting) {
    sensitivity::Factors& factors = sensitivity::factors();
    factors.lasting = lasting;
    sensitivity::vary(factors.varied, factors.factor);
  }
};

/// What is looked at of a hold.
struct Figures {
  std::string status;
  double force = 0.0, area = 0.0, peak = 0.0;  // sum of normal forces, N; mm^2; MPa
  hand::Posture posture;

  bool operator==(const Figures& other) const {
    return status == other.status && force == other.force && area == other.area &&
           peak == other.peak && posture.angle == other.posture.angle;
  }
};

Json json_of(const Figures& figures) {
  Json angles = Json::array();
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    angles.push_back(figures.posture[grasp::grip_dof(j)] / geometry::kDegree);
  }
  return {{"status", figures.status},
          {"force", figures.force},
          {"area", figures.area},
          {"peak", figures.peak},
          {"angles", std::move(angles)}};
}

/// How a product's holds are ranked.
struct Ranking {
  std::string first;  // in words
  double lead = 0.0;  // of its score over the next

  bool operator==(const Ranking&) const = default;
};

bool are_same(const grasp::Grasp& a, const grasp::Grasp& b) {
  return a.status == b.status && a.posture.angle == b.posture.angle &&
         a.product_from_hand.translation == b.product_from_hand.translation &&
         a.product_from_hand.rotation.coeffs() == b.product_from_hand.rotation.coeffs();
}

class Holds {
 public:
  explicit Holds(const std::string& share)
      : hand_(std::make_shared<const hand::Hand>(records::read_hand(share + "/template.hand.glb"))),
        // Not the file's, whose digits may be rounded otherwise.
        compliance_(std::make_shared<const contact::SkinCompliance>(
            contact::skin_compliance(*hand_, contact::skin_geometry(hand_->skin)))),
        prepared_(prepare(compliance_)) {
    std::vector<Task> all = tasks();
    for (Task& task : all) held_.push_back({.task = std::move(task)});
  }

  Json hold();
  Json change(const std::string& anew, std::uint64_t id);

 private:
  struct Held {
    Task task;
    grasp::Grasp closed;
    grasp::EffortTask effort;
    grasp::GripState rest;
    std::vector<double> problem;                        // at rest
    std::array<Figures, kStarts> at_rest, from_closed;  // by where the search begins
    Ranking ranking;
  };

  contact::PreparedHand prepare(std::shared_ptr<const contact::SkinCompliance> compliance) const {
    return contact::PreparedHand(hand_, contact::palmar_model(), std::move(compliance));
  }
  grasp::Grasp close(const Held& held) const;
  Ranking rank(const Held& held) const;
  Figures look(const contact::PreparedHand& prepared, const product::Product& product,
               const grasp::GripState& state) const;
  grasp::EffortRest search(const contact::PreparedHand& prepared, const Held& held,
                           const grasp::Grasp& closed, const grasp::GripState& from) const;
  Figures rest(const contact::PreparedHand& prepared, const Held& held, const grasp::Grasp& closed,
               const grasp::GripState& from, grasp::GripState* at = nullptr) const;
  std::vector<double> problem(const contact::PreparedHand& prepared, const Held& held) const;
  Figures balance(const Held& held, grasp::Grasp grasp, int start) const;

  std::shared_ptr<const hand::Hand> hand_;
  std::shared_ptr<const contact::SkinCompliance> compliance_;
  contact::PreparedHand prepared_;
  std::vector<Held> held_;
};

grasp::Grasp Holds::close(const Held& held) const {
  grasp::GraspOptions options;
  options.grip = held.task.grip;
  options.hold = held.closed.hold;
  return grasp::find_grasp(*hand_, held.task.product, options);
}

Ranking Holds::rank(const Held& held) const {
  const grasp::RankedHolds ranked = grasp::rank_holds(*hand_, held.task.product);
  if (ranked.holds.empty()) return {};
  return {ranked.holds.front().words,
          ranked.holds.size() > 1 ? ranked.holds[0].score - ranked.holds[1].score : 0.0};
}

Figures Holds::look(const contact::PreparedHand& prepared, const product::Product& product,
                    const grasp::GripState& state) const {
  const contact::ContactResult contact = contact::solve_hand_contact(
      prepared, hand::pose_skin(*hand_, state.posture), state.product_from_hand, *product.distance);
  Figures figures;
  figures.force = contact.total.force;
  figures.area = contact.total.area;
  figures.peak = contact.total.peak_pressure_cells;
  figures.posture = state.posture;
  return figures;
}

grasp::EffortRest Holds::search(const contact::PreparedHand& prepared, const Held& held,
                                const grasp::Grasp& closed, const grasp::GripState& from) const {
  grasp::EffortTask task = held.effort;
  const grasp::BalanceOptions usual;
  task.friction = usual.friction;
  task.strength = usual.strength;
  task.model = {};
  const grasp::SearchStart start{.on_skin = from};
  return grasp::rest_with_least_effort(prepared, held.task.product,
                                       {closed.posture, closed.product_from_hand}, task, {}, {},
                                       &start);
}

bool is_held(const grasp::Grasp& grasp) {
  return grasp.status == grasp::GraspStatus::kHeld ||
         grasp.status == grasp::GraspStatus::kPartlyHeld;
}

Figures Holds::rest(const contact::PreparedHand& prepared, const Held& held,
                    const grasp::Grasp& closed, const grasp::GripState& from,
                    grasp::GripState* at) const {
  if (!is_held(closed)) return {.status = grasp::name_of(closed.status)};
  const TightSearch ends_late(TightSearch::End::kLate);
  const grasp::EffortRest rest = search(prepared, held, closed, from);
  if (rest.status != grasp::EffortRest::Status::kSolved) return {.status = "no contact"};
  Figures figures = look(prepared, held.task.product, rest.state);
  // As balance_grasp() judges it.
  const double missing = std::max(rest.missing.segment<3>(grasp::kGripJoints).norm(),
                                  rest.missing.tail<3>().norm() / rest.arm);
  const double at_joints = rest.missing.head<grasp::kGripJoints>().lpNorm<Eigen::Infinity>();
  const bool is_balanced = missing < std::max(0.01 * rest.force, 0.1) &&
                           at_joints < std::max(0.05 * rest.strongest_moment, 0.1 * rest.arm);
  figures.status = is_balanced ? "balanced" : "slips_out";
  if (at != nullptr) *at = rest.state;
  return figures;
}

/// All that the search sees at the product at rest, and what is looked at of it.
std::vector<double> Holds::problem(const contact::PreparedHand& prepared, const Held& held) const {
  const TightSearch ends_at_once(TightSearch::End::kAtOnce);
  const grasp::EffortRest rest = search(prepared, held, held.closed, held.rest);
  const Figures figures = look(prepared, held.task.product, held.rest);
  std::vector<double> all{static_cast<double>(rest.status),
                          rest.asked,
                          rest.force,
                          rest.arm,
                          rest.strongest_moment,
                          rest.share,
                          rest.friction_use,
                          rest.load.wrist,
                          figures.force,
                          figures.area,
                          figures.peak};
  all.insert(all.end(), rest.merit.begin(), rest.merit.end());
  all.insert(all.end(), rest.activation.begin(), rest.activation.end());
  all.insert(all.end(), rest.missing.begin(), rest.missing.end());
  for (const auto& digit : rest.load.digit) all.insert(all.end(), digit.begin(), digit.end());
  return all;
}

grasp::GripState nudged(grasp::GripState state, int k) {
  const auto sign = [&](int j) { return (j * (2 * k + 3)) % 7 % 2 == 0 ? 1.0 : -1.0; };
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    state.posture[grasp::grip_dof(j)] += sign(j) * kNudge / 50.0;
  }
  state.product_from_hand.translation += kNudge * Vec3(sign(1), sign(2), sign(3)) / std::sqrt(3.0);
  return state;
}

Figures Holds::balance(const Held& held, grasp::Grasp grasp, int start) const {
  if (!is_held(grasp)) return {.status = grasp::name_of(grasp.status)};
  const grasp::GripState from = nudged({grasp.posture, grasp.product_from_hand}, start);
  grasp.posture = from.posture;
  grasp.product_from_hand = from.product_from_hand;
  grasp::BalanceOptions options;
  options.grip_force = held.task.force;
  const grasp::Balance balance = grasp::balance_grasp(prepared_, held.task.product, grasp, options);
  Figures figures = look(prepared_, held.task.product, {grasp.posture, grasp.product_from_hand});
  figures.status = name_of(balance.status);
  return figures;
}

/// The parts of a hand that hold, as balance_grasp() has it for power grips and for fingertips.
grasp::VolarVector parts_that_hold(const hand::Hand& hand, grasp::Grip grip) {
  if (grasp::is_power(grip)) return grasp::VolarVector::Ones();
  grasp::VolarVector parts = grasp::VolarVector::Zero();
  for (const grasp::FingertipPoint& tip : grasp::fingertips_of(hand, grip)) {
    const bool is_volar = tip.part == grasp::FingertipPart::kPad ||
                          tip.part == grasp::FingertipPart::kTip ||
                          tip.part == grasp::FingertipPart::kMiddlePad;
    if (is_volar) parts[static_cast<int>(tip.segment) - 1] = 1.0;
  }
  return parts;
}

Json Holds::hold() {
  Json all = Json::array();
  for (Held& held : held_) {
    held.closed = close(held);
    held.closed = close(held);  // in the hold that was found
    held.effort.force = held.task.force;
    held.effort.takes_part = parts_that_hold(*hand_, held.task.grip);
    held.ranking = rank(held);
    grasp::Grasp at_rest = held.closed;
    grasp::BalanceOptions options;
    options.grip_force = held.task.force;
    const grasp::Balance balance =
        grasp::balance_grasp(prepared_, held.task.product, at_rest, options);
    held.rest = {at_rest.posture, at_rest.product_from_hand};
    // Until the search finds nothing lower.
    for (int k = 0; k < 3; ++k) {
      rest(prepared_, held, held.closed, nudged(held.rest, k), &held.rest);
    }
    held.problem = problem(prepared_, held);
    Json json{{"product", held.task.name},      {"force_n", held.task.force},
              {"hold", held.closed.hold_words}, {"message", balance.message},
              {"first", held.ranking.first},    {"lead", held.ranking.lead}};
    for (int k = 0; k < kStarts; ++k) {
      held.at_rest[k] = rest(prepared_, held, held.closed, nudged(held.rest, k));
      held.from_closed[k] = this->balance(held, held.closed, k);
      json["at_rest"].push_back(json_of(held.at_rest[k]));
      json["from_closed"].push_back(json_of(held.from_closed[k]));
    }
    all.push_back(std::move(json));
  }
  return all;
}

/// Where a closed hand comes to, if hand and product move as they did to `rest` from another.
grasp::GripState moved_alike(const grasp::Grasp& closed, const grasp::Grasp& other,
                             const grasp::GripState& rest) {
  grasp::GripState state{
      closed.posture,
      closed.product_from_hand * other.product_from_hand.inverse() * rest.product_from_hand};
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    const hand::Dof dof = grasp::grip_dof(j);
    state.posture[dof] += rest.posture[dof] - other.posture[dof];
  }
  return state;
}

Json Holds::change(const std::string& what, std::uint64_t id) {
  const bool closes = what == "closed" || what == "fingertips";
  const bool prepares = what == "prepared" || what == "compliance";
  Json results = Json::array();
  std::vector<char> moves(held_.size(), 1);
  for (const double factor : {kChange, 1.0 / kChange}) {
    const bool is_first = factor == kChange;
    sensitivity::vary(id, factor);
    std::optional<contact::PreparedHand> own;
    if (prepares && std::count(moves.begin(), moves.end(), 1) > 0) {
      own.emplace(prepare(what == "compliance" ? nullptr : compliance_));
    }
    const contact::PreparedHand& prepared = own ? *own : prepared_;
    for (std::size_t h = 0; h < held_.size(); ++h) {
      const Held& held = held_[h];
      // What isn't used by the first factor isn't by the second.
      if (moves[h] == 0 || (what == "fingertips" && grasp::is_power(held.task.grip))) continue;
      Json json{{"product", held.task.name}, {"factor", factor}};
      if (what == "ranked") {
        const Ranking ranking = rank(held);
        moves[h] = ranking == held.ranking ? 0 : 1;
        json["first"] = ranking.first;
        json["lead"] = ranking.lead;
      } else if (what == "searched") {
        const Figures found = balance(held, held.closed, 0);
        if (is_first && found == held.from_closed[0]) moves[h] = 0;
        json["starts"].push_back(json_of(found));
      } else {
        const grasp::Grasp closed = closes ? close(held) : held.closed;
        if (closes && is_first) moves[h] = are_same(closed, held.closed) ? 0 : 1;
        if ((prepares || what == "rest") && is_first) {
          moves[h] = problem(prepared, held) == held.problem ? 0 : 1;
        }
        const grasp::GripState from =
            closes ? moved_alike(closed, held.closed, held.rest) : held.rest;
        for (int k = 0; k < kStarts && moves[h] != 0; ++k) {
          const Figures found = rest(prepared, held, closed, nudged(from, k));
          if (k == 0 && is_first && found == held.at_rest[k]) moves[h] = 0;
          json["starts"].push_back(json_of(found));
        }
      }
      if (moves[h] != 0) results.push_back(std::move(json));
    }
  }
  sensitivity::vary(0, 1.0);
  return results;
}

int run(const std::string& share) {
  set_thread_count(1);
  std::optional<Holds> holds;
  std::string what, line;
  while (std::cin >> what) {
    const auto begin = std::chrono::steady_clock::now();
    Json answer{{"what", what}};
    if (what == "tight") {
      std::string id;
      double factor = 1.0;
      std::cin >> id >> factor;
      tight().emplace_back(std::strtoull(id.c_str(), nullptr, 16), factor);
      continue;
    }
    if (what == "hold") {
      holds.emplace(share);
      answer["held"] = holds->hold();
    } else {
      std::string id;
      std::cin >> id;
      answer["id"] = id;
      try {
        answer["results"] = holds.value().change(what, std::strtoull(id.c_str(), nullptr, 16));
      } catch (const std::exception& error) {
        sensitivity::vary(0, 1.0);
        answer["error"] = error.what();
      }
    }
    answer["seconds"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::cout << answer.dump() << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace palmar

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: sensitivity SHARE\n");
    return 2;
  }
  return palmar::run(argv[1]);
}
