// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/records/handle_file.h"

namespace palmar {
namespace {

constexpr double kSections = 10.0;    // mm between them, about
constexpr double kOutlineStep = 4.0;  // mm, of the original's outlines
constexpr int kOutlineColumns = 72;

/// The functions of handle_features.h and handle_shape.h, in Python.
constexpr const char* kBody = R"PY(
def mound(t):
    return max(0.0, 1.0 - t * t) ** 3

def lobe(angle):
    return (0.5 * (1.0 + math.cos(angle))) ** 3

def section_point(z, t):
    more = (-taper * z / 100.0 + swell * mound(z / (0.8 * breadth))
            - waist * mound((z - 0.36 * breadth) / (0.3 * breadth)))
    a, b, p = 0.5 * (width + more), 0.5 * (depth + more), 2.0 + 3.0 * squareness
    c, s = math.cos(2.0 * math.pi * t), math.sin(2.0 * math.pi * t)
    k = (abs(c) ** p + abs(s) ** p) ** (-1.0 / p)
    x, y = a * c * k * (1.0 + egg * s * k), b * s * k
    w = math.radians(turn + twist * z / 100.0)
    x, y = x * math.cos(w) - y * math.sin(w), x * math.sin(w) + y * math.cos(w)
    phi = math.atan2(y, x)
    m = mound(z / (0.6 * breadth))
    out = (palm_swell * m * lobe(phi - 0.5 * math.pi)
           + finger_swell * m * lobe(phi + 0.5 * math.pi)
           - thumb_rest * mound((z - thumb_at) / 16.0) * lobe(phi - thumb_phi) ** 4)
    k = 1.0 + out / math.hypot(x, y)
    return x * k, y * k

def smooth_step(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)

def share(z, phi):
    value = 1.0
    for run_out, way in ((run_out_bottom, z - bottom), (run_out_top, top - z)):
        if run_out >= 0.0:
            value *= smooth_step((way - run_out) / 14.0)
    if value > 0.0 and kept_boxes:
        r = old_radius(z, phi)
        at = placement.multVec(middle(z) + FreeCAD.Vector(r * math.cos(phi), r * math.sin(phi), 0.0))
        for low, high in kept_boxes:
            beyond = [max(l - a, a - h, 0.0) for l, a, h in zip(low, at, high)]
            value *= smooth_step(math.sqrt(sum(b * b for b in beyond)) / 14.0)
    return value

def middle(z):
    return FreeCAD.Vector(centre[0][0] + z * (centre[1][0] + z * centre[2][0]),
                          centre[0][1] + z * (centre[1][1] + z * centre[2][1]), z)

def old_radius(z, phi):
    v = min(max((z - old_z[0]) / (old_z[-1] - old_z[0]), 0.0), 1.0) * (len(old_z) - 1)
    j = min(int(v), len(old_z) - 2)
    n = len(old[0])
    u = (phi / (2.0 * math.pi) * n) % n
    i = int(u) % n
    low = old[j][i] + (u - int(u)) * (old[j][(i + 1) % n] - old[j][i])
    high = old[j + 1][i] + (u - int(u)) * (old[j + 1][(i + 1) % n] - old[j + 1][i])
    return low + (v - j) * (high - low)

def side_point(z, t):
    x, y = section_point(z, t)
    phi = math.atan2(y, x)
    s = share(z, phi)
    if s < 1.0:
        r = math.hypot(x, y)
        k = (s * r + (1.0 - s) * old_radius(z, phi)) / r
        x, y = x * k, y * k
    return middle(z) + FreeCAD.Vector(x, y, 0.0)

def build():
    wires = []
    for j in range(sections + 1):
        z = bottom + (top - bottom) * j / sections
        curve = Part.BSplineCurve()
        curve.interpolate(Points=[side_point(z, i / columns) for i in range(columns)],
                          PeriodicFlag=True)
        wires.append(Part.Wire([curve.toShape()]))
    solid = Part.makeLoft(wires, True)
    if end_radius > 0.0:
        ends = [e for e in solid.Edges
                if all(abs(v.Point.z - bottom) < 1e-6 or abs(v.Point.z - top) < 1e-6
                       for v in e.Vertexes)
                and abs(e.BoundBox.ZLength) < 1e-6]
        solid = solid.makeFillet(end_radius, ends)
    solid.Placement = placement
    return solid

solid = build()
document = FreeCAD.ActiveDocument or FreeCAD.newDocument("handle")
handle = document.addObject("Part::Feature", "handle")
handle.Shape = solid
document.recompute()
print("handle: valid %s, volume %.1f mm3, faces %d"
      % (solid.isValid(), solid.Volume, len(solid.Faces)))
)PY";

}  // namespace

std::string freecad_macro(const HandleShape& shape, const std::string& product) {
  const HandleBody& body = shape.body;
  std::string text = fmt::format(
      "# {}: a handle by its features, made by Palmar. Edit the numbers and run it again.\n"
      "import math\nimport FreeCAD\nimport Part\n\n",
      product);
  for (const HandleFeature& one : handle_features()) {
    text += fmt::format("{} = {:.4f}  # {}{}{}\n", one.name, one.scale * shape.features.*one.value,
                        one.unit, one.unit.empty() ? "" : "; ", one.meaning);
  }
  text += fmt::format("end_radius = {:.4f}  # mm, of the edges at both ends\n",
                      body.is_whole ? shape.end_radius : 0.0);
  text += fmt::format(
      "\n# Where the handle is: z runs along it towards the thumb, y towards the palm.\n"
      "bottom, top = {:.4f}, {:.4f}  # mm\nbreadth = {:.4f}  # mm, of the hand over four fingers\n"
      "thumb_at, thumb_phi = {:.4f}, {:.5f}  # mm, rad\n",
      body.bottom, body.top, body.hands.breadth, body.hands.thumb_at, body.hands.thumb_phi);
  text += fmt::format("centre = (({:.6f}, {:.6f}), ({:.8f}, {:.8f}), ({:.10f}, {:.10f}))\n",
                      body.centre[0].x(), body.centre[0].y(), body.centre[1].x(),
                      body.centre[1].y(), body.centre[2].x(), body.centre[2].y());
  const Quat& q = body.product_from_handle.rotation;
  const Vec3& o = body.product_from_handle.translation;
  text += fmt::format(
      "placement = FreeCAD.Placement(FreeCAD.Vector({:.6f}, {:.6f}, {:.6f}),\n"
      "                              FreeCAD.Rotation({:.12f}, {:.12f}, {:.12f}, {:.12f}))\n",
      o.x(), o.y(), o.z(), q.x(), q.y(), q.z(), q.w());
  // Below 0: the features go to the end.
  const auto run_out = [&](bool is_free) {
    if (body.is_whole) return shape.kept_ends > 0.0 ? shape.kept_ends : -1.0;
    return is_free ? -1.0 : 0.0;
  };
  const double low = run_out(body.is_free[0]), high = run_out(body.is_free[1]);
  const bool keeps = low >= 0.0 || high >= 0.0 || !shape.kept_boxes.empty();
  text += fmt::format(
      "run_out_bottom, run_out_top = {:.3f}, {:.3f}  # mm; below 0: none\n"
      "sections, columns = {}, {}\n",
      low, high, std::max(8, static_cast<int>((body.top - body.bottom) / kSections)),
      keeps ? kOutlineColumns
            : 8 * static_cast<int>(std::ceil((24.0 + 24.0 * shape.features.squareness) / 8.0)));
  text += "kept_boxes = [";
  for (const Box3& box : shape.kept_boxes) {
    text += fmt::format("(({:.4f}, {:.4f}, {:.4f}), ({:.4f}, {:.4f}, {:.4f})), ", box.min().x(),
                        box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z());
  }
  text += "]  # mm, low and high corners, product frame\n";
  text +=
      "\n# The outlines that were there, by z and direction, mm\nold_z, old = [0.0, 1.0], "
      "[[1.0], [1.0]]\n";
  if (keeps) {
    const double margin = body.is_whole && body.end_radius > 0.0 ? body.end_radius + 0.5 : 0.0;
    const double from = body.bottom + margin, to = body.top - margin;
    const int steps = std::max(2, static_cast<int>(std::ceil((to - from) / kOutlineStep)));
    std::string heights, rows;
    for (int j = 0; j <= steps; ++j) {
      const double z = from + (to - from) * j / steps;
      heights += fmt::format("{}{:.3f}", j == 0 ? "" : ", ", z);
      rows += "    [";
      for (int i = 0; i < kOutlineColumns; ++i) {
        rows += fmt::format("{}{:.2f}", i == 0 ? "" : ", ",
                            body.outlines.at(z, 2.0 * std::numbers::pi * i / kOutlineColumns));
      }
      rows += "],\n";
    }
    text += "old_z = [" + heights + "]\nold = [\n" + rows + "]\n";
  }
  return text + kBody;
}

}  // namespace palmar
