// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "palmar/study/assessment/assessment.h"

namespace palmar::records {

/// The assessment's sensors: {"layout": {"name", "kind", "pitch_mm", "source"}, "rows", "columns",
/// "force_n", "force_beside_n", "peak_pressure_mpa", "pressed_area_mm2", "cells": [{"patch", "row",
/// "column", "area_mm2", "force_n", "mean_pressure_mpa", "region"}], "measured": null or {"source",
/// "force_measured_n", "force_simulated_n", "peak_measured_mpa", "peak_simulated_mpa", "compared",
/// "pearson": {"r", "n", "p_value", "low", "high"}, "spearman": {"r", "n", "p_value"}, "rms_mpa",
/// "mean_difference_mpa", "parts": [{"name", "cells", "measured_n", "simulated_n"}],
/// "cell_force_n": [...] in the order of the cells}}.
nlohmann::ordered_json sensor_object(const study::Assessment& assessment);

}  // namespace palmar::records
