// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "palmar/hand/hand.h"
#include "palmar/report/page/page_engine.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/report/words/phrases.h"

namespace palmar::report {

// Parts of the data of pages, by the types of apps/workbench/types.

using PageJson = nlohmann::ordered_json;

/// Text that may hold bytes that are no UTF-8 doesn't stop it.
std::string page_text(const PageJson& json);

PageJson maker_json();
/// Words, colours and limits by Palmar's names; ranges of motion are the hand's.
PageJson vocabulary_json(const hand::Hand& hand);
PageJson colour_bar_json(const ColourScale& scale);

/// `<attachment:NAME>`, which becomes `text`.
std::string attached(Attachments& attachments, const std::string& name, std::string text);
/// The address of a picture of PNG bytes.
std::string attached_png(Attachments& attachments, const std::string& name, const std::string& png);

/// A picture as a page embeds it.
struct EncodedPicture {
  std::string name;       ///< as in Picture
  std::string title;      ///< caption
  std::string alt;        ///< for those who can't see it
  std::string png;        ///< bytes
  std::string thumbnail;  ///< bytes of a small one; "": none
};
/// `prefix` keeps their attachments apart from others'.
PageJson pictures_json(const std::vector<EncodedPicture>& pictures, const std::string& prefix,
                       Attachments& attachments);
/// The same of pictures as they are.
PageJson pictures_json(const std::vector<Picture>& pictures, Attachments& attachments);

/// The same JSON with the texts for people in the language: values of keys such as "message",
/// "words" and "notes", and names of what also has a key. Names, files and keys stay.
void put_in_language(PageJson& json, const Phrases& phrases);

/// A page of a result and of what it shows beside it. Both stand in the page, too (attachments
/// "report" and "view"), there as the files have them; what is shown is in view["language"].
std::string render_page(const std::string& kind, const std::string& report, const PageJson& view,
                        Attachments attachments);

}  // namespace palmar::report
