// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/product/product.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/live/live_session.h"

namespace palmar::server {

/// One product that can be opened.
struct ShelvedProduct {
  std::string key;             ///< "p1"
  std::string file_name;       ///< "cup.stl"
  std::filesystem::path path;  ///< where its file is
  /// As the command line takes it: the user's own file, or the name of one that was dropped.
  std::string argument;
  std::optional<geometry::LengthUnit> unit;  ///< as the user said
  std::string made_by;                       ///< command that makes the file; empty if it was there
  std::shared_ptr<const product::Product> product;
};

/// Its file, with the findings of its check. Throws InputError naming the file, Cancelled.
std::shared_ptr<const product::Product> read_product(const ShelvedProduct& shelved,
                                                     const Progress& progress = {});

/// A finished example: made by a command that people can run, too.
struct ShelvedExample {
  std::string name;                                   ///< "round-handle"
  std::string kind;                                   ///< of `palmar product make`
  std::vector<std::pair<std::string, double>> given;  ///< its parameters
};
const std::vector<ShelvedExample>& shelved_examples();

/// The file's unit can't be decided; the sides of its box as they stand in it.
struct UnitQuestion {
  Vec3 sides = Vec3::Zero();
};

/// Products and hands that sessions share. Files that were sent are kept in a folder that goes with
/// the shelf. Thread-safe.
class ProductShelf {
 public:
  ProductShelf();
  ProductShelf(const ProductShelf&) = delete;
  ProductShelf& operator=(const ProductShelf&) = delete;
  ~ProductShelf();

  /// At most this many products; the one that was put there first goes.
  static constexpr std::size_t kMost = 32;
  /// So many stay read; the others are read again when they are opened.
  static constexpr std::size_t kMostRead = 6;

  struct Added {
    ShelvedProduct product;                ///< without key if there is a question
    std::optional<UnitQuestion> question;  ///< which unit; put it there again with the answer
  };
  /// A file that a client sent. Throws InputError naming the file and what is wrong with it,
  /// Cancelled.
  Added add_bytes(const std::string& name, std::string_view bytes,
                  std::optional<geometry::LengthUnit> unit, const Progress& progress = {});
  /// A file of the user's, read when it is first opened.
  ShelvedProduct add_file(const std::filesystem::path& path,
                          std::optional<geometry::LengthUnit> unit);
  /// One whose file is there and isn't the shelf's own, with all that is known of it but its key.
  ShelvedProduct add_known(ShelvedProduct product);
  /// The one that is there if it is still. Throws UsageError for a name that is none.
  ShelvedProduct add_example(const std::string& name);

  /// With its product, read if it wasn't. Throws UsageError for an unknown key, InputError,
  /// Cancelled.
  ShelvedProduct open(const std::string& key, const Progress& progress = {});
  /// As it stands there, read or not; nothing for an unknown key.
  std::optional<ShelvedProduct> find(const std::string& key) const;

  /// Whose hand.
  struct Holder {
    std::optional<workflow::PersonOfSize> person;  ///< unset: the template, or `own_hand`
    std::string own_hand;                          ///< key of a hand that was made here
    bool is_left = false;
  };
  /// A hand ready for contact; made once for every choice. Throws InputError, UsageError.
  workflow::LiveHand hand(const Holder& holder);
  /// Where the file of a hand with that key is.
  using OwnHands = std::function<std::optional<std::filesystem::path>(const std::string& key)>;
  void set_own_hands(OwnHands own) { own_hands_ = std::move(own); }
  /// Throws UsageError if it isn't there.
  std::filesystem::path own_hand(const std::string& key) const;

  /// That goes with the shelf.
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::string example_key(const std::string& name) const;  ///< empty if it never was there
  ShelvedProduct put(ShelvedProduct product);
  std::filesystem::path new_folder();
  /// That one was used last; with the mutex locked.
  void keep_read(const std::string& key);

  mutable std::mutex mutex_;
  std::filesystem::path folder_;
  int count_ = 0;
  std::vector<ShelvedProduct> products_;
  std::map<std::string, std::string> examples_;  ///< key by name
  std::vector<std::string> read_;  ///< keys of those that are read, the one used last at the end
  OwnHands own_hands_;
  std::mutex hands_mutex_;
  std::vector<std::pair<std::string, workflow::LiveHand>> hands_;  ///< the latest last
};

}  // namespace palmar::server
