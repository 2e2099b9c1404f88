// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/person/scan_posture.h"

#include <gtest/gtest.h>

namespace palmar::hand {
namespace {

TEST(ScanPosture, IsFoundInTheDescriptionOfASeries) {
  EXPECT_EQ(scan_posture_in("T1 Thumb-Flexion cor 1mm"), ScanPosture::kThumbFlexion);
  EXPECT_EQ(scan_posture_in("REFERENCE"), ScanPosture::kReference);
  EXPECT_EQ(scan_posture_in("t1 finger.abduction"), ScanPosture::kFingerAbduction);
  EXPECT_EQ(scan_posture_in("localizer"), std::nullopt);
  EXPECT_EQ(scan_posture_in("reference or grasp"), std::nullopt);
  for (int k = 0; k < kScanPostureCount; ++k) {
    EXPECT_EQ(scan_posture_in(name_of(static_cast<ScanPosture>(k))), static_cast<ScanPosture>(k));
  }
}

}  // namespace
}  // namespace palmar::hand
