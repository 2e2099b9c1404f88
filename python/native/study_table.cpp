// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study_table.h"

#include <limits>

#include "arrays.h"

namespace palmar::python {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A column made of every record.
template <typename Value, typename Get>
py::array_t<Value> column(const study::StudyResults& results, const Get& get) {
  py::array_t<Value> values(static_cast<py::ssize_t>(results.records.size()));
  Value* next = values.mutable_data();
  for (const study::StudyRecord& record : results.records) *next++ = get(record);
  return values;
}

template <typename Get>
py::object texts(const study::StudyResults& results, const Get& get) {
  py::list values;
  for (const study::StudyRecord& record : results.records) values.append(std::string(get(record)));
  return py::module_::import("numpy").attr("array")(values, py::arg("dtype") = "str");
}

}  // namespace

py::dict grasp_table(const study::StudyResults& results) {
  const study::StudyPlan& plan = results.plan;
  const auto task = [&](const study::StudyRecord& record) {
    return study::task_at(plan, record.number);
  };
  const auto hand = [&](const study::StudyRecord& record) -> const study::StudyHand& {
    return plan.hands[static_cast<std::size_t>(task(record).hand)];
  };
  py::dict table;
  table["number"] = column<std::int64_t>(results, [](const auto& r) { return r.number; });
  table["hand"] = column<std::int64_t>(results, [&](const auto& r) { return task(r).hand; });
  table["label"] = texts(results, [&](const auto& r) { return hand(r).sample.label; });
  table["population"] = texts(results, [&](const auto& r) {
    return plan.populations[static_cast<std::size_t>(hand(r).population)].population.name;
  });
  table["hand_length_mm"] = column<double>(results, [&](const auto& r) {
    return study::size_of(hand(r), {hand::DimensionKind::kHandLength, hand::Segment::kPalm})
        .value_or(kNone);
  });
  table["hand_circumference_mm"] = column<double>(results, [&](const auto& r) {
    return study::size_of(hand(r), {hand::DimensionKind::kHandCircumference, hand::Segment::kPalm})
        .value_or(kNone);
  });
  table["profile"] = texts(results, [&](const auto& r) {
    return plan.profiles[static_cast<std::size_t>(task(r).profile)].name;
  });
  table["setting"] = texts(results, [&](const auto& r) {
    return plan.settings[static_cast<std::size_t>(task(r).setting)].name;
  });
  table["product"] = texts(results, [&](const auto& r) {
    return plan.products[static_cast<std::size_t>(task(r).product)].name;
  });
  table["outcome"] = texts(results, [](const auto& r) { return name_of(r.outcome); });
  table["grip"] = texts(results, [](const auto& r) { return name_of(r.grip); });
  table["hold"] =
      texts(results, [](const auto& r) { return r.hold ? r.hold->words : std::string(); });
  for (const study::StudyQuantity& quantity : study::quantities_of(results)) {
    table[py::str(quantity.key)] = column<double>(results, [&](const auto& r) {
      return study::quantity_of(r, quantity.key).value_or(kNone);
    });
  }
  return table;
}

}  // namespace palmar::python
