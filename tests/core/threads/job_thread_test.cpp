#include "core/threads/job_thread.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <vector>

using namespace faba;

TEST_CASE("job thread: jobs are run in their order, and wait() returns after the last") {
  std::vector<int> done;
  JobThread b(3);
  for (int i = 0; i < 100; ++i) b.add([&done, i] { done.push_back(i); });
  b.wait();
  REQUIRE(done.size() == 100);
  for (int i = 0; i < 100; ++i) CHECK(done[std::size_t(i)] == i);
}

TEST_CASE("job thread: not more jobs wait than permitted") {
  std::atomic<bool> go = false;
  std::atomic<int> started = 0, added = 0;
  JobThread b(2);
  std::thread caller([&] {
    for (int i = 0; i < 5; ++i) {
      b.add([&] {
        ++started;
        while (!go) std::this_thread::yield();
      });
      ++added;
    }
  });
  while (added < 3) std::this_thread::yield();  // one runs, two wait
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(added == 3);
  CHECK(started == 1);
  go = true;
  caller.join();
  b.wait();
  CHECK(started == 5);
}

TEST_CASE("job thread: the exception of a job is thrown to the caller, and later jobs are not run") {
  JobThread b(10);
  std::atomic<int> later = 0;
  std::atomic<bool> go = false;
  b.add([&] {
    while (!go) std::this_thread::yield();
    throw std::runtime_error("full");
  });
  b.add([&] { ++later; });
  go = true;
  CHECK_THROWS_WITH(b.wait(), "full");
  CHECK_THROWS_WITH(b.add([] {}), "full");
  CHECK(later == 0);
}

TEST_CASE("job thread: the destructor waits for the running job and drops the others") {
  std::atomic<int> run = 0;
  std::atomic<bool> started = false, go = false;
  std::optional<JobThread> b(std::in_place, 10);
  b->add([&] {
    started = true;
    while (!go) std::this_thread::yield();
    ++run;
  });
  for (int i = 0; i < 5; ++i) b->add([&] { ++run; });
  while (!started) std::this_thread::yield();
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    go = true;
  });
  b.reset();
  CHECK(run == 1);
  later.join();
  const JobThread unused(1);
}
