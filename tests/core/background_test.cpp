#include "core/background.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <vector>

using namespace faba;

TEST_CASE("background: jobs are run in their order, and wait() returns after the last") {
  std::vector<int> done;
  Background b(3);
  for (int i = 0; i < 100; ++i) b.add([&done, i] { done.push_back(i); });
  b.wait();
  REQUIRE(done.size() == 100);
  for (int i = 0; i < 100; ++i) CHECK(done[std::size_t(i)] == i);
}

TEST_CASE("background: not more jobs wait than permitted") {
  std::atomic<bool> go = false;
  std::atomic<int> begun = 0, added = 0;
  Background b(2);
  std::thread caller([&] {
    for (int i = 0; i < 5; ++i) {
      b.add([&] {
        ++begun;
        while (!go) std::this_thread::yield();
      });
      ++added;
    }
  });
  while (added < 3) std::this_thread::yield();  // one runs, two wait
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(added == 3);
  CHECK(begun == 1);
  go = true;
  caller.join();
  b.wait();
  CHECK(begun == 5);
}

TEST_CASE("background: the exception of a job is thrown to the caller, and later jobs are not run") {
  Background b(10);
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

TEST_CASE("background: the destructor waits for the running job and drops the others") {
  std::atomic<int> run = 0;
  std::atomic<bool> begun = false, go = false;
  std::optional<Background> b(std::in_place, 10);
  b->add([&] {
    begun = true;
    while (!go) std::this_thread::yield();
    ++run;
  });
  for (int i = 0; i < 5; ++i) b->add([&] { ++run; });
  while (!begun) std::this_thread::yield();
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    go = true;
  });
  b.reset();
  CHECK(run == 1);
  later.join();
  const Background unused(1);
}
