#pragma once
// Errors carry a sentence, a source position where there is one, and a hint. Libraries throw them; only the application prints.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tsubu {

/// Where a value was written. Line and column count from 1; line 0 means "the file as a whole", an empty file "no file at all".
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;

  bool operator==(const SourcePosition&) const = default;
};

/// "scenes/hopper.toml:12:5", or without line and column when there are none.
std::string toString(const SourcePosition& position);

/// One complaint: a full sentence, where, and what to do about it (may be empty).
struct Diagnostic {
  SourcePosition position;
  std::string message;
  std::string hint;
};

/// "scenes/hopper.toml:12:5: message (hint)".
std::string toString(const Diagnostic& diagnostic);

/// What went wrong, in the words of the exit code of the program.
enum class ErrorKind {
  simulation = 1,  ///< the simulation failed: not a number, overlap, a grain too fast
  scene = 2,       ///< the scene or the command line is wrong
  files = 3,       ///< a file cannot be read or written
};

/// The one exception of tsubu: all the complaints at once, so that a user mends a file in one go.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::vector<Diagnostic> diagnostics);
  Error(ErrorKind kind, std::string message, std::string hint = {});

  ErrorKind kind() const { return kind_; }
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  ErrorKind kind_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace tsubu
