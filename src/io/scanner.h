// A cursor over the bytes of a mesh file held in memory: numbers by fast_float, no allocation per
// token. Lines are counted only when an error has to name one.
#pragma once

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "nonobtuse/error.h"

namespace nonobtuse::io {

/// Bytes and the name that error messages give them.
struct Source {
  std::string_view bytes;
  std::string name;
};

class Scanner {
 public:
  explicit Scanner(const Source& source)
      : source_(source),
        cursor_(source.bytes.data()),
        end_(source.bytes.data() + source.bytes.size()) {}

  [[nodiscard]] bool at_end() const { return cursor_ == end_; }
  [[nodiscard]] const char* position() const { return cursor_; }
  void set_position(const char* position) { cursor_ = position; }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - cursor_); }

  /// Blanks of one line; a backslash before the line's end continues it (OBJ).
  void skip_blanks() {
    while (cursor_ != end_) {
      const char c = *cursor_;
      if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v') {
        ++cursor_;
      } else if (c == '\\' && continuation() > 0) {
        cursor_ += continuation();
      } else {
        return;
      }
    }
  }

  /// End of the line's content: line break, comment or end of file. Call after skip_blanks.
  [[nodiscard]] bool at_line_end() const {
    return cursor_ == end_ || *cursor_ == '\n' || *cursor_ == '#';
  }

  void next_line() {
    const void* found =
        remaining() > 0 ? std::char_traits<char>::find(cursor_, remaining(), '\n') : nullptr;
    cursor_ = found != nullptr ? static_cast<const char*>(found) + 1 : end_;
  }

  /// Moves to the first content of this or a later line; false at the end of the file.
  bool next_content() {
    for (;;) {
      skip_blanks();
      if (cursor_ == end_) return false;
      if (!at_line_end()) return true;
      next_line();
    }
  }

  /// The characters up to the next blank or line end.
  std::string_view word() {
    skip_blanks();
    return rest_of_word();
  }

  /// The same without skipping blanks: empty if the cursor is at one.
  std::string_view rest_of_word() {
    const char* const begin = cursor_;
    while (cursor_ != end_ && static_cast<unsigned char>(*cursor_) > ' ' &&
           (*cursor_ != '\\' || continuation() == 0))
      ++cursor_;
    return {begin, static_cast<std::size_t>(cursor_ - begin)};
  }

  /// A number of this line; it may be infinite or not a number.
  double number(const char* what) {
    skip_blanks();
    if (at_line_end()) line_ends(what);
    const char* begin = cursor_;
    if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
    double value = 0;
    const auto [rest, error] = fast_float::from_chars(begin, end_, value);
    if (error == std::errc::invalid_argument || !ends_token(rest)) not_a_number(what);
    cursor_ = rest;
    return value;
  }

  std::int64_t integer(const char* what) {
    skip_blanks();
    if (at_line_end()) line_ends(what);
    const std::int64_t value = leading_integer(what);
    if (!ends_token(cursor_)) not_a_number(what);
    return value;
  }

  /// An integer that another character may follow ("7/1/2").
  std::int64_t leading_integer(const char* what) {
    const char* digit = cursor_;
    const bool negative = digit != end_ && *digit == '-';
    if (digit != end_ && (*digit == '-' || *digit == '+')) ++digit;
    const char* const first = digit;
    std::int64_t value = 0;
    for (; digit != end_ && *digit >= '0' && *digit <= '9'; ++digit)
      value = std::min<std::int64_t>(value * 10 + (*digit - '0'), std::int64_t{1} << 50);
    if (digit == first) not_a_number(what);
    cursor_ = digit;
    return negative ? -value : value;
  }

  /// Throws IoError for this line.
  [[noreturn]] void fail(const std::string& what) const { throw IoError(where() + what + "."); }
  /// Throws InvalidInput for this line.
  [[noreturn]] void fail_invalid(const std::string& what, Index element) const {
    throw InvalidInput(where() + what + ".", element);
  }

  /// "file.obj, line 7: " of the cursor.
  [[nodiscard]] std::string where() const { return where(cursor_); }
  [[nodiscard]] std::string where(const char* position) const {
    const auto line = 1 + std::count(source_.bytes.data(), position, '\n');
    return source_.name + ", line " + std::to_string(line) + ": ";
  }

 private:
  [[nodiscard]] bool ends_token(const char* c) const {
    return c == end_ || static_cast<unsigned char>(*c) <= ' ' || *c == '#' || *c == '\\';
  }
  /// Length of "\\\n" or "\\\r\n" at the cursor, 0 if there is none.
  [[nodiscard]] int continuation() const {
    if (end_ - cursor_ >= 2 && cursor_[1] == '\n') return 2;
    if (end_ - cursor_ >= 3 && cursor_[1] == '\r' && cursor_[2] == '\n') return 3;
    return 0;
  }
  [[noreturn]] void line_ends(const char* what) const {
    const std::string missing = std::string(" ends where ") + what + " should be";
    if (at_end()) fail("the file" + missing + ": it is truncated");
    fail("the line" + missing);
  }
  [[noreturn]] void not_a_number(const char* what) {
    std::string token;
    for (const char c : word().substr(0, 20)) token += c >= ' ' && c < 127 ? c : '?';
    fail("'" + token + "' stands where " + what + " should be");
  }

  const Source& source_;
  const char* cursor_;
  const char* end_;
};

}  // namespace nonobtuse::io
