// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace palmar::person_workflow {

/// Throws UsageError naming the setting "out" unless the path ends in .hand.glb.
void check_hand_output(const std::string& out);
/// Refuses an output that is the input itself, also by another spelling or through links: the
/// original stays as it is. `what` the input is: "scan". Throws UsageError.
void refuse_overwriting(const std::string& input, const std::string& out, const std::string& what);
/// "folder/anna.hand.glb" -> "anna".
std::string hand_name_of(const std::string& out);
/// "folder/anna.hand.glb", ".mri" -> "folder/anna.mri".
std::string beside_hand(const std::string& out, const std::string& ending);
/// The folder that a file lies in; "." for a bare name.
std::filesystem::path folder_of(const std::string& out);
/// Minutes of work shall not end in a folder that can't be written to: throws OutputError at once.
void require_writable(const std::filesystem::path& folder);

/// A folder for what steps leave, made where there is none and found writable, or OutputError. What
/// was made for a run that then left nothing goes with it.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& path);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

 private:
  std::filesystem::path path_;
  bool is_new_ = false;
};

}  // namespace palmar::person_workflow
