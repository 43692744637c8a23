#include "study/sweep/sweep.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "study/sweep/study_directory.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

struct Work {
  std::vector<Task> tasks;
  std::atomic<int> done{0};
  explicit Work(int n) {
    for (int i = 0; i < n; ++i)
      tasks.push_back({task_key(std::to_string(i)), [this, i] {
                         ++done;
                         return std::vector<double>{double(i), 1.0 / (i + 3)};
                       }});
  }
};

}  // namespace

TEST_CASE("a resumed sweep repeats no completed task") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  Work work(20);
  SweepOptions stopped;
  stopped.threads = 2;
  stopped.stop = [&] { return work.done >= 7; };
  {
    ResultStore store(f / "r.jsonl");
    CHECK_THROWS_AS(sweep(store, work.tasks, stopped), Error);
    CHECK(store.size() >= 7);
  }
  // Killed while writing a line.
  const std::string complete = read_file(f / "r.jsonl");
  write_file(f / "r.jsonl", complete.substr(0, complete.size() - 5));
  ResultStore store(f / "r.jsonl");
  const int before = work.done;
  const auto kept = int(store.size());
  CHECK(sweep(store, work.tasks, {}));
  CHECK(work.done == before + 20 - kept);
  for (int i = 0; i < 20; ++i) {
    const auto* values = store.find(work.tasks[std::size_t(i)].key);
    REQUIRE(values);
    CHECK(*values == std::vector<double>{double(i), 1.0 / (i + 3)});  // bit-identical
  }
}

TEST_CASE("shards run each task once, and together all tasks") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  Work work(11);
  for (std::uint64_t k = 1; k <= 3; ++k) {
    SweepOptions o;
    o.shard = {k, 3};
    ResultStore store(f / std::to_string(k));
    CHECK_FALSE(sweep(store, work.tasks, o));
  }
  CHECK(work.done == 11);
  ResultStore all(f / "all");
  for (const char* part : {"1", "2", "3"}) all.merge(f / part);
  CHECK(sweep(all, work.tasks, {}));
  CHECK(work.done == 11);
}

TEST_CASE("NaN is stored; an error of a task ends the sweep; damaged files are refused") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  {
    ResultStore store(f / "r");
    store.add("a", {std::numeric_limits<double>::quiet_NaN(), 2});
  }
  const ResultStore store(f / "r");
  REQUIRE(store.find("a"));
  CHECK(std::isnan((*store.find("a"))[0]));
  CHECK((*store.find("a"))[1] == 2);

  ResultStore other(f / "s");
  const std::vector<Task> bad{{"x", []() -> std::vector<double> { throw Error(Errc::usage, "x", "no"); }}};
  CHECK_THROWS_WITH(sweep(other, bad, {}), doctest::Contains("no"));

  write_file(f / "t", "{\"task\":\"a\",\"values\":[1]}\ninvalid\n");
  CHECK_THROWS_WITH(ResultStore(f / "t"), doctest::Contains("t:2"));
}

TEST_CASE("study directory: resumed, neither mixed with another study nor overwritten") {
  const test::TemporaryFolder folder("sweep");
  const auto& f = folder.path();
  const auto dir = f / "study";
  {
    StudyDirectory d(dir, "one", "again", false);
    d.results().add("a", {1});
  }
  {
    StudyDirectory d(dir, "one", "again", false);  // resumes after a kill
    CHECK(d.results().find("a"));
    CHECK_THROWS_WITH(StudyDirectory(dir, "one", "again", false), doctest::Contains("process"));
    d.complete(nlohmann::ordered_json::object());
  }
  CHECK_THROWS_WITH(StudyDirectory(dir, "one", "again", false), doctest::Contains("complete"));
  CHECK_THROWS_WITH(StudyDirectory(dir, "two", "again", false), doctest::Contains("a different study"));
  CHECK_NOTHROW(check_merge({dir}, "one"));
  CHECK_THROWS_WITH(check_merge({dir}, "two"), doctest::Contains("a different study"));
  CHECK_THROWS_WITH(check_merge({dir / "none"}, "one"), doctest::Contains("directory not found"));
  CHECK(StudyDirectory(dir, "one", "again", true).results().find("a"));
  StudyDirectory replaced(dir, "two", "again", true);
  CHECK_FALSE(replaced.results().find("a"));
  write_file(f / "mine.txt", "x");
  CHECK_THROWS_WITH(StudyDirectory(f, "one", "again", true), doctest::Contains("no study"));
  StudyDirectory third(f / "third", "three", "again", false);
  CHECK_THROWS_WITH(third.merge({dir}), doctest::Contains("a different study"));
  CHECK_THROWS_AS(third.merge({f / "none"}), Error);
}
