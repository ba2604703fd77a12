#include "house/source_tree.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace house {
namespace {

std::vector<std::string> tracked_files() {
  std::vector<std::string> files;
  const std::string command = "git -C '" + root().string() + "' ls-files -z 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return files;
  std::string name;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != 0) {
      name += static_cast<char>(c);
    } else {
      if (std::filesystem::is_regular_file(root() / name)) files.push_back(name);
      name.clear();
    }
  }
  pclose(pipe);
  return files;
}

std::vector<std::string> walked_files() {
  std::vector<std::string> files;
  using Walker = std::filesystem::recursive_directory_iterator;
  for (Walker it(root()); it != Walker(); ++it) {
    const std::string name = it->path().lexically_relative(root()).generic_string();
    if (name == ".git" || starts_with(name, "build")) it.disable_recursion_pending();
    if (it->is_regular_file()) files.push_back(name);
  }
  return files;
}

}  // namespace

std::filesystem::path root() { return NONOBTUSE_SOURCE_DIR; }

std::vector<std::string> project_files() {
  std::vector<std::string> files = tracked_files();
  if (files.empty()) files = walked_files();
  std::sort(files.begin(), files.end());
  return files;
}

std::string read_text(const std::string& file) {
  std::ifstream stream(root() / file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

bool ends_with(const std::string& text, const std::string& suffix) {
  return text.size() >= suffix.size() &&
         text.compare(text.size() - suffix.size(), suffix.size(), suffix) == 0;
}

}  // namespace house
