// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/length_plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/palm_ruler.h"
#include "palmar/population/survey_figures.h"

namespace palmar::capture {
namespace {

constexpr hand::HandDimension kLength{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kWidth{hand::DimensionKind::kHandWidth};
constexpr hand::HandDimension kCircumference{hand::DimensionKind::kHandCircumference};
constexpr hand::HandDimension kPalm{hand::DimensionKind::kSegmentLength, hand::Segment::kPalm};

bool has(const population::Population& population, hand::HandDimension dimension) {
  for (const population::Stratum& stratum : population.strata) {
    if (!population::moments_of(stratum, dimension)) return false;
  }
  return true;
}

/// Terms of a finger's length in the population's dimensions; empty if it lacks one.
std::vector<std::pair<hand::HandDimension, double>> terms_of(
    hand::Finger finger, const population::Population& population) {
  std::vector<std::pair<hand::HandDimension, double>> terms;
  // The middle finger is what hand length and palm leave.
  if (finger == hand::Finger::kMiddle) {
    terms = {{kLength, 1.0}, {kPalm, -1.0}};
  } else {
    for (const auto& segment : hand::segments_of(finger)) {
      if (segment) terms.push_back({{hand::DimensionKind::kSegmentLength, *segment}, 1.0});
    }
  }
  for (const auto& [dimension, factor] : terms) {
    if (!has(population, dimension)) return {};
  }
  return terms;
}

/// Share of hand length that the middle finger has, by either ruler.
struct FingerShare {
  double of_template = 0.0, mean = 0.0, sd = 0.0;
};

FingerShare finger_share() {
  double survey = 0.0;
  for (const grasp::Sex sex : {grasp::Sex::kFemale, grasp::Sex::kMale}) {
    const population::AnsurFigures& figures = population::ansur2_figures(sex);
    survey += 0.5 * (1.0 - figures.palm.mean / figures.length.mean);
  }
  const double own = 1.0 - population::template_palm_share();
  return {own, 0.5 * (own + survey), (own - survey) / std::sqrt(12.0)};
}

/// The fingers as one measure in the template's ruler, which the population's means follow.
std::optional<population::KnownMeasure> fingers_of(const RestOfHand& rest,
                                                   const population::Population& population) {
  population::KnownMeasure all{{}, 0.0, 0.0, "fingers"};
  int count = 0;
  for (std::size_t f = 0; f < rest.finger.size(); ++f) {
    if (!(rest.finger[f] > 0.0)) continue;
    const auto terms = terms_of(static_cast<hand::Finger>(f + 1), population);
    if (terms.empty()) continue;
    all.terms.insert(all.terms.end(), terms.begin(), terms.end());
    all.value += rest.finger[f];
    ++count;
  }
  if (count == 0) return {};
  const FingerShare share = finger_share();
  const double ruler = share.of_template / share.mean;
  // Four fingers are as much longer than what may be given as one dimension.
  const double each = ruler / count;
  all.value *= each;
  for (auto& [dimension, factor] : all.terms) factor /= count;
  all.sd = std::hypot(all.value * share.sd / share.mean, ruler * rest.finger_sd);
  return all;
}

}  // namespace

RestOfHand RestOfHand::of(const hand::HandDimensions& dimensions) {
  RestOfHand rest;
  for (std::size_t f = 0; f < rest.finger.size(); ++f) {
    for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(f + 1))) {
      if (segment) rest.finger[f] += dimensions.segment[index_of(*segment)].length;
    }
  }
  rest.width = dimensions.hand_width;
  rest.circumference = dimensions.hand_circumference;
  return rest;
}

std::optional<ExpectedLength> expected_hand_length(const RestOfHand& rest,
                                                   const population::Population& population) {
  std::vector<population::KnownMeasure> known;
  if (!has(population, kLength)) return {};
  if (const auto fingers = fingers_of(rest, population)) known.push_back(*fingers);
  if (rest.width > 0.0 && has(population, kWidth)) {
    known.push_back(population::KnownMeasure::of(kWidth, rest.width, rest.width_sd));
  }
  if (rest.circumference > 0.0 && has(population, kCircumference)) {
    known.push_back(
        population::KnownMeasure::of(kCircumference, rest.circumference, rest.circumference_sd));
  }
  if (rest.by_skin > 0.0) {
    known.push_back(population::KnownMeasure::of(kLength, rest.by_skin, kLengthBySkinSd));
  }
  if (known.empty()) return {};
  const population::PersonEstimate estimate = population::estimate_person(population, known);
  if (!estimate.notes.empty()) return {};
  for (const population::EstimatedDimension& one : estimate.dimensions) {
    if (one.dimension == kLength) return ExpectedLength{one.value, one.sd};
  }
  return {};
}

std::string length_doubt(double length, double length_sd, const RestOfHand& rest,
                         const population::Population& population) {
  auto expected = expected_hand_length(rest, population);
  if (!expected) return {};
  expected->sd = std::hypot(expected->sd, length_sd);
  if (std::abs(length - expected->value) <= expected->range()) return {};
  return fmt::format(
      "Hand length is {:.0f} mm, where the rest of the hand lets one expect {:.0f} +- {:.0f} mm "
      "(99 of 100 people): look where the crease of the wrist was taken to be.",
      length, expected->value, expected->range());
}

std::string length_doubt(const std::vector<population::KnownMeasure>& measures,
                         const population::Population& population) {
  RestOfHand rest;
  rest.finger_sd = 0.0;
  double length = 0.0, length_sd = 0.0;
  for (const population::KnownMeasure& one : measures) {
    const hand::HandDimension first = one.terms.front().first;
    const std::optional<hand::Finger> finger = hand::finger_of(first.segment);
    if (one.terms.size() == 3 && finger && *finger != hand::Finger::kThumb) {
      rest.finger[index_of(*finger) - 1] = one.value;
      rest.finger_sd = std::max(rest.finger_sd, one.sd);
    }
    if (one.terms.size() > 1) continue;
    if (first == kLength) {
      length = one.value;
      length_sd = one.sd;
    } else if (first == kWidth) {
      rest.width = one.value;
      rest.width_sd = one.sd;
    } else if (first == kCircumference) {
      rest.circumference = one.value;
      rest.circumference_sd = one.sd;
    }
  }
  return length > 0.0 ? length_doubt(length, length_sd, rest, population) : "";
}

std::string length_doubt(const hand::HandDimensions& dimensions, double by_skin) {
  RestOfHand rest = RestOfHand::of(dimensions);
  rest.by_skin = by_skin;
  return length_doubt(dimensions.hand_length, 0.0, rest, population::population_named("ansur2"));
}

}  // namespace palmar::capture
