// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/segment_regressions.h"

#include <algorithm>
#include <cmath>

#include "palmar/population/survey_figures.h"

namespace palmar::population {
namespace {

constexpr hand::HandDimension kMiddleWidth{hand::DimensionKind::kSegmentWidth,
                                           hand::Segment::kMiddleProximal};

// Proximal phalanx of the thumb, 66 European adults: 31.57 mm, SD 3.13 mm (Buryanov & Kotiuk 2010,
// Int J Morphol 28:755-758), less a hand length that varies by 5.1 % as in ANSUR II. Greiner's link
// of 21 mm is another distance.
constexpr Moment kThumbProximal{31.57, 3.13};
constexpr Moment kHandLength{193.28, 9.946};

constexpr const char* kAnsur =
    "elasticity and residual of ANSUR II (Gordon et al. 2014), mean in the template's proportion";
constexpr const char* kGreiner =
    "residual of Greiner 1991 (NATICK/TR-92/011, second-hand transcription), mean in the "
    "template's proportion";
constexpr const char* kBuryanov =
    "residual of Buryanov & Kotiuk 2010 (Int J Morphol 28:755-758), mean in the template's "
    "proportion";
constexpr const char* kShared =
    "in the template's proportion to the width of the middle finger's proximal segment";

hand::HandDimension length_of(hand::Segment segment) {
  return {hand::DimensionKind::kSegmentLength, segment};
}

double template_value(hand::HandDimension dimension) {
  return hand::value_of(template_proportions(), dimension);
}

DimensionRegression palm(const SegmentDrivers& drivers) {
  const AnsurFigures& ansur = ansur2_figures(drivers.sex);
  const double elasticity = ansur.palm_slope * ansur.length.mean / ansur.palm.mean;
  const double share =
      template_value(hand::kPalmLengthDimension) / template_value(hand::kHandLengthDimension);
  return {.dimension = hand::kPalmLengthDimension,
          .intercept = share * drivers.mean_length * (1.0 - elasticity),
          .terms = {{hand::kHandLengthDimension, share * elasticity}},
          .residual_sd = share * drivers.mean_length * ansur.palm_residual / ansur.palm.mean,
          .evidence = Evidence::kRegressed,
          .source = kAnsur};
}

// Segment of a finger from the length L - P that hand and palm leave. `scatter` at given L as a
// share of the mean; part of it comes through the palm's residual already.
DimensionRegression finger_segment(hand::Segment segment, const SegmentDrivers& drivers,
                                   const DimensionRegression& palm, double scatter) {
  const double template_rest =
      template_value(hand::kHandLengthDimension) - template_value(hand::kPalmLengthDimension);
  const double share = template_value(length_of(segment)) / template_rest;
  const double rest = drivers.mean_length * template_rest /
                      template_value(hand::kHandLengthDimension);  // mean of L - P
  const double through_palm = palm.residual_sd / rest;
  const double own = std::sqrt(std::max(0.0, scatter * scatter - through_palm * through_palm));
  return {.dimension = length_of(segment),
          .intercept = 0.0,
          .terms = {{hand::kHandLengthDimension, share}, {hand::kPalmLengthDimension, -share}},
          .residual_sd = own * share * rest,
          .evidence = Evidence::kRegressed,
          .source = kGreiner};
}

DimensionRegression thumb_segment(hand::Segment segment, const SegmentDrivers& drivers,
                                  double scatter, const char* source) {
  const double share =
      template_value(length_of(segment)) / template_value(hand::kHandLengthDimension);
  return {.dimension = length_of(segment),
          .intercept = 0.0,
          .terms = {{hand::kHandLengthDimension, share}},
          .residual_sd = scatter * share * drivers.mean_length,
          .evidence = Evidence::kRegressed,
          .source = source};
}

DimensionRegression leading_width(const SegmentDrivers& drivers) {
  const GreinerFigures& greiner = greiner_figures(drivers.sex);
  const double scatter = 0.5 * (residual_share(greiner.index_pip_breadth, greiner.circumference) +
                                residual_share(greiner.middle_pip_breadth, greiner.circumference));
  const double share = template_value(kMiddleWidth) / template_value(hand::kCircumferenceDimension);
  return {.dimension = kMiddleWidth,
          .intercept = 0.0,
          .terms = {{hand::kCircumferenceDimension, share}},
          .residual_sd = scatter * share * drivers.mean_circumference,
          .evidence = Evidence::kRegressed,
          .source = kGreiner};
}

}  // namespace

const hand::HandDimensions& template_proportions() {
  static const hand::HandDimensions dimensions = [] {
    hand::HandDimensions d;
    d.hand_length = 176.1;
    d.hand_circumference = 193.5;
    d.hand_width = 80.7;
    d.hand_thickness = 31.3;
    d.segment = {{{97.2, 80.7, 31.3},  // palm
                  {28.0, 20.2, 18.4},  // thumb
                  {31.9, 19.7, 14.7},
                  {19.7, 16.9, 17.9},  // index
                  {21.2, 15.9, 15.3},
                  {29.3, 13.8, 12.1},
                  {23.9, 16.8, 18.5},  // middle
                  {24.3, 15.9, 15.8},
                  {32.0, 14.6, 12.6},
                  {21.1, 15.4, 16.5},  // ring
                  {22.7, 15.3, 14.7},
                  {30.6, 13.3, 12.3},
                  {14.1, 14.4, 13.5},  // little
                  {17.3, 13.2, 12.9},
                  {27.1, 12.1, 10.9}}};
    return d;
  }();
  return dimensions;
}

std::vector<DimensionRegression> segment_regressions(const SegmentDrivers& drivers) {
  const GreinerFigures& greiner = greiner_figures(drivers.sex);
  std::vector<DimensionRegression> list = {palm(drivers)};
  const DimensionRegression palm_length = list.front();
  list.push_back(thumb_segment(hand::Segment::kThumbProximal, drivers,
                               residual_share(kThumbProximal, kHandLength), kBuryanov));
  list.push_back(thumb_segment(hand::Segment::kThumbDistal, drivers,
                               residual_share(greiner.thumb_distal, greiner.length), kGreiner));
  for (int s = static_cast<int>(hand::Segment::kIndexProximal); s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    if (segment == hand::Segment::kMiddleProximal) continue;  // what the others leave
    const auto at = static_cast<std::size_t>(s - static_cast<int>(hand::Segment::kIndexProximal));
    list.push_back(finger_segment(segment, drivers, palm_length,
                                  residual_share(greiner.link[at / 3][at % 3], greiner.length)));
  }
  list.push_back(leading_width(drivers));
  for (const hand::DimensionKind kind :
       {hand::DimensionKind::kSegmentWidth, hand::DimensionKind::kSegmentThickness}) {
    for (int s = 1; s < hand::kSegmentCount; ++s) {
      const hand::HandDimension dimension{kind, static_cast<hand::Segment>(s)};
      if (dimension == kMiddleWidth) continue;
      list.push_back(
          {.dimension = dimension,
           .intercept = 0.0,
           .terms = {{kMiddleWidth, template_value(dimension) / template_value(kMiddleWidth)}},
           .residual_sd = 0.0,
           .evidence = Evidence::kScaled,
           .source = kShared});
    }
  }
  return list;
}

}  // namespace palmar::population
