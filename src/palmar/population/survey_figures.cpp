// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/survey_figures.h"

#include <algorithm>
#include <cmath>

namespace palmar::population {
namespace {

constexpr AnsurFigures kAnsurMen = {.n = 4082,
                                    .length = {193.28, 9.946},
                                    .circumference = {212.28, 10.243},
                                    .breadth = {88.26, 4.388},
                                    .palm = {116.46, 6.233},
                                    .r_length_circumference = 0.5905,
                                    .r_length_breadth = 0.5817,
                                    .r_circumference_breadth = 0.9217,
                                    .palm_slope = 0.49788,
                                    .palm_residual = 3.785};
constexpr AnsurFigures kAnsurWomen = {.n = 1986,
                                      .length = {181.08, 10.056},
                                      .circumference = {186.55, 8.820},
                                      .breadth = {78.15, 3.843},
                                      .palm = {108.70, 5.940},
                                      .r_length_circumference = 0.5623,
                                      .r_length_breadth = 0.5697,
                                      .r_circumference_breadth = 0.8934,
                                      .palm_slope = 0.49544,
                                      .palm_residual = 3.236};

constexpr GreinerFigures kGreinerMen = {.length = {194.1, 9.9},
                                        .circumference = {213.3, 9.8},
                                        .thumb_distal = {34.5, 2.6},
                                        .link = {{{{{60.8, 5.9}, {22.6, 2.4}, {28.4, 2.3}}},
                                                  {{{54.8, 5.0}, {26.4, 2.8}, {28.7, 2.3}}},
                                                  {{{52.9, 4.0}, {24.3, 2.6}, {29.6, 2.4}}},
                                                  {{{41.5, 3.6}, {17.5, 2.4}, {27.3, 2.3}}}}},
                                        .index_pip_breadth = {23.0, 1.6},
                                        .middle_pip_breadth = {22.5, 1.6}};
constexpr GreinerFigures kGreinerWomen = {.length = {180.7, 9.8},
                                          .circumference = {186.5, 8.6},
                                          .thumb_distal = {30.8, 2.4},
                                          .link = {{{{{56.5, 5.3}, {21.1, 2.2}, {25.5, 2.1}}},
                                                    {{{49.7, 4.4}, {25.1, 2.7}, {25.5, 2.1}}},
                                                    {{{48.4, 3.4}, {22.8, 2.6}, {26.1, 2.2}}},
                                                    {{{37.8, 3.0}, {16.3, 2.2}, {23.7, 2.0}}}}},
                                          .index_pip_breadth = {19.9, 1.3},
                                          .middle_pip_breadth = {19.3, 1.3}};

}  // namespace

const AnsurFigures& ansur2_figures(grasp::Sex sex) {
  return sex == grasp::Sex::kMale ? kAnsurMen : kAnsurWomen;
}

Eigen::Matrix3d ansur_correlation(grasp::Sex sex) {
  const AnsurFigures& figures = ansur2_figures(sex);
  const double lc = figures.r_length_circumference, lw = figures.r_length_breadth,
               cw = figures.r_circumference_breadth;
  return Eigen::Matrix3d{{1.0, lc, lw}, {lc, 1.0, cw}, {lw, cw, 1.0}};
}

const GreinerFigures& greiner_figures(grasp::Sex sex) {
  return sex == grasp::Sex::kMale ? kGreinerMen : kGreinerWomen;
}

double residual_share(const Moment& dimension, const Moment& driver) {
  const double through_driver = dimension.mean / driver.mean * driver.sd;
  const double rest = dimension.sd * dimension.sd - through_driver * through_driver;
  return std::sqrt(std::max(0.0, rest)) / dimension.mean;
}

}  // namespace palmar::population
