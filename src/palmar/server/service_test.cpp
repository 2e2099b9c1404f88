// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/formats/mesh/stl.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

const Service& service() {
  static Service one(kToken, std::make_shared<ProductShelf>());
  one.set_place({"127.0.0.1", 8123});
  return one;
}

ServiceRequest asking(const std::string& method, const std::string& target,
                      const std::string& body = "") {
  return {.method = method,
          .target = target,
          .host = "127.0.0.1:8123",
          .origin = "",
          .authorization = std::string("Bearer ") + kToken,
          .body = body};
}

std::string sphere_stl(double radius) {
  return formats::format_stl(geometry::make_icosphere(radius, 3));
}

TEST(Service, ApiRefusesWithoutTheToken) {
  for (const char* target : {"/api/state", "/api/products", "/api/live", "/api/nothing",
                             "/api/state?token=wrong", "/%61pi/state"}) {
    ServiceRequest request = asking("GET", target);
    request.authorization = "";
    EXPECT_EQ(service().answer(request).status, 401) << target;
  }
  ServiceRequest request = asking("GET", std::string("/api/state?token=") + kToken);
  request.authorization = "";
  EXPECT_EQ(service().answer(request).status, 200);
}

TEST(Service, OtherHostsAndPagesAreRefusedEvenWithTheToken) {
  ServiceRequest request = asking("GET", "/api/state");
  request.host = "evil.example:8123";
  EXPECT_EQ(service().answer(request).status, 403);
  request = asking("GET", "/api/state");
  request.origin = "http://evil.example";
  EXPECT_EQ(service().answer(request).status, 403);
  request.origin = "http://localhost:8123";
  EXPECT_EQ(service().answer(request).status, 200);
}

TEST(Service, ClientIsServedAndNothingBesideIt) {
  const ServiceAnswer page = service().answer(asking("GET", "/"));
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("<!doctype html>"));
  EXPECT_THAT(page.body, Not(HasSubstr("https://")));
  EXPECT_GT(service().answer(asking("GET", "/bench.js")).body.size(), 100000U);
  for (const char* target :
       {"/../etc/passwd", "/..%2f..%2fetc/passwd", "/bench.js/..", "//etc/passwd", "/.git/config",
        "/api/products/../../etc/passwd/file", "/api/products/p1%2f..%2f/file",
        "/api/products//file", "/api/products/file"}) {
    EXPECT_EQ(service().answer(asking("GET", target)).status, 404) << target;
  }
  EXPECT_EQ(service().answer(asking("POST", "/")).status, 405);
}

TEST(Service, FileThatIsSentBecomesAProductAndComesBack) {
  const std::string stl = sphere_stl(30.0);
  const ServiceAnswer answer =
      service().answer(asking("POST", "/api/products?name=..%2Fmy%20ball.stl", stl));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json product = json::parse(answer.body);
  EXPECT_EQ(product["file_name"], "my ball.stl");
  EXPECT_EQ(product["name"], "my ball");
  EXPECT_NEAR(product["sides_mm"][0].get<double>(), 60.0, 1.0);
  EXPECT_EQ(product["unit_source"], "proposed");
  const ServiceAnswer same =
      service().answer(asking("GET", "/api/products/" + product["key"].get<std::string>()));
  EXPECT_EQ(json::parse(same.body), product);
  EXPECT_EQ(service().answer(asking("GET", "/api/products/p999")).status, 404);
  const ServiceAnswer file = service().answer(
      asking("GET", "/api/products/" + product["key"].get<std::string>() + "/file"));
  EXPECT_EQ(file.body, stl);
  EXPECT_EQ(file.file_name, "my ball.stl");
}

TEST(Service, UndecidableUnitIsAskedFor) {
  const std::string stl = sphere_stl(5.0);  // 10 cm or 10 inch
  const ServiceAnswer asked = service().answer(asking("POST", "/api/products?name=b.stl", stl));
  ASSERT_EQ(asked.status, 409) << asked.body;
  const json question = json::parse(asked.body);
  ASSERT_EQ(question["units"].size(), 4U);
  EXPECT_EQ(question["units"][1]["unit"], "cm");
  EXPECT_NEAR(question["units"][1]["sides_mm"][0].get<double>(), 100.0, 2.0);
  const ServiceAnswer answer =
      service().answer(asking("POST", "/api/products?name=b.stl&unit=cm", stl));
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_NEAR(json::parse(answer.body)["sides_mm"][0].get<double>(), 100.0, 2.0);
}

TEST(Service, BadFilesAreRefusedByTheirName) {
  for (const std::string& body :
       {std::string("no mesh at all"), std::string(), sphere_stl(30.0).substr(0, 500)}) {
    const ServiceAnswer answer =
        service().answer(asking("POST", "/api/products?name=cup.stl&unit=mm", body));
    EXPECT_EQ(answer.status, 422) << answer.body;
    const std::string message = json::parse(answer.body)["error"];
    EXPECT_THAT(message, HasSubstr("cup.stl"));
    EXPECT_THAT(message, Not(HasSubstr("/tmp/"))) << "folders of the server are nobody's business";
  }
  EXPECT_EQ(service().answer(asking("POST", "/api/products?name=a.stl&unit=ell", "x")).status, 400);
}

TEST(Service, ExamplesAreMadeByCommandsThatAreNamed) {
  for (const ShelvedExample& example : shelved_examples()) {
    const ServiceAnswer answer =
        service().answer(asking("POST", "/api/examples?name=" + example.name));
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_THAT(json::parse(answer.body)["made_by"].get<std::string>(),
                HasSubstr("palmar product make " + example.kind));
  }
  EXPECT_EQ(service().answer(asking("POST", "/api/examples?name=none")).status, 400);
}

TEST(Service, OnlyProductsMayBeLarge) {
  EXPECT_EQ(service().largest_body(asking("POST", "/api/products?name=a.stl")), 256ULL << 20U);
  EXPECT_EQ(service().largest_body(asking("POST", "/api/examples")), 1ULL << 20U);
  EXPECT_EQ(service().largest_body(asking("GET", "/api/products")), 1ULL << 20U);
}

/// A service that keeps what users do, in a folder that goes with it.
class KeepingService : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "palmar_keeping_XXXXXX").string();
    test_folder = mkdtemp(name.data());
    shelf = std::make_shared<ProductShelf>();
    keeping = std::make_unique<Service>(
        kToken, shelf,
        KeptData{std::make_shared<ProjectDrawer>(test_folder / "projects"),
                 std::make_shared<JobShelf>(test_folder / "jobs", "/bin/false")});
    keeping->set_place({"127.0.0.1", 8123});
    product = shelf->add_example("ball").key;
  }
  void TearDown() override {
    keeping.reset();
    std::filesystem::remove_all(test_folder);
  }
  ServiceAnswer ask(const std::string& method, const std::string& target,
                    const json& body = nullptr) const {
    return keeping->answer(asking(method, target, body.is_null() ? "" : body.dump()));
  }

  std::filesystem::path test_folder;
  std::shared_ptr<ProductShelf> shelf;
  std::unique_ptr<Service> keeping;
  std::string product;
};

TEST_F(KeepingService, ProjectsAreKeptOpenedAndRemoved) {
  EXPECT_EQ(json::parse(ask("GET", "/api/projects").body)["projects"].size(), 0U);
  const json content = {{"product", product}, {"state", {{"hold", 2}}}, {"history", {{"at", 0}}}};
  EXPECT_EQ(ask("POST", "/api/projects/mine", content).status, 200);
  const json opened = json::parse(ask("GET", "/api/projects/mine").body);
  EXPECT_EQ(opened["product"]["file_name"], "ball.stl");
  EXPECT_NE(opened["product"]["key"], product) << "the drawer's own copy";
  EXPECT_EQ(opened["state"]["hold"], 2);
  EXPECT_EQ(opened["history"]["at"], 0);
  EXPECT_EQ(ask("DELETE", "/api/projects/mine").status, 200);
  EXPECT_EQ(ask("GET", "/api/projects/mine").status, 400);
  for (const char* target : {"/api/projects/..", "/api/projects/a.b", "/api/projects/%2e%2e"}) {
    EXPECT_EQ(ask("POST", target, content).status, 400) << target;
  }
  EXPECT_EQ(ask("POST", "/api/projects/%2e%2e%2fx", content).status, 404);
  EXPECT_EQ(ask("POST", "/api/projects/mine", {{"product", "p99"}, {"state", {}}}).status, 400);
}

TEST_F(KeepingService, JobsAreListedAndTheirFilesConfined) {
  const json request = {{"kind", "compare"},
                        {"products", {product, shelf->add_example("round-handle").key}}};
  const json added = json::parse(ask("POST", "/api/jobs", request).body);
  const std::string path = "/api/jobs/" + added["key"].get<std::string>();
  EXPECT_EQ(json::parse(ask("GET", "/api/jobs").body)["jobs"].size(), 1U);
  EXPECT_EQ(json::parse(ask("GET", path).body)["title"], "ball, round-handle");
  for (const char* rest : {"/report", "/dots", "/files/job.json", "/files/..%2fjob.json", "/files/",
                           "/files/..", "/nothing"}) {
    EXPECT_EQ(ask("GET", path + rest).status, 404) << rest;
  }
  EXPECT_EQ(ask("POST", path + "/shelve?name=../job.json").status, 404);
  EXPECT_EQ(ask("POST", path + "/stop").status, 404);
  EXPECT_EQ(ask("GET", "/api/jobs/..").status, 404);
  EXPECT_EQ(ask("POST", "/api/jobs/nothing/start").status, 404);
  EXPECT_EQ(ask("POST", "/api/jobs", {{"kind", "compare"}, {"products", {"p98", "p99"}}}).status,
            400);
  EXPECT_EQ(ask("POST", path + "/cancel").status, 200);
}

TEST_F(KeepingService, NothingOfItWithoutTheToken) {
  for (const char* target : {"/api/projects", "/api/projects/a", "/api/jobs", "/api/jobs/a/report",
                             "/api/jobs/a/files/b"}) {
    for (const char* method : {"GET", "POST", "DELETE"}) {
      ServiceRequest request = asking(method, target);
      request.authorization = "";
      EXPECT_EQ(keeping->answer(request).status, 401) << method << " " << target;
    }
  }
}

}  // namespace
}  // namespace palmar::server
