// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace palmar::imaging {

struct SharpeningOptions {
  double width = 0.15;  ///< full width at half maximum of the blur, in units of the values
  double noise = 0.01;  ///< Wiener filter's
  int bins = 200;
};

/// Values v = u + f, with f normally distributed: the expectation of u for every v. The histogram
/// V of v is that of u blurred by the Gaussian F; its Wiener-filtered inverse U = G * V with
/// G^ = F^ / (F^^2 + noise), nowhere below 0, gives E[u | v] = (F * (u U)) / (F * U) at v.
///
/// Source: Sled, Zijdenbos, Evans 1998, IEEE Trans. Med. Imaging 17, 87-97, eq. (8)-(12).
std::vector<double> sharpened(const std::vector<double>& values, const SharpeningOptions& options);

}  // namespace palmar::imaging
