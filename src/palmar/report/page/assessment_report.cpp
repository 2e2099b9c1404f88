// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/assessment_report.h"

#include <filesystem>
#include <set>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/glb_fields.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/csv.h"
#include "palmar/report/page/assessment_page.h"
#include "palmar/report/page/file_names.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/picture/holds_picture.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/verdict_words.h"

namespace palmar::report {

namespace {

constexpr int kEmbeddedWidth = 720;   // pixels; the page shows pictures about 540 wide
constexpr int kSheetWidth = 1280;     // pixels; the sheet of holds, as wide as the page
constexpr int kSheetTile = 320;       // pixels
constexpr int kThumbnailWidth = 440;  // pixels; on the cards of products side by side

std::vector<formats::MeshNote> notes_of(const contact::ContactResult& contact) {
  return {{"contact_model", name_of(contact.model)},
          {"kernel", std::string(name_of(contact.model.kernel))},
          {"tissue_model", std::string(name_of(contact.model.tissue))},
          {"regions", std::string(name_of(contact.model.coupling))}};
}

std::string hand_vtp(const hand::Hand& hand, const study::Assessment& assessment) {
  const std::size_t n = hand.skin.vertices.size();
  const auto sized = [&](std::vector<double> values) {
    values.resize(n, 0.0);
    return values;
  };
  const contact::ContactResult& contact = assessment.contact;
  const geometry::TriangleMesh deformed = deformed_skin(hand, assessment);
  const geometry::TriangleMesh undeformed = undeformed_skin(hand, assessment);
  std::vector<Vec3> moved(n);
  for (std::size_t i = 0; i < n; ++i) moved[i] = deformed.vertices[i] - undeformed.vertices[i];
  std::vector<double> region;
  for (const hand::Region r : hand.region) region.push_back(static_cast<double>(r));
  std::vector<formats::PointField> fields = {{"pressure_mpa", sized(contact.pressure)},
                                             {"force_n", sized(contact.force)},
                                             {"distance_before_mm", sized(contact.distance)},
                                             {"indentation_mm", sized(contact.displacement)},
                                             {"region", sized(region)},
                                             formats::vector_field("displacement_mm", moved)};
  if (assessment.options.friction.is_on()) {
    std::vector<Vec3> friction = assessment.friction.force;
    friction.resize(n, Vec3::Zero());
    fields.push_back({"mobilised_friction", sized(assessment.friction.mobilised)});
    fields.push_back(formats::vector_field("friction_force_n", friction));
  }
  return formats::format_vtp(deformed, fields, notes_of(contact));
}

std::vector<formats::VertexColour> glb_colours(const std::vector<double>& field,
                                               const ColourScale& scale, Rgb neutral) {
  std::vector<formats::VertexColour> colours;
  for (const Rgb c : field_colours(field, scale.upper, scale.map, neutral, 0.005 * scale.upper)) {
    colours.push_back({c.r, c.g, c.b});
  }
  return colours;
}

std::string grasp_glb(const hand::Hand& hand, const study::AssessedProduct& one,
                      const ColourScale& scale) {
  const std::vector<double> pressure = skin_pressure(hand, one.assessment);
  const contact::ProductFootprint footprint = footprint_of(one);
  formats::FieldMesh skin{"hand",
                          deformed_skin(hand, one.assessment),
                          glb_colours(pressure, scale, kSkinColour),
                          {{"pressure_mpa", pressure}}};
  if (one.assessment.options.friction.is_on()) {
    std::vector<double> mobilised = one.assessment.friction.mobilised;
    mobilised.resize(pressure.size(), 0.0);
    skin.field.push_back({"mobilised_friction", std::move(mobilised)});
  }
  return formats::format_glb_fields({std::move(skin),
                                     {"product",
                                      footprint.surface,
                                      glb_colours(footprint.pressure, scale, kProductColour),
                                      {{"pressure_mpa", footprint.pressure}}}});
}

void write_fields(const std::filesystem::path& folder, const hand::Hand& hand,
                  const study::AssessedProduct& one, const ColourScale& scale,
                  const Progress& progress) {
  const auto write = [&](const char* name, const auto& make) {
    if (!progress.is_cancelled()) formats::write_file(folder / name, make());
  };
  write("hand.vtp", [&] { return hand_vtp(hand, one.assessment); });
  write("product.vtp", [&] {
    const contact::ProductFootprint footprint = footprint_of(one);
    return formats::format_vtp(footprint.surface, {{"pressure_mpa", footprint.pressure}},
                               notes_of(one.assessment.contact));
  });
  write("grasp.glb", [&] { return grasp_glb(hand, one, scale); });
}

std::string small_png(const Image& image, int width) {
  return encode_png(narrowed(image, width), PngEffort::kSmall);
}

/// Those that slides show keep their size.
int embedded_width(const Picture& picture, const ReportOptions& options) {
  if (picture.name == "holds") return kSheetWidth;
  const bool is_on_slide = picture.name == "map_open_hand" || picture.name == "grasp_palm";
  return options.extras.slides && is_on_slide ? options.picture_width : kEmbeddedWidth;
}

bool has_thumbnail(const Picture& picture, bool are_compared) {
  return are_compared && (picture.name == "map_open_hand" || picture.name == "grasp_palm" ||
                          picture.name == "grasp_back");
}

/// Other ways to hold the product, if they are known.
void add_sheet_of_holds(const study::AssessedProduct& one, Language language,
                        const Progress& progress, std::vector<Picture>& pictures) {
  if (one.ways == nullptr || one.ways->holds.size() < 2 || progress.is_cancelled()) return;
  HoldsPictureOptions drawing;
  drawing.language = language;
  drawing.tile_width = kSheetTile;
  drawing.up = one.assessment.options.grasp.holds.up;
  try {
    pictures.push_back({"holds", "Ways to hold it, best first",
                        one.product.name + ": hands holding it in different ways, numbered.",
                        holds_picture(*one.ways_hand, one.product, *one.ways, drawing, progress)});
  } catch (const Cancelled&) {
    return;
  }
}

// Writes the pictures at full size and gives them back at the size in which report.html shows them.
std::vector<EncodedPicture> write_pictures(const std::filesystem::path& folder,
                                           const hand::Hand& hand,
                                           const study::AssessedProduct& one,
                                           const ColourScale& scale, const ReportOptions& options,
                                           bool are_compared, const Progress& progress) {
  std::vector<Picture> pictures = assessment_pictures(hand, one, scale,
                                                      {.width = options.picture_width,
                                                       .height = options.picture_height,
                                                       .language = options.language},
                                                      progress);
  add_sheet_of_holds(one, options.language, progress, pictures);
  std::vector<EncodedPicture> embedded(pictures.size());
  std::vector<std::string> full(pictures.size());
  parallel_for(static_cast<int>(pictures.size()), [&](int k) {
    const auto i = static_cast<std::size_t>(k);
    const Picture& picture = pictures[i];
    full[i] = encode_png(picture.image);
    embedded[i] = {.name = picture.name,
                   .title = picture.title,
                   .alt = picture.alt,
                   .png = small_png(picture.image, embedded_width(picture, options)),
                   .thumbnail = has_thumbnail(picture, are_compared)
                                    ? small_png(picture.image, kThumbnailWidth)
                                    : ""};
  });
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    formats::write_file(folder / (pictures[i].name + ".png"), full[i]);
  }
  return embedded;
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

void check_report_folder(const std::string& folder) {
  const std::filesystem::path root(folder);
  std::error_code error;
  const auto status = std::filesystem::status(root, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_directory(status)) {
    throw OutputError(folder + ": is a file; a report needs a folder");
  }
  const auto refuse_unless = [&](const char* name, bool (*is_ours)(const std::string&)) {
    const std::filesystem::path path = root / name;
    if (!std::filesystem::exists(path)) return;
    // An empty file holds nothing that could be lost.
    if (std::filesystem::is_regular_file(path)) {
      if (std::filesystem::file_size(path) == 0 || is_ours(formats::read_file(path))) return;
    }
    throw UsageError(path.string() +
                     ": was not written by Palmar and would be overwritten; choose another folder "
                     "or move the file");
  };
  refuse_unless("assessment.json", records::is_assessment_json);
  refuse_unless("report.html", [](const std::string& text) {
    return text.find("<meta name=\"generator\" content=\"Palmar ") != std::string::npos;
  });
  refuse_unless("faces.csv",
                [](const std::string& text) { return text.starts_with("product,hand,face,"); });
  refuse_unless("sensors.csv",
                [](const std::string& text) { return text.starts_with("product,hand,layout,"); });
  refuse_unless("regions.csv",
                [](const std::string& text) { return text.starts_with("product,hand,region,"); });
}

void write_report(const std::string& folder, const study::AssessmentSet& set,
                  const ReportOptions& options, const Progress& progress) {
  options.check();
  if (!set.hand) throw UsageError("report: the set has no hand");
  check_report_folder(folder);
  const hand::Hand& hand = *set.hand;
  const std::filesystem::path root(folder);
  formats::create_folder(root);
  const std::string json =
      records::assessment_json(set, verdict_words(set, study::verdict_of(set), options.language));
  formats::write_file(root / "assessment.json", json);
  const records::CsvTable regions = records::region_table(set);
  const records::CsvTable faces = records::face_table(set);
  std::string title = "Palmar:";
  for (const study::AssessedProduct& one : set.assessments) title += " " + one.product.name;
  write_desk_tables(root, title,
                    {{"regions", "One region of the hand on one product, or the total.", regions},
                     {"faces", "One face of a product under pressure.", faces},
                     {"indices", "One index of one product.", records::index_table(set)}},
                    options.extras);
  formats::write_file(root / "regions.csv", records::format_csv(regions));
  // One of an earlier run must not stand beside results that it isn't of.
  if (!faces.rows.empty() || std::filesystem::exists(root / "faces.csv")) {
    formats::write_file(root / "faces.csv", records::format_csv(faces));
  }

  const records::CsvTable sensors = records::sensor_table(set);
  if (!sensors.rows.empty() || std::filesystem::exists(root / "sensors.csv")) {
    formats::write_file(root / "sensors.csv", records::format_csv(sensors));
  }

  ColourScale scale = pressure_scale(set);
  const Phrases phrases(options.language);
  scale.quantity = phrases(scale.quantity);
  scale.none = phrases(scale.none);
  std::vector<std::vector<EncodedPicture>> embedded(set.assessments.size());
  std::set<std::string> used;
  for (std::size_t i = 0; i < set.assessments.size() && !progress.is_cancelled(); ++i) {
    const study::AssessedProduct& one = set.assessments[i];
    if (progress.report) {
      progress.report(static_cast<double>(i) / static_cast<double>(set.assessments.size()),
                      "pictures and fields of " + one.product.name);
    }
    const std::filesystem::path own =
        root / unique_file_name(one.product.name, used, FullStops::kKept);
    formats::create_folder(own);
    write_fields(own, hand, one, scale, progress);
    if (options.pictures) {
      embedded[i] =
          write_pictures(own, hand, one, scale, options, set.assessments.size() > 1, progress);
    }
  }
  const bool is_cut_short = progress.is_cancelled();
  if (progress.report) progress.report(0.98, "report.html");
  formats::write_file(root / "report.html",
                      assessment_page(set, embedded, scale, json,
                                      {options.language, is_cut_short, options.extras}));
  if (is_cut_short)
    throw Cancelled("cancelled; " + folder + "/report.html holds what was finished");
}

}  // namespace palmar::report
