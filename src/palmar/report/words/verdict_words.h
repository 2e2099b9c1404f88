// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/records/assessment/verdict_text.h"
#include "palmar/report/words/texts.h"
#include "palmar/study/assessment/verdict.h"

namespace palmar::report {

/// An assessment in words: the answer first ("B presses 27 % less than A at its hardest place, in
/// the same grip of 60 N"), why, and one thing to do next with the command for it. The same words
/// stand in the report, in assessment.json and on standard output.
records::VerdictWords verdict_words(const study::AssessmentSet& set,
                                    const study::SetVerdict& verdict, Language language);

/// "a moment of this grip doesn't hurt; repeated, it becomes uncomfortable in 9 of 18 regions, ...;
/// held for minutes ...": the three questions of comfort in one sentence.
std::string comfort_words(const grasp::ComfortResult& comfort, const Texts& texts);

/// A command line with options taken out ("--grip-force-n" with its value) and others put at the
/// end.
std::string changed_command(const std::string& command_line,
                            const std::vector<std::string>& removed, const std::string& added);

/// "a.stl b.stl --unit mm": products as commands take them; empty if one of them is no file.
/// `option` stands before each ("--product ").
std::string product_arguments(const std::vector<const product::Product*>& products,
                              const std::string& option = "");

/// "in the same grip of 60 N"; of products each gripped as one task asks, whose forces [N] differ:
/// "each gripped as its task asks (B with 12 N, A with 20 N)".
std::string grip_words(std::optional<double> worse_of_task, double better, const std::string& worse,
                       const std::string& better_name, const Texts& texts);

/// "27 % larger", "about the same": how an area differs.
std::string area_words(double change, const Texts& texts);

}  // namespace palmar::report
