// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"
#include "palmar/hand/posture.h"
#include "palmar/study/study_record.h"

namespace palmar::records {

// How a study store packs values into blobs; little endian throughout (docs/using/study-store.md).
// What can't be unpacked throws InputError "WHAT is damaged"; callers put the file in front.

/// zlib (RFC 1950) behind the length of what is in it (uint32).
std::string pack(std::string_view bytes);
std::string unpack(std::string_view packed);

/// Vertex count (uint32), triangle count (uint32), vertices (3 doubles each, mm), triangles (3
/// int32 each).
std::string mesh_bytes(const geometry::TriangleMesh& mesh);
geometry::TriangleMesh mesh_from_bytes(std::string_view bytes);

/// Count (uint32), vertices as differences to the one before (LEB128), then the values' four bytes
/// (float32) sorted by significance: all lowest bytes first.
std::string field_bytes(const study::SparseField& field);
study::SparseField field_from_bytes(std::string_view bytes);

/// 23 angles, rad, in the order of Dof.
std::string posture_bytes(const hand::Posture& posture);
hand::Posture posture_from_bytes(std::string_view bytes);

/// Quaternion w, x, y, z, then the translation in mm.
std::string rigid_bytes(const geometry::Rigid3& rigid);
geometry::Rigid3 rigid_from_bytes(std::string_view bytes);

/// Everything of a record but fields and time, for checksums.
std::string record_bytes(const study::StudyRecord& record);
/// A hold, for the digest; not in record_bytes(), so that older programs can check a record.
std::string hold_bytes(const study::StudyHold& held);

}  // namespace palmar::records
