// Includes point only downward: tool -> remesh -> {refine, energy, optimize, rdt, features, sizing}
// -> rvd -> {mesh, spatial} -> {numeric, parallel}; quality, io and sample sit beside remesh and
// use nothing above {mesh, spatial}.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "house/source_tree.h"

namespace {

// Folder of src/ -> height.
const std::map<std::string, int> kHeights{
    {"numeric", 0},    {"parallel", 0}, {"mesh", 1},     {"spatial", 1},
    {"attributes", 1}, {"rvd", 2},      {"refine", 3},   {"energy", 3},
    {"optimize", 3},   {"rdt", 3},      {"features", 3}, {"sizing", 3},
    {"remesh", 4},     {"quality", 4},  {"io", 4},       {"sample", 4}};
const std::set<std::string> kBesideRemesh{"quality", "io", "sample"};

// Folders that `file` includes headers of, by its lines #include "folder/...".
std::set<std::string> included_folders(const std::string& file) {
  static const std::regex pattern("#include \"([a-z_]+)/[^\"]*\"");
  std::set<std::string> folders;
  std::istringstream text(house::read_text(file));
  for (std::string line; std::getline(text, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) folders.insert(match[1]);
  }
  return folders;
}

bool is_source(const std::string& file) {
  return house::ends_with(file, ".h") || house::ends_with(file, ".cpp");
}

std::string folder_of(const std::string& file) {  // "src/rvd/clip.cpp" -> "rvd"
  const std::size_t begin = file.find('/') + 1;
  return file.substr(begin, file.find('/', begin) - begin);
}

// Folder -> folders it includes, over all of src/.
std::map<std::string, std::set<std::string>> folder_graph() {
  std::map<std::string, std::set<std::string>> graph;
  for (const std::string& file : house::project_files()) {
    if (!house::starts_with(file, "src/") || !is_source(file)) continue;
    std::set<std::string> folders = included_folders(file);
    folders.erase("nonobtuse");
    folders.erase(folder_of(file));
    graph[folder_of(file)].insert(folders.begin(), folders.end());
  }
  return graph;
}

TEST(Layering, EveryFolderOfSrcHasItsPlace) {
  const auto graph = folder_graph();
  EXPECT_FALSE(graph.empty());
  for (const auto& [folder, included] : graph)
    EXPECT_TRUE(kHeights.contains(folder)) << "src/" << folder << " is in no layer";
}

TEST(Layering, IncludesPointDownward) {
  for (const auto& [folder, included] : folder_graph()) {
    for (const std::string& other : included) {
      ASSERT_TRUE(kHeights.contains(other)) << "src/" << folder << " includes " << other << "/";
      const int limit = kBesideRemesh.contains(folder) ? 1 : kHeights.at(folder);
      EXPECT_LE(kHeights.at(other), limit) << "src/" << folder << " includes src/" << other;
    }
  }
}

TEST(Layering, NoTwoFoldersIncludeEachOther) {
  const auto graph = folder_graph();
  // Depth-first: a folder that is reached again from itself lies on a cycle.
  for (const auto& [start, first] : graph) {
    std::set<std::string> reached;
    std::vector<std::string> open(first.begin(), first.end());
    while (!open.empty()) {
      const std::string folder = open.back();
      open.pop_back();
      if (!reached.insert(folder).second || !graph.contains(folder)) continue;
      const auto& next = graph.at(folder);
      open.insert(open.end(), next.begin(), next.end());
    }
    EXPECT_FALSE(reached.contains(start)) << "src/" << start << " includes itself through others";
  }
}

TEST(Layering, PublicHeadersStandAlone) {
  for (const std::string& file : house::project_files()) {
    if (!house::starts_with(file, "include/")) continue;
    for (const std::string& folder : included_folders(file)) EXPECT_EQ(folder, "nonobtuse") << file;
    EXPECT_EQ(house::read_text(file).find("Eigen"), std::string::npos) << file;
  }
}

TEST(Layering, TheToolUsesThePublicHeadersAlone) {
  for (const std::string& file : house::project_files()) {
    if (!house::starts_with(file, "tool/") || !is_source(file)) continue;
    for (const std::string& folder : included_folders(file)) EXPECT_EQ(folder, "nonobtuse") << file;
  }
}

}  // namespace
