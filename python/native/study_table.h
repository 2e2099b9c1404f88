// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "palmar/study/statistics/study_results.h"

namespace palmar::python {

/// One row per finished grasp as columns: whose hand, what product and how, how it ended, what the
/// whole hand feels, and every index under its key (nan where it has no value).
pybind11::dict grasp_table(const study::StudyResults& results);

}  // namespace palmar::python
