// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/embree_mesh.h"

#include <limits>
#include <string>

#include "palmar/core/error.h"

namespace palmar {
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

void check_mesh(const TriangleMesh& mesh) {
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3& x = mesh.vertices[v];
    if (!x.allFinite()) {
      throw InputError("mesh vertex " + std::to_string(v) + ": coordinates are " +
                       std::to_string(x.x()) + ", " + std::to_string(x.y()) + ", " +
                       std::to_string(x.z()) + "; finite numbers are required");
    }
  }
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v < 0 || v >= mesh.vertex_count()) {
        throw InputError("mesh triangle " + std::to_string(t) + ": corner is vertex " +
                         std::to_string(v) + "; 0 to " + std::to_string(mesh.vertex_count() - 1) +
                         " exist");
      }
    }
  }
}

}  // namespace

EmbreeMesh::EmbreeMesh(const TriangleMesh& mesh) {
  check_mesh(mesh);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) box_.extend(mesh.vertices[v]);
  }
  if (!box_.isEmpty()) {
    origin_ = box_.center();
    float_error_ = box_.sizes().maxCoeff() * std::numeric_limits<float>::epsilon();
  }

  scene_ = rtcNewScene(device());
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
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcCommitScene(scene_);
}

EmbreeMesh::~EmbreeMesh() { rtcReleaseScene(scene_); }

}  // namespace palmar
