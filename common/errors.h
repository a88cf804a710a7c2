// What can go wrong with what a user hands in. Everything else is either our bug (assert) or "nothing found" (an empty result).
//
// Thrown only in read_*, write_* and check*; caught once in each main(), printed as `foresight: FILE: cause; what to do`.
#pragma once

#include <stdexcept>
#include <string>

namespace foresight {

// Process exit codes of both binaries. A promise to users, see README.
enum ExitCode : int {
  kExitDone = 0,             // done; something recognized in at least one scan
  kExitNothingFound = 1,     // ran well, nothing recognized
  kExitUsage = 2,            // wrong command line
  kExitBadInput = 3,         // a file that cannot be used
  kExitBadDatabase = 4,      // a bad, foreign or incompatible database
  kExitDeadline = 5,         // deadline reached, partial result printed
  kExitInternal = 70,        // our bug
};

// Base of all errors a user can cause and mend.
class Error : public std::runtime_error {
 public:
  // file: the path as the user gave it, or the option's name. cause: what is wrong. mend: what to do about it.
  Error(std::string file, std::string cause, std::string mend)
      : std::runtime_error(file + ": " + cause + "; " + mend),
        file_(std::move(file)), cause_(std::move(cause)), mend_(std::move(mend)) {}
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& cause() const { return cause_; }
  [[nodiscard]] const std::string& mend() const { return mend_; }
  [[nodiscard]] virtual int exit_code() const = 0;

 private:
  std::string file_, cause_, mend_;
};

// A command line or an option value outside its limits.
class UsageError : public Error {
 public:
  using Error::Error;
  [[nodiscard]] int exit_code() const override { return kExitUsage; }
};

// A CAD, scan, camera, pose or sensor file that cannot be used.
class InputError : public Error {
 public:
  using Error::Error;
  [[nodiscard]] int exit_code() const override { return kExitBadInput; }
};

enum class DatabaseFault { wrong_kind, newer_version, truncated, corrupt, inconsistent, incompatible };

// A database that cannot be used, and in which way.
class DatabaseError : public Error {
 public:
  DatabaseError(DatabaseFault fault, std::string file, std::string cause, std::string mend)
      : Error(std::move(file), std::move(cause), std::move(mend)), fault_(fault) {}
  [[nodiscard]] DatabaseFault fault() const { return fault_; }
  [[nodiscard]] int exit_code() const override { return kExitBadDatabase; }

 private:
  DatabaseFault fault_;
};

}  // namespace foresight
