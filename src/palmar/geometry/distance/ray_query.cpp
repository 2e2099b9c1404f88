// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/ray_query.h"

#include <algorithm>
#include <tuple>

#include "palmar/geometry/distance/embree_mesh.h"

namespace palmar::geometry {
namespace {

RTCRayHit make_ray(const EmbreeMesh& mesh, const Vec3& origin, const Vec3& direction, double from,
                   double to) {
  const Vec3 start = origin - mesh.origin();
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(start.x());
  ray.ray.org_y = static_cast<float>(start.y());
  ray.ray.org_z = static_cast<float>(start.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tnear = static_cast<float>(from);
  ray.ray.tfar = static_cast<float>(to);
  ray.ray.mask = 0xFFFFFFFFu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

/// Embree hands the context to the filter; the list of hits follows it in memory.
struct CollectingContext {
  RTCIntersectContext base;
  std::vector<RayHit>* hits;
};

void collect(const RTCFilterFunctionNArguments* arguments) {
  auto& context = *reinterpret_cast<CollectingContext*>(arguments->context);
  context.hits->push_back({static_cast<int>(RTCHitN_primID(arguments->hit, 1, 0)),
                           static_cast<double>(RTCRayN_tfar(arguments->ray, 1, 0))});
  arguments->valid[0] = 0;  // go on along the ray
}

}  // namespace

struct RayQuery::Impl {
  EmbreeMesh mesh;
};

RayQuery::RayQuery(const TriangleMesh& mesh) : impl_(new Impl{EmbreeMesh(mesh)}) {}
RayQuery::~RayQuery() = default;
RayQuery::RayQuery(RayQuery&&) noexcept = default;
RayQuery& RayQuery::operator=(RayQuery&&) noexcept = default;

std::optional<RayHit> RayQuery::first_hit(const Vec3& origin, const Vec3& direction, double from,
                                          double to) const {
  RTCRayHit ray = make_ray(impl_->mesh, origin, direction, from, to);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->mesh.scene(), &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return RayHit{static_cast<int>(ray.hit.primID), static_cast<double>(ray.ray.tfar)};
}

std::vector<RayHit> RayQuery::all_hits(const Vec3& origin, const Vec3& direction,
                                       double from) const {
  std::vector<RayHit> hits;
  RTCRayHit ray =
      make_ray(impl_->mesh, origin, direction, from, std::numeric_limits<double>::infinity());
  CollectingContext context{{}, &hits};
  rtcInitIntersectContext(&context.base);
  context.base.filter = collect;
  rtcIntersect1(impl_->mesh.scene(), &context.base, &ray);
  std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
    return std::tie(a.distance, a.triangle) < std::tie(b.distance, b.triangle);
  });
  return hits;
}

}  // namespace palmar::geometry
