// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.h"
#include "bindings.h"
#include "palmar/product/mass.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/hand/hand_json.h"

namespace palmar::python {
namespace {

/// Names of an enumeration's values, in their order.
template <typename Name>
py::list names_of(int count) {
  py::list names;
  for (int i = 0; i < count; ++i) names.append(std::string(name_of(static_cast<Name>(i))));
  return names;
}

/// Per vertex the name of what it belongs to.
template <typename Name>
py::object names_by_vertex(const std::vector<Name>& of, int count) {
  py::array_t<int> code(static_cast<py::ssize_t>(of.size()));
  std::transform(of.begin(), of.end(), code.mutable_data(),
                 [](Name one) { return static_cast<int>(one); });
  return py::module_::import("numpy").attr("array")(names_of<Name>(count))[code];
}

std::string summary_of(const product::Product& product) {
  return "<palmar.Product " + product.name + ": " + std::to_string(product.mesh.triangle_count()) +
         " triangles, from " + product.source + ">";
}

std::string summary_of(const hand::Hand& hand) {
  return "<palmar.Hand " + hand.name + ": " + std::string(name_of(hand.side)) + ", length " +
         std::to_string(static_cast<int>(hand.dimensions.hand_length + 0.5)) + " mm>";
}

py::list joints_of(const hand::Hand& hand) {
  py::list centres;
  for (const hand::Joint& joint : hand.skeleton.joints) {
    const Vec3& c = joint.centre;
    py::dict one;
    one["joint"] = std::string(name_of(joint.id));
    one["centre_mm"] = py::make_tuple(c.x(), c.y(), c.z());
    centres.append(one);
  }
  return centres;
}

}  // namespace

void bind_values(py::module_& module) {
  py::class_<product::Product, std::shared_ptr<product::Product>>(
      module, "Product",
      "A handheld product: a triangle mesh in its own frame, mm. Made by palmar.product.read() "
      "and\n"
      "palmar.product.make(); nobody changes it. Arrays are read-only views, without a copy.")
      .def_readonly("name", &product::Product::name, "For people; the file's stem unless made.")
      .def_readonly("source", &product::Product::source,
                    "Path or generating words (\"made: prism ...\").")
      .def_property_readonly(
          "unit", [](const product::Product& product) { return name_of(product.unit); },
          "Length unit of the file: \"mm\", \"cm\", \"m\", \"inch\". The mesh is in mm.")
      .def_property_readonly(
          "unit_source",
          [](const product::Product& product) { return name_of(product.unit_source); },
          "How the unit was known: \"file\", \"user\", \"proposed\", \"made\".")
      .def_readonly("notes", &product::Product::notes, "What was repaired, proposed or doubted.")
      .def_property_readonly(
          "vertices_mm",
          [](const py::object& self) {
            return view(self.cast<const product::Product&>().mesh.vertices, self);
          },
          "Vertices, n x 3, mm, product frame.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            return view(self.cast<const product::Product&>().mesh.triangles, self);
          },
          "Corner indices, m x 3, counter-clockwise seen from outside.")
      .def_property_readonly(
          "volume_mm3",
          [](const product::Product& product) { return product::mass_properties(product).volume; },
          "Volume, mm3. InputError if the surface is open or a sheet.")
      .def("__repr__", [](const product::Product& product) { return summary_of(product); });

  py::class_<hand::Hand, std::shared_ptr<hand::Hand>>(
      module, "Hand",
      "A hand in its reference posture: skin in the hand frame (x radial, y distal, z palmar for "
      "a\n"
      "right hand; origin at the wrist joint), mm. Made by palmar.hand.load(); nobody changes it.\n"
      "Arrays are read-only views, without a copy.")
      .def_readonly("name", &hand::Hand::name, "\"template\", or that of the file or person.")
      .def_property_readonly(
          "side", [](const hand::Hand& hand) { return std::string(name_of(hand.side)); },
          "\"right\" or \"left\".")
      .def_property_readonly(
          "skin_vertices_mm",
          [](const py::object& self) {
            return view(self.cast<const hand::Hand&>().skin.vertices, self);
          },
          "Vertices of the skin, n x 3, mm, hand frame.")
      .def_property_readonly(
          "skin_triangles",
          [](const py::object& self) {
            return view(self.cast<const hand::Hand&>().skin.triangles, self);
          },
          "Corner indices of the skin, m x 3, counter-clockwise seen from outside.")
      .def_property_readonly(
          "segment",
          [](const hand::Hand& hand) { return names_by_vertex(hand.segment, hand::kSegmentCount); },
          "Rigid part that a vertex lies on, n names: \"palm\", \"index_distal\" ...")
      .def_property_readonly(
          "region",
          [](const hand::Hand& hand) { return names_by_vertex(hand.region, hand::kRegionCount); },
          "Contact region that a vertex lies on, n names: \"dorsum\", \"thenar\" ...")
      .def_property_readonly("joints", &joints_of,
                             "Joints as dicts: \"joint\", \"centre_mm\" (hand frame).")
      .def_property_readonly(
          "hand_length_mm", [](const hand::Hand& hand) { return hand.dimensions.hand_length; },
          "Wrist crease to tip of the middle finger, mm (Xie 2014, fig. 5-3).")
      .def_property_readonly(
          "hand_circumference_mm",
          [](const hand::Hand& hand) { return hand.dimensions.hand_circumference; },
          "Girth over the metacarpal heads, thumb excluded, mm (Xie 2014, fig. 5-3).")
      .def_property_readonly(
          "record", [](const hand::Hand& hand) { return from_json(records::hand_info_json(hand)); },
          "What `palmar hand info --json` prints: dimensions in mm, joints, ranges in degrees.")
      .def_readonly("provenance", &hand::Hand::provenance,
                    "Origin, licence and what was done to it.")
      .def(
          "save",
          [](const hand::Hand& hand, const py::object& path) {
            py::dict one;
            one["path"] = path;
            std::string file;
            Arguments(one).take("path", file);
            records::write_hand(file, hand);
          },
          py::arg("path"), "Writes the hand as a .hand.glb file, which any glTF viewer opens.")
      .def("__repr__", [](const hand::Hand& hand) { return summary_of(hand); });
}

}  // namespace palmar::python
