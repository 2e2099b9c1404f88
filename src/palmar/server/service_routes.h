// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/server/access.h"
#include "palmar/server/job_shelf.h"
#include "palmar/server/project_drawer.h"
#include "palmar/server/service.h"
#include "palmar/server/upload_drawer.h"

namespace palmar::server {

// Parts of what the server answers (service.h). Nothing: the path is none of theirs. Throw as what
// they call does.

std::optional<ServiceAnswer> projects_answer(const ServiceRequest& request, const Target& target,
                                             ProductShelf& shelf, ProjectDrawer& drawer);
std::optional<ServiceAnswer> jobs_answer(const ServiceRequest& request, const Target& target,
                                         ProductShelf& shelf, JobShelf& jobs,
                                         UploadDrawer& uploads);
std::optional<ServiceAnswer> uploads_answer(const ServiceRequest& request, const Target& target,
                                            UploadDrawer& uploads);
/// Hands that were made here and can be chosen.
std::optional<ServiceAnswer> hands_answer(const ServiceRequest& request, const Target& target,
                                          const JobShelf& jobs);

/// What stands between `begin` and `end` of a path, without a slash; nothing if it isn't so.
std::optional<std::string> name_between(std::string_view path, std::string_view begin,
                                        std::string_view end = "");

}  // namespace palmar::server
