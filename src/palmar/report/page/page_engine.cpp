// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/page_engine.h"

#include <duktape.h>

#include <memory>
#include <stdexcept>
#include <string_view>

#include "palmar/report/words/html_text.h"
#include "palmar/report/words/page_parts.h"

namespace palmar::report {
namespace {

static_assert(DUK_VERSION >= 20600, "Duktape 2.6 or newer is needed");

constexpr std::string_view kToken = "attachment:";

bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

/// The page with its attachments put in.
std::string filled(std::string_view page, const Attachments& attachments) {
  std::size_t length = page.size();
  for (const auto& [name, text] : attachments) length += text.size();
  std::string out;
  out.reserve(length);
  std::size_t done = 0;
  for (std::size_t at = page.find(kToken); at != page.npos; at = page.find(kToken, at + 1)) {
    const char before = at > 0 ? page[at - 1] : ' ';
    std::size_t end = at + kToken.size();
    while (end < page.size() && is_name(page[end])) ++end;
    const char after = end < page.size() ? page[end] : ' ';
    const bool is_element = before == '<' && after == '>';
    if (!is_element && !(before == '"' && after == '"')) continue;
    const std::string name(page.substr(at + kToken.size(), end - at - kToken.size()));
    const auto found = attachments.find(name);
    if (found == attachments.end()) {
      throw std::logic_error("page: no attachment \"" + name + "\"");
    }
    out += page.substr(done, (is_element ? at - 1 : at) - done);
    out += found->second;
    done = is_element ? end + 1 : end;
    at = end - 1;
  }
  return out += page.substr(done);
}

/// What runs the components: nothing but the language itself, no files, no network, no clock.
std::string rendered(const std::string& json) {
  const std::unique_ptr<duk_context, void (*)(duk_context*)> heap(duk_create_heap_default(),
                                                                  duk_destroy_heap);
  duk_context* engine = heap.get();
  if (engine == nullptr) throw std::runtime_error("page: no memory");
  const auto check = [&](duk_int_t result) {
    if (result != DUK_EXEC_SUCCESS) {
      throw std::logic_error(std::string("page: ") + duk_safe_to_stacktrace(engine, -1));
    }
  };
  const std::string_view script = page_script();
  check(duk_peval_lstring(engine, script.data(), script.size()));
  duk_pop(engine);
  check(duk_peval_string(engine,
                         "(function (text) { return palmarPages.render(JSON.parse(text)); })"));
  duk_push_lstring(engine, json.data(), json.size());
  check(duk_pcall(engine, 1));
  duk_size_t size = 0;
  const char* text = duk_get_lstring(engine, -1, &size);
  if (text == nullptr) throw std::logic_error("page: its data are of no known kind");
  return {text, size};
}

}  // namespace

std::string render_page(const std::string& json, Attachments attachments) {
  attachments.emplace("style", page_style());
  attachments.emplace("page", script_escaped(page_behaviour()));
  attachments.emplace("viewer", script_escaped(viewer_script()));
  return filled(rendered(json), attachments);
}

}  // namespace palmar::report
