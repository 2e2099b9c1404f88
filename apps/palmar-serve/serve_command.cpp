// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <malloc.h>

#include <cstdlib>
#include <filesystem>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/core/program_folder.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/records/product/cad_format.h"
#include "palmar/server/data_folder.h"
#include "palmar/server/http_server.h"

namespace palmar::cli {
namespace {

struct ServeArguments {
  std::vector<std::string> files;
  std::string unit;
  std::string listen = server::HttpServerOptions{}.address;
  int port = 0;
  bool no_browser = false;
};

bool is_loopback(const std::string& address) {
  return address == "::1" || address.starts_with("127.");
}

/// Without one, xdg-open would start a browser of text in this terminal.
bool has_desktop() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

/// Small meshes are read at once, so that what is wrong with them is said here and not in the page.
bool is_read_fast(const std::filesystem::path& file) {
  constexpr std::uintmax_t kSmall = std::uintmax_t{1} << 19U;  // bytes; some 0.1 s
  return std::filesystem::file_size(file) <= kSmall && !records::is_cad_file(file);
}

int run_serve(const ServeArguments& arguments, const Context& context) {
  // glibc gives each thread an arena of its own, and what is freed in one doesn't serve another: in
  // ten minutes the server grew by 130 MB. What lies free at the end goes back to the system from
  // kMostFree on, which glibc would raise with every large block that is freed. Smaller blocks than
  // kOwnPages come from the heap: fetching pages for each array of a step takes as long as the
  // step.
  constexpr int kMostFree = 16 << 20, kOwnPages = 4 << 20;  // bytes
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kOwnPages);
  mallopt(M_TRIM_THRESHOLD, kMostFree);
  for (const std::string& file : arguments.files) {
    if (!std::filesystem::is_regular_file(file)) {
      throw InputError(file + ": there is no such file");
    }
  }
  const auto data = server::user_data_folder();
  const auto in_data = [&](const char* name) -> std::optional<std::filesystem::path> {
    return data ? std::optional(*data / name) : std::nullopt;
  };
  // Children say where they stand in lines (make_progress()).
  ::setenv("PALMAR_PROGRESS", "lines", 1);
  const server::KeptData kept{
      std::make_shared<server::ProjectDrawer>(in_data("projects")),
      std::make_shared<server::JobShelf>(in_data("jobs"), program_folder() / "palmar")};
  const auto shelf = std::make_shared<server::ProductShelf>();
  const auto service = std::make_shared<server::Service>(server::random_token(), shelf, kept);
  for (const std::string& file : arguments.files) {
    const std::string key = service->give(file, parse_unit(arguments.unit));
    formats::read_ends(file, 1);  // whether it can be read at all
    if (is_read_fast(file)) shelf->open(key);
  }
  server::HttpServerOptions options;
  options.address = arguments.listen;
  options.port = static_cast<unsigned short>(arguments.port);
  options.stops_on_signals = true;
  server::HttpServer server(service, options);
  if (!is_loopback(arguments.listen)) {
    note(context.common, "warning: --listen " + arguments.listen +
                             " lets other machines in; whoever has the URL can use this server, "
                             "and what is sent can be read on the way (no encryption)");
  }
  const server::ServedAt at = server.place();
  const bool is_any = at.address == "0.0.0.0" || at.address == "::";
  const std::string host = is_any                                    ? "127.0.0.1"
                           : at.address.find(':') != at.address.npos ? "[" + at.address + "]"
                                                                     : at.address;
  const std::string url = fmt::format("http://{}:{}/?token={}", host, at.port, service->token());
  print(context.common.json ? fmt::format("{{\"url\": \"{}\"}}\n", url) : url + "\n");
  if (!arguments.no_browser && has_desktop()) {
    const auto opener = formats::find_program("xdg-open");
    if (opener) formats::start_detached(*opener, {url});
  }
  note(context.common, "the workbench runs until Ctrl-C");
  server.run();
  return 0;
}

}  // namespace

void add_serve_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* verb = add_verb(app, "serve",
                            "The workbench in a browser: move a product in the hand and see what "
                            "presses; runs until Ctrl-C",
                            "palmar serve handle.stl --unit mm");
  verb->add_option("PRODUCT", arguments->files,
                   "Products to begin with: STL, OBJ, PLY, 3MF, glTF, STEP or IGES");
  verb->add_option("--unit", arguments->unit,
                   "Unit of files that carry none (STL, OBJ, PLY): mm, cm, m, inch");
  verb->add_option("--port", arguments->port, "Port to listen on; 0: one that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  verb->add_flag("--no-browser", arguments->no_browser, "Don't open the browser");
  verb->add_option("--listen", arguments->listen,
                   "Address to listen on; any but this machine's own (127.0.0.1, ::1) lets other "
                   "machines in")
      ->capture_default_str();
  verb->callback([&context, arguments] {
    context.run = [&context, arguments] { return run_serve(*arguments, context); };
  });
}

}  // namespace palmar::cli
