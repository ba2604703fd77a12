// The files of the project, for tests about the project itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace house {

std::filesystem::path root();

/// Tracked files, relative to the root, sorted; all files outside build folders where there is no
/// git checkout.
std::vector<std::string> project_files();

std::string read_text(const std::string& file);

bool starts_with(const std::string& text, const std::string& prefix);
bool ends_with(const std::string& text, const std::string& suffix);

}  // namespace house
