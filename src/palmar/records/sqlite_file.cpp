// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/sqlite_file.h"

#include <sqlite3.h>

namespace palmar::records {
namespace {

[[noreturn]] void fail(sqlite3* handle, int code) {
  const std::string text =
      handle != nullptr ? sqlite3_errmsg(handle) : sqlite3_errstr(code);  // "out of memory" if null
  throw SqliteFailure(code & 0xFF, text);
}

}  // namespace

SqliteFile::SqliteFile(const std::string& name, int flags) {
  const int code = sqlite3_open_v2(name.c_str(), &handle_, flags, nullptr);
  if (code == SQLITE_OK) return;
  const std::string text = handle_ != nullptr ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  sqlite3_close(handle_);
  throw SqliteFailure(code & 0xFF, text);
}

SqliteFile::~SqliteFile() { sqlite3_close(handle_); }

void SqliteFile::close() {
  const int code = sqlite3_close(handle_);
  if (code != SQLITE_OK) fail(handle_, code);
  handle_ = nullptr;
}

void SqliteFile::run(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(handle_, code);
}

std::int64_t SqliteFile::integer(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  return statement.next() ? statement.integer(0) : 0;
}

std::string SqliteFile::text(const std::string& sql) {
  SqliteStatement statement(*this, sql);
  return statement.next() ? statement.text(0) : "";
}

SqliteStatement::SqliteStatement(SqliteFile& file, const std::string& sql) : file_(file) {
  const int code = sqlite3_prepare_v2(file.handle(), sql.data(), static_cast<int>(sql.size()),
                                      &statement_, nullptr);
  if (code != SQLITE_OK) fail(file.handle(), code);
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(statement_); }

SqliteStatement& SqliteStatement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(statement_, parameter, value);
  if (code != SQLITE_OK) fail(file_.handle(), code);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, double value) {
  const int code = sqlite3_bind_double(statement_, parameter, value);
  if (code != SQLITE_OK) fail(file_.handle(), code);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::string_view text) {
  const int code = sqlite3_bind_text64(statement_, parameter, text.data(), text.size(),
                                       SQLITE_TRANSIENT, SQLITE_UTF8);
  if (code != SQLITE_OK) fail(file_.handle(), code);
  return *this;
}

SqliteStatement& SqliteStatement::bind_blob(int parameter, std::string_view bytes) {
  // A null pointer would be stored as NULL.
  const char* data = bytes.empty() ? "" : bytes.data();
  const int code = sqlite3_bind_blob64(statement_, parameter, data, bytes.size(), SQLITE_TRANSIENT);
  if (code != SQLITE_OK) fail(file_.handle(), code);
  return *this;
}

SqliteStatement& SqliteStatement::bind_null(int parameter) {
  const int code = sqlite3_bind_null(statement_, parameter);
  if (code != SQLITE_OK) fail(file_.handle(), code);
  return *this;
}

bool SqliteStatement::next() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const SqliteFailure failure(code & 0xFF, sqlite3_errmsg(file_.handle()));
    sqlite3_reset(statement_);
    throw failure;
  }
  sqlite3_reset(statement_);
  return false;
}

void SqliteStatement::run() {
  while (next()) {
  }
}

void SqliteStatement::reset() { sqlite3_reset(statement_); }

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}
double SqliteStatement::number(int column) const {
  return sqlite3_column_double(statement_, column);
}
std::string SqliteStatement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  return data == nullptr ? "" : std::string(data, size);
}
std::string SqliteStatement::blob(int column) const {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  return data == nullptr ? "" : std::string(data, size);
}
bool SqliteStatement::is_null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

}  // namespace palmar::records
