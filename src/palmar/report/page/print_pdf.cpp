// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/print_pdf.h"

#include <unistd.h>

#include <array>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/child_process.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/formats/process/program_missing.h"

namespace palmar::report {
namespace {

namespace fs = std::filesystem;

constexpr std::array kBrowsers = {"chromium", "chromium-browser", "google-chrome",
                                  "google-chrome-stable", "microsoft-edge"};
constexpr double kPatience = 120.0;      // s, for one file
constexpr double kAddressSpace = 1.0e7;  // MB; a browser reserves far more than it uses

fs::path browser() {
  std::string names;
  for (const char* name : kBrowsers) {
    if (const auto found = formats::find_program(name)) return *found;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  throw formats::ProgramMissing(
      "PDF and slides: no browser is there to print with; install one of " + names +
      " (Debian: apt install chromium), or print report.html from your own");
}

/// As the path of an address.
std::string address_of(const fs::path& file) {
  std::string address = "file://";
  for (const char c : fs::absolute(file).string()) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '/' || c == '.' || c == '-' || c == '_';
    std::array<char, 4> code{c, 0, 0, 0};
    if (!is_plain) {
      std::snprintf(code.data(), code.size(), "%%%02X", static_cast<unsigned char>(c));
    }
    address += code.data();
  }
  return address;
}

/// Runs the browser on a page for one file.
void browse(const fs::path& program, const fs::path& page, const std::string& hash,
            const std::vector<std::string>& how, const fs::path& out, const Progress& progress) {
  const fs::path profile = fs::temp_directory_path() / ("palmar-print-" + std::to_string(getpid()));
  std::vector<std::string> arguments = {"--headless=new", "--disable-gpu", "--no-first-run",
                                        "--user-data-dir=" + profile.string(),
                                        "--virtual-time-budget=5000"};
  arguments.insert(arguments.end(), how.begin(), how.end());
  arguments.push_back(address_of(page) + "#" + hash);
  // A browser's sandbox doesn't work for root.
  if (geteuid() == 0) arguments.insert(arguments.begin(), "--no-sandbox");
  fs::remove(out);
  formats::create_folder(profile);
  const formats::ChildResult result = formats::run_child(
      program, arguments, profile / "log",
      {.seconds = kPatience, .memory_mb = kAddressSpace, .file_mb = 8192.0},
      [](const std::string&) {}, [&] { return progress.is_cancelled(); });
  std::error_code ignored;
  fs::remove_all(profile, ignored);
  progress.throw_if_cancelled();
  if (result.end != formats::ChildResult::End::kExited || result.code != 0 || !fs::exists(out)) {
    throw OutputError(out.string() + ": " + program.filename().string() +
                      " wrote nothing; report.html can be printed from any browser");
  }
}

void print(const fs::path& program, const fs::path& page, const std::string& what, Paper paper,
           const fs::path& out, const Progress& progress) {
  browse(program, page, "print=" + what + "," + name_of(paper),
         {"--no-pdf-header-footer", "--print-to-pdf=" + fs::absolute(out).string()}, out, progress);
}

}  // namespace

std::string name_of(Paper paper) { return paper == Paper::kLetter ? "letter" : "a4"; }

Paper paper_named(const std::string& name) {
  for (const Paper paper : {Paper::kA4, Paper::kLetter}) {
    if (lower_case(name) == name_of(paper)) return paper;
  }
  throw UsageError("setting \"paper\" is \"" + name + "\"; a4 or letter is allowed");
}

void print_pdf(const fs::path& report_html, Paper paper, const Progress& progress) {
  const fs::path program = browser();
  const fs::path folder = report_html.parent_path();
  print(program, report_html, "answer", paper, folder / "answer.pdf", progress);
  print(program, report_html, "all", paper, folder / "report.pdf", progress);
}

void take_slides(const fs::path& report_html, const Progress& progress) {
  const fs::path program = browser();
  const bool has_pictures =
      formats::read_file(report_html).find("data-picture=\"") != std::string::npos;
  for (const std::string slide : {"answer", "hold", "map"}) {
    if (slide != "answer" && !has_pictures) break;
    const fs::path out = report_html.parent_path() / ("slide-" + slide + ".png");
    browse(program, report_html, "slide=" + slide,
           {"--hide-scrollbars", "--window-size=1920,1080",
            "--screenshot=" + fs::absolute(out).string()},
           out, progress);
  }
}

}  // namespace palmar::report
