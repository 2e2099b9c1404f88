// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/page_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace palmar::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The page of a study without conditions' contents, distinguished by its title.
std::string study_of(const std::string& title) {
  return R"({"kind":"study","maker":{"version":"1","build":"b","viewer_licence":""},"title":")" +
         title +
         R"(","hands":1,"grasps":0,"grasps_planned":1,"vocabulary":{"regions":{}},"products":[],)"
         R"("language":"en","answer":{"tone":"fair","sentence":"","reasons":[],"next":"","command":"",)"
         R"("better":null,"worse":null,"changes":[]},"verdict":[],"warnings":[],"limits":[],"threshold_mpa":0.05,"main_quantities":[],)"
         R"("quantities":[],"conditions":[{"title":"","words":"","are_figures_shown":true,)"
         R"("figures":[],"products":[],"comparisons":[],"sizes":[],"dependence":[],"faces":[],)"
         R"("has_nails":false}],"scene":null,"provenance":{"study":"s","seed":1,"sha256":"",)"
         R"("program":"","populations":[],"products":[],"grips":[],"settings":[],)"
         R"("has_several_profiles":false,"profiles":[],"hand":{"name":"h","side":"right",)"
         R"("hand_length_mm":1,"hand_circumference_mm":1,"sha256":"","provenance":""},)"
         R"("stiffness":[]}})";
}

TEST(RenderPage, EscapesWhatTheDataSay) {
  const std::string page =
      render_page(study_of("<b> \\\"&\\\" mm\u00b2 \xf0\x9f\x98\x80"), {{"data", "{}"}});
  EXPECT_THAT(page, HasSubstr("<title>Palmar study: &lt;b&gt; &quot;&amp;&quot; mm\u00b2 "
                              "\xf0\x9f\x98\x80</title>"));
}

TEST(RenderPage, PutsAttachmentsInWhereThePageAsksForThem) {
  const std::string page =
      render_page(study_of("<attachment:data> attachment:data"), {{"data", "{\"a\":1}"}});
  EXPECT_THAT(page, AllOf(HasSubstr("id=\"palmar-study\">{\"a\":1}</script>"),
                          HasSubstr("&lt;attachment:data&gt; attachment:data</title>"),
                          HasSubstr("--ink"), Not(HasSubstr("<attachment:"))));
}

TEST(RenderPage, NamesAnAttachmentThatIsMissing) {
  try {
    render_page(study_of("x"), {});
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no attachment \"data\""));
  }
}

TEST(RenderPage, RefusesDataOfNoPage) {
  EXPECT_THROW(render_page("{", {}), std::logic_error);
  EXPECT_THROW(render_page(R"({"kind":"nothing"})", {}), std::logic_error);
  EXPECT_THROW(render_page(R"({"kind":"study"})", {}), std::logic_error);
}

}  // namespace
}  // namespace palmar::report
