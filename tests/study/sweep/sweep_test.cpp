#include "study/sweep/sweep.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "study/sweep/program_version.h"
#include "study/sweep/round_planner.h"
#include "study/sweep/study_directory.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

struct Work {
  std::atomic<int> done{0};
  Round round;
  explicit Work(std::uint64_t n) {
    round.description = "work";
    round.size = n;
    round.work = [this](std::uint64_t i) {
      ++done;
      return std::vector<double>{double(i), 1.0 / double(i + 3)};
    };
  }
};

std::filesystem::path only_file(const std::filesystem::path& folder) {
  return std::filesystem::directory_iterator(folder)->path();
}

std::vector<double> values(const ResultStore& store, TaskId id) {
  const auto found = store.find(id).value();
  return {found.begin(), found.end()};
}

}  // namespace

TEST_CASE("a resumed sweep repeats no completed task") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  Work work(20);
  SweepOptions stopped;
  stopped.threads = 2;
  stopped.stop = [&] { return work.done >= 7; };
  {
    ResultStore store(f / "r", "study");
    CHECK_THROWS_AS(sweep(store, work.round, stopped), Error);
    CHECK(store.size() >= 7);
  }
  // Killed while writing a record.
  const auto file = only_file(f / "r");
  const std::string complete = read_file(file);
  std::filesystem::remove(file);
  write_file(partial_name(file), complete.substr(0, complete.size() - 5));
  ResultStore store(f / "r", "study");
  const int before = work.done;
  const auto kept = int(store.size());
  CHECK(kept >= 6);
  CHECK(sweep(store, work.round, {}));
  CHECK(work.done == before + 20 - kept);
  for (std::uint64_t i = 0; i < 20; ++i)  // bit-identical
    CHECK(values(store, {store.key(work.round), i}) == std::vector<double>{double(i), 1.0 / double(i + 3)});
}

TEST_CASE("shards run each task once, and together all tasks") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  Work work(11);
  for (std::uint64_t k = 1; k <= 3; ++k) {
    SweepOptions o;
    o.shard = {k, 3};
    ResultStore store(f / std::to_string(k), "study");
    CHECK_FALSE(sweep(store, work.round, o));
  }
  CHECK(work.done == 11);
  ResultStore all(f / "all", "study");
  for (const char* part : {"1", "2", "3"}) all.merge(f / part);
  CHECK(sweep(all, work.round, {}));
  CHECK(work.done == 11);
}

TEST_CASE("a task that fails is named at the end; all others are computed, and only it is tried again") {
  const test::TemporaryFolder folder("sweep");
  ResultStore store(folder.path(), "study");
  Work work(20);
  Round round = work.round;
  bool broken = true;
  round.work = [&](std::uint64_t i) {
    if (i == 4 && broken) throw Error(Errc::input, "film.avi", "is empty");
    return work.round.work(i);
  };
  round.labels = [](std::uint64_t i) { return std::vector<TaskLabel>{{"seed", std::to_string(i)}}; };
  try {
    sweep(store, round, {});
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::input);
    CHECK(std::string(e.what()).starts_with(
        "1 of 20 tasks of this round failed: task 5 (seed 4): film.avi: is empty; the results"));
  }
  CHECK(store.size() == 19);
  broken = false;
  CHECK(sweep(store, round, {}));
  CHECK(work.done == 20);
  // When nothing works, the sweep does not try everything.
  std::atomic<int> tried = 0;
  Round hopeless{"hopeless", 1000, [&](std::uint64_t) -> std::vector<double> {
                   ++tried;
                   throw Error(Errc::usage, "", "no");
                 }};
  SweepOptions one;
  one.threads = 1;
  CHECK_THROWS_AS(sweep(store, hopeless, one), Error);
  CHECK(tried == int(kHopelessTasks));
}

TEST_CASE("NaN is stored; damaged files and those of other studies and programs are refused") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  {
    ResultStore store(f / "r", "study");
    store.add({1, 5}, std::vector<double>{nan, 2});
  }
  const ResultStore store(f / "r", "study");
  CHECK(std::isnan(values(store, {1, 5})[0]));
  CHECK(values(store, {1, 5})[1] == 2);
  CHECK_FALSE(store.find({1, 4}));
  CHECK_FALSE(store.find({2, 5}));

  ResultStore other(f / "s", "study");
  Round bad{"bad", 1, [](std::uint64_t) -> std::vector<double> { throw Error(Errc::usage, "x", "no"); }};
  CHECK_THROWS_WITH(sweep(other, bad, {}), doctest::Contains("no"));

  const auto file = only_file(f / "r");
  // Another build of the same version.
  std::string by_other = read_file(file);
  const std::string version = program_version();
  by_other[40 + version.size() - 1] ^= 1;
  const std::uint32_t sum =
      std::uint32_t(crc32_z(0, reinterpret_cast<const unsigned char*>(by_other.data()), 60));
  std::memcpy(by_other.data() + 60, &sum, 4);
  std::filesystem::create_directories(f / "t");
  write_file(f / "t/a.results", by_other);
  CHECK_THROWS_WITH(ResultStore(f / "t", "study"), doctest::Contains(("this is faba " + version).c_str()));

  CHECK_THROWS_WITH(ResultStore(f / "r", "another"), doctest::Contains("a different study"));
  std::string content = read_file(file);
  content[content.size() - 3] ^= 1;
  write_file(file, content);
  CHECK_THROWS_WITH(ResultStore(f / "r", "study"), doctest::Contains("is damaged at byte 64"));
  content = read_file(file);
  content[40] = '9';
  write_file(file, content);
  CHECK_THROWS_WITH(ResultStore(f / "r", "study"), doctest::Contains("not a file of results"));
}

TEST_CASE(
    "results are read while another process appends them; failures are counted until there is a result") {
  const test::TemporaryFolder folder("sweep");
  ResultStore store(folder.path(), "study");
  ResultFile file(folder.path() / "a.results", "study");
  const std::vector<double> one{1};
  CHECK_FALSE(store.read_new());
  file.add({{7, 0}, 0.5, one, {}});
  file.add({{7, 1}, 0.5, {}, "broken"});
  CHECK(store.read_new());
  CHECK(values(store, {7, 0}) == one);
  CHECK(store.failures(7).at(1).what == "broken");
  CHECK(store.seconds_per_task(7) == doctest::Approx(0.5));
  CHECK_FALSE(store.read_new());
  file.add({{7, 1}, 0.5, one, {}});
  file.complete();
  CHECK(store.read_new());
  CHECK(store.failures(7).empty());
  CHECK_FALSE(store.read_new());
}

TEST_CASE("numbers of tasks as text") {
  CHECK(number_list({1, 2, 3, 7, 9, 10}) == "1-3,7,9-10");
  CHECK(number_list({}).empty());
  CHECK(numbers_in("1-3,7,9-10") == std::vector<std::uint64_t>{1, 2, 3, 7, 9, 10});
  for (const char* bad : {"", "0", "3-1", "1,", "a", "1-", "-2", "1-1000000000"}) {
    INFO(bad);
    CHECK_THROWS_WITH(numbers_in(bad), doctest::Contains("not a list of tasks"));
  }
}

TEST_CASE("a planned study: numbers continue over rounds; tasks that always fail end it with their names") {
  const test::TemporaryFolder folder("sweep");
  const auto results = folder.path() / "results";
  ResultStore store(results, "study");
  Work work(3);
  Round second = work.round;
  second.description = "second";
  second.labels = [](std::uint64_t i) { return std::vector<TaskLabel>{{"seed", std::to_string(i)}}; };
  RoundPlanner planner(folder.path());
  CHECK_FALSE(planner(work.round, store));
  CHECK(planner.open_tasks() == std::vector<std::uint64_t>{1, 2, 3});
  CHECK(sweep(store, work.round, {}));
  RoundPlanner next(folder.path());
  CHECK(next(work.round, store));
  CHECK_FALSE(next(second, store));
  CHECK(next.open_tasks() == std::vector<std::uint64_t>{4, 5, 6});
  CHECK(planned_round(folder.path(), "study", 5).description == "second");
  CHECK_THROWS_WITH(planned_round(folder.path(), "study", 7), doctest::Contains("task 7 is not planned"));
  CHECK_THROWS_WITH(planned_round(folder.path(), "other", 5), doctest::Contains("a different study"));

  const std::uint64_t key = store.key(second);
  const std::vector<double> one{1};
  ResultFile file(results / "a.results", "study");
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) file.add({{key, 1}, 0, {}, "no cells"});
  file.add({{key, 0}, 0, one, {}});
  store.read_new();
  RoundPlanner open(folder.path());
  open(work.round, store);
  CHECK_FALSE(open(second, store));  // task 6 is open
  CHECK(open.open_tasks() == std::vector<std::uint64_t>{6});
  file.add({{key, 2}, 0, one, {}});
  store.read_new();
  RoundPlanner last(folder.path());
  last(work.round, store);
  CHECK_THROWS_WITH(last(second, store), doctest::Contains("task 5 (seed 1): no cells"));
}

TEST_CASE("study directory: resumed, neither mixed with another study nor overwritten") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  const auto dir = f / "study";
  {
    StudyDirectory d(dir, "one", "again", false);
    d.results().add({1, 2}, std::vector<double>{1});
  }
  {
    StudyDirectory d(dir, "one", "again", false);  // resumes after a kill
    CHECK(d.results().find({1, 2}));
    CHECK_THROWS_WITH(StudyDirectory(dir, "one", "again", false), doctest::Contains("process"));
    d.complete(nlohmann::ordered_json::object());
  }
  CHECK_THROWS_WITH(StudyDirectory(dir, "one", "again", false), doctest::Contains("complete"));
  CHECK_THROWS_WITH(StudyDirectory(dir, "two", "again", false), doctest::Contains("a different study"));
  CHECK_NOTHROW(check_merge({dir}, "one"));
  CHECK_THROWS_WITH(check_merge({dir}, "two"), doctest::Contains("a different study"));
  CHECK_THROWS_WITH(check_merge({dir / "none"}, "one"), doctest::Contains("directory not found"));
  CHECK(StudyDirectory(dir, "one", "again", true).results().find({1, 2}));
  StudyDirectory replaced(dir, "two", "again", true);
  CHECK_FALSE(replaced.results().find({1, 2}));
  write_file(f / "mine.txt", "x");
  CHECK_THROWS_WITH(StudyDirectory(f, "one", "again", true), doctest::Contains("no study"));
  StudyDirectory third(f / "third", "three", "again", false);
  CHECK_THROWS_WITH(third.merge({dir}), doctest::Contains("a different study"));
  CHECK_THROWS_AS(third.merge({f / "none"}), Error);
}
