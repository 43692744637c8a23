#include "server/runs/run_catalogue.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

struct Lab {
  test::TemporaryFolder folder{"runs"};
  Workspace workspace{folder.path(), {}};
  JobList jobs{"/bin/sleep", folder.path(), [] {}};
  Trash trash{workspace};
  RunCatalogue runs{workspace, jobs, trash};
  fs::path root = workspace.root();

  // 200 cells 150 px from their setpoint.
  void simulate(const std::string& name, const std::string& more = "") const {
    const Scenario s = read_scenario(parse_toml(fmt::format(R"(
title = "Run {}"
duration = "6 s"
camera = {{ rate = "20 Hz" }}
reference = {{ type = "hold", setpoint_px = [200, 240] }}
controller = {{ type = "proportional" }}
record = {{ video = false {} }}
[[swarm]]
count = 200
model = {{ type = "basic" }}
start = {{ type = "disc", radius_px = 20 }}
)",
                                                            name, more),
                                                "test.toml"),
                                     builtin_parts());
    RunOptions o;
    o.out = root / "runs" / name;
    o.threads = 1;
    Session session = Session::begin(s, 7, o);
    session.run();
    session.complete();
  }
};

Json named(const Json& list, const std::string& name) {
  for (const Json& run : list)
    if (run["name"] == name) return run;
  return {};
}

}  // namespace

TEST_CASE("the list of runs has what a table of runs shows") {
  Lab lab;
  lab.simulate("one");
  lab.simulate("part", ", from = 2, to = 4");
  write_file(lab.root / "runs/one.toml", "x");
  const Json list = lab.runs.list(), one = named(list, "one"), part = named(list, "part");
  REQUIRE(list.size() == 2);
  CHECK(one["title"] == "Run one");
  CHECK(one["seed"] == "7");
  CHECK(one["frames"] == 120);
  CHECK(one["duration_s"] == 6);
  CHECK(one["recorded_s"].is_null());
  CHECK(one["model"] == "basic");
  CHECK(one["controller"] == "proportional");
  CHECK(one["cells"] == 200);
  CHECK(one["date"].get<std::string>().ends_with("Z"));
  CHECK(one["measured"] == true);
  CHECK(one["has_setpoint"] == true);
  CHECK(one["steady_rms_px"].is_number());
  CHECK(one["bytes"] == lab.runs.size("one"));
  CHECK(one["writing"] == false);
  CHECK(part["frames"] == 40);
  CHECK(part["duration_s"] == 2);
  CHECK(part["recorded_s"] == Json{2.0, 4.0});
  CHECK(lab.runs.list() == list);  // from memory
}

TEST_CASE("tags and note are stored beside the run, not in its manifest") {
  Lab lab;
  lab.simulate("one");
  const std::string manifest = read_file(lab.root / "runs/one/manifest.json");
  (void)lab.runs.list();
  lab.runs.set_tags("one", {{"tags", {" drift ", "ageing", "drift"}}, {"note", "second drop"}});
  const Json one = named(lab.runs.list(), "one");
  CHECK(one["tags"] == Json{"drift", "ageing"});
  CHECK(one["note"] == "second drop");
  CHECK(read_file(lab.root / "runs/one/manifest.json") == manifest);
  for (const Json& bad :
       {Json{{"tags", "x"}}, Json{{"tags", {1}}}, Json{{"tags", {""}}}, Json{{"tags", {"a\nb"}}},
        Json{{"tags", {std::string(41, 'x')}}}, Json{{"note", 1}}, Json::array()})
    CHECK_THROWS_AS(lab.runs.set_tags("one", bad), const Error&);
  CHECK(named(lab.runs.list(), "one")["note"] == "second drop");
  CHECK_THROWS_AS(lab.runs.set_tags("none", {}), const Error&);
}

TEST_CASE("a run is renamed with its scenario; names in use are refused") {
  Lab lab;
  lab.simulate("one");
  lab.simulate("two");
  write_file(lab.root / "runs/one.toml", "x");
  CHECK_THROWS_WITH_AS(lab.runs.rename("one", "two"), doctest::Contains("the name two is already used"),
                       const Error&);
  CHECK_THROWS_WITH_AS(lab.runs.rename("one", "../"), doctest::Contains("at least one letter"), const Error&);
  CHECK(lab.runs.rename("one", "one") == "one");
  CHECK(lab.runs.rename("one", "../Drift of drop 2") == "Drift-of-drop-2");
  CHECK(fs::exists(lab.root / "runs/Drift-of-drop-2/series.csv"));
  CHECK(fs::exists(lab.root / "runs/Drift-of-drop-2.toml"));
  CHECK(lab.runs.list().size() == 2);
  for (const char* bad : {"none", "../runs/two", "two/tracks.h5", ".."})
    CHECK_THROWS_AS(lab.runs.rename(bad, "x"), const Error&);
}

TEST_CASE("a run that is being written or used by a job is not deleted") {
  Lab lab;
  lab.simulate("one");
  {
    const RunLock writing(lab.root / "runs/one", "");
    CHECK(named(lab.runs.list(), "one")["writing"] == true);
    CHECK_THROWS_WITH_AS(lab.runs.remove("one"), doctest::Contains("a process is writing this run"),
                         const Error&);
    CHECK_THROWS_AS(lab.runs.rename("one", "two"), const Error&);
  }
  const int running = lab.jobs.add({.title = "first", .words = {"1000"}, .page = "a", .out = "b"});
  // As the page starts jobs, in the queue.
  for (const char* word : {"./runs/one", "--reference=./runs/one", "./runs/one.toml"}) {
    const int job =
        lab.jobs.add({.title = "compare: one", .words = {"compare", word}, .page = "a", .out = "b"});
    CHECK_THROWS_WITH_AS(lab.runs.remove("one"), doctest::Contains("the job \"compare: one\" uses this run"),
                         const Error&);
    lab.jobs.cancel(job);
  }
  lab.jobs.cancel(running);
  while (lab.jobs.jobs()[0].state <= Job::State::running) usleep(10000);
  // It is interrupted, but no process writes it.
  CHECK(named(lab.runs.list(), "one")["complete"] == false);
  const std::uint64_t bytes = lab.runs.size("one");
  const Trash::Item item = lab.runs.remove("one");
  CHECK(item.bytes == bytes);
  CHECK(lab.runs.list().empty());
  lab.trash.undo(item.id);
  CHECK(lab.runs.list().size() == 1);
}

TEST_CASE("a thousand runs are listed in well under a second") {
  Lab lab;
  lab.simulate("run-0");
  for (int i = 1; i < 1000; ++i)
    fs::copy(lab.root / "runs/run-0", lab.root / fmt::format("runs/run-{}", i), fs::copy_options::recursive);
  // Processor time, because other processes use the machine as well.
  const auto seconds_of_list = [&](Json& list) {
    const std::clock_t began = std::clock();
    list = lab.runs.list();
    return double(std::clock() - began) / CLOCKS_PER_SEC;
  };
  Json list;
  double longest = 0, total = 0;
  int calls = 0;
  bool measured = false;
  for (; !measured; ++calls) {
    REQUIRE(calls < 1000);
    const double seconds = seconds_of_list(list);
    longest = std::max(longest, seconds);
    total += seconds;
    REQUIRE(list.size() == 1000);
    measured = std::all_of(list.begin(), list.end(), [](const Json& run) { return run["measured"] == true; });
  }
  const double known = seconds_of_list(list);
  MESSAGE(calls, " lists until all runs are measured, ", total, " s, the longest ", longest, " s; then ",
          known, " s");
  // Several times what a program without optimisation needs.
  CHECK(longest < 2);
  CHECK(known < 0.5);
}
