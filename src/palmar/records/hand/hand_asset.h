// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/template/template_hand.h"

namespace palmar::records {

/// Reads the generic hand of the WebXR input profiles (`profiles/generic-hand/right.glb`): skin and
/// 25 named joint nodes; metres become mm. Nodes may be nested; their transforms are chained to the
/// scene's frame, scale is checked to be 1. Throws InputError, naming the file, if the mesh or a
/// joint node is missing.
hand::HandAsset read_hand_asset(const std::string& path);

}  // namespace palmar::records
