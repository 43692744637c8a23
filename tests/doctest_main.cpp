#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>
#include <vector>

#include "tests/skip.h"

namespace {

int skips = 0;
bool real_time = false;

// Processor time of the calling thread, s.
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

unsigned cores() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace

namespace faba::test {

void skip(const std::string& why) {
  ++skips;
  MESSAGE("skipped: ", why);
}

bool skipped_without(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) return false;
  skip("file not found: " + path.string());
  return true;
}

void works_in_real_time() { real_time = true; }

double competing_processes() {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> period{0.5};
  const auto end = Clock::now() + period;
  std::vector<double> used(cores());
  std::vector<std::thread> threads;
  for (double& one : used)
    threads.emplace_back([&one, end] {
      while (Clock::now() < end) {
      }
      one = processor_time();
    });
  for (std::thread& one : threads) one.join();
  double sum = 0;
  for (const double one : used) sum += one;
  const double n = cores();
  return n * (n * period.count() / sum - 1);
}

bool cores_taken() { return std::lround(competing_processes()) >= long(cores()); }

}  // namespace faba::test

int main(int argc, char** argv) {
  doctest::Context context(argc, argv);
  const int result = context.run();
  if (context.shouldExit()) return result;
  if (result != 0 && real_time && faba::test::cores_taken()) {
    std::cout << "Skipped: checks failed while other processes took all cores of the machine.\n";
    return faba::test::kSkipped;
  }
  return result == 0 && skips > 0 ? faba::test::kSkipped : result;
}
