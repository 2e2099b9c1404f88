// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/assessment_report.h"

#include <cctype>
#include <filesystem>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/io/assessment_json.h"
#include "palmar/io/csv.h"
#include "palmar/io/file.h"
#include "palmar/io/glb_fields.h"
#include "palmar/io/vtk.h"
#include "palmar/report/assessment_pictures.h"
#include "palmar/report/html_report.h"

namespace palmar {

namespace {

// A folder name that every file system takes, different from those already used.
std::string folder_name(const std::string& product, std::set<std::string>& used) {
  std::string name;
  for (const char c : product) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ||
                          c == '_' || (c == '.' && !name.empty());
    name += is_plain ? c : '_';
  }
  if (name.empty()) name = "product";
  if (name.size() > 80) name.resize(80);
  std::string unique = name;
  for (int k = 2; !used.insert(unique).second; ++k) unique = name + "_" + std::to_string(k);
  return unique;
}

std::string hand_vtp(const Hand& hand, const Assessment& assessment) {
  const std::size_t n = hand.skin.vertices.size();
  const auto sized = [&](std::vector<double> values) {
    values.resize(n, 0.0);
    return values;
  };
  const ContactResult& contact = assessment.contact;
  const TriangleMesh deformed = deformed_skin(hand, assessment);
  const TriangleMesh undeformed = undeformed_skin(hand, assessment);
  std::vector<Vec3> moved(n);
  for (std::size_t i = 0; i < n; ++i) moved[i] = deformed.vertices[i] - undeformed.vertices[i];
  std::vector<double> region;
  for (const Region r : hand.region) region.push_back(static_cast<double>(r));
  return format_vtp(deformed, {{"pressure_mpa", sized(contact.pressure)},
                               {"force_n", sized(contact.force)},
                               {"distance_before_mm", sized(contact.distance)},
                               {"indentation_mm", sized(contact.displacement)},
                               {"region", sized(region)},
                               vector_field("displacement_mm", moved)});
}

std::vector<VertexColour> glb_colours(const std::vector<double>& field, const ColourScale& scale,
                                      Rgb neutral) {
  std::vector<VertexColour> colours;
  for (const Rgb c : field_colours(field, scale.upper, scale.map, neutral, 0.005 * scale.upper)) {
    colours.push_back({c.r, c.g, c.b});
  }
  return colours;
}

std::string grasp_glb(const Hand& hand, const AssessedProduct& one, const ColourScale& scale) {
  const std::vector<double> pressure = skin_pressure(hand, one.assessment);
  const ProductFootprint footprint = footprint_of(one);
  return format_glb_fields({{"hand",
                             deformed_skin(hand, one.assessment),
                             glb_colours(pressure, scale, kSkinColour),
                             {{"pressure_mpa", pressure}}},
                            {"product",
                             footprint.surface,
                             glb_colours(footprint.pressure, scale, kProductColour),
                             {{"pressure_mpa", footprint.pressure}}}});
}

}  // namespace

void ReportOptions::check() const {
  for (const auto& [field, value] :
       {std::pair{"picture_width", picture_width}, std::pair{"picture_height", picture_height}}) {
    if (value < 64 || value > 8192) {
      throw UsageError(std::string("report option ") + field + " is " + std::to_string(value) +
                       " pixels; 64 to 8192 are allowed");
    }
  }
}

void write_report(const std::string& folder, const AssessmentSet& set, const ReportOptions& options,
                  const Progress& progress) {
  options.check();
  if (!set.hand) throw UsageError("report: the set has no hand");
  const Hand& hand = *set.hand;
  const std::filesystem::path root(folder);
  create_folder(root);
  const std::string json = assessment_json(set);
  write_file(root / "assessment.json", json);
  write_file(root / "regions.csv", format_csv(region_table(set)));

  const ColourScale scale = pressure_scale(set);
  std::vector<std::vector<EncodedPicture>> embedded(set.assessments.size());
  std::set<std::string> used;
  for (std::size_t i = 0; i < set.assessments.size(); ++i) {
    const AssessedProduct& one = set.assessments[i];
    progress.update(static_cast<double>(i) / static_cast<double>(set.assessments.size()),
                    "pictures and fields of " + one.product.name);
    const std::filesystem::path own = root / folder_name(one.product.name, used);
    create_folder(own);
    const ProductFootprint footprint = footprint_of(one);
    write_file(own / "hand.vtp", hand_vtp(hand, one.assessment));
    write_file(own / "product.vtp",
               format_vtp(footprint.surface, {{"pressure_mpa", footprint.pressure}}));
    write_file(own / "grasp.glb", grasp_glb(hand, one, scale));
    if (!options.pictures) continue;
    const std::vector<Picture> pictures = assessment_pictures(
        hand, one, scale, {.width = options.picture_width, .height = options.picture_height});
    progress.throw_if_cancelled();
    embedded[i].resize(pictures.size());
    parallel_for(static_cast<int>(pictures.size()), [&](int k) {
      const Picture& picture = pictures[static_cast<std::size_t>(k)];
      embedded[i][static_cast<std::size_t>(k)] = {picture.name, picture.title, picture.alt,
                                                  encode_png(picture.image)};
    });
    for (const EncodedPicture& picture : embedded[i]) {
      write_file(own / (picture.name + ".png"), picture.png);
    }
  }
  progress.update(0.98, "report.html");
  write_file(root / "report.html", html_report(set, embedded, scale, json));
}

}  // namespace palmar
