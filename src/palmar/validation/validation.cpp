// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/validation/validation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/primitives.h"
#include "palmar/validation/validation_cases.h"

namespace palmar::validation {
namespace {

struct CaseEntry {
  const char* id;
  const char* title;
  bool is_slow;
  double weight;  ///< about its share of the time
  ValidationRows (*run)(ValidationBench&);
};

constexpr CaseEntry kCases[] = {
    {"G1", "closed forms of the half-space: sphere, flat punch, ellipse, two punches", false, 2,
     validate_half_space},
    {"skin", "closed forms on flat skins of 2.5, 1.25 and 0.6 mm, by the solver of assess", true,
     10, validate_skin_meshes},
    {"layer", "incompressible layer bonded to bone under sphere and punch", false, 4,
     validate_layer},
    {"G2", "template's middle fingertip on a plate at 30 degrees", false, 4, validate_fingertip},
    {"G3", "contact area on a 35 mm cylinder, power grasp to 4 mm (fingers) and 7 mm (palm)", true,
     100, validate_contact_area},
    {"G4", "51 mm cylinder: sum of normal forces over grip force", false, 3, validate_grip_force},
    {"G5", "shares of hand regions on cylinders of 32, 48 and 64 mm", false, 4, validate_shares},
    {"G6", "prism 30 x 40 mm with fillets of 3 and 10 mm in the same posture", false, 3,
     validate_fillets},
    {"predictions", "published figures that nothing was chosen on: finger shares, fingertip area",
     true, 10, validate_predictions},
    {"coupling", "regions in one problem or one by one", false, 6, validate_coupling},
    {"motion", "force along a closing motion in steps of 0.05 mm, 51 mm cylinder", true, 15,
     validate_motion},
    {"structure", "laws that hold whatever the tissue", true, 8, validate_structure}};

const CaseEntry* find_case(const std::string& id) {
  for (const CaseEntry& entry : kCases) {
    if (id == entry.id) return &entry;
  }
  return nullptr;
}

}  // namespace

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMet:
      return "met";
    case Verdict::kMissed:
      return "missed";
    case Verdict::kNotBuilt:
      return "not built yet";
    case Verdict::kInformation:
      break;
  }
  return "information";
}

ValidationTarget near_value(double value, double share, std::string source) {
  const double margin = share * std::abs(value);
  return {value, value - margin, value + margin, std::move(source)};
}

ValidationTarget between(double lowest, double highest, std::string source) {
  return {std::nullopt, lowest, highest, std::move(source)};
}

ValidationTarget at_least(double lowest, std::string source) {
  return {std::nullopt, lowest, std::nullopt, std::move(source)};
}

ValidationTarget at_most(double highest, std::string source) {
  return {std::nullopt, std::nullopt, highest, std::move(source)};
}

ValidationTarget information(std::optional<double> value, std::string source) {
  return {value, std::nullopt, std::nullopt, std::move(source)};
}

ValidationRow judge(std::string quantity, std::string unit, double ours, ValidationTarget target) {
  ValidationRow row;
  row.quantity = std::move(quantity);
  row.unit = std::move(unit);
  row.ours = ours;
  row.target = std::move(target);
  const ValidationTarget& t = row.target;
  const auto relative = [&](double reference) {
    if (reference != 0.0 && std::isfinite(ours))
      row.difference = (ours - reference) / std::abs(reference);
  };
  const bool is_below = t.lowest && !(ours >= *t.lowest);
  const bool is_above = t.highest && !(ours <= *t.highest);
  if (t.value) {
    relative(*t.value);
  } else if (is_below) {
    relative(*t.lowest);
  } else if (is_above) {
    relative(*t.highest);
  } else if (t.lowest || t.highest) {
    row.difference = 0.0;
  }
  if (!t.lowest && !t.highest) {
    row.verdict = Verdict::kInformation;
  } else {
    row.verdict = is_below || is_above ? Verdict::kMissed : Verdict::kMet;
  }
  return row;
}

ValidationRow not_built(std::string quantity, const std::string& why) {
  ValidationRow row;
  row.quantity = std::move(quantity);
  row.target.source = why;
  row.verdict = Verdict::kNotBuilt;
  return row;
}

int ValidationReport::count(Verdict verdict) const {
  int sum = 0;
  for (const ValidationCase& one : cases) {
    sum += static_cast<int>(
        std::count_if(one.rows.begin(), one.rows.end(),
                      [&](const ValidationRow& row) { return row.verdict == verdict; }));
  }
  return sum;
}

void ValidationOptions::check() const {
  for (const std::string& id : cases) {
    if (find_case(id) != nullptr) continue;
    std::vector<std::string> known;
    for (const CaseEntry& entry : kCases) known.emplace_back(entry.id);
    const std::string nearest = nearest_name(id, known);
    throw UsageError("case \"" + id + "\" is not known" +
                     (nearest.empty() ? "" : ", did you mean " + nearest + "?") + "; allowed are " +
                     joined(known, ", "));
  }
}

std::vector<ValidationCaseName> validation_cases() {
  std::vector<ValidationCaseName> names;
  for (const CaseEntry& entry : kCases) names.push_back({entry.id, entry.title, entry.is_slow});
  return names;
}

void set_history(ValidationRows& rows, const std::string& added_in, const std::string& chosen_in) {
  for (ValidationRow& row : rows) {
    if (!row.added_in.empty()) continue;
    row.added_in = added_in;
    row.chosen_in = chosen_in;
  }
}

contact::ContactModel independent_model() {
  contact::ContactModel model;
  model.coupling = contact::RegionCoupling::kIndependent;
  return model;
}

contact::ContactModel layered_model() {
  contact::ContactModel model;
  model.tissue = contact::TissueModel::kLayered;
  return model;
}

ValidationBench::ValidationBench(std::shared_ptr<const hand::Hand> hand,
                                 std::shared_ptr<const contact::SkinCompliance> compliance,
                                 Progress progress)
    : hand_(std::move(hand)), compliance_(std::move(compliance)), progress_(std::move(progress)) {
  if (!hand_) throw UsageError("validate: no hand was given");
}

const contact::PreparedHand& ValidationBench::prepared(const contact::ContactModel& model) {
  std::unique_ptr<contact::PreparedHand>& slot = prepared_[name_of(model)];
  if (slot) return *slot;
  const bool is_on_bone = model.tissue == contact::TissueModel::kBone;
  slot = std::make_unique<contact::PreparedHand>(hand_, model, is_on_bone ? compliance() : nullptr);
  return *slot;
}

const HeldCylinder& ValidationBench::cylinder(double diameter) {
  std::unique_ptr<HeldCylinder>& slot = cylinders_[diameter];
  if (!slot) {
    product::CylinderProductOptions options;
    options.diameter = diameter;
    options.length = 160.0;
    auto held = std::make_unique<HeldCylinder>();
    held->product = product::make_cylinder_product(options);
    held->grasp = grasp::close_power_grasp(*hand_, held->product);
    held->balance =
        grasp::balance_grasp(prepared(contact::palmar_model()), held->product, held->grasp);
    held->posed_skin = hand::pose_skin(*hand_, held->grasp.posture);
    slot = std::move(held);
  }
  return *slot;
}

std::shared_ptr<const contact::SkinCompliance> ValidationBench::compliance() {
  if (!compliance_) {
    compliance_ = std::make_shared<const contact::SkinCompliance>(
        contact::skin_compliance(*hand_, contact::skin_geometry(hand_->skin)));
  }
  return compliance_;
}

contact::ContactResult ValidationBench::contact(const HeldCylinder& held,
                                                const contact::ContactModel& model) {
  return contact::solve_hand_contact(prepared(model), held.posed_skin, held.grasp.product_from_hand,
                                     *held.product.distance);
}

void ValidationBench::update(double share, const std::string& activity) const {
  progress_.update(case_begin + share * (case_end - case_begin), activity);
}

ValidationReport validate(std::shared_ptr<const hand::Hand> hand, const ValidationOptions& options,
                          const Progress& progress) {
  options.check();
  ValidationBench bench(std::move(hand), options.compliance, progress);
  ValidationReport report;
  report.hand_name = bench.hand().name;
  std::vector<const CaseEntry*> chosen;
  double weight = 0.0;
  for (const CaseEntry& entry : kCases) {
    const bool is_asked =
        std::find(options.cases.begin(), options.cases.end(), entry.id) != options.cases.end();
    if (!options.cases.empty() && !is_asked) continue;
    if (options.quick && entry.is_slow) continue;
    chosen.push_back(&entry);
    weight += entry.weight;
  }
  double before = 0.0;
  for (const CaseEntry* entry : chosen) {
    bench.case_begin = before / weight;
    before += entry->weight;
    bench.case_end = before / weight;
    bench.update(0.0, std::string("case ") + entry->id);
    const auto start = std::chrono::steady_clock::now();
    ValidationCase& one = report.cases.emplace_back();
    one.id = entry->id;
    one.title = entry->title;
    one.rows = entry->run(bench);
    one.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (progress.report) progress.report(1.0, "validated");
  return report;
}

}  // namespace palmar::validation
