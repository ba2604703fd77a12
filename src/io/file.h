// Whole files to and from memory.
#pragma once

#include <string>
#include <string_view>

namespace nonobtuse::io {

/// The bytes of a file. Throws IoError: missing, a directory, not readable.
std::string read_file(const std::string& path);

/// Replaces the file by `bytes`: written beside it under a temporary name, then renamed, so that
/// no reader ever sees half a file; on failure nothing is left behind. Symbolic links are followed,
/// permissions kept; devices and pipes are written directly. Throws IoError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace nonobtuse::io
