// Part of nonobtuse, MIT licence. The exceptions of the public interface.
#pragma once

#include <stdexcept>
#include <string>

#include "nonobtuse/mesh.h"

namespace nonobtuse {

/// The input cannot be used. `what()` is one sentence: what is wrong, where, and what to do.
class InvalidInput : public std::runtime_error {
 public:
  explicit InvalidInput(const std::string& sentence, Index element = -1)
      : std::runtime_error(sentence), element_(element) {}

  /// Index (from 0) of the offending vertex, triangle or option entry; -1 where there is none.
  [[nodiscard]] Index element() const noexcept { return element_; }

 private:
  Index element_;
};

/// The topology of the surface needs more vertices than were asked for.
class TooFewVertices : public InvalidInput {
 public:
  TooFewVertices(const std::string& sentence, Index least)
      : InvalidInput(sentence), least_(least) {}

  /// The least number of vertices that was reached (an upper bound of what is needed).
  [[nodiscard]] Index least() const noexcept { return least_; }

 private:
  Index least_;
};

/// The distance asked for (RemeshOptions::max_error) was not reached within reason.
class ErrorBoundNotReached : public InvalidInput {
 public:
  ErrorBoundNotReached(const std::string& sentence, double reached)
      : InvalidInput(sentence), reached_(reached) {}

  /// The least distance that was reached, input units.
  [[nodiscard]] double reached() const noexcept { return reached_; }

 private:
  double reached_;
};

/// A file cannot be opened, read, parsed or written. `what()` names the file (and line, if text).
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nonobtuse
