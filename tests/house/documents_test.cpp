// What the documents point to exists, the README's C++ example compiles, and no file of the project
// holds a path of somebody's machine.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "house/source_tree.h"

namespace {

std::vector<std::string> documents() {
  std::vector<std::string> files;
  for (const std::string& file : house::project_files())
    if (house::ends_with(file, ".md")) files.push_back(file);
  return files;
}

// All first groups of `pattern` in `text`.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

TEST(Documents, LinksLeadSomewhere) {
  ASSERT_FALSE(documents().empty());
  for (const std::string& file : documents()) {
    const std::filesystem::path folder = (house::root() / file).parent_path();
    for (const std::string& link : matches(house::read_text(file), R"(\]\(([^)\s#]+)[^)]*\))")) {
      if (house::starts_with(link, "http")) continue;
      EXPECT_TRUE(std::filesystem::exists(folder / link)) << file << " links to " << link;
    }
  }
}

// `src/rvd/clip.cpp` in backticks is a promise that the file is there.
TEST(Documents, NamedFilesExist) {
  const std::string pattern =
      "`((?:src|include|tests|tool|bench|scripts|docs|cmake|\\.ci)/[A-Za-z0-9_./-]+)`";
  for (const std::string& file : documents())
    for (const std::string& name : matches(house::read_text(file), pattern))
      EXPECT_TRUE(std::filesystem::exists(house::root() / name)) << file << " names " << name;
}

// A test named as `Suite.Name` in docs/pipeline.md is defined in some test file.
TEST(Documents, NamedTestsExist) {
  std::string tests;
  for (const std::string& file : house::project_files())
    if (house::starts_with(file, "tests/") && house::ends_with(file, ".cpp"))
      tests += house::read_text(file);
  for (const std::string& name :
       matches(house::read_text("docs/pipeline.md"), "`([A-Z][A-Za-z0-9]+\\.[A-Z][A-Za-z0-9]+)`")) {
    const std::size_t dot = name.find('.');
    const std::regex definition("TEST(_F|_P)?\\(\\s*" + name.substr(0, dot) + ",\\s*" +
                                name.substr(dot + 1) + "\\)");
    EXPECT_TRUE(std::regex_search(tests, definition)) << "docs/pipeline.md names test " << name;
  }
}

TEST(Documents, TheReadmeExampleIsTheCompiledOne) {
  const std::string example = house::read_text("tests/house/example/readme_example.cpp");
  const std::string begin = "// README begins\n";
  const std::size_t from = example.find(begin) + begin.size();
  const std::string code = example.substr(from, example.find("// README ends") - from);
  EXPECT_GT(code.size(), 100U);
  EXPECT_NE(house::read_text("README.md").find("```cpp\n" + code + "```"), std::string::npos)
      << "README.md must hold the example of tests/house/example/readme_example.cpp";
}

TEST(Documents, NoMachinePaths) {
  // Put together here, or this file would hold them itself.
  const std::regex machine_path(std::string("(^|[^A-Za-z0-9_.])/(") + "work" + "|home|root|Users)" +
                                "/");
  for (const std::string& file : house::project_files()) {
    const std::string text = house::read_text(file);
    EXPECT_FALSE(std::regex_search(text, machine_path)) << file;
  }
}

TEST(Documents, TheVersionIsTheSameEverywhere) {
  const auto version =
      matches(house::read_text("include/nonobtuse/version.h"), "NONOBTUSE_VERSION \"([^\"]+)\"");
  ASSERT_EQ(version.size(), 1U);
  EXPECT_NE(house::read_text("CITATION.cff").find("version: " + version[0] + "\n"),
            std::string::npos);
}

}  // namespace
