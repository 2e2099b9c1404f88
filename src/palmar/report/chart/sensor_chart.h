// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/report/chart/figure.h"
#include "palmar/study/sensors/measured_pressure.h"

namespace palmar::report {

/// Maps of a sensor's cells: what is simulated, or measured, simulated and their difference side by
/// side, the first two on one scale. A mat is drawn as it is unrolled, seen from outside, the rows
/// that are pressed with two more on either side; a glove as the palm of a right hand with the
/// fingers up; free sensors as a list of squares.
Figure sensor_figure(const study::SensorReading& reading,
                     const std::optional<study::PressureComparison>& measured);

}  // namespace palmar::report
