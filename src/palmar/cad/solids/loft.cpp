// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/loft.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pln.hxx>
#include <numbers>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kSewing = 1e-5;  // mm; faces share their borders to rounding
constexpr int kFilletRows = 9;    // of a quarter round; beside it the spline is off by 0.002 radii
constexpr double kDerivative = 1e-4;  // of a turn, for normals of sections

constexpr double kBesideFillet[] = {1.0 / 6.0, 0.5};  // radii beside it

struct Row {
  double z, inset;
};

/// Rows of one end's rounding, from the flat end inwards, without the row where the side begins.
std::vector<Row> rows_of_fillet(double end, double inwards, double fillet, double whole_angle) {
  std::vector<Row> rows;
  for (int k = 0; k < kFilletRows && fillet > 0.0; ++k) {
    const double angle = whole_angle * (1.0 - static_cast<double>(k) / kFilletRows);
    rows.push_back({end + inwards * fillet * (std::sin(whole_angle) - std::sin(angle)),
                    fillet * (1.0 - std::cos(angle))});
  }
  return rows;
}

std::vector<Row> rows_of(const LoftOptions& o) {
  std::vector<Row> rows = rows_of_fillet(o.bottom, 1.0, o.end_fillet, o.end_angle);
  // Rows at the borders of bands, and evenly between.
  std::vector<double> borders;
  for (const LoftBand& band : o.bands) borders.push_back(band.begin);
  borders.push_back(o.bands.back().end);
  for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
    const double length = borders[b + 1] - borders[b];
    const int steps = std::max(2, static_cast<int>(std::ceil(length / o.row_distance)));
    for (int k = 0; k < steps; ++k) rows.push_back({borders[b] + length * k / steps, 0.0});
  }
  rows.push_back({borders.back(), 0.0});
  if (o.splits_fillets && o.end_fillet > 0.0) {
    for (const double share : kBesideFillet) {
      rows.push_back({borders.front() + share * o.end_fillet, 0.0});
      rows.push_back({borders.back() - share * o.end_fillet, 0.0});
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.z < b.z; });
  }
  std::vector<Row> top = rows_of_fillet(o.top, -1.0, o.end_fillet, o.end_angle);
  rows.insert(rows.end(), top.rbegin(), top.rend());
  return rows;
}

/// Spline parameters: mean distance from row to row.
std::vector<double> parameters_of(const std::vector<std::vector<gp_Pnt>>& points) {
  std::vector<double> parameters = {0.0};
  for (std::size_t j = 1; j < points.size(); ++j) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points[j].size(); ++i) {
      sum += points[j][i].Distance(points[j - 1][i]);
    }
    parameters.push_back(parameters.back() + sum / static_cast<double>(points[j].size()));
  }
  return parameters;
}

Handle(Geom_BSplineCurve) interpolate(const std::vector<gp_Pnt>& points,
                                      const std::vector<double>& parameters, bool is_periodic) {
  const auto n = static_cast<int>(points.size());
  const Handle(TColgp_HArray1OfPnt) p = new TColgp_HArray1OfPnt(1, n);
  for (int i = 0; i < n; ++i) p->SetValue(i + 1, points[i]);
  const auto m = static_cast<int>(parameters.size());
  const Handle(TColStd_HArray1OfReal) u = new TColStd_HArray1OfReal(1, m);
  for (int i = 0; i < m; ++i) u->SetValue(i + 1, parameters[i]);
  GeomAPI_Interpolate spline(p, u, is_periodic, 1e-9);
  spline.Perform();
  if (!spline.IsDone()) throw NumericalError("no spline goes through the sections");
  return spline.Curve();
}

/// Bicubic through all points, closed in u, which goes from 0 to 1.
Handle(Geom_BSplineSurface)
    surface_through(const std::vector<std::vector<gp_Pnt>>& points, const std::vector<double>& v) {
  const std::size_t columns = points.front().size();
  std::vector<double> u;
  for (std::size_t i = 0; i <= columns; ++i) {
    u.push_back(static_cast<double>(i) / static_cast<double>(columns));
  }
  std::vector<Handle(Geom_BSplineCurve)> rows;
  for (const auto& row : points) rows.push_back(interpolate(row, u, true));
  const int poles_u = rows.front()->NbPoles();
  std::vector<Handle(Geom_BSplineCurve)> lines;
  for (int i = 1; i <= poles_u; ++i) {
    std::vector<gp_Pnt> column;
    for (const auto& row : rows) column.push_back(row->Pole(i));
    lines.push_back(interpolate(column, v, false));
  }
  const int poles_v = lines.front()->NbPoles();
  TColgp_Array2OfPnt poles(1, poles_u, 1, poles_v);
  for (int i = 1; i <= poles_u; ++i) {
    for (int j = 1; j <= poles_v; ++j) {
      poles(i, j) = lines[i - 1]->Pole(j);
    }
  }
  return new Geom_BSplineSurface(poles, rows.front()->Knots(), lines.front()->Knots(),
                                 rows.front()->Multiplicities(), lines.front()->Multiplicities(), 3,
                                 3, true, false);
}

}  // namespace

double smoother_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

double Undulation::operator()(double at) const {
  if (at <= points_.front().at) return points_.front().value;
  for (std::size_t k = 1; k < points_.size(); ++k) {
    const Point& a = points_[k - 1];
    const Point& b = points_[k];
    if (at < b.at)
      return a.value + (b.value - a.value) * smoother_step((at - a.at) / (b.at - a.at));
  }
  return points_.back().value;
}

SectionPoint superellipse(double a, double b, double p, double turn) {
  const double anomaly = 2.0 * std::numbers::pi * turn;
  const double x = std::cos(anomaly);
  const double y = std::sin(anomaly);
  const double scale = std::pow(std::pow(std::abs(x), p) + std::pow(std::abs(y), p), -1.0 / p);
  return {a * x * scale, b * y * scale};
}

NamedSolid make_loft(const std::function<SectionPoint(double z, double turn)>& section,
                     const LoftOptions& options) {
  const std::vector<Row> rows = rows_of(options);
  std::vector<std::vector<gp_Pnt>> points;
  for (const Row& row : rows) {
    std::vector<gp_Pnt> line;
    for (int i = 0; i < options.columns; ++i) {
      const double turn = static_cast<double>(i) / options.columns;
      const SectionPoint p = section(row.z, turn);
      const SectionPoint ahead = section(row.z, turn + kDerivative);
      const SectionPoint behind = section(row.z, turn - kDerivative);
      const double tx = ahead[0] - behind[0];
      const double ty = ahead[1] - behind[1];
      const double inset = row.inset / std::hypot(tx, ty);  // the normal (ty, -tx) points outwards
      line.emplace_back(p[0] - inset * ty, p[1] + inset * tx, row.z);
    }
    points.push_back(std::move(line));
  }
  const std::vector<double> v = parameters_of(points);
  const Handle(Geom_BSplineSurface) side = surface_through(points, v);
  const auto parameter_at = [&](double z) {
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (std::abs(rows[j].z - z) < std::abs(rows[nearest].z - z)) nearest = j;
    }
    return v[nearest];
  };

  std::vector<NamedSolid::Name> faces;
  const auto add_patch = [&](double u1, double u2, double v1, double v2, const std::string& name) {
    const Handle(Geom_BSplineSurface) patch = Handle(Geom_BSplineSurface)::DownCast(side->Copy());
    patch->Segment(u1, u2, v1, v2);
    faces.push_back({BRepBuilderAPI_MakeFace(patch, 1e-7).Face(), name});
  };
  const auto add_band = [&](double v1, double v2, const LoftBand& band) {
    if (band.splits.empty()) return add_patch(0.0, 1.0, v1, v2, band.names.front());
    for (std::size_t k = 0; k < band.splits.size(); ++k) {
      const double next =
          k + 1 < band.splits.size() ? band.splits[k + 1] : band.splits.front() + 1.0;
      add_patch(band.splits[k], next, v1, v2, band.names[k]);
    }
  };
  const auto add_cap = [&](double parameter, double z, const std::string& name) {
    BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(side->VIso(parameter)).Edge());
    faces.push_back(
        {BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), wire.Wire()).Face(),
         name});
  };
  const auto fillet_band = [&](const LoftBand& beside, const std::string& name) {
    LoftBand band = beside;
    for (std::string& one : band.names) one = name + ", " + one;
    if (!options.splits_fillets) band.splits.clear();
    if (!options.splits_fillets) band.names = {name};
    return band;
  };
  for (const LoftBand& band : options.bands) {
    add_band(parameter_at(band.begin), parameter_at(band.end), band);
  }
  add_cap(v.front(), options.bottom, "bottom");
  add_cap(v.back(), options.top, "top");
  if (options.end_fillet > 0.0) {
    const LoftBand& first = options.bands.front();
    const LoftBand& last = options.bands.back();
    add_band(v.front(), parameter_at(first.begin), fillet_band(first, "bottom fillet"));
    add_band(parameter_at(last.end), v.back(), fillet_band(last, "top fillet"));
  }

  BRepBuilderAPI_Sewing sewing(kSewing);
  for (const NamedSolid::Name& one : faces) sewing.Add(one.face);
  sewing.Perform();
  TopExp_Explorer shell(sewing.SewedShape(), TopAbs_SHELL);
  if (!shell.More()) throw NumericalError("the loft's faces make no shell");
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell.Current())).Solid();
  BRepLib::OrientClosedSolid(solid);
  NamedSolid result{solid, {}};
  for (const NamedSolid::Name& one : faces) {
    const TopoDS_Shape now = sewing.IsModified(one.face) ? sewing.Modified(one.face) : one.face;
    for (TopExp_Explorer it(now, TopAbs_FACE); it.More(); it.Next()) {
      result.names.push_back({TopoDS::Face(it.Current()), one.text});
    }
  }
  return result;
}

}  // namespace palmar::cad
