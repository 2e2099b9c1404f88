// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/report/page/page_json.h"
#include "palmar/report/page/report_extras.h"

namespace palmar::report {

/// Units and project for a page (Desk in apps/workbench/types/common.ts).
PageJson desk_json(const ReportExtras& extras, Attachments& attachments);

}  // namespace palmar::report
