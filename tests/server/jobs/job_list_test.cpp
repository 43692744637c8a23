#include "server/jobs/job_list.h"

#include <doctest/doctest.h>

#include <chrono>

#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

/// A mock of the program: a shell script.
fs::path script(const fs::path& folder, const std::string& text) {
  const fs::path file = folder / "program";
  write_file(file, "#!/bin/sh\n" + text);
  fs::permissions(file, fs::perms::owner_all);
  return file;
}

Job wait_for(const JobList& list, int id, const std::function<bool(const Job&)>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < end) {
    for (const Job& j : list.jobs())
      if (j.id == id && done(j)) return j;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  FAIL("timeout: the job did not reach the expected state");
  return {};
}

/// A list of jobs whose program is a shell script, in its folder.
struct Jobs {
  explicit Jobs(const std::string& text) : list(script(folder.path(), text), folder.path(), [] {}) {}
  int add(const std::string& word) { return list.add({.words = {word}}); }
  fs::path file(const char* name) const { return folder.path() / name; }

  test::TemporaryFolder folder{"jobs"};
  JobList list;
};

}  // namespace

TEST_CASE("a job: arguments, working folder, progress, result") {
  test::TemporaryFolder folder("jobs");
  const fs::path program = script(folder.path(),
                                  "pwd > where; printf '%s|' \"$@\" > words\n"
                                  "eval \"echo 'doing this 3 10' >&$FABA_PROGRESS_FD\"\n"
                                  "while [ ! -e go ]; do sleep 0.02; done\n"
                                  "echo '{\"out\": 7}'\n");
  std::atomic<int> changes = 0;
  JobList list(program, folder.path(), [&] { ++changes; });
  const int id =
      list.add({.title = "title", .words = {"run", "a b", "$(x)"}, .page = "page.html", .out = "out"});
  const Job half = wait_for(list, id, [](const Job& j) { return j.of == 10; });
  CHECK(half.state == Job::State::running);
  CHECK(half.doing == "doing this");
  CHECK(half.did == 3);
  write_file(folder.path() / "go", "");
  const Job j = wait_for(list, id, is_over);
  CHECK(j.state == Job::State::done);
  CHECK(j.result["out"] == 7);
  CHECK(read_file(folder.path() / "words") == "run|a b|$(x)|");
  CHECK(fs::canonical(read_file(folder.path() / "where").substr(0, folder.path().string().size())) ==
        fs::canonical(folder.path()));
  CHECK(changes >= 3);
  CHECK(job_json(j)["state"] == "done");
}

TEST_CASE("a failed job has an error message, and the next job runs") {
  test::TemporaryFolder folder("jobs");
  const fs::path program =
      script(folder.path(), "echo 'faba: note: x' >&2; echo \"faba: error: $1: is wrong$3\" >&2; exit $2\n");
  JobList list(program, folder.path(), [] {});
  const int bad = list.add({.words = {"scene", "2"}}), good = list.add({.words = {"other", "0"}});
  CHECK(wait_for(list, bad, is_over).error == "scene: is wrong");
  CHECK(wait_for(list, good, is_over).state == Job::State::done);
  const int usage = list.add({.words = {"--at", "2", " (see /x/faba run --help)"}});
  CHECK(wait_for(list, usage, is_over).error == "--at: is wrong");
  JobList none(folder.path() / "absent", folder.path(), [] {});
  CHECK(wait_for(none, none.add(Job()), is_over).state == Job::State::failed);
}

TEST_CASE("cancel stops the running job with SIGINT and, after a timeout, with SIGKILL") {
  Jobs jobs(
      "trap 'echo stopped > stopped; exit 130' INT\n"
      "[ \"$1\" = ignores ] && trap '' INT\n"
      "echo > started\nfor i in $(seq 1000); do sleep 0.05; done\n");
  JobList& list = jobs.list;
  const int first = jobs.add("x"), waiting = jobs.add("y");
  wait_for(list, first, [&](const Job&) { return fs::exists(jobs.file("started")); });
  CHECK(list.cancel(waiting));
  CHECK(list.cancel(first));
  CHECK_FALSE(list.cancel(99));
  CHECK(wait_for(list, first, is_over).state == Job::State::cancelled);
  CHECK(wait_for(list, waiting, is_over).state == Job::State::cancelled);
  CHECK(fs::exists(jobs.file("stopped")));
  fs::remove(jobs.file("started"));
  const int ignores = jobs.add("ignores");
  wait_for(list, ignores, [&](const Job&) { return fs::exists(jobs.file("started")); });
  list.cancel(ignores);
  CHECK(wait_for(list, ignores, is_over).state == Job::State::cancelled);
}

TEST_CASE("the queue: a job moves to the front, and an ended one starts again or leaves the list") {
  Jobs jobs(
      "echo \"$1\" >> order\n"
      "[ \"$1\" = first ] && while [ ! -e go ]; do sleep 0.02; done\n"
      "[ \"$1\" = bad ] && [ ! -e mended ] && exit 1\nexit 0\n");
  JobList& list = jobs.list;
  const int first = jobs.add("first"), bad = jobs.add("bad"), last = jobs.add("last");
  wait_for(list, first, [](const Job& j) { return j.state == Job::State::running; });
  CHECK(list.move_to_front(last));
  CHECK_FALSE(list.move_to_front(first));  // it is running
  CHECK_FALSE(list.move_to_front(99));
  CHECK_FALSE(list.start_again(bad));
  CHECK_FALSE(list.clear(bad));
  write_file(jobs.file("go"), "");
  CHECK(wait_for(list, bad, is_over).state == Job::State::failed);
  CHECK(read_file(jobs.file("order")) == "first\nlast\nbad\n");
  write_file(jobs.file("mended"), "");
  CHECK(list.start_again(bad));
  CHECK(wait_for(list, bad, is_over).state == Job::State::done);
  CHECK_FALSE(list.start_again(bad));  // it is done
  CHECK(list.clear(bad));
  CHECK_FALSE(list.job(bad));
  CHECK(list.clear({}));
  CHECK(list.jobs().empty());
}

TEST_CASE("ended jobs are listed by the next list in the same workspace, with their results") {
  test::TemporaryFolder folder("jobs");
  const fs::path program = script(folder.path(), "echo '{\"out\": 7}'\n");
  const Job job{.title = "drop: a",
                .words = {"drop", "./a"},
                .page = "runs/drop-1/edge.png",
                .out = "runs/drop-1",
                .kind = "drop",
                .work = 3};
  int kept = 0, cleared = 0;
  {
    JobList list(program, folder.path(), [] {});
    kept = list.add(job);
    Job other = job;
    other.out = "experiments/one/results/drop-2";
    other.page = other.out / "edge.png";
    cleared = list.add(other);
    const int recording =
        list.add({.title = "recording", .words = {}, .page = "runs/r/report.html", .out = "runs/r"});
    wait_for(list, recording, is_over);
    CHECK(list.clear(cleared));
  }
  // What a file states about places outside of its folder is not used.
  fs::create_directories(folder.path() / "runs/evil");
  Json evil = Json::parse(read_file(folder.path() / "runs/drop-1/job.json"));
  evil["id"] = 50;
  evil["out"] = "../..";
  evil["page"] = "/etc/passwd";
  write_file(folder.path() / "runs/evil/job.json", evil.dump());
  fs::create_directories(folder.path() / "runs/broken");
  write_file(folder.path() / "runs/broken/job.json", "{\"id\": ");
  JobList next(program, folder.path(), [] {});
  CHECK(next.jobs().size() == 2);
  const auto j = next.job(kept);
  REQUIRE(j);
  CHECK(j->state == Job::State::done);
  CHECK(j->result["out"] == 7);
  CHECK(j->page == "runs/drop-1/edge.png");
  CHECK(j->work == 3);
  CHECK(j->ended > 1e9);
  CHECK_FALSE(next.job(cleared));
  REQUIRE(next.job(50));
  CHECK(next.job(50)->out == "runs/evil");
  CHECK(next.job(50)->page == "runs/evil/passwd");
  CHECK(next.add(job) == 51);
}
