// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/product_parts_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "output_guard.h"
#include "palmar/workflow/product/product_parts.h"
#include "product/cad_arguments.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PartsArguments {
  std::string product, unit;
  workflow::ProductPartsRequest request;
  CadArguments cad;
};

Json parts_vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::string parts_point_text(const Vec3& v) {
  return fmt::format("{:.0f}, {:.0f}, {:.0f}", v.x(), v.y(), v.z());
}

Json parts_part_json(const product::ProductPart& part) {
  Json json = {{"number", part.number},
               {"kind", name_of(part.kind)},
               {"name", part.name},
               {"length_mm", part.length},
               {"girth_mm", part.girth},
               {"diameter_mm", part.diameter()},
               {"width_mm", part.width},
               {"thickness_mm", part.thickness},
               {"straightness", part.straightness},
               {"is_ring", part.is_ring},
               {"volume_mm3", part.volume},
               {"area_mm2", part.area},
               {"joined", part.joined}};
  if (!part.is_ring) {
    Json ends = Json::array();
    for (const product::PartEnd& end : part.ends) {
      ends.push_back({{"point_mm", parts_vector_json(end.point)},
                      {"joined", end.joined ? Json(*end.joined) : Json()}});
    }
    json["ends"] = std::move(ends);
  }
  if (part.opening) {
    json["opening"] = {{"disc_mm", part.opening->disc},
                       {"width_mm", part.opening->width},
                       {"height_mm", part.opening->height},
                       {"centre_mm", parts_vector_json(part.opening->centre)},
                       {"axis", parts_vector_json(part.opening->axis)}};
  }
  if (part.face_normal) json["face_normal"] = parts_vector_json(*part.face_normal);
  if (!part.waists.empty()) {
    Json waists = Json::array();
    for (const product::PartWaist& waist : part.waists) {
      waists.push_back({{"kind", waist.is_neck ? "neck" : "waist"},
                        {"along", waist.along},
                        {"girth_mm", waist.girth}});
    }
    json["waists"] = std::move(waists);
  }
  Json line = Json::array();
  for (const product::PartStation& s : part.line) {
    line.push_back({{"along", s.along},
                    {"centre_mm", parts_vector_json(s.centre)},
                    {"axis", parts_vector_json(s.axis)},
                    {"turn_zero", parts_vector_json(s.zero)}});
  }
  json["line"] = std::move(line);
  Json sections = Json::array();
  for (const product::PartSection& s : part.sections) {
    sections.push_back({{"along", s.along},
                        {"girth_mm", s.girth},
                        {"width_mm", s.width},
                        {"thickness_mm", s.thickness},
                        {"wide", parts_vector_json(s.wide)}});
  }
  json["sections"] = std::move(sections);
  return json;
}

std::string parts_part_text(const product::ProductPart& part) {
  std::string text = fmt::format("{:>2}  {:<5} {:<12} {:>6.0f} {:>6.0f} {:>6.0f} {:>9.0f}  ",
                                 part.number, name_of(part.kind), part.name, part.length,
                                 part.girth, part.width, part.thickness);
  std::string more;
  const auto add = [&](const std::string& words) { more += (more.empty() ? "" : "; ") + words; };
  if (part.opening) {
    add(fmt::format("opening {:.0f} x {:.0f} mm, disc {:.0f} mm", part.opening->width,
                    part.opening->height, part.opening->disc));
  }
  for (const product::PartWaist& waist : part.waists) {
    add(fmt::format("{} of {:.0f} mm girth at {:.0f} %", waist.is_neck ? "neck" : "waist",
                    waist.girth, 100.0 * waist.along));
  }
  if (!part.joined.empty()) {
    std::string words = "joins";
    for (const int other : part.joined) words += fmt::format(" {}", other);
    add(words);
  }
  return text + more + "\n";
}

int list_parts(PartsArguments& o, const Context& context) {
  o.request.file = o.product;
  o.request.reading = o.cad.options(o.unit);
  if (!o.request.out.empty()) refuse_same_file(o.product, o.request.out);
  const auto [product, parts] =
      workflow::list_product_parts(o.request, make_progress(context.common));
  finish_progress();
  for (const std::string& line : product.notes) note(context.common, line);
  if (context.common.json) {
    Json list = Json::array();
    for (const product::ProductPart& part : parts.parts) list.push_back(parts_part_json(part));
    Json json = {{"product", product.name}, {"source", product.source}, {"parts", std::move(list)}};
    json["triggers"] = Json::array();
    for (const product::PartTrigger& trigger : parts.triggers) {
      json["triggers"].push_back({{"part", trigger.part},
                                  {"point_mm", parts_vector_json(trigger.point)},
                                  {"front", parts_vector_json(trigger.front)},
                                  {"along", trigger.along},
                                  {"length_mm", trigger.length},
                                  {"reach_mm", trigger.reach}});
    }
    json["buttons"] = Json::array();
    for (const product::PartButton& button : parts.buttons) {
      json["buttons"].push_back({{"part", button.part},
                                 {"point_mm", parts_vector_json(button.point)},
                                 {"normal", parts_vector_json(button.normal)},
                                 {"width_mm", button.width},
                                 {"height_mm", button.height}});
    }
    if (parts.narrow_tunnels) json["narrow_tunnels"] = *parts.narrow_tunnels;
    print(json.dump(2) + "\n");
  } else {
    std::string text = fmt::format("{}: {} part{}\n", product.name, parts.parts.size(),
                                   parts.parts.size() == 1 ? "" : "s");
    text += fmt::format("{:>2}  {:<5} {:<12} {:>6} {:>6} {:>6} {:>9}\n", "", "kind", "name",
                        "length", "girth", "width", "thickness");
    for (const product::ProductPart& part : parts.parts) text += parts_part_text(part);
    for (const product::PartTrigger& trigger : parts.triggers) {
      text +=
          fmt::format("trigger before {}: {:.0f} mm long, {:.0f} mm before it, at ({})\n",
                      trigger.part, trigger.length, trigger.reach, parts_point_text(trigger.point));
    }
    for (const product::PartButton& button : parts.buttons) {
      text += fmt::format("button on {}: {:.0f} mm wide, {:.0f} mm high, at ({})\n", button.part,
                          button.width, button.height, parts_point_text(button.point));
    }
    text += "lengths in mm; girth, width and thickness are medians along the part\n";
    if (parts.narrow_tunnels.value_or(0) > 0) {
      text += fmt::format("{} tunnel{} too narrow for a finger, or faults of a scan\n",
                          *parts.narrow_tunnels, *parts.narrow_tunnels == 1 ? "" : "s");
    }
    print(text);
  }
  if (!o.request.out.empty()) note(context.common, "wrote " + o.request.out);
  return 0;
}

}  // namespace

void add_product_parts_command(CLI::App& product, Context& context) {
  const auto o = std::make_shared<PartsArguments>();
  CLI::App* verb = add_verb(product, "parts",
                            "List and draw what hands can take hold of: handles, loops, bodies",
                            "palmar product parts handle.step --out parts.png");
  verb->add_option("PRODUCT", o->product, "File: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  verb->add_option("--unit", o->unit, "Unit of a file that carries none: mm, cm, m, inch");
  verb->add_option("--finger-mm", o->request.options.finger,
                   "Tunnels and gaps narrower than this count as closed")
      ->capture_default_str();
  verb->add_option("--out", o->request.out, "Picture to write: .png or .svg");
  o->cad.add_to(*verb);
  verb->callback(
      [&context, o] { context.run = [&context, o] { return list_parts(*o, context); }; });
}

}  // namespace palmar::cli
