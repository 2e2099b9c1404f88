// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/outline_person.h"

#include <algorithm>
#include <cmath>

#include "hands/capture/length_plausibility.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/mirror.h"

namespace palmar::capture {
namespace {

constexpr hand::HandDimension kHandLength{hand::DimensionKind::kHandLength};
constexpr hand::HandDimension kHandWidth{hand::DimensionKind::kHandWidth};

/// Against a model measures are better than by themselves.
constexpr OutlineErrors kRawErrors{
    .length = 3.0, .width = 1.6, .finger = 4.0, .breadth = {1.3, 0.9, 0.9}};
constexpr OutlineErrors kModelErrors{};
constexpr double kStraightAbove = 12.0, kTwice = 20.0;  // deg; deg more make errors twice as large

OutlineErrors seen_obliquely(const OutlineErrors& errors, double tilt) {
  const double more = 1.0 + std::max(0.0, tilt - kStraightAbove) / kTwice;
  return {
      .length = more * errors.length,
      .width = more * errors.width,
      .finger = more * errors.finger,
      .breadth = {more * errors.breadth[0], more * errors.breadth[1], more * errors.breadth[2]}};
}

double true_length(const hand::HandDimensions& d, std::size_t finger) {
  double sum = 0.0;
  for (const auto& segment : hand::segments_of(static_cast<hand::Finger>(finger))) {
    if (segment) sum += d.segment[index_of(*segment)].length;
  }
  return sum;
}

/// The outline with what was missed on a model taken off; nothing where either has no measure.
HandOutline corrected(const HandOutline& seen, const HandOutline& model,
                      const hand::HandDimensions& truth) {
  HandOutline result = seen;
  const auto correct = [](double& value, double measured, double real) {
    value = value > 0.0 && measured > 0.0 ? value + real - measured : 0.0;
  };
  correct(result.hand_length, model.hand_length, truth.hand_length);
  correct(result.hand_width, model.hand_width, truth.hand_width);
  for (std::size_t f = 1; f < 5; ++f) {
    OutlineFinger& finger = result.finger[f];
    correct(finger.length, model.finger[f].length, true_length(truth, f));
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    for (std::size_t k = 0; k < 3; ++k) {
      if (!chain[k]) continue;
      correct(finger.width[k], model.finger[f].width[k], truth.segment[index_of(*chain[k])].width);
    }
  }
  return result;
}

}  // namespace

std::vector<population::KnownMeasure> measures_of(const HandOutline& outline,
                                                  const OutlineErrors& errors, double scale_error) {
  std::vector<population::KnownMeasure> list;
  const auto sd = [&](double error, double value) {
    return std::hypot(error, scale_error * value);
  };
  list.push_back(population::KnownMeasure::of(kHandLength, outline.hand_length,
                                              sd(errors.length, outline.hand_length)));
  if (outline.hand_width > 0.0) {
    list.push_back(population::KnownMeasure::of(kHandWidth, outline.hand_width,
                                                sd(errors.width, outline.hand_width)));
  }
  for (std::size_t f = 1; f < 5; ++f) {
    const OutlineFinger& finger = outline.finger[f];
    const auto chain = hand::segments_of(static_cast<hand::Finger>(f));
    if (finger.length > 0.0) {
      population::KnownMeasure whole{
          {},
          finger.length,
          sd(errors.finger, finger.length),
          std::string(name_of(static_cast<hand::Finger>(f))) + " finger"};
      for (const auto& segment : chain) {
        if (segment) whole.terms.push_back({{hand::DimensionKind::kSegmentLength, *segment}, 1.0});
      }
      list.push_back(whole);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!chain[k] || finger.width[k] <= 0.0) continue;
      list.push_back(population::KnownMeasure::of({hand::DimensionKind::kSegmentWidth, *chain[k]},
                                                  finger.width[k],
                                                  sd(errors.breadth[k], finger.width[k])));
    }
  }
  return list;
}

void allow_for_build(population::PersonEstimate& estimate) {
  const auto length_of = [&](hand::Segment segment) {
    for (const population::EstimatedDimension& one : estimate.dimensions) {
      if (one.dimension == hand::HandDimension{hand::DimensionKind::kSegmentLength, segment})
        return one.value;
    }
    return 0.0;
  };
  for (population::EstimatedDimension& one : estimate.dimensions) {
    const auto [kind, segment] = one.dimension;
    double share = 0.0;
    if (kind == hand::DimensionKind::kSegmentLength) {
      share = segment == hand::Segment::kPalm ? kPalmShare : kSegmentShare;
    } else if (kind == hand::DimensionKind::kSegmentWidth && one.is_measured) {
      share =
          segment == hand::Segment::kMiddleProximal ? population::kProportionScatter : kOwnWidth;
    } else if (kind == hand::DimensionKind::kHandWidth && one.is_measured) {
      share = kOwnBreadth;
    } else if (kind == hand::DimensionKind::kSegmentThickness && !one.is_measured) {
      share = kDepth;
    } else if (kind != hand::DimensionKind::kHandLength && !one.is_measured) {
      share = kFullness;
    }
    double more = share * one.value;
    const std::optional<hand::Finger> finger = hand::finger_of(segment);
    if (kind == hand::DimensionKind::kSegmentLength && finger && *finger != hand::Finger::kThumb) {
      const auto chain = hand::segments_of(*finger);
      const double others = std::hypot(length_of(*chain[1]), length_of(*chain[2]));
      if (segment == chain[0]) more = share * others;
    }
    one.sd = std::hypot(one.sd, more);
  }
}

std::vector<population::KnownMeasure> measures_together(
    std::vector<population::KnownMeasure> own, const std::vector<population::KnownMeasure>& photo) {
  for (const population::KnownMeasure& one : photo) {
    const bool is_known = std::any_of(
        own.begin(), own.end(),
        [&](const population::KnownMeasure& other) { return other.terms == one.terms; });
    if (!is_known) own.push_back(one);
  }
  return own;
}

OutlinePerson person_of_outline(const hand::Hand& template_hand,
                                const population::Population& population,
                                const std::vector<population::KnownMeasure>& own,
                                const HandOutline& seen, const OutlineScene& scene, int rounds) {
  const hand::HandInstanceMaker maker(template_hand);
  const hand::Side side = seen.is_right ? hand::Side::kRight : hand::Side::kLeft;
  OutlinePerson person;
  std::vector<population::KnownMeasure> measures;
  const auto estimate_from = [&](const HandOutline& outline, const OutlineErrors& errors) {
    measures = measures_together(own, measures_of(outline, seen_obliquely(errors, scene.sheet.tilt),
                                                  scene.sheet.scale_error));
    person.outline = outline;
    person.measures = static_cast<int>(measures.size());
    person.estimate = population::estimate_person(population, measures);
    allow_for_build(person.estimate);
    person.hand = maker.make(population::sizes_of(person.estimate)).hand;
    if (person.hand.side != side) person.hand = hand::mirrored(person.hand);
  };
  const auto check_length = [&] {
    const std::string doubt = length_doubt(measures, population);
    if (!doubt.empty()) person.notes.push_back(doubt);
  };
  estimate_from(seen, kRawErrors);
  for (int round = 0; round < rounds; ++round) {
    try {
      const PlacedModel start =
          person.model ? person.model->model : flat_model(person.hand, seen, scene.options.palm_up);
      person.model = match_model(person.hand, seen, scene, start, round == 0 ? 4 : 2);
    } catch (const InputError& error) {
      person.model.reset();
      person.notes.push_back(std::string("no model of a hand could be placed like this one (") +
                             error.what() +
                             "): measures are taken as they are seen, with larger errors");
      estimate_from(seen, kRawErrors);
      check_length();
      return person;
    }
    estimate_from(corrected(seen, person.model->outline, straight_dimensions(person.hand)),
                  kModelErrors);
  }
  check_length();
  return person;
}

}  // namespace palmar::capture
