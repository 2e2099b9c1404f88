// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/study/sensors/measured_pressure.h"

namespace palmar::records {

/// What a sensor of that layout measured, from a CSV file as read_csv() takes it apart; one row per
/// cell and frame. Columns:
///
///     patch                 the glove's region or the free sensor's name; of a mat not needed
///     row, column           from 1, as in the layout; of free sensors not needed
///     force_n, or           force on the cell, or
///     pressure_kpa, pressure_mpa   mean pressure over it
///
/// Other columns are not looked at, so what `palmar assess --sensors` writes (sensors.csv) can be
/// read, too. Throws InputError naming file, line, column and value: a column is missing or given
/// twice (force and pressure), no number, a force below 0, a row or column that is no whole number
/// from 1, no row at all.
study::MeasuredPressure read_measured_pressure(const std::string& path,
                                               const study::SensorLayout& layout);

}  // namespace palmar::records
