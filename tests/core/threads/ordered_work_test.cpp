#include "core/threads/ordered_work.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

using namespace faba;

namespace {

/// The squares of 0 to n - 1, with work of different duration.
struct Squares {
  int n = 50, made = 0;
  std::atomic<int> making{0}, most_making{0};
  std::vector<int> number, square;
  std::atomic<bool> threads_in_range{true};
  unsigned threads;

  explicit Squares(unsigned of)
      : number(OrderedWork::slots(of)), square(OrderedWork::slots(of)), threads(of) {}
  OrderedWork::Steps steps() {
    return {[this](std::size_t slot) {
              most_making = std::max(most_making.load(), ++making);
              number[slot] = made++;
              --making;
              return number[slot] < n;
            },
            [this](std::size_t slot, unsigned thread) {
              if (thread >= threads) threads_in_range = false;
              if (number[slot] % 3 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
              square[slot] = number[slot] * number[slot];
            }};
  }
};

}  // namespace

TEST_CASE("items are taken in their order, once each, for any number of threads") {
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    CAPTURE(threads);
    Squares s(threads);
    OrderedWork work(threads, s.steps());
    int next = 0;
    bool in_order = true;
    while (const auto slot = work.next()) {
      in_order = in_order && s.number[*slot] == next && s.square[*slot] == next * next;
      ++next;
    }
    CHECK(in_order);
    CHECK(next == s.n);
    CHECK_FALSE(work.next());
    CHECK(s.most_making == 1);
    CHECK(s.threads_in_range);
  }
}

TEST_CASE("memory is bounded: no item is made for which there is no slot") {
  Squares s(3);
  OrderedWork work(3, s.steps());
  REQUIRE(work.next());
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(s.made <= int(OrderedWork::slots(3)));
}

TEST_CASE("errors arrive with their item, after the items before it") {
  for (const bool in_make : {true, false}) {
    CAPTURE(in_make);
    Squares s(2);
    OrderedWork::Steps steps = s.steps();
    const auto fail_at_7 = [&](std::size_t slot) {
      if (s.number[slot] == 7) throw std::runtime_error("seven");
    };
    const auto made = steps.make;
    const auto worked = steps.work;
    if (in_make)
      steps.make = [&, made](std::size_t slot) {
        const bool more = made(slot);
        fail_at_7(slot);
        return more;
      };
    else
      steps.work = [&, worked](std::size_t slot, unsigned thread) {
        fail_at_7(slot);
        worked(slot, thread);
      };
    OrderedWork work(2, steps);
    int taken = 0;
    std::string error;
    try {
      while (work.next()) ++taken;
    } catch (const std::runtime_error& e) {
      error = e.what();
    }
    CHECK(taken == 7);
    CHECK(error == "seven");
  }
}
