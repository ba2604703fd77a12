// measure, certify, convert, sample, and inputs that cannot be read (exit 3).
#include <algorithm>

#include "cli/run_tool.h"

namespace {

using cli::Outcome;
using cli::run_tool;
using Commands = cli::ToolTest;
using BadInput = cli::ToolTest;

constexpr const char* kTetrahedron =
    "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";

TEST_F(Commands, MeasureTellsTheTruthAboutATetrahedron) {
  cli::write_file(path("t.obj"), kTetrahedron);
  const auto json = cli::measured(path("t.obj"));
  EXPECT_EQ(json["vertices"], 4);
  EXPECT_EQ(json["angles"]["obtuse"], 0);
  EXPECT_NEAR(json["angles"]["quality_min"].get<double>(), 1, 1e-12);
  EXPECT_NEAR(json["angles"]["max_angle"].get<double>(), 60, 1e-9);
  EXPECT_EQ(json["topology"]["euler_characteristic"], 2);
  EXPECT_EQ(json["topology"]["boundary_loops"], 0);
  EXPECT_EQ(json["self_intersections"], 0);
  EXPECT_FALSE(json.contains("distance"));
}

TEST_F(Commands, MeasureAgainstItselfIsZero) {
  const std::string file = sample();
  const Outcome outcome = run_tool({"measure", file, "--against", file, "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_LT(json["distance"]["hausdorff"].get<double>(),
            1e-9 * json["distance"]["diagonal"].get<double>());
  EXPECT_EQ(json["flipped"], 0);
  EXPECT_EQ(json["topology"]["euler_characteristic"], -4);
  EXPECT_GT(json["angles"]["obtuse"].get<int>(), 0);
}

TEST_F(Commands, MeasurePrintsEveryFigureAsATable) {
  const std::string file = sample();
  const Outcome outcome = run_tool({"measure", file, "--against", file});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* row : {"vertices", "obtuse", "Q_min", "Q_avg", "smallest angle", "largest angle",
                          "< 30", ">= 90", "valence", "d_RMS", "d_H", "Euler characteristic"})
    EXPECT_NE(outcome.out.find(row), std::string::npos) << row;
}

TEST_F(Commands, CertifySaysYesOnlyToGoodMeshes) {
  cli::write_file(path("t.obj"), kTetrahedron);
  const Outcome good = run_tool({"certify", path("t.obj")});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("certified: every angle"), std::string::npos);
  const Outcome bad = run_tool({"certify", sample()});
  EXPECT_EQ(bad.exit_code, 1) << bad.err;
  EXPECT_NE(bad.out.find("not certified"), std::string::npos);
  EXPECT_NE(bad.out.find("  triangle "), std::string::npos);
}

// A right angle is not below 90 degrees, however it is rounded.
TEST_F(Commands, CertifyRefusesARightAngle) {
  cli::write_file(path("r.obj"), "v 0.1 0.1 0.3\nv 1.1 0.1 0.3\nv 0.1 0.9 0.3\nf 1 2 3\n");
  EXPECT_EQ(run_tool({"certify", path("r.obj")}).exit_code, 1);
  const Outcome json = run_tool({"certify", path("r.obj"), "--json"});
  EXPECT_EQ(json.exit_code, 1);
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["certified"], false);
  EXPECT_EQ(report["too_large"], 1);
  EXPECT_EQ(report["worst_too_large"][0]["triangle"], 0);
}

TEST_F(Commands, CertifyObeysItsBounds) {
  // Angles 45 (twice) and just below 90.
  cli::write_file(path("i.obj"), "v 0 0 0\nv 1 0 0\nv 0.001 1 0\nf 1 2 3\n");
  EXPECT_EQ(run_tool({"certify", path("i.obj")}).exit_code, 0);
  EXPECT_EQ(run_tool({"certify", path("i.obj"), "--min-angle", "50"}).exit_code, 1);
  EXPECT_EQ(run_tool({"certify", path("i.obj"), "--max-angle", "80"}).exit_code, 1);
}

TEST_F(Commands, ConvertKeepsEveryBitOfTheCoordinates) {
  const std::string file = sample();
  for (const char* format : {"a.ply", "b.off", "c.ply", "d.off"}) {
    std::vector<std::string> arguments{"convert", file, path(format)};
    if (std::string(format) == "c.ply") arguments.push_back("--ascii");
    const Outcome there = run_tool(arguments);
    ASSERT_EQ(there.exit_code, 0) << there.err;
    const Outcome back = run_tool({"convert", path(format), path("back.obj")});
    ASSERT_EQ(back.exit_code, 0) << back.err;
    EXPECT_EQ(cli::read_file(path("back.obj")), cli::read_file(file)) << format;
  }
}

TEST_F(Commands, ConvertReadsByContentWhereTheSuffixLies) {
  const std::string file = sample();
  std::filesystem::copy_file(file, path("liar.stl"));
  const Outcome outcome = run_tool({"convert", path("liar.stl"), path("out.obj")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(cli::read_file(path("out.obj")), cli::read_file(file));
}

TEST_F(BadInput, MissingFileIsNamed) {
  for (const char* command : {"measure", "certify"}) {
    const Outcome outcome = run_tool({command, path("absent.obj")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(cli::is_one_sentence(outcome));
    EXPECT_NE(outcome.err.find("absent.obj"), std::string::npos);
  }
}

TEST_F(BadInput, LeavesAnExistingOutputAlone) {
  cli::write_file(path("in.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  cli::write_file(path("out.obj"), "precious");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{path("in.obj"), "-o", path("out.obj")},
                                             {"convert", path("in.obj"), path("out.obj")},
                                             {path("absent.obj"), "-o", path("out.obj")}}) {
    const Outcome outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(cli::is_one_sentence(outcome));
    EXPECT_EQ(cli::read_file(path("out.obj")), "precious");
  }
  // Nothing temporary is left behind.
  const auto begin = std::filesystem::directory_iterator(folder_);
  EXPECT_EQ(std::count_if(begin, {}, [](const auto&) { return true; }), 2);
}

TEST_F(BadInput, AFolderIsNoMesh) {
  const Outcome outcome = run_tool({"measure", folder_.string()});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(cli::is_one_sentence(outcome));
}

}  // namespace
