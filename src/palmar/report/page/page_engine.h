// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace palmar::report {

/// Texts that go into a page as they are, by the name under which its data ask for them.
using Attachments = std::map<std::string, std::string>;

/// A page as HTML from its data: JSON of one of the pages of apps/workbench/types. The
/// components that a browser runs, too, are run here when the page is written, so that it can be
/// read without scripts.
///
/// Large texts needn't pass through them: <attachment:NAME> in the page, and "attachment:NAME" as
/// an attribute, become the attachment of that name. Text of the data can't ask for one, since <
/// and " are escaped in it. "style" and "viewer" are there always.
///
/// Throws std::logic_error if the data are not what the page expects, naming the place in it, or an
/// attachment is missing.
std::string render_page(const std::string& json, Attachments attachments);

}  // namespace palmar::report
