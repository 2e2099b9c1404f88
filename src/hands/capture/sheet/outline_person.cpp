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

namespace palmar {
namespace {

constexpr HandDimension kHandLength{DimensionKind::kHandLength};
constexpr HandDimension kHandWidth{DimensionKind::kHandWidth};

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

double true_length(const HandDimensions& d, std::size_t finger) {
  double sum = 0.0;
  for (const auto& segment : segments_of(static_cast<Finger>(finger))) {
    if (segment) sum += d.segment[index_of(*segment)].length;
  }
  return sum;
}

/// The outline with what was missed on a model taken off; nothing where either has no measure.
HandOutline corrected(const HandOutline& seen, const HandOutline& model,
                      const HandDimensions& truth) {
  HandOutline result = seen;
  const auto correct = [](double& value, double measured, double real) {
    value = value > 0.0 && measured > 0.0 ? value + real - measured : 0.0;
  };
  correct(result.hand_length, model.hand_length, truth.hand_length);
  correct(result.hand_width, model.hand_width, truth.hand_width);
  for (std::size_t f = 1; f < 5; ++f) {
    OutlineFinger& finger = result.finger[f];
    correct(finger.length, model.finger[f].length, true_length(truth, f));
    const auto chain = segments_of(static_cast<Finger>(f));
    for (std::size_t k = 0; k < 3; ++k) {
      if (!chain[k]) continue;
      correct(finger.width[k], model.finger[f].width[k], truth.segment[index_of(*chain[k])].width);
    }
  }
  return result;
}

}  // namespace

std::vector<KnownMeasure> measures_of(const HandOutline& outline, const OutlineErrors& errors,
                                      double scale_error) {
  std::vector<KnownMeasure> list;
  const auto sd = [&](double error, double value) {
    return std::hypot(error, scale_error * value);
  };
  list.push_back(
      KnownMeasure::of(kHandLength, outline.hand_length, sd(errors.length, outline.hand_length)));
  if (outline.hand_width > 0.0) {
    list.push_back(
        KnownMeasure::of(kHandWidth, outline.hand_width, sd(errors.width, outline.hand_width)));
  }
  for (std::size_t f = 1; f < 5; ++f) {
    const OutlineFinger& finger = outline.finger[f];
    const auto chain = segments_of(static_cast<Finger>(f));
    if (finger.length > 0.0) {
      KnownMeasure whole{{},
                         finger.length,
                         sd(errors.finger, finger.length),
                         std::string(name_of(static_cast<Finger>(f))) + " finger"};
      for (const auto& segment : chain) {
        if (segment) whole.terms.push_back({{DimensionKind::kSegmentLength, *segment}, 1.0});
      }
      list.push_back(whole);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!chain[k] || finger.width[k] <= 0.0) continue;
      list.push_back(KnownMeasure::of({DimensionKind::kSegmentWidth, *chain[k]}, finger.width[k],
                                      sd(errors.breadth[k], finger.width[k])));
    }
  }
  return list;
}

void allow_for_build(PersonEstimate& estimate) {
  const auto length_of = [&](Segment segment) {
    for (const EstimatedDimension& one : estimate.dimensions) {
      if (one.dimension == HandDimension{DimensionKind::kSegmentLength, segment}) return one.value;
    }
    return 0.0;
  };
  for (EstimatedDimension& one : estimate.dimensions) {
    const auto [kind, segment] = one.dimension;
    double share = 0.0;
    if (kind == DimensionKind::kSegmentLength) {
      share = segment == Segment::kPalm ? kPalmShare : kSegmentShare;
    } else if (kind == DimensionKind::kSegmentWidth && one.is_measured) {
      share = segment == Segment::kMiddleProximal ? kProportionScatter : kOwnWidth;
    } else if (kind == DimensionKind::kHandWidth && one.is_measured) {
      share = kOwnBreadth;
    } else if (kind == DimensionKind::kSegmentThickness && !one.is_measured) {
      share = kDepth;
    } else if (kind != DimensionKind::kHandLength && !one.is_measured) {
      share = kFullness;
    }
    double more = share * one.value;
    const std::optional<Finger> finger = finger_of(segment);
    if (kind == DimensionKind::kSegmentLength && finger && *finger != Finger::kThumb) {
      const auto chain = segments_of(*finger);
      const double others = std::hypot(length_of(*chain[1]), length_of(*chain[2]));
      if (segment == chain[0]) more = share * others;
    }
    one.sd = std::hypot(one.sd, more);
  }
}

std::vector<KnownMeasure> measures_together(std::vector<KnownMeasure> own,
                                            const std::vector<KnownMeasure>& photo) {
  for (const KnownMeasure& one : photo) {
    const bool is_known = std::any_of(own.begin(), own.end(), [&](const KnownMeasure& other) {
      return other.terms == one.terms;
    });
    if (!is_known) own.push_back(one);
  }
  return own;
}

OutlinePerson person_of_outline(const Hand& template_hand, const Population& population,
                                const std::vector<KnownMeasure>& own, const HandOutline& seen,
                                const OutlineScene& scene, int rounds) {
  const HandInstanceMaker maker(template_hand);
  const Side side = seen.is_right ? Side::kRight : Side::kLeft;
  OutlinePerson person;
  std::vector<KnownMeasure> measures;
  const auto estimate_from = [&](const HandOutline& outline, const OutlineErrors& errors) {
    measures = measures_together(own, measures_of(outline, seen_obliquely(errors, scene.sheet.tilt),
                                                  scene.sheet.scale_error));
    person.outline = outline;
    person.measures = static_cast<int>(measures.size());
    person.estimate = estimate_person(population, measures);
    allow_for_build(person.estimate);
    person.hand = maker.make(sizes_of(person.estimate)).hand;
    if (person.hand.side != side) person.hand = mirrored(person.hand);
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

}  // namespace palmar
