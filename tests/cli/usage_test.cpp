// The command line: help, versions, and every way to get it wrong (exit 2, before any work).
#include <regex>
#include <set>
#include <sstream>

#include "cli/run_tool.h"
#include "nonobtuse/version.h"

namespace {

using cli::Outcome;
using cli::run_tool;

TEST(Help, TeachesExamplesAndExitCodes) {
  const Outcome outcome = run_tool({"--help"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* word : {"Examples:", "Exit codes:", "remesh", "measure", "certify", "convert",
                           "sample", "--vertices", "cancelled"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
}

TEST(Help, OfACommandTellsItsOptions) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"remesh", "--help"}, {"in.stl", "--help"}}) {
    const Outcome outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* option :
         {"--output", "--vertices", "--edge-length", "--method", "--penalty", "--normal-weight",
          "--iterations", "--history", "--min-angle", "--max-angle", "--on-surface", "--seed",
          "--threads", "--quiet", "--progress", "--json", "--report"})
      EXPECT_NE(outcome.out.find(option), std::string::npos) << option;
  }
}

std::set<std::string> options_in(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::set<std::string> options;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    options.insert((*it)[1]);
  return options;
}

// What the help tells can be read in the README, and the other way round.
TEST(Help, TellsTheOptionsThatTheReadmeTells) {
  const std::string readme = cli::read_file(NONOBTUSE_SOURCE_DIR "/README.md");
  const std::size_t start = readme.find("| option of `remesh` |");
  ASSERT_NE(start, std::string::npos);
  std::istringstream table(readme.substr(start, readme.find("\n\n", start) - start));
  std::set<std::string> in_readme;
  for (std::string row; std::getline(table, row);)
    in_readme.merge(options_in(row.substr(0, row.find(" | ")), "(--[a-z][a-z-]*)"));
  std::set<std::string> in_help =
      options_in(run_tool({"remesh", "--help"}).out, "\n  (?:-[a-z],)?(--[a-z-]+)");
  in_help.erase("--help");
  in_help.erase("--output");  // `-o FILE` there
  EXPECT_EQ(in_readme, in_help);
}

TEST(Version, IsThatOfTheHeader) {
  const Outcome outcome = run_tool({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "nonobtuse " NONOBTUSE_VERSION "\n");
}

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  const char* named;  // what the sentence must name
};

class BadUsage : public testing::TestWithParam<Mistake> {};

// in.obj exists nowhere: a mistake of usage must be found before a file is opened.
TEST_P(BadUsage, IsOneSentenceAndExitTwo) {
  const Outcome outcome = run_tool(GetParam().arguments);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(cli::is_one_sentence(outcome));
  EXPECT_NE(outcome.err.find(GetParam().named), std::string::npos) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BadUsage,
    testing::Values(
        Mistake{"Nothing", {}, "--help"}, Mistake{"UnknownCommand", {"mesure", "a.obj"}, "mesure"},
        Mistake{"UnknownOption", {"in.obj", "-o", "out.obj", "--bogus"}, "--bogus"},
        Mistake{"NoOutput", {"in.obj"}, "--output"},
        Mistake{"NoInput", {"remesh", "-o", "out.obj"}, "input"},
        Mistake{"UnknownSuffix", {"in.obj", "-o", "out.xyz"}, "out.xyz"},
        Mistake{"NoSuffix", {"in.obj", "-o", "out"}, ".obj"},
        Mistake{"ConvertToUnknownSuffix", {"convert", "in.obj", "out.gltf"}, "out.gltf"},
        Mistake{"SampleToUnknownSuffix", {"sample", "-o", "out.txt"}, "out.txt"},
        Mistake{"NoSuchFolder", {"in.obj", "-o", "no/such/folder/out.obj"}, "no/such/folder"},
        Mistake{"VerticesNoNumber", {"in.obj", "-o", "o.obj", "--vertices", "many"}, "--vertices"},
        Mistake{"VerticesNegative", {"in.obj", "-o", "o.obj", "--vertices", "-5"}, "--vertices"},
        Mistake{"VerticesAndEdgeLength",
                {"in.obj", "-o", "o.obj", "--vertices", "10", "--edge-length", "1%"},
                "--vertices"},
        Mistake{"EdgeLengthNoNumber", {"in.obj", "-o", "o.obj", "--edge-length", "1cm"}, "1cm"},
        Mistake{"EdgeLengthZero", {"in.obj", "-o", "o.obj", "--edge-length", "0"}, "--edge-length"},
        Mistake{"EdgeLengthOnlySign", {"in.obj", "-o", "o.obj", "--edge-length", "%"}, "%"},
        Mistake{"EdgeLengthEmpty", {"in.obj", "-o", "o.obj", "--edge-length", ""}, "--edge-length"},
        Mistake{"UnknownMethod", {"in.obj", "-o", "o.obj", "--method", "magic"}, "--method"},
        Mistake{"NormalWeightBelowOne",
                {"in.obj", "-o", "o.obj", "--normal-weight", "0.5"},
                "--normal-weight"},
        Mistake{"IterationsOfTheDefault",
                {"in.obj", "-o", "o.obj", "--iterations", "10"},
                "--iterations"},
        Mistake{"SeamsWithoutFeatures",
                {"in.obj", "-o", "o.obj", "--keep-seams", "--features", "none"},
                "--keep-seams"},
        Mistake{"HistoryWithoutJson", {"in.obj", "-o", "o.obj", "--history"}, "--json"},
        Mistake{"ReportOfUnknownSuffix", {"in.obj", "-o", "o.obj", "--report", "r.txt"}, "r.txt"},
        Mistake{"NoFolderForTheReport",
                {"in.obj", "-o", "o.obj", "--report", "no/r.html"},
                "no/r.html"},
        Mistake{"MinAngleTooLarge", {"in.obj", "-o", "o.obj", "--min-angle", "60"}, "--min-angle"},
        Mistake{"MaxAngleTooSmall", {"in.obj", "-o", "o.obj", "--max-angle", "60"}, "--max-angle"},
        Mistake{"MaxAngleObtuse", {"certify", "in.obj", "--max-angle", "91"}, "--max-angle"},
        Mistake{"AngleNotANumber", {"in.obj", "-o", "o.obj", "--min-angle", "nan"}, "--min-angle"},
        Mistake{"ThreadsNegative", {"in.obj", "-o", "o.obj", "--threads", "-1"}, "--threads"},
        Mistake{
            "ResolutionTooSmall", {"sample", "-o", "o.obj", "--resolution", "3"}, "--resolution"}),
    [](const testing::TestParamInfo<Mistake>& mistake) { return std::string(mistake.param.name); });

}  // namespace
