#pragma once
// A TOML file as a tree in which every value knows where it was written, and which remembers what was read of it.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"

namespace tsubu::io {

/// A value of a document. Reading a member of a table marks it as read; what nobody has read in the end is an error of the file.
class Value {
 public:
  using Array = std::vector<Value>;
  using Table = std::vector<std::pair<std::string, Value>>;  ///< in the order as written
  /// A date or time of day: TOML has them, no scene does.
  struct Date {
    std::string text;
  };
  using Content = std::variant<bool, std::int64_t, double, std::string, Date, Array, Table>;

  const bool* boolean() const { return std::get_if<bool>(&content_); }
  const std::int64_t* integer() const { return std::get_if<std::int64_t>(&content_); }
  const double* real() const { return std::get_if<double>(&content_); }
  const std::string* text() const { return std::get_if<std::string>(&content_); }
  const Array* array() const { return std::get_if<Array>(&content_); }
  const Table* table() const { return std::get_if<Table>(&content_); }

  /// Where the value starts, or "--set path" when the command line gave it.
  const SourcePosition& position() const { return position_; }
  /// Where the key of this value starts; for elements of arrays, the value itself.
  const SourcePosition& keyPosition() const { return keyPosition_; }
  /// Such as "walls.hopper.motion"; elements of arrays by index, "output.size.0"; empty for the document itself.
  const std::string& path() const { return path_; }
  /// What it is, for messages: "the text 'abc'", "the number 3", "a table".
  std::string description() const;
  /// Came into being by an override of something inside it, where the file has nothing of that name.
  bool madeByOverride() const { return madeByOverride_; }

  /// The member of this table with this key, marked as read, or nullptr. Any key asked for counts as known.
  const Value* find(std::string_view key) const;
  /// Is there such a member? Marks nothing.
  bool has(std::string_view key) const;
  /// Adds a key that may be written here to the known ones, without reading it.
  void know(std::string_view key) const;
  /// Has this key been asked for?
  bool knows(std::string_view key) const;
  /// Has any key been asked for?
  bool knowsKeys() const { return !known_.empty(); }
  /// The member as by find(), but the key does not become a known one.
  const Value* findQuietly(std::string_view key) const;
  /// Gives up on this value: whatever is inside counts as read, because something else is wrong with it.
  void skip() const { skipped_ = true; }
  bool skipped() const { return skipped_; }

 private:
  friend class Document;
  friend struct Conversion;

  Content content_;
  SourcePosition position_, keyPosition_;
  std::string path_;
  bool madeByOverride_ = false;
  mutable bool read_ = false;
  mutable bool skipped_ = false;
  mutable std::vector<std::string> known_;
};

/// A document with the overrides of the command line in place.
class Document {
 public:
  /// Reads a file. Throws Error(files) when it cannot be read, Error(scene) with the position of a syntax error.
  static Document fromFile(const std::string& path);
  /// Parses a text; `name` takes the place of the file in positions. Throws Error(scene) with the position of a syntax error.
  static Document fromText(std::string_view text, const std::string& name);

  /// \brief Puts a value in place: "path.to.key=value".
  /// The value is TOML, or a text when it is not (`radius=2 mm`). Path segments are keys of tables; of arrays, the index from 0 or the
  /// `name` of an element. Missing keys are made: whether they are known is for the reader to say. Throws Error(scene) when the
  /// path leads through a value that has no parts, or to an element that does not exist.
  void set(std::string_view assignment);

  const Value& root() const { return root_; }
  /// One complaint for each value that nobody has read, with the nearest known key.
  std::vector<Diagnostic> unreadKeys() const;

 private:
  Value root_;
};

}  // namespace tsubu::io
