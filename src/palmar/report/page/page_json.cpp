// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/page_json.h"

#include <set>

#include "palmar/core/version.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/pressure_thresholds.h"
#include "palmar/report/picture/colormap.h"
#include "palmar/report/words/html_text.h"
#include "palmar/report/words/page_parts.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

PageJson motions_json(const hand::Hand& hand) {
  PageJson motions = PageJson::object();
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    PageJson& one = motions[std::string(name_of(dof))];
    one = {{"words", plain_words(dof)}, {"lower_deg", nullptr}, {"upper_deg", nullptr}};
    for (const hand::Joint& joint : hand.skeleton.joints) {
      for (const hand::JointDof& moved : joint.dofs) {
        if (moved.dof != dof) continue;
        one["lower_deg"] = moved.lower * geometry::kDegreesPerRadian;
        one["upper_deg"] = moved.upper * geometry::kDegreesPerRadian;
      }
    }
  }
  return motions;
}

}  // namespace

std::string page_text(const PageJson& json) {
  return json.dump(-1, ' ', false, PageJson::error_handler_t::replace);
}

PageJson maker_json() {
  return {
      {"version", version()}, {"build", build_description()}, {"viewer_licence", viewer_licence()}};
}

PageJson vocabulary_json(const hand::Hand& hand) {
  PageJson regions = PageJson::object();
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const auto region = static_cast<hand::Region>(r);
    regions[std::string(name_of(region))] = {
        {"words", plain_words(region)},
        {"colour", hex_colour(region_colour(region))},
        {"pain_onset_mpa", grasp::pain_onset_probe(region)},
        {"discomfort_onset_mpa", grasp::discomfort_onset_probe(region)}};
  }
  PageJson segments = PageJson::object();
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    segments[std::string(name_of(segment))] = plain_words(segment);
  }
  PageJson stops = PageJson::object();
  for (const grasp::StopReason reason :
       {grasp::StopReason::kLimitDepth, grasp::StopReason::kRangeOfMotion,
        grasp::StopReason::kProximalStop, grasp::StopReason::kDistalStop,
        grasp::StopReason::kOtherFinger, grasp::StopReason::kNotReached,
        grasp::StopReason::kGiven}) {
    stops[std::string(name_of(reason))] = plain_words(reason);
  }
  PageJson statuses = PageJson::object();
  for (const grasp::GraspStatus status :
       {grasp::GraspStatus::kHeld, grasp::GraspStatus::kPartlyHeld, grasp::GraspStatus::kTooLarge,
        grasp::GraspStatus::kTooSmall, grasp::GraspStatus::kNotGraspable}) {
    statuses[std::string(name_of(status))] = plain_words(status);
  }
  PageJson grips = PageJson::object();
  for (int g = 0; g < grasp::kGripCount; ++g) {
    const auto grip = static_cast<grasp::Grip>(g);
    grips[std::string(name_of(grip))] = {{"is_power", grasp::is_power(grip)}};
  }
  return {{"regions", std::move(regions)},
          {"segments", std::move(segments)},
          {"motions", motions_json(hand)},
          {"stops", std::move(stops)},
          {"statuses", std::move(statuses)},
          {"grips", std::move(grips)},
          {"blood_flow_stop_mpa", grasp::kBloodFlowStop}};
}

PageJson colour_bar_json(const ColourScale& scale) {
  constexpr int kBands = 64;
  PageJson colours = PageJson::array();
  for (int i = 0; i < kBands; ++i) {
    colours.push_back(hex_colour(map_colour(scale.map, (i + 0.5) / kBands)));
  }
  PageJson ticks = PageJson::array();
  const Ticks all = ticks_of(scale);
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    ticks.push_back({{"value", all.value[i]}, {"text", all.text[i]}});
  }
  return {{"quantity", scale.quantity},    {"unit", scale.unit},
          {"upper", scale.upper},          {"is_open_ended", scale.is_open_ended},
          {"colours", std::move(colours)}, {"neutral", hex_colour(scale.neutral)},
          {"ticks", std::move(ticks)}};
}

std::string attached(Attachments& attachments, const std::string& name, std::string text) {
  attachments[name] = std::move(text);
  return "<attachment:" + name + ">";
}

std::string attached_png(Attachments& attachments, const std::string& name,
                         const std::string& png) {
  attachments[name] = "data:image/png;base64," + formats::base64(png);
  return "attachment:" + name;
}

PageJson pictures_json(const std::vector<EncodedPicture>& pictures, const std::string& prefix,
                       Attachments& attachments) {
  PageJson list = PageJson::array();
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const EncodedPicture& one = pictures[i];
    const std::string name = prefix + "-picture-" + std::to_string(i);
    PageJson thumbnail = nullptr;
    if (!one.thumbnail.empty()) {
      thumbnail = attached_png(attachments, name + "-small", one.thumbnail);
    }
    list.push_back({{"name", one.name},
                    {"title", one.title},
                    {"alt", one.alt},
                    {"src", attached_png(attachments, name, one.png)},
                    {"thumbnail", std::move(thumbnail)}});
  }
  return list;
}

PageJson pictures_json(const std::vector<Picture>& pictures, Attachments& attachments) {
  std::vector<EncodedPicture> encoded;
  for (const Picture& one : pictures) {
    encoded.push_back({.name = one.name,
                       .title = one.title,
                       .alt = one.alt,
                       .png = encode_png(one.image),
                       .thumbnail = ""});
  }
  return pictures_json(encoded, "shown", attachments);
}

void put_in_language(PageJson& json, const Phrases& phrases) {
  if (phrases.language() == Language::kEnglish) return;
  static const std::set<std::string> sentences = {"against",
                                                  "alt",
                                                  "definition",
                                                  "description",
                                                  "face",
                                                  "friction_words",
                                                  "grip_force_from",
                                                  "message",
                                                  "part_name",
                                                  "provenance",
                                                  "quantity",
                                                  "grip_force_words",
                                                  "left_out_words",
                                                  "region",
                                                  "remark",
                                                  "series",
                                                  "source",
                                                  "subject",
                                                  "text",
                                                  "title",
                                                  "words"};
  static const std::set<std::string> lists = {"cautions", "hands", "limits", "notes", "verdict"};
  if (json.is_array()) {
    for (PageJson& one : json) put_in_language(one, phrases);
    return;
  }
  if (!json.is_object()) return;
  // Names of indices and of hands that were made for a person; other names are people's own.
  const bool is_described = json.contains("key") || json.contains("provenance");
  for (auto& [key, value] : json.items()) {
    if (value.is_string() && (sentences.contains(key) || (key == "name" && is_described))) {
      value = phrases(value.get<std::string>());
    } else if (value.is_array() && lists.contains(key)) {
      for (PageJson& one : value) {
        if (one.is_string()) one = phrases(one.get<std::string>());
      }
    }
    put_in_language(value, phrases);
  }
}

std::string render_page(const std::string& kind, const std::string& report, const PageJson& view,
                        Attachments attachments) {
  // What scripts read stays as it is in the files; what people read is in their language.
  attachments["report"] = script_escaped(report);
  attachments["view"] = script_escaped(page_text(view));
  const Phrases phrases(language_named(view.value("language", "en")));
  std::string shown_report = report;
  PageJson shown_view = view;
  if (phrases.language() != Language::kEnglish) {
    PageJson said = PageJson::parse(report);
    put_in_language(said, phrases);
    shown_report = page_text(said);
    put_in_language(shown_view, phrases);
  }
  return render_page(R"({"kind":")" + kind + R"(","report":)" + shown_report + R"(,"view":)" +
                         page_text(shown_view) + "}",
                     std::move(attachments));
}

}  // namespace palmar::report
