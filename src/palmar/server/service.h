// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/server/access.h"
#include "palmar/server/job_shelf.h"
#include "palmar/server/product_shelf.h"
#include "palmar/server/project_drawer.h"
#include "palmar/server/upload_drawer.h"

namespace palmar::server {

/// A request as HTTP brings it, without the connection.
struct ServiceRequest {
  std::string method;  ///< "GET", ...
  std::string target;  ///< "/api/products?name=cup.stl"
  std::string host = {}, origin = {}, authorization = {};
  std::string body = {};
};

struct ServiceAnswer {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::string file_name = {};  ///< if it is to be saved under that name
  std::string policy = {};     ///< Content-Security-Policy; "": that of the client's page
};

/// {"error": "..."}
ServiceAnswer refusal(int status, const std::string& message);

/// The largest file that is taken; other requests are small.
inline constexpr std::uint64_t kLargestUpload = std::uint64_t{256} << 20U;
inline constexpr std::uint64_t kLargestRequest = std::uint64_t{1} << 20U;

/// What the server keeps for the user beyond its own end. Null: nothing of that kind.
struct KeptData {
  std::shared_ptr<ProjectDrawer> projects = nullptr;
  std::shared_ptr<JobShelf> jobs = nullptr;
};

/// What the server answers, apart from how requests come in:
///
///     GET  /, /bench.js, /bench.css, /icon.svg, /licence.txt   the client, to everybody on this
///                                                              machine
///     GET  /api/state                      version, examples, products on the shelf
///     POST /api/products?name=&unit=       the file as body -> the product, or the question which
///                                          unit (409)
///     POST /api/examples?name=             -> the product
///     GET  /api/products/KEY               the product
///     GET  /api/products/KEY/file          its file
///     GET  /api/projects                   what was kept by itself, the newest first
///     GET  /api/projects/KEY               one of them: its product (now on the shelf), state,
///     steps POST /api/projects/KEY               keeps {"product", "state", "picture", "history"}
///     DELETE /api/projects/KEY
///     GET  /api/jobs                       studies, comparisons and redesigns (job_request.h)
///     POST /api/jobs                       a new one
///     GET  /api/jobs/KEY                   how it stands
///     POST /api/jobs/KEY/start, /cancel
///     POST /api/jobs/KEY/revise            a hand again, with other settings or corrections
///     POST /api/jobs/KEY/shelve?name=      a shape that a redesign made -> the product
///     POST /api/jobs/KEY/shelve?product=1  the job's own copy of its product -> the product
///     DELETE /api/jobs/KEY
///     GET  /api/jobs/KEY/report, /dots, /files/NAME
///     GET  /api/jobs/KEY/shape?of=preview|result&what=before|after   frames of a redesign's shapes
///     GET  /api/jobs/KEY/made?file=        a file of a preview, or of what was found of a hand
///     POST /api/uploads/KEY?name=          one file of those that a hand is made from
///     GET  /api/hands                      hands that were made and can be chosen
///     GET  /api/hands/KEY/file             the *.hand.glb of one
///     GET  /api/live                       the live channel (http_server.h)
///
/// Everything under /api/ needs the token (401); all requests need a Host and, where a page sends
/// them, an Origin of this server's (403). Thread-safe.
class Service {
 public:
  Service(std::string token, std::shared_ptr<ProductShelf> shelf, KeptData kept = {});

  void set_place(const ServedAt& at) { at_ = at; }  ///< once the port is known
  const std::string& token() const { return token_; }
  const std::shared_ptr<ProductShelf>& shelf() const { return shelf_; }
  /// A product that was given on the command line; its key.
  std::string give(const std::filesystem::path& file, std::optional<geometry::LengthUnit> unit);

  /// Why it isn't let in, from its head alone; nothing if it is.
  std::optional<ServiceAnswer> refused(const ServiceRequest& head) const;
  /// How large its body may be.
  std::uint64_t largest_body(const ServiceRequest& head) const;
  /// Never throws for what a client sends: errors are answers.
  ServiceAnswer answer(const ServiceRequest& request, const Progress& progress = {}) const;

 private:
  ServiceAnswer routed(const ServiceRequest& request, const Target& target,
                       const Progress& progress) const;
  ServiceAnswer client_file(const std::string& path) const;
  ServiceAnswer state() const;
  ServiceAnswer add_product(const ServiceRequest& request, const Target& target,
                            const Progress& progress) const;

  std::string token_;
  std::shared_ptr<ProductShelf> shelf_;
  KeptData kept_;
  std::shared_ptr<UploadDrawer> uploads_;
  ServedAt at_;
  std::vector<std::string> given_;  ///< keys of products
};

}  // namespace palmar::server
