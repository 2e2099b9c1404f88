// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/modulus_search.h"

#include <algorithm>
#include <cmath>

namespace palmar::contact {
namespace {

// Choices: what is learnt from a step, and which steps are taken.
constexpr double kLongestStep = 0.7;  // of ln lambda; longer steps say little about the derivatives
constexpr double kLeastLearnt = 0.2;  // of the step; less would be a division by next to nothing
constexpr double kMostGain = 2.0;     // of what is asked for

}  // namespace

BlockStiffening ModulusSearch::next(const BlockStiffening& from, const BlockStiffening& to) {
  Vector x, asked;
  for (std::size_t b = 0; b < from.size(); ++b) {
    const auto i = static_cast<Eigen::Index>(b);
    x[i] = std::log(from[b]);
    asked[i] = std::log(to[b]) - x[i];
  }
  if (has_last_) {
    const Vector way = x - last_x_;
    const Vector learnt = gain_ * (asked - last_asked_);  // -way, were the gain right
    const double share = -way.dot(learnt);
    if (asked.lpNorm<Eigen::Infinity>() > last_asked_.lpNorm<Eigen::Infinity>()) {
      gain_.setIdentity();
    } else if (way.lpNorm<Eigen::Infinity>() < kLongestStep &&
               share > kLeastLearnt * way.squaredNorm()) {
      gain_ += (way + learnt) * (way.transpose() * gain_) / share;
    }
  }
  Vector step = gain_ * asked;
  if (step.dot(asked) <= 0.0 ||
      step.lpNorm<Eigen::Infinity>() > kMostGain * asked.lpNorm<Eigen::Infinity>()) {
    gain_.setIdentity();
    step = asked;
  }
  last_x_ = x;
  last_asked_ = asked;
  has_last_ = true;
  BlockStiffening result = to;
  for (std::size_t b = 0; b < result.size(); ++b) {
    const auto i = static_cast<Eigen::Index>(b);
    result[b] = std::max(1.0, std::exp(x[i] + step[i]));
  }
  return result;
}

}  // namespace palmar::contact
