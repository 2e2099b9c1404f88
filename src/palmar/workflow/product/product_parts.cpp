// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product/product_parts.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/report/picture/parts_picture.h"

namespace palmar::workflow {

void ProductPartsRequest::check() const {
  options.check();
  if (!out.empty() && !out.ends_with(".png") && !out.ends_with(".svg")) {
    throw UsageError("setting \"out\" is " + out +
                     "; a name that ends with .png or .svg is required");
  }
}

ProductPartsOutcome list_product_parts(const ProductPartsRequest& request,
                                       const Progress& progress) {
  request.check();
  records::LoadProductOptions reading = request.reading;
  reading.progress = progress;
  ProductPartsOutcome outcome;
  outcome.product = records::load_product(request.file, reading);
  outcome.parts = product::find_parts(outcome.product, request.options);
  if (!request.out.empty()) {
    const report::Image picture =
        report::parts_picture(outcome.product, outcome.parts, {}, progress);
    formats::write_file(request.out, request.out.ends_with(".svg") ? report::picture_svg(picture)
                                                                   : report::encode_png(picture));
  }
  return outcome;
}

}  // namespace palmar::workflow
