// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/xml_scan.h"

#include <algorithm>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool ends_name(char c) { return is_space(c) || c == '>' || c == '/' || c == '=' || c == '<'; }

std::string_view local_part(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == name.npos ? name : name.substr(colon + 1);
}

}  // namespace

std::optional<std::string_view> XmlTag::attribute(std::string_view attribute_name) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute_name) return value;
  }
  return std::nullopt;
}

std::optional<std::string_view> XmlTag::local_attribute(std::string_view attribute_name) const {
  for (const auto& [key, value] : attributes) {
    if (local_part(key) == attribute_name) return value;
  }
  return std::nullopt;
}

std::string XmlScanner::place() const {
  const char* from = text_.data() + std::min(counted_to_, tag_start_);
  counted_lines_ += std::count(from, text_.data() + tag_start_, '\n');
  counted_to_ = tag_start_;
  return name_ + ":" + std::to_string(counted_lines_ + 1);
}

void XmlScanner::fail(const std::string& what) const { throw InputError(place() + ": " + what); }

void XmlScanner::skip_past(std::string_view end, const std::string& what) {
  const std::size_t found = text_.find(end, position_);
  if (found == text_.npos) fail(what + " does not end");
  position_ = found + end.size();
}

const XmlTag* XmlScanner::next() {
  while (true) {
    position_ = std::min(text_.find('<', position_), text_.size());
    if (position_ == text_.size()) return nullptr;
    tag_start_ = position_;
    const std::string_view rest = text_.substr(position_);
    if (rest.starts_with("<!--")) {
      position_ += 4;
      skip_past("-->", "a comment");
    } else if (rest.starts_with("<![CDATA[")) {
      skip_past("]]>", "a CDATA section");
    } else if (rest.starts_with("<?")) {
      skip_past("?>", "a processing instruction");
    } else if (rest.starts_with("<!")) {
      fail("document type definitions are not allowed");
    } else {
      break;
    }
  }
  ++position_;
  tag_.attributes.clear();
  tag_.is_end = position_ < text_.size() && text_[position_] == '/';
  tag_.is_start = !tag_.is_end;
  if (tag_.is_end) ++position_;
  const std::size_t start = position_;
  while (position_ < text_.size() && !ends_name(text_[position_])) ++position_;
  tag_.name = local_part(text_.substr(start, position_ - start));
  if (tag_.name.empty()) fail("a tag has no name");
  read_attributes();
  return &tag_;
}

void XmlScanner::read_attributes() {
  while (true) {
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    if (position_ == text_.size()) fail("a tag does not end");
    if (text_[position_] == '>') {
      ++position_;
      return;
    }
    if (text_[position_] == '/') {
      tag_.is_end = true;
      ++position_;
      continue;
    }
    const std::size_t start = position_;
    while (position_ < text_.size() && !ends_name(text_[position_])) ++position_;
    const std::string_view key = text_.substr(start, position_ - start);
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    const bool has_value = !key.empty() && position_ + 1 < text_.size() && text_[position_] == '=';
    if (!has_value) fail("an attribute has no value");
    ++position_;
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    const char quote = position_ < text_.size() ? text_[position_] : '\0';
    if (quote != '"' && quote != '\'') fail("an attribute value has no quotes");
    ++position_;
    const std::size_t end = text_.find(quote, position_);
    if (end == text_.npos) fail("an attribute value does not end");
    tag_.attributes.emplace_back(key, text_.substr(position_, end - position_));
    position_ = end + 1;
  }
}

}  // namespace palmar::formats
