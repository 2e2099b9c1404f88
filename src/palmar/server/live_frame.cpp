// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_frame.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "palmar/geometry/degrees.h"

namespace palmar::server {
namespace {

constexpr double kSteps = 65535.0;

/// Numbers as bytes, the lowest first.
class FrameWriter {
 public:
  explicit FrameWriter(const FrameHead& head) {
    u32(kFrameMagic);
    u32(static_cast<std::uint32_t>(head.kind));
    u32(head.request);
    u32(head.number);
  }
  void u16(std::uint32_t value) {
    bytes_ += static_cast<char>(value & 0xffU);
    bytes_ += static_cast<char>(value >> 8U & 0xffU);
  }
  void u32(std::uint32_t value) {
    u16(value & 0xffffU);
    u16(value >> 16U);
  }
  void u8(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void f32(double value) { u32(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  void f64(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    u32(static_cast<std::uint32_t>(bits & 0xffffffffU));
    u32(static_cast<std::uint32_t>(bits >> 32U));
  }
  void steps(double value, double step) {
    u16(static_cast<std::uint32_t>(std::lround(std::clamp(value / step, 0.0, kSteps))));
  }
  void triangles(const std::vector<Triangle>& all) {
    for (const Triangle& t : all) {
      for (const int corner : t) u32(static_cast<std::uint32_t>(corner));
    }
  }
  void mesh(const geometry::TriangleMesh& mesh) {
    bytes_.reserve(bytes_.size() + 12 * (mesh.vertices.size() + mesh.triangles.size()) + 64);
    u32(static_cast<std::uint32_t>(mesh.vertices.size()));
    u32(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Vec3& v : mesh.vertices) {
      for (int k = 0; k < 3; ++k) f32(v[k]);
    }
    triangles(mesh.triangles);
  }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

std::vector<Vec3> shown_skin(const LiveField& field) {
  if (field.contact == nullptr || field.contact->deformed.empty()) {
    return field.posed_skin != nullptr ? *field.posed_skin : std::vector<Vec3>{};
  }
  const geometry::Rigid3 hand_from_product = field.product_from_hand.inverse();
  std::vector<Vec3> skin;
  skin.reserve(field.contact->deformed.size());
  for (const Vec3& v : field.contact->deformed) skin.push_back(hand_from_product * v);
  return skin;
}

void write_totals(FrameWriter& out, const contact::RegionContact& total) {
  out.f32(total.force);
  out.f32(total.area);
  out.f32(total.peak_pressure);
  out.f32(total.peak_pressure_cells);
  out.f32(total.mean_pressure);
}

}  // namespace

std::string hand_frame(const hand::Hand& hand, std::uint32_t request) {
  FrameWriter out({FrameKind::kHand, request, 0});
  out.u32(static_cast<std::uint32_t>(hand.skin.vertices.size()));
  out.u32(static_cast<std::uint32_t>(hand.skin.triangles.size()));
  out.triangles(hand.skin.triangles);
  for (const hand::Region region : hand.region) out.u8(static_cast<std::uint8_t>(region));
  return out.take();
}

std::string product_frame(const geometry::TriangleMesh& mesh, std::uint32_t request) {
  FrameWriter out({FrameKind::kProduct, request, 0});
  out.mesh(mesh);
  return out.take();
}

std::string footprint_frame(const contact::ProductFootprint& footprint, std::uint32_t request) {
  FrameWriter out({FrameKind::kFootprint, request, 0});
  out.mesh(footprint.surface);
  for (const double pressure : footprint.pressure) out.f32(pressure);
  return out.take();
}

std::string field_frame(const LiveField& field, const FrameHead& head) {
  const std::vector<Vec3> skin = shown_skin(field);
  const contact::ContactResult none;
  const contact::ContactResult& contact = field.contact != nullptr ? *field.contact : none;
  FrameWriter out(head);
  out.reserve(8 * skin.size() + 1024);
  const Quat& q = field.product_from_hand.rotation;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) out.f64(value);
  for (int k = 0; k < 3; ++k) out.f64(field.product_from_hand.translation[k]);
  out.f32(field.grip_force);
  write_totals(out, contact.total);
  out.u32(static_cast<std::uint32_t>(contact.status));
  for (const double angle : field.posture.angle) out.f32(geometry::kDegreesPerRadian * angle);

  Box3 box;
  for (const Vec3& v : skin) box.extend(v);
  const Vec3 low = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
  const double span = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  const double step = std::max(kFrameStep, span / kSteps);
  for (int k = 0; k < 3; ++k) out.f32(low[k]);
  out.f32(step);
  double peak = 0.0;
  for (const double pressure : contact.pressure) peak = std::max(peak, pressure);
  const double pressure_step = std::max(peak, 1e-6) / kSteps;
  out.f32(pressure_step);
  out.u32(static_cast<std::uint32_t>(contact.regions.size()));
  for (const contact::RegionContact& region : contact.regions) {
    out.f32(static_cast<double>(region.region));
    write_totals(out, region);
  }
  out.u32(static_cast<std::uint32_t>(skin.size()));
  for (const Vec3& v : skin) {
    for (int k = 0; k < 3; ++k) out.steps(v[k] - low[k], step);
  }
  for (std::size_t i = 0; i < skin.size(); ++i) {
    out.steps(i < contact.pressure.size() ? contact.pressure[i] : 0.0, pressure_step);
  }
  const contact::MovingFootprint::Loaded nothing;
  const contact::MovingFootprint::Loaded& on_product =
      field.on_product ? *field.on_product : nothing;
  out.u32(static_cast<std::uint32_t>(on_product.vertex.size()));
  for (const int v : on_product.vertex) out.u32(static_cast<std::uint32_t>(v));
  for (const double pressure : on_product.pressure) out.steps(pressure, pressure_step);
  return out.take();
}

}  // namespace palmar::server
