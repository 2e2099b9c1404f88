// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/statistics/correlation.h"
#include "palmar/study/sensors/sensor_reading.h"

namespace palmar::study {

/// One cell as a real sensor read it.
struct MeasuredCell {
  std::string patch;
  int row = 1, column = 1;
  double load = 0.0;         ///< force, N, or
  bool is_pressure = false;  ///< mean pressure, MPa
  int line = 0;              ///< of the file
};

/// Forces that a sensor measured, cell by cell; of a cell given more than once (frames of a
/// recording, repeated trials) the mean counts. Cells without a row were not pressed.
struct MeasuredPressure {
  std::string source;  ///< file
  std::vector<MeasuredCell> cells;
};

/// Force of one part of the sensor: cells that one region of the simulated hand presses, or a
/// glove's patch.
struct SensorPart {
  std::string name;  ///< "index_distal"; "beside the hand" where no skin presses
  int cells = 0;
  double measured = 0.0;   ///< N
  double simulated = 0.0;  ///< N
};

/// A measurement beside the simulation of the same sensor.
struct PressureComparison {
  std::string source;
  std::vector<double> measured;                        ///< force per cell of the reading, N
  double force_measured = 0.0, force_simulated = 0.0;  ///< of all cells, N
  double peak_measured = 0.0, peak_simulated = 0.0;    ///< MPa
  int compared = 0;  ///< cells with a load in either; the rest says nothing
  statistics::Correlation pearson, spearman;  ///< of the mean pressures of those
  double rms = 0.0;                           ///< of the differences of pressure over those, MPa
  double mean_difference = 0.0;               ///< simulated less measured, over those, MPa
  std::vector<SensorPart> parts;
};

/// Lays a measurement beside a reading. Cells that neither loads are left out of the statistics:
/// their zeros would correlate by themselves. Throws InputError naming file, line and cell if a
/// cell isn't the layout's, and naming the file if fewer than 3 cells are loaded.
PressureComparison compare_pressure(const SensorReading& reading, const MeasuredPressure& measured);

}  // namespace palmar::study
