// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/formats/process/worker.h"

namespace palmar::records {

using CadLimits = formats::WorkerLimits;
using CadFolder = formats::WorkerFolder;

/// Runs `palmar-cad VERB FOLDER` (beside this program, or $PALMAR_CAD) as a child; see
/// run_worker().
std::string run_cad(const std::string& verb, const std::string& request, const CadFolder& folder,
                    const std::string& object, const CadLimits& limits = {},
                    const Progress& progress = {});

}  // namespace palmar::records
