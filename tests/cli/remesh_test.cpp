// The main command from file to certified file: promises, determinism, reports, Ctrl-C.
#include <csignal>

#include "cli/run_tool.h"

namespace {

using cli::Outcome;
using cli::run_tool;
using Remesh = cli::ToolTest;

TEST_F(Remesh, GivesWhatItPromises) {
  const std::string in = sample();
  const std::string out = path("out.obj");
  const Outcome outcome = run_tool({"remesh", in, "-o", out, "--vertices", "700"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress where there is no terminal
  EXPECT_NE(outcome.out.find("certified: every angle"), std::string::npos);
  for (const char* word : {"before", "after", "Q_avg", "d_RMS", "d_H"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  EXPECT_EQ(run_tool({"certify", out, "--min-angle", "40", "--max-angle", "80"}).exit_code, 0);
  const auto json = cli::measured(out);
  EXPECT_EQ(json["vertices"], 700);
  EXPECT_EQ(json["topology"]["euler_characteristic"], -4);
  EXPECT_EQ(json["topology"]["components"], 1);
  EXPECT_EQ(json["topology"]["nonmanifold_edges"], 0);
  EXPECT_EQ(json["topology"]["nonmanifold_vertices"], 0);
  EXPECT_EQ(json["topology"]["oriented"], true);
}

TEST_F(Remesh, SameBytesForAnyThreadsAndEveryRun) {
  const std::string in = sample();
  const auto bytes = [&](const std::string& threads, const std::string& out) {
    const Outcome outcome =
        run_tool({in, "-o", path(out), "--vertices", "900", "--threads", threads, "--quiet"});
    EXPECT_LE(outcome.exit_code, 1) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");  // --quiet
    return cli::read_file(path(out));
  };
  const std::string one = bytes("1", "1.obj");
  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(bytes("2", "2.obj") == one);
  EXPECT_TRUE(bytes("5", "5.obj") == one);
  EXPECT_TRUE(bytes("1", "again.obj") == one);
}

TEST_F(Remesh, SeedsDiffer) {
  const std::string in = sample();
  for (const char* seed : {"1", "2"})
    run_tool({in, "-o", path(std::string(seed) + ".off"), "--vertices", "500", "--seed", seed});
  EXPECT_FALSE(cli::read_file(path("1.off")).empty());
  EXPECT_NE(cli::read_file(path("1.off")), cli::read_file(path("2.off")));
}

TEST_F(Remesh, TheWordMayBeLeftOutAndTheInputOverwritten) {
  const std::string in = sample();
  ASSERT_EQ(run_tool({"remesh", in, "-o", path("a.obj"), "--vertices", "600"}).exit_code, 0);
  ASSERT_EQ(run_tool({in, "-o", in, "--vertices", "600"}).exit_code, 0);
  EXPECT_EQ(cli::read_file(in), cli::read_file(path("a.obj")));
}

// The certificate is that of the file: binary STL holds floats.
TEST_F(Remesh, CertifiesTheFileItWrites) {
  const std::string in = sample();
  for (const char* name : {"out.stl", "out.ply", "out.off"}) {
    const Outcome outcome = run_tool({in, "-o", path(name), "--vertices", "600", "--json"});
    const auto json = nlohmann::json::parse(outcome.out, nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << outcome.out << outcome.err;
    const bool certified =
        run_tool({"certify", path(name), "--min-angle", "40", "--max-angle", "80"}).exit_code == 0;
    EXPECT_EQ(json["goal"]["certified"], certified) << name;
    EXPECT_EQ(outcome.exit_code, certified ? 0 : 1) << name;
  }
}

TEST_F(Remesh, AnglesOutsideTheBoundsAskedForAreExitOne) {
  const std::string in = sample();
  const std::string out = path("out.obj");
  // No mesh of 601 vertices on genus 3 has all angles in [59.9, 60.1).
  const Outcome outcome =
      run_tool({in, "-o", out, "--vertices", "601", "--min-angle", "59.9", "--max-angle", "60.1"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_TRUE(cli::exists(out));
  EXPECT_NE(outcome.out.find("not certified"), std::string::npos);
  EXPECT_NE(outcome.out.find("  triangle "), std::string::npos);  // says where
}

TEST_F(Remesh, ReportsJson) {
  const std::string in = sample();
  const Outcome outcome =
      run_tool({in, "-o", path("out.ply"), "--edge-length", "5%", "--seed", "7", "--json"});
  const auto json = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << outcome.out << outcome.err;
  EXPECT_EQ(json["exit_code"], outcome.exit_code);
  EXPECT_EQ(json["options"]["seed"], 7);
  EXPECT_NEAR(json["options"]["relative_edge_length"].get<double>(), 0.05, 1e-15);
  for (const char* key :
       {"status", "before", "after", "goal", "promise", "repairs", "stages", "distance", "seconds"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["after_vertices"], cli::measured(path("out.ply"))["vertices"]);
}

// Iterations 0, 1, 2, ... of every stage; watching changes nothing.
TEST_F(Remesh, ReportsTheHistoryOfThePapersMethods) {
  const std::string in = sample();
  const auto run = [&](const char* out, bool history) {
    std::vector<std::string> arguments{in,         "-o",     path(out),      "--vertices",
                                       "500",      "--json", "--iterations", "4",
                                       "--method", "cvt-nob"};
    if (history) arguments.push_back("--history");
    return nlohmann::json::parse(run_tool(arguments).out, nullptr, false);
  };
  const auto json = run("out.off", true);
  ASSERT_FALSE(json.is_discarded());
  std::vector<std::string> seen;
  for (const auto& record : json["history"])
    seen.push_back(record["stage"].get<std::string>() + ' ' +
                   std::to_string(record["iteration"].get<int>()));
  std::vector<std::string> expected;
  for (const char* stage : {"cvt", "obtuse removal", "feature-sensitive"})
    for (int k = 0; k <= 4; ++k) expected.push_back(std::string(stage) + ' ' + std::to_string(k));
  EXPECT_EQ(seen, expected);
  EXPECT_GT(json["history"][0]["obtuse"], json["history"][4]["obtuse"]);
  EXPECT_FALSE(run("again.off", false).contains("history"));
  EXPECT_EQ(cli::read_file(path("out.off")), cli::read_file(path("again.off")));
}

// The data and the page that shows them; neither changes the mesh.
TEST_F(Remesh, WritesAReport) {
  const std::string in = path("a <b> 'c'.off");  // names that a page and a shell must quote
  std::filesystem::rename(sample(), path("in.obj"));
  run_tool({"convert", path("in.obj"), in});
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{in, "-o", path("out.ply"), "--vertices", "500", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_tool(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");
    return cli::read_file(path("out.ply"));
  };
  const std::string plain = run({});
  EXPECT_TRUE(run({"--report", path("r.json")}) == plain);
  EXPECT_TRUE(run({"--report", path("r.html")}) == plain);
  const auto json = nlohmann::json::parse(cli::read_file(path("r.json")), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  EXPECT_EQ(json["input"], in);
  EXPECT_EQ(json["meshes"]["after"]["vertices"]["shape"], nlohmann::json({500, 3}));
  EXPECT_EQ(json["meshes"]["before"]["distance"]["shape"][0], json["before_vertices"]);
  EXPECT_FALSE(json["history"].empty());
  EXPECT_NE(json["command_line"].get<std::string>().find("'\\''c'\\''"), std::string::npos);

  const std::string page = cli::read_file(path("r.html"));
  const std::string begin = "<script type=\"application/json\" id=\"report\">";
  const std::size_t from = page.find(begin) + begin.size();
  const std::string data = page.substr(from, page.find("</script>", from) - from);
  const auto shown = nlohmann::json::parse(data, nullptr, false);
  ASSERT_FALSE(shown.is_discarded());
  EXPECT_EQ(shown["meshes"], json["meshes"]);
  EXPECT_EQ(data.find('<'), std::string::npos);
  EXPECT_EQ(page.find("@REPORT@"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("r.html.part")));
}

TEST_F(Remesh, AReportThatCannotBeWrittenIsSaid) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  std::filesystem::create_symlink("/dev/full", path("r.json"));
  const Outcome outcome = run_tool({sample(), "-o", path("out.off"), "--vertices", "500", "--quiet",
                                    "--no-distance", "--report", path("r.json")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(cli::is_one_sentence(outcome));
  EXPECT_NE(outcome.err.find("r.json"), std::string::npos);
}

TEST_F(Remesh, ReportsRepairs) {
  // Two triangles of a tetrahedron as they are, one face the wrong way round.
  cli::write_file(path("in.obj"),
                  "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nv 5 5 5\n"
                  "f 1 2 3\nf 1 4 2\nf 1 4 3\nf 2 4 3\n");
  const Outcome outcome = run_tool({path("in.obj"), "-o", path("out.obj"), "--vertices", "60"});
  EXPECT_LE(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("in.obj: 1 "), std::string::npos) << outcome.out;
}

TEST_F(Remesh, TooFewVerticesIsBadInputWithTheLeastNumber) {
  const Outcome outcome = run_tool({sample(), "-o", path("out.obj"), "--vertices", "5"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_TRUE(cli::is_one_sentence(outcome));
  EXPECT_NE(outcome.err.find_first_of("0123456789"), std::string::npos) << outcome.err;
  EXPECT_FALSE(cli::exists(path("out.obj")));
}

TEST_F(Remesh, ProgressIsReportedWhereAskedFor) {
  const Outcome outcome =
      run_tool({sample(), "-o", path("out.obj"), "--vertices", "500", "--progress"});
  EXPECT_NE(outcome.err.find(" %"), std::string::npos);
}

TEST_F(Remesh, CtrlCWritesAValidMesh) {
  const std::string in = sample(100);
  const std::string out = path("out.obj");
  bool sent = false;
  const Outcome outcome = run_tool({in, "-o", out, "--vertices", "60000", "--progress"}, 60,
                                   [&sent](int pid, const std::string& err) {
                                     // The first line of progress: the work has begun.
                                     if (sent || err.find('\n') == std::string::npos) return;
                                     kill(pid, SIGINT);
                                     sent = true;
                                   });
  ASSERT_TRUE(sent);
  EXPECT_FALSE(outcome.timed_out);
  ASSERT_EQ(outcome.exit_code, 4) << outcome.out << outcome.err;
  ASSERT_TRUE(cli::exists(out));
  const auto topology = cli::measured(out)["topology"];
  EXPECT_EQ(topology["euler_characteristic"], -4);
  EXPECT_EQ(topology["components"], 1);
  EXPECT_EQ(topology["boundary_loops"], 0);
  EXPECT_EQ(topology["nonmanifold_edges"], 0);
  EXPECT_EQ(topology["nonmanifold_vertices"], 0);
}

}  // namespace
