// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study_export.h"

#include "palmar/records/study/study_export.h"
#include "palmar/records/study/study_store.h"

namespace palmar::workflow {

StudyExportOutcome export_study(const StudyExportRequest& request, const Progress& progress) {
  const records::StudyStore store(request.store);
  StudyExportOutcome outcome;
  outcome.files = export_study(store, request.folder, request.with_fields, progress);
  outcome.missing = store.missing().size();
  outcome.digest = store.digest();
  return outcome;
}

}  // namespace palmar::workflow
