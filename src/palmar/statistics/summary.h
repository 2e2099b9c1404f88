// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace palmar {

/// Value below which a share p of sorted values lies: linear between order statistics, with
/// h = (n - 1) p (Hyndman & Fan 1996, type 7; R's default). `sorted` ascending and not empty, p in
/// [0, 1]; throws UsageError otherwise.
double quantile(std::span<const double> sorted, double p);

}  // namespace palmar
