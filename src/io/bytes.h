// Numbers in the bytes of binary files, of either byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace nonobtuse::io {

/// The number stored at `bytes`; `swap` if its byte order is not the machine's.
template <class T>
T load(const char* bytes, bool swap = false) {
  char buffer[sizeof(T)];
  std::memcpy(buffer, bytes, sizeof(T));
  if (swap) std::reverse(buffer, buffer + sizeof(T));
  T value;
  std::memcpy(&value, buffer, sizeof(T));
  return value;
}

constexpr bool little_endian_machine = std::endian::native == std::endian::little;

/// Appends a number in little-endian order.
template <class T>
void store(std::string& out, T value) {
  char buffer[sizeof(T)];
  std::memcpy(buffer, &value, sizeof(T));
  if (!little_endian_machine) std::reverse(buffer, buffer + sizeof(T));
  out.append(buffer, sizeof(T));
}

}  // namespace nonobtuse::io
