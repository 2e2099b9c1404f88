// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/tissue/modulus_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palmar::contact {
namespace {

/// A map of two blocks, linear in the logarithms: each asks for less as the other is stiffer. With
/// the numbers below its fixed point is ln lambda = (2, 1), by elimination.
BlockStiffening asked(const BlockStiffening& lambda, double shift = 0.0) {
  BlockStiffening result = no_stiffening();
  const double a = std::log(lambda[0]), b = std::log(lambda[1]);
  result[0] = std::exp(2.3 + shift - 0.3 * b);
  result[1] = std::exp(1.7 + shift - 0.35 * a);
  return result;
}

double misfit(const BlockStiffening& lambda, double shift = 0.0) {
  const BlockStiffening to = asked(lambda, shift);
  return std::max(std::abs(std::log(to[0] / lambda[0])), std::abs(std::log(to[1] / lambda[1])));
}

/// Rounds until the misfit is below 1e-8; `lambda` is left there.
int rounds(ModulusSearch& search, BlockStiffening& lambda, double shift = 0.0) {
  search.begin();
  int count = 0;
  for (; misfit(lambda, shift) > 1e-8 && count < 50; ++count) {
    lambda = search.next(lambda, asked(lambda, shift));
  }
  return count;
}

TEST(ModulusSearch, FindsTheFixedPoint) {
  ModulusSearch search;
  BlockStiffening lambda = no_stiffening();
  rounds(search, lambda);
  EXPECT_NEAR(std::log(lambda[0]), 2.0, 1e-7);
  EXPECT_NEAR(std::log(lambda[1]), 1.0, 1e-7);
  EXPECT_EQ(lambda[2], 1.0);
}

TEST(ModulusSearch, TakesFewerRoundsThanRepetitionAndFewerStillNextTime) {
  int repeated = 0;
  for (BlockStiffening plain = no_stiffening(); misfit(plain) > 1e-8; plain = asked(plain)) {
    ++repeated;
  }
  ModulusSearch search;
  BlockStiffening lambda = no_stiffening();
  const int first = rounds(search, lambda);
  const int second = rounds(search, lambda, 0.1);
  EXPECT_LT(first, repeated);
  EXPECT_LT(second, first);
}

TEST(ModulusSearch, NoModulusFallsBelowThatOfTissueAtRest) {
  ModulusSearch search;
  BlockStiffening from = no_stiffening(), to = no_stiffening();
  from[0] = 3.0;
  const BlockStiffening next = search.next(from, to);
  EXPECT_EQ(next[0], 1.0);
}

}  // namespace
}  // namespace palmar::contact
