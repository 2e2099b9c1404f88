// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "cli.h"
#include "grasp/grasp_options.h"
#include "palmar/core/error.h"
#include "palmar/effort/effort.h"
#include "palmar/records/effort_json.h"
#include "palmar/workflow/effort/effort.h"
#include "palmar/workflow/effort/effort_capacity.h"
#include "palmar/workflow/effort/effort_fingertip.h"
#include "palmar/workflow/words/fingertip_words.h"
#include "palmar/workflow/words/person_words.h"
#include "plain_names.h"
#include "text.h"

namespace palmar::cli {
namespace {

/// Where the wrist is.
struct WristArguments {
  double flexion = -30.0, deviation = 0.0;  // degrees
  void add_to(CLI::App& verb) {
    verb.add_option("--wrist-flexion-deg", flexion,
                    "Flexion of the wrist; extension is negative: -70 to 75")
        ->capture_default_str();
    verb.add_option("--wrist-deviation-deg", deviation,
                    "Deviation of the wrist to the thumb's side: -35 to 20")
        ->capture_default_str();
  }
  hand::WristPosture posture() const { return {radians(flexion), radians(deviation)}; }
};

struct ModelArguments {
  std::string points = "synek2019", hood = "synek2019";
  void add_to(CLI::App& verb) {
    verb.add_option("--tendon-points", points,
                    "Where the fingers' tendons run: synek2019 (calibrated) or an1979")
        ->capture_default_str();
    verb.add_option("--hood", hood, "Shares of the extensor hood: synek2019 or chao1989")
        ->capture_default_str();
  }
};

std::string fingertip_text(const std::vector<effort::FingertipForce>& forces) {
  std::string text = fmt::format(
      "{}, fingertip held still; force of the fingertip, N\n"
      "tendon   pulls  magnitude   radial   distal   palmar"
      "   hand frame x, y, z\n",
      name_of(forces.front().finger));
  for (const effort::FingertipForce& tip : forces) {
    text += fmt::format(
        "{:<6} {:>7.2f} {:>10.3f} {:>8.3f} {:>8.3f} {:>8.3f}   {:.3f}, {:.3f}, {:.3f}\n",
        name_of(tip.tendon), tip.tendon_force, tip.force.norm(), tip.force_in_phalanx.x(),
        tip.force_in_phalanx.y(), tip.force_in_phalanx.z(), tip.force.x(), tip.force.y(),
        tip.force.z());
  }
  text += "\nmoment arms, mm";
  for (const hand::Dof dof : forces.front().dof)
    text += fmt::format("{:>24}", effort::plain_name_of(dof));
  text += "\n";
  for (const effort::FingertipForce& tip : forces) {
    text += fmt::format("{:<15}", name_of(tip.tendon));
    for (const double arm : tip.moment_arm) text += fmt::format("{:>24.2f}", arm);
    text += "\n";
  }
  return text;
}

void add_fingertip(CLI::App& effort, Context& context) {
  struct Options {
    std::string finger = "index", posture, tendon = "all", hand = "template";
    double force_n = 1.0;
    ModelArguments model;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      effort, "fingertip", "Force at a fingertip held still when one tendon is loaded",
      "palmar effort fingertip --finger middle --posture mcp=40,pip=55,dip=35 --tendon fdp "
      "--force-n 1");
  verb->add_option("--finger", o->finger, "thumb, index, middle, ring or little")
      ->capture_default_str();
  verb->add_option("--posture", o->posture,
                   "Angles in degrees: mcp, pip, dip, abduction; of the thumb cmc-flexion, "
                   "cmc-abduction, mp, ip; not named: 0");
  verb->add_option("--tendon", o->tendon,
                   "fdp, fds, edc, lum, ri, ui; of the thumb fpl, fpb, apb, opp, adp, epl, epb, "
                   "apl; or all")
      ->capture_default_str();
  verb->add_option("--force-n", o->force_n, "Force in the tendon, N")->capture_default_str();
  verb->add_option("--hand", o->hand, "\"template\" or a .hand.glb file")->capture_default_str();
  o->model.add_to(*verb);
  verb->callback([&context, o] {
    context.run = [&context, o] {
      workflow::FingertipRequest request;
      request.hand.name = o->hand;
      request.finger = workflow::parse_finger(o->finger);
      request.tendons = workflow::parse_tendons(request.finger, o->tendon);
      request.posture = workflow::parse_digit_posture(request.finger, o->posture);
      request.force = o->force_n;
      request.model = workflow::parse_tendon_model(o->model.points, o->model.hood);
      const auto [forces, posture] = workflow::fingertip_forces(request);
      print(context.common.json ? records::fingertip_json(forces, posture) + "\n"
                                : fingertip_text(forces));
      return 0;
    };
  });
}

std::string capacity_json(const workflow::Capacity& capacity) {
  const auto number = [](double value) { return std::round(1e6 * value) / 1e6; };
  nlohmann::ordered_json json;
  json["capacity"] = {
      {"grip_force_n", number(capacity.grip_force)},
      {"torque_n_mm", number(capacity.torque)},
      {"push_n", number(capacity.push)},
      {"pull_n", number(capacity.pull)},
      {"torque_axis",
       {capacity.torque_axis.x(), capacity.torque_axis.y(), capacity.torque_axis.z()}},
      {"limited_by", capacity.limited_by},
      {"activation", number(capacity.activation)},
      {"strength", number(capacity.strength)},
      {"friction", capacity.friction},
      {"axis", {capacity.axis.x(), capacity.axis.y(), capacity.axis.z()}},
      {"grip", capacity.grip},
      {"hold", capacity.hold},
      {"message", capacity.message}};
  return json.dump(2);
}

std::string effort_text(const effort::EffortResult& effort) {
  std::string text = fmt::format("effort: {}{}{}\n", name_of(effort.status),
                                 effort.message.empty() ? "" : ", ", effort.message);
  text += fmt::format("contact force on the digits {:.1f} N, all tendons {:.1f} N ({})\n",
                      effort.contact_force, effort.tendon_force,
                      effort.with_friction ? "with friction" : "pressure alone");
  for (const effort::DigitEffort& digit : effort.digits) {
    text += fmt::format("\n{:<13} {:.1f} N of contact\n", finger_words(digit.finger),
                        digit.contact_force);
    if (digit.status == effort::EffortStatus::kNoLoad) continue;
    text += "  tendon   force_n  strength_n  activation\n";
    for (const effort::TendonLoad& load : digit.tendons) {
      text += fmt::format("  {:<6} {:>9.2f} {:>11.1f} {:>10.1f} %\n", name_of(load.tendon),
                          load.force, load.strength, 100.0 * load.activation);
    }
    text += "  moments, N mm          external   muscles      stop   missing\n";
    for (const effort::JointEffort& joint : digit.joints) {
      text += fmt::format("  {:<20} {:>10.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n",
                          effort::plain_name_of(joint.dof), joint.external, joint.muscles,
                          joint.stop, joint.missing);
    }
  }
  if (!effort.wrist) return text;
  const effort::WristEffort& wrist = *effort.wrist;
  text += "\nwrist\n  muscle   force_n  strength_n  activation\n";
  for (int i = 0; i < hand::kWristMuscleCount; ++i) {
    const auto muscle = static_cast<hand::WristMuscle>(i);
    const auto k = static_cast<std::size_t>(i);
    text += fmt::format("  {:<6} {:>9.2f} {:>11.1f} {:>10.1f} %\n", name_of(muscle), wrist.force[k],
                        wrist.strength[k], 100.0 * wrist.activation(muscle));
  }
  text += "  moments, N mm          external    digits     wrist   missing\n";
  text += fmt::format("  {:<20} {:>10.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n", "flexion", wrist.external,
                      wrist.digits, wrist.muscles, wrist.missing);
  return text;
}

void add_grasp(CLI::App& effort, Context& context) {
  struct Options {
    std::string product, file;
    GraspArguments grasp;
    ContactArguments contact;
    FrictionArguments friction;
    BalanceArguments balance;
    ModelArguments model;
    WristArguments wrist;
    effort::EffortOptions effort;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(effort, "grasp", "Forces of the muscles of fingers and thumb that hold a product",
               "palmar effort grasp handle.step");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  verb->add_option("--grasp", o->file,
                   "Grasp to take instead of finding one: JSON of palmar grasp close");
  o->grasp.add_to(*verb);
  o->contact.add_to(*verb);
  o->friction.add_to(*verb);
  o->balance.add_to(*verb);
  o->model.add_to(*verb);
  o->wrist.add_to(*verb);
  verb->add_option("--exponent", o->effort.exponent,
                   "n of the smallest sum (force / cross-section)^n: 2 or 3")
      ->capture_default_str();
  verb->add_option("--strength", o->effort.strength,
                   "Strength of the person's muscles over that of the model's")
      ->capture_default_str();
  verb->callback([&context, o] {
    context.setting_options = {{"strength", "--strength-n"}};  // of the grip; not the muscles' own
    context.run = [&context, o] {
      workflow::EffortRequest request;
      request.grasp = o->grasp.settings();
      request.contact = o->contact.options();
      request.model = o->contact.model();
      request.friction = o->friction.settings();
      request.rest = o->balance.settings();
      request.effort = o->effort;
      request.effort.tendons = workflow::parse_tendon_model(o->model.points, o->model.hood);
      request.effort.wrist = o->wrist.posture();
      request.product = {o->product, {.unit = parse_unit(o->grasp.unit)}};
      request.hand = {.name = o->grasp.hand,
                      .tissue = o->contact.tissue,
                      .value = nullptr,
                      .person = o->balance.person()};
      request.grasp_file = o->file;
      request.note = [&context](const std::string& text) { note(context.common, text); };
      const effort::EffortResult result =
          workflow::effort_of_grasp(request, make_progress(context.common));
      finish_progress();
      print(context.common.json ? records::effort_json(result) + "\n" : effort_text(result));
      return result.status == effort::EffortStatus::kNotConverged ? 4 : 0;
    };
  });
}

std::string capacity_text(const workflow::Capacity& capacity) {
  std::string text =
      fmt::format("held: {}\n", capacity.hold.empty() ? capacity.grip : capacity.hold);
  text += fmt::format("largest grip force   {:.0f} N: {}\n", capacity.grip_force, capacity.message);
  if (capacity.grip_force <= 0.0) return text;
  const Vec3& about = capacity.torque_axis;
  text += fmt::format("largest torque       {:.2f} N m about {} (friction {:g})\n",
                      1e-3 * capacity.torque,
                      about.isApprox(capacity.axis)
                          ? "the grip axis"
                          : fmt::format("{:.3g},{:.3g},{:.3g}", about.x(), about.y(), about.z()),
                      capacity.friction);
  text += fmt::format("largest push         {:.0f} N along the grip axis, to the thumb's side\n",
                      capacity.push);
  text +=
      fmt::format("largest pull         {:.0f} N, to the little finger's side\n", capacity.pull);
  return text;
}

void add_capacity(CLI::App& effort, Context& context) {
  struct Options {
    std::string product;
    GraspArguments grasp;
    ContactArguments contact;
    std::optional<double> friction, strength_n;
    std::string person, about;
    WristArguments wrist;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(effort, "capacity",
               "Largest grip force, torque, push and pull that a hand reaches on a product",
               "palmar effort capacity handle.step");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  o->grasp.add_to(*verb);
  o->contact.add_to(*verb);
  verb->add_option("--friction", o->friction,
                   "Coefficient of friction of skin on the product; default 0.5");
  verb->add_option("--about", o->about,
                   "Direction of the axis of the torque, x,y,z in the product's frame; default the "
                   "grip axis");
  verb->add_option("--strength-n", o->strength_n,
                   "How strong the person is: largest force on a grip dynamometer, N; default the "
                   "mean of adults, 427 N");
  verb->add_option("--person", o->person,
                   "woman, man or man:age=60: mean grip strength of that group (Steiber 2016)")
      ->excludes("--strength-n");
  o->wrist.add_to(*verb);
  verb->callback([&context, o] {
    context.run = [&context, o] {
      workflow::CapacityRequest request;
      request.wrist = o->wrist.posture();
      request.grasp = o->grasp.settings();
      request.contact = o->contact.options();
      request.model = o->contact.model();
      request.friction.friction = o->friction;
      request.strength = o->strength_n;
      if (!o->person.empty()) request.person = workflow::parse_person(o->person);
      if (!o->about.empty()) request.torque_axis = workflow::parse_vector("--about", o->about);
      request.product = {o->product, {.unit = parse_unit(o->grasp.unit)}};
      request.hand = {.name = o->grasp.hand, .tissue = o->contact.tissue, .value = nullptr};
      request.note = [&context](const std::string& text) { note(context.common, text); };
      const workflow::Capacity capacity =
          workflow::capacity_of_grip(request, make_progress(context.common));
      finish_progress();
      print(context.common.json ? capacity_json(capacity) + "\n" : capacity_text(capacity));
      return 0;
    };
  });
}

}  // namespace

void add_effort_commands(CLI::App& app, Context& context) {
  CLI::App* effort =
      app.add_subcommand("effort", "Joint moments, tendon forces and what a hand can do at most");
  effort->require_subcommand(1);
  effort->fallthrough();
  add_fingertip(*effort, context);
  add_grasp(*effort, context);
  add_capacity(*effort, context);
}

}  // namespace palmar::cli
