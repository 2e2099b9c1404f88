// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// sensitivity SHARE: holds eight products with the hand of the folder SHARE, then reads a line per
// constant from standard input and writes what comes of changing it, a line of JSON each. Built in
// the copy of scripts/sensitivity.mjs alone. A line: what is done anew, and the constant.
//   tight ID FACTOR   changed in every search that goes on from a product at rest; before all else
//   hold              holds the products; writes how
//   rest ID           from the product at rest
//   prepared ID       the same with a hand that is prepared anew
//   balanced ID       from the closed hand
//   closed ID         the hand is closed anew, in the same hold
//   fingertips ID     the same with the products that are held between fingertips
//   ranked ID         the holds are ranked anew
//
// A search that begins exactly where it ended before stays there, whatever a small change asks for.
// So every search begins a little beside that, once on one side and once on another: figures that
// both agree on are no chance.
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
#include "palmar/records/hand/compliance_file.h"
#include "palmar/records/hand/hand_file.h"

namespace palmar {
namespace {

using Json = nlohmann::json;

constexpr double kChange = 1.05;  // factor of a constant, and of it 1 over that
constexpr double kNudge = 0.05;   // mm and, over 50 mm, rad; by which searches begin beside
constexpr int kStarts = 2;

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

/// While it exists, searches end as late as `tight` says.
class TightSearch {
 public:
  TightSearch() { set(tight()); }
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
        compliance_(std::make_shared<const contact::SkinCompliance>(
            records::read_compliance(share + "/template.compliance",
                                     records::compliance_key(*hand_), *hand_)
                .value())),
        prepared_(prepare()) {
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
    std::array<Figures, kStarts> at_rest, from_closed;  // by where the search begins
    Ranking ranking;
  };

  contact::PreparedHand prepare() const {
    return contact::PreparedHand(hand_, contact::palmar_model(), compliance_);
  }
  grasp::Grasp close(const Held& held) const;
  Ranking rank(const Held& held) const;
  Figures look(const contact::PreparedHand& prepared, const product::Product& product,
               const grasp::GripState& state) const;
  Figures rest(const contact::PreparedHand& prepared, const Held& held,
               const grasp::GripState& from, grasp::GripState* at = nullptr) const;
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

Figures Holds::rest(const contact::PreparedHand& prepared, const Held& held,
                    const grasp::GripState& from, grasp::GripState* at) const {
  const grasp::GripState closed{held.closed.posture, held.closed.product_from_hand};
  grasp::EffortTask task = held.effort;
  task.model = {};
  const TightSearch is_tight;
  const grasp::EffortRest rest =
      grasp::rest_with_least_effort(prepared, held.task.product, closed, task, {}, {}, &from);
  if (rest.status != grasp::EffortRest::Status::kSolved) return {.status = "no contact"};
  Figures figures = look(prepared, held.task.product, rest.state);
  const double missing = std::max(rest.missing.segment<3>(grasp::kGripJoints).norm(),
                                  rest.missing.tail<3>().norm() / rest.arm);
  figures.status = missing < std::max(0.01 * rest.force, 0.1) ? "balanced" : "slips_out";
  if (at != nullptr) *at = rest.state;
  return figures;
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
  if (grasp.status != grasp::GraspStatus::kHeld &&
      grasp.status != grasp::GraspStatus::kPartlyHeld) {
    return {.status = std::string(name_of(grasp.status))};
  }
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
    for (int k = 0; k < 3; ++k) rest(prepared_, held, nudged(held.rest, k), &held.rest);
    Json json{{"product", held.task.name},      {"force_n", held.task.force},
              {"hold", held.closed.hold_words}, {"message", balance.message},
              {"first", held.ranking.first},    {"lead", held.ranking.lead}};
    for (int k = 0; k < kStarts; ++k) {
      held.at_rest[k] = rest(prepared_, held, nudged(held.rest, k));
      held.from_closed[k] = this->balance(held, held.closed, k);
      json["at_rest"].push_back(json_of(held.at_rest[k]));
      json["from_closed"].push_back(json_of(held.from_closed[k]));
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json Holds::change(const std::string& what, std::uint64_t id) {
  const bool is_warm = what == "rest" || what == "prepared";
  Json results = Json::array();
  std::vector<char> moves(held_.size(), 1);
  for (const double factor : {kChange, 1.0 / kChange}) {
    sensitivity::vary(id, factor);
    std::optional<contact::PreparedHand> own;
    if (what == "prepared" && std::count(moves.begin(), moves.end(), 1) > 0) {
      own.emplace(prepare());
    }
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
      } else {
        const bool closes = what == "closed" || what == "fingertips";
        const grasp::Grasp closed = closes ? close(held) : held.closed;
        if (closes && are_same(closed, held.closed)) moves[h] = 0;
        for (int k = 0; k < kStarts && moves[h] != 0; ++k) {
          const Figures found = is_warm ? rest(own ? *own : prepared_, held, nudged(held.rest, k))
                                        : balance(held, closed, k);
          const Figures& usual = is_warm ? held.at_rest[k] : held.from_closed[k];
          if (k == 0 && found == usual) moves[h] = 0;
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
