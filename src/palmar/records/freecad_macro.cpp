// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/records/handle_file.h"

namespace palmar::records {
namespace {

constexpr double kOutlineStep = 2.0;  // mm, of the original's outlines
constexpr int kOutlineColumns = 72;

/// The functions of handle_features.h and handle_shape.h, in Python.
constexpr const char* kBody = R"PY(
def mound(t):
    return max(0.0, 1.0 - t * t) ** 3

def lobe(angle):
    return (0.5 * (1.0 + math.cos(angle))) ** 3

def waves(s):
    return (0.5 * (1.0 - math.cos(8.0 * math.pi * s))) ** 2 if abs(s) < 0.5 else 0.0

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
           - thumb_rest * mound((z - thumb_at) / 16.0) * lobe(phi - thumb_phi) ** 4
           - finger_grooves * waves(z / breadth) * lobe(phi + 0.5 * math.pi) ** 2)
    k = 1.0 + out / math.hypot(x, y)
    return x * k, y * k

def middle(z):
    return FreeCAD.Vector(centre[0][0] + z * (centre[1][0] + z * centre[2][0]),
                          centre[0][1] + z * (centre[1][1] + z * centre[2][1]), z)

def between(table, z, phi):
    v = min(max((z - old_z[0]) / (old_z[-1] - old_z[0]), 0.0), 1.0) * (len(old_z) - 1)
    j = min(int(v), len(old_z) - 2)
    n = len(table[0])
    u = (phi / (2.0 * math.pi) * n) % n
    i = int(u) % n
    low = table[j][i] + (u - int(u)) * (table[j][(i + 1) % n] - table[j][i])
    high = table[j + 1][i] + (u - int(u)) * (table[j + 1][(i + 1) % n] - table[j + 1][i])
    return low + (v - j) * (high - low)

def side_point(z, t):
    x, y = section_point(z, t)
    phi = math.atan2(y, x)
    s = between(share, z, phi)
    if s < 1.0:
        r = math.hypot(x, y)
        k = (s * r + (1.0 - s) * between(old, z, phi)) / r
        x, y = x * k, y * k
    return middle(z) + FreeCAD.Vector(x, y, 0.0)

def rounding(end, inwards):
    rows = []
    for k in range(9 if end_radius > 0.0 else 0):
        angle = end_angle * (1.0 - k / 9.0)
        rows.append((end + inwards * end_radius * (math.sin(end_angle) - math.sin(angle)),
                     end_radius * (1.0 - math.cos(angle))))
    return rows

def inset_point(z, t, inset):
    way = side_point(z, t + 1e-4) - side_point(z, t - 1e-4)
    return side_point(z, t) + FreeCAD.Vector(-way.y, way.x, 0.0) * (inset / way.Length)

def build():
    # Points round every section, the sections of the roundings among them.
    height = end_radius * math.sin(end_angle)
    low, high = bottom + height, top - height
    steps = max(2, math.ceil((high - low) / row_distance))
    rows = rounding(bottom, 1.0) + [(low + (high - low) * j / steps, 0.0) for j in range(steps + 1)]
    if end_radius > 0.0:  # without these the side bulges beside its roundings
        rows += [(z, 0.0) for s in (1.0 / 6.0, 0.5)
                 for z in (low + s * end_radius, high - s * end_radius)]
    rows = sorted(rows) + list(reversed(rounding(top, -1.0)))
    points = [[inset_point(z, 0.125 + i / columns, inset) for i in range(columns)]
              for z, inset in rows]
    # One bicubic surface through all of them: splines round, then splines through their poles.
    v = [0.0]
    for before, after in zip(points, points[1:]):
        v.append(v[-1] + sum(a.distanceToPoint(b) for a, b in zip(before, after)) / columns)
    rounds = []
    for row in points:
        rounds.append(Part.BSplineCurve())
        rounds[-1].interpolate(Points=row, PeriodicFlag=True,
                               Parameters=[i / columns for i in range(columns + 1)])
    poles = []
    for column in zip(*[curve.getPoles() for curve in rounds]):
        along = Part.BSplineCurve()
        along.interpolate(Points=list(column), Parameters=v)
        poles.append(along.getPoles())
    surface = Part.BSplineSurface()
    surface.buildFromPolesMultsKnots(poles, rounds[0].getMultiplicities(), along.getMultiplicities(),
                                     rounds[0].getKnots(), along.getKnots(), True, False, 3, 3)
    # Palm, left, fingers and right, each with its roundings, and the flat ends.
    ends = len(rounding(bottom, 1.0))
    borders = [v[0], v[ends], v[-1 - ends], v[-1]] if ends else [v[0], v[-1]]
    faces = []
    for first, last in zip(borders, borders[1:]):
        for quarter in range(4):
            patch = surface.copy()
            patch.segment(0.25 * quarter, 0.25 * (quarter + 1), first, last)
            faces.append(patch.toShape())
    for border in (v[0], v[-1]):
        faces.append(Part.Face(Part.Wire([surface.vIso(border).toShape()])))
    shell = Part.Shell(faces)
    shell.sewShape()
    solid = Part.Solid(shell)
    if solid.Volume < 0.0:
        solid.reverse()
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

/// The original's outlines and the share of the features, as Python lists.
std::string outline_tables(const redesign::HandleShape& shape) {
  const redesign::HandleBody& body = shape.body;
  const double length = body.top - body.bottom;
  const int steps = std::max(2, static_cast<int>(std::ceil(length / kOutlineStep)));
  std::string heights, radii, shares;
  for (int j = 0; j <= steps; ++j) {
    const double z = body.bottom + length * j / steps;
    heights += fmt::format("{}{:.3f}", j == 0 ? "" : ", ", z);
    radii += "    [";
    shares += "    [";
    for (int i = 0; i < kOutlineColumns; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / kOutlineColumns;
      const char* const comma = i == 0 ? "" : ", ";
      radii += fmt::format("{}{:.2f}", comma, shape.radius_before(z, phi));
      shares += fmt::format("{}{:.3g}", comma, shape.share_at(z, phi));
    }
    radii += "],\n";
    shares += "],\n";
  }
  return "old_z = [" + heights + "]\nold = [\n" + radii + "]\nshare = [\n" + shares + "]\n";
}

}  // namespace

std::string freecad_macro(const redesign::HandleShape& shape, const std::string& product) {
  const redesign::HandleBody& body = shape.body;
  std::string text = fmt::format(
      "# {}: a handle by its features, made by Palmar. Edit the numbers and run it again.\n"
      "import math\nimport FreeCAD\nimport Part\n\n",
      product);
  for (const redesign::HandleFeature& one : redesign::handle_features()) {
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
  const redesign::HandleRows rows = redesign::rows_for(shape);
  text += fmt::format(
      "end_angle = math.radians({:.1f})  # over which the edges at both ends turn\n"
      "columns, row_distance = {}, {:.2f}  # points round a section; mm between sections\n",
      redesign::kEndAngle * 180.0 / std::numbers::pi, rows.columns, rows.distance);
  text +=
      "\n# What is kept: the outlines that were there, by z and direction, mm, and the share of "
      "the\n"
      "# features there.\nold_z, old, share = [0.0, 1.0], [[1.0], [1.0]], [[1.0], [1.0]]\n";
  if (shape.keeps()) text += outline_tables(shape);
  return text + kBody;
}

}  // namespace palmar::records
