// A study on an engine of the test, whose workers fail in every way.
#include "study/engines/engine_run.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "study/engines/chunk_size.h"
#include "study/engines/engine_settings.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

/// Computes attempts when they are submitted. A task in `dies` ends its worker `times` times; a task in
/// `fails` always fails.
class TestEngine final : public Engine {
 public:
  TestEngine(std::uint64_t key, std::uint64_t first) : key_(key), first_(first) {}
  std::map<std::uint64_t, int> dies;
  std::set<std::uint64_t> fails;
  int exit_of_all = 0;
  int lost = 0;      ///< workers that end before they start, such as those of a host that is not reached
  int refusals = 0;  ///< submissions that are not accepted at first

  unsigned slots() const override { return 2; }
  double period_s() const override { return 0.001; }
  void cancel() override {}
  bool submit(std::span<const Attempt> attempts) override {
    if (refusals-- > 0) {
      refused_.push_back(attempts.front().results);
      return false;
    }
    for (const Attempt& a : attempts) ends_.push_back(run(a));
    if (!refused_.empty()) CHECK(refused_.back() == attempts.front().results);  // no new files for a retry
    refused_.clear();
    return true;
  }
  std::vector<AttemptEnd> ended() override { return std::exchange(ends_, {}); }

 private:
  AttemptEnd run(const Attempt& a) {
    if (lost-- > 0) return {a.id, "exit code 255", 255};
    if (exit_of_all != 0) return {a.id, "exit code " + std::to_string(exit_of_all), exit_of_all};
    ResultFile file(a.results, "study");
    for (const std::uint64_t number : numbers_in(a.tasks)) {
      if (dies.contains(number) && dies[number]-- > 0) return {a.id, "signal 9", -1};
      const std::vector<double> values{double(number - first_)};
      if (fails.contains(number))
        file.add({{key_, number - first_}, 0.001, {}, "no cells"});
      else
        file.add({{key_, number - first_}, 0.001, values, {}});
    }
    file.complete();
    return {a.id, "exit code 0", 0};
  }
  std::uint64_t key_, first_;
  std::vector<AttemptEnd> ends_;
  std::vector<std::filesystem::path> refused_;
};

/// A round of 50 tasks in a folder.
struct Study {
  test::TemporaryFolder folder{"engine"};
  ResultStore store{folder.path() / "results", "study"};
  Round round{"tasks", 50, {}};
  TestEngine tasks{store.key(round), 1};  ///< copied for each run
  bool run() {
    EngineRun::Reports reports{[](auto, auto, const auto&) {}, [] { return false; },
                               [this](const std::string& text) { notes.push_back(text); }};
    EngineRun all(std::make_unique<TestEngine>(tasks), "test", folder.path(), std::move(reports));
    return all(round, store);
  }
  std::vector<std::string> notes = {};
  std::string log() const { return read_file(folder.path() / "attempts.csv"); }
};

}  // namespace

TEST_CASE("workers that die are replaced, and every task has its result") {
  Study s;
  s.tasks.dies = {{3, 1}, {17, 2}, {50, 2}};
  CHECK(s.run());
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto values = s.store.find({s.store.key(s.round), i});
    REQUIRE(values);
    CHECK((*values)[0] == double(i));
  }
  CHECK(s.log().find("left tasks") != std::string::npos);
  CHECK(s.log().find("signal 9") != std::string::npos);
  REQUIRE(s.notes.size() == 1);  // one for each kind of end
  CHECK(s.notes[0].find("ended with signal 9; its tasks are submitted again") != std::string::npos);
}

TEST_CASE("workers that end before they start are no failures of a task") {
  Study s;
  s.tasks.lost = 20;
  CHECK(s.run());
  CHECK(s.store.size() == 50);
  CHECK(s.log().find("task failed") == std::string::npos);
  CHECK(s.log().find("exit code 255") != std::string::npos);
}

TEST_CASE("an attempt that the engine does not accept is submitted again with the same files") {
  Study s;
  s.tasks.refusals = 1;
  CHECK(s.run());
  CHECK(s.store.size() == 50);
}

TEST_CASE(
    "a task that always fails or kills its worker ends the study with its number; all others are kept") {
  Study s;
  s.tasks.dies = {{20, 1000}};
  s.tasks.fails = {31};
  std::string message;
  try {
    s.run();
  } catch (const Error& e) {
    message = e.what();
  }
  CHECK_MESSAGE(message.find("2 of 50 tasks of this round failed 3 times") != std::string::npos, message);
  CHECK_MESSAGE(message.find("task 20: the worker ended with signal 9") != std::string::npos, message);
  CHECK_MESSAGE(message.find("task 31: no cells") != std::string::npos, message);
  CHECK(s.store.size() == 48);
  CHECK(s.log().find(",task error,31,no cells") != std::string::npos);
  CHECK(s.log().find(",task failed,31,no cells") != std::string::npos);
  // The same command tries the failed tasks again, and no other.
  s.tasks.dies.clear();
  s.tasks.fails.clear();
  CHECK(s.run());
  CHECK(s.store.size() == 50);
}

TEST_CASE("an engine whose workers never give a result, or refuse the study, is an error") {
  Study s;
  s.tasks.exit_of_all = 127;
  CHECK_THROWS_WITH(s.run(), doctest::Contains("the last 30 workers ended without a result"));
  s.tasks.exit_of_all = 2;
  CHECK_THROWS_WITH(s.run(), doctest::Contains("a worker refused the study"));
}

TEST_CASE("an engine with a queue accepts attempts when half of it is used") {
  struct Queue final : Engine {
    unsigned slots() const override { return 3; }
    bool queues() const override { return true; }
    bool submit(std::span<const Attempt>) override { return true; }
    std::vector<AttemptEnd> ended() override { return {}; }
    double period_s() const override { return 1; }
    void cancel() override {}
  };
  CHECK(Queue().accepts(0, false) == 3);  // they measure the time of a task
  CHECK(Queue().accepts(1, false) == 0);
  CHECK(Queue().accepts(0, true) == 12);
  CHECK(Queue().accepts(6, true) == 6);
  CHECK(Queue().accepts(7, true) == 0);
  const TestEngine free_workers(0, 1);
  CHECK(free_workers.accepts(0, true) == 2);
  CHECK(free_workers.accepts(2, true) == 0);
  CHECK(free_workers.accepts(5, true) == 0);
}

TEST_CASE("a round whose every second task has a result is computed, although lists of tasks are limited") {
  const test::TemporaryFolder folder("engine");
  ResultStore store(folder.path() / "results", "study");
  const Round round{"tasks", 30000, {}};
  const std::uint64_t key = store.key(round);
  const std::vector<double> value{1};
  for (std::uint64_t i = 0; i < round.size; i += 2) store.add({key, i}, value, 1e-6);
  EngineRun::Reports reports{[](auto, auto, const auto&) {}, [] { return false; }, [](const std::string&) {}};
  EngineRun run(std::make_unique<TestEngine>(key, 1), "test", folder.path(), std::move(reports));
  CHECK(run(round, store));
  CHECK(store.size() == round.size);
}

TEST_CASE("chunks take at most 60 s, less at the end, one task while the time is unknown") {
  CHECK(ChunkSize{1000, 4, {}, false}.tasks() == 1);
  CHECK(ChunkSize{1000, 4, {}, true}.tasks() == 20);
  CHECK(ChunkSize{1000000, 4, 0.05, false}.tasks() == 1200);  // 60 s
  CHECK(ChunkSize{2000, 2, 0.05, false}.tasks() == 500);      // 25 s
  CHECK(ChunkSize{40, 2, 0.05, false}.tasks() == 20);         // 1 s
  CHECK(ChunkSize{10, 2, 100, false}.tasks() == 1);
  CHECK(ChunkSize{2000, 3, 0.05, true}.tasks() == 166);
  CHECK(ChunkSize{2000, 2, 0.005, true}.tasks() == 1000);  // 5 s
  CHECK(ChunkSize{112, 100, {}, true}.tasks() == 1);
  CHECK(ChunkSize{112, 100, 0.015, true}.tasks() == 67);  // 1 s, although most workers get nothing
  CHECK(ChunkSize{112, 100, 3, true}.tasks() == 1);
}

TEST_CASE("settings of an engine: name or file, and single values") {
  CHECK(engine_settings("slurm", {"partition=short", "time=2 h"}).time == doctest::Approx(7200));
  CHECK(engine_settings("slurm", {"partition=short"}).partition == "short");
  CHECK_THROWS_WITH(engine_settings("local", {"partition=short"}),
                    doctest::Contains("partition is not used by the engine local, but by slurm"));
  CHECK_THROWS_WITH(engine_settings("dask", {"environment=[\"x\"]"}),
                    doctest::Contains("but by slurm and parallel"));
  CHECK_THROWS_WITH(engine_settings("slurm", {"time=60 s"}), doctest::Contains("180"));
  CHECK_THROWS_WITH(engine_settings("slrum", {}), doctest::Contains("did you mean \"slurm\""));
  CHECK_THROWS_WITH(engine_settings("pbs", {}), doctest::Contains("for another scheduler use `faba study`"));
  CHECK_THROWS_WITH(engine_settings("slurm", {"partitoin=a"}),
                    doctest::Contains("did you mean \"partition\""));
  CHECK_THROWS_WITH(engine_settings("slurm", {"partition"}), doctest::Contains("has no value"));
  const test::TemporaryFolder folder("engine");
  write_file(
      folder.path() / "c.toml",
      "[engine]\ntype = \"dask\"\nscheduler = \"tcp://a:8786\"\nenvironment = [\"module load gcc\"]\n");
  const EngineSettings s = engine_settings((folder.path() / "c.toml").string(), {});
  CHECK(s.type == EngineType::dask);
  CHECK(s.environment == std::vector<std::string>{"module load gcc"});
}
