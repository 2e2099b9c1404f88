// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/product_shelf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::server {
namespace {

/// A tetrahedron with edges of about that many millimetres; each length is another file.
std::string tetrahedron(double length) {
  const std::string l = std::to_string(length);
  const std::string o = "v 0 0 0\nv " + l + " 0 0\nv 0 " + l + " 0\nv 0 0 " + l + "\n";
  return o + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

ShelvedProduct added(ProductShelf& shelf, double length) {
  return shelf.add_bytes("t.obj", tetrahedron(length), geometry::LengthUnit::kMillimetre).product;
}

TEST(ProductShelf, ExampleOpenedAgainIsTheSameProduct) {
  ProductShelf shelf;
  const std::string ball = shelf.add_example("ball").key;
  EXPECT_NE(shelf.add_example("round-handle").key, ball);
  EXPECT_EQ(shelf.add_example("ball").key, ball);
  for (std::size_t k = 0; k < ProductShelf::kMost; ++k) added(shelf, 20.0);
  EXPECT_FALSE(shelf.find(ball));  // had to go
  const ShelvedProduct again = shelf.add_example("ball");
  EXPECT_NE(again.key, ball);
  EXPECT_TRUE(shelf.find(again.key));
}

TEST(ProductShelf, OnlyProductsUsedLastStayRead) {
  ProductShelf shelf;
  std::vector<std::string> keys;
  for (std::size_t k = 0; k < ProductShelf::kMostRead; ++k) {
    keys.push_back(added(shelf, 20.0 + static_cast<double>(k)).key);
  }
  for (const std::string& key : keys) EXPECT_NE(shelf.find(key)->product, nullptr) << key;
  shelf.open(keys[0]);  // now the second is the one not used for longest
  keys.push_back(added(shelf, 60.0).key);
  EXPECT_NE(shelf.find(keys[0])->product, nullptr);
  EXPECT_EQ(shelf.find(keys[1])->product, nullptr);
  // Opened, it is read again from its file, and the next goes.
  EXPECT_NEAR(shelf.open(keys[1]).product->mesh.vertices[1].x(), 21.0, 1e-6);
  EXPECT_NE(shelf.find(keys[1])->product, nullptr);
  EXPECT_EQ(shelf.find(keys[2])->product, nullptr);
}

TEST(ProductShelf, NamesWhatIsNotThere) {
  ProductShelf shelf;
  EXPECT_THROW(shelf.open("p9"), UsageError);
  EXPECT_THROW(shelf.add_example("teapot"), UsageError);
}

}  // namespace
}  // namespace palmar::server
