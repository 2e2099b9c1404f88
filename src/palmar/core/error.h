// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace palmar {

/// Root of every exception that Palmar throws on purpose. The message names the object (file and
/// place, joint, region, vertex), the value with its unit, and what was allowed. The command line
/// prints it to stderr and ends with exit_code().
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
  /// Documented exit code of the command line (docs/using/exit-codes.md).
  virtual int exit_code() const { return 1; }
};

/// An option, argument or setting is outside what is allowed. Exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 2; }
};

/// An input file is missing, unreadable, broken, or its unit can't be decided. Exit code 3.
class InputError : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 3; }
};

/// A numerical method found no answer where the caller can't go on without one. Exit code 4.
class NumericalError : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 4; }
};

/// A stated check failed (for instance `palmar product check`). Exit code 5.
class CheckFailed : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 5; }
};

/// A result can't be written (folder missing, no permission, disk full). Exit code 1.
class OutputError : public Error {
 public:
  using Error::Error;
};

/// The user cancelled; what was finished is kept. Exit code 130.
class Cancelled : public Error {
 public:
  using Error::Error;
  int exit_code() const override { return 130; }
};

}  // namespace palmar
