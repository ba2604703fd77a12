#include "io/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "nonobtuse/error.h"
#include "nonobtuse/io.h"

namespace nonobtuse::io {

namespace {

namespace fs = std::filesystem;

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

constexpr int kMostLinks = 40;

[[noreturn]] void fail(const std::string& path, const char* verb, int error) {
  throw IoError(path + ": cannot " + verb + ": " + std::strerror(error) + ".");
}

// What a symbolic link leads to, though there may be nothing yet.
fs::path behind_links(const std::string& path) {
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == kMostLinks) fail(path, "write", ELOOP);
    const fs::path next = fs::read_symlink(target, error);
    if (error) fail(path, "write", error.value());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

// A file that is replaced keeps its permissions, and one that must not be written stays.
void take_permissions(const fs::path& target, const std::string& path,
                      const std::string& temporary) {
  std::error_code error;
  if (!fs::exists(target, error)) return;
  if (!File(std::fopen(target.string().c_str(), "r+b"))) {
    const int cause = errno;
    std::remove(temporary.c_str());
    fail(path, "write", cause);
  }
  fs::permissions(temporary, fs::status(target, error).permissions(), error);
}

// Creates a file that did not exist, beside `target`; `name` gets its name.
File create_beside(const fs::path& target, const std::string& path, std::string& name) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = target.string() + "." + std::to_string(attempt) + ".tmp";
    if (std::FILE* const file = std::fopen(name.c_str(), "wbx")) return File(file);
    if (errno != EEXIST) fail(path, "write", errno);
  }
  throw IoError(path + ": cannot write: too many temporary files lie beside it.");
}

// Whether all went well, up to closing; errno says what did not.
bool write_all(File file, std::string_view bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() &&
                       std::fflush(file.get()) == 0;
  const int error = errno;
  const bool closed = std::fclose(file.release()) == 0;
  if (!written) errno = error;
  return written && closed;
}

}  // namespace

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw IoError(path + ": this is a directory, not a mesh file.");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "open", errno);
  std::string bytes;
  const auto size = fs::file_size(path, ignored);  // fails for pipes, which are read in pieces
  std::size_t filled = 0;
  bytes.resize(ignored ? 1 << 16 : static_cast<std::size_t>(size) + 1);
  for (;;) {
    const std::size_t got = std::fread(&bytes[filled], 1, bytes.size() - filled, file.get());
    filled += got;
    if (filled < bytes.size()) break;
    bytes.resize(2 * bytes.size());
  }
  if (std::ferror(file.get()) != 0) fail(path, "read", errno);
  bytes.resize(filled);
  return bytes;
}

void write_file(const std::string& path, std::string_view bytes) {
  std::error_code error;
  const fs::path target = behind_links(path);
  if (fs::is_directory(target, error)) throw IoError(path + ": cannot write: this is a directory.");
  const fs::path directory = target.parent_path();
  if (!directory.empty() && !fs::is_directory(directory, error))
    throw IoError(path + ": cannot write: the directory " + directory.string() +
                  " does not exist.");
  if (fs::exists(target, error) && !fs::is_regular_file(target, error)) {
    File device(std::fopen(path.c_str(), "wb"));
    if (!device || !write_all(std::move(device), bytes)) fail(path, "write", errno);
    return;
  }
  std::string temporary;
  File file = create_beside(target, path, temporary);
  take_permissions(target, path, temporary);
  if (!write_all(std::move(file), bytes)) {
    const int cause = errno;
    std::remove(temporary.c_str());
    fail(path, "write", cause);
  }
  fs::rename(temporary, target, error);
  if (error) {
    std::remove(temporary.c_str());
    throw IoError(path + ": cannot write: " + error.message() + ".");
  }
}

}  // namespace nonobtuse::io

namespace nonobtuse {

void write_file(const std::string& path, std::string_view bytes) { io::write_file(path, bytes); }

}  // namespace nonobtuse
