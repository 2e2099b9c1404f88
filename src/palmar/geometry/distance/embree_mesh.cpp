// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/embree_mesh.h"

#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/triangle_partition.h"

namespace palmar::geometry {
namespace {

// One device for the whole process, never released: other static objects may still hold scenes.
RTCDevice device() {
  static const RTCDevice instance = [] {
    const RTCDevice created = rtcNewDevice(nullptr);
    if (created == nullptr) {
      throw Error("Embree can't start on this processor (error " +
                  std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")");
    }
    return created;
  }();
  return instance;
}

}  // namespace

EmbreeMesh::EmbreeMesh(const TriangleMesh& mesh) {
  check_finite_and_indexed(mesh);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box_.extend(mesh.vertices[v]);
  }
  if (!box_.isEmpty()) origin_ = box_.center();

  scene_ = rtcNewScene(device());
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  if (mesh.triangles.empty()) {
    rtcCommitScene(scene_);
    return;
  }
  const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) *corners++ = static_cast<unsigned>(v);
  }
  auto* coordinates = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), mesh.vertices.size()));
  for (const Vec3& x : mesh.vertices) {
    for (int k = 0; k < 3; ++k) *coordinates++ = static_cast<float>(x[k] - origin_[k]);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

EmbreeMesh::~EmbreeMesh() { rtcReleaseScene(scene_); }

}  // namespace palmar::geometry
