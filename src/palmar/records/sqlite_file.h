// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace palmar::records {

/// What SQLite says when it can't; callers turn it into an Error with the file's name.
struct SqliteFailure : std::runtime_error {
  SqliteFailure(int primary, const std::string& message)
      : std::runtime_error(message), code(primary) {}
  int code = 0;  ///< primary result code: SQLITE_BUSY, SQLITE_FULL, ...
};

/// One SQLite file. For use inside `io` only. Every function throws SqliteFailure.
class SqliteFile {
 public:
  /// `flags` as of sqlite3_open_v2(); `name` may be a URI.
  SqliteFile(const std::string& name, int flags);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  void run(const std::string& sql);
  /// The single value that a statement gives.
  std::int64_t integer(const std::string& sql);
  std::string text(const std::string& sql);
  sqlite3* handle() const { return handle_; }
  void close();

 private:
  sqlite3* handle_ = nullptr;
};

/// A statement that is run again and again. Parameters count from 1, columns from 0.
class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, const std::string& sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  SqliteStatement& bind(int parameter, std::int64_t value);
  SqliteStatement& bind(int parameter, int value) {
    return bind(parameter, static_cast<std::int64_t>(value));
  }
  SqliteStatement& bind(int parameter, double value);
  SqliteStatement& bind(int parameter, std::string_view text);
  SqliteStatement& bind_blob(int parameter, std::string_view bytes);
  SqliteStatement& bind_null(int parameter);
  /// Next row; false at the end, after which the statement may be bound again.
  bool next();
  /// To the end, without rows.
  void run();
  void reset();

  std::int64_t integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;
  std::string blob(int column) const;
  bool is_null(int column) const;

 private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
};

}  // namespace palmar::records
