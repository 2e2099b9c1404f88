// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_worker.h"

namespace palmar::records {

std::string run_cad(const std::string& verb, const std::string& request, const CadFolder& folder,
                    const std::string& object, const CadLimits& limits, const Progress& progress) {
  static const formats::Worker kCad = {
      .program = "palmar-cad",
      .variable = "PALMAR_CAD",
      .name = "the CAD program",
      .crashed = "the CAD kernel crashed on it",
      .reason = "it is damaged, or holds what the kernel can't handle"};
  return formats::run_worker(kCad, verb, request, folder, object, limits, progress);
}

}  // namespace palmar::records
