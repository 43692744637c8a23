#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "core/threads/parallel.h"

using namespace faba;

TEST_CASE("uneven blocks: each is done once, for any number of threads and blocks") {
  for (const unsigned threads : {1U, 2U, 3U}) {
    Pool pool(threads);
    for (const std::size_t blocks : {0U, 1U, 2U, 100U}) {
      std::vector<std::atomic<int>> done(blocks);
      pool.run_uneven(blocks, [&](std::size_t b) { ++done[b]; });
      for (const auto& times : done) CHECK(times == 1);
    }
  }
}

TEST_CASE("uneven blocks: an exception ends the job, and the pool can be used again") {
  for (const unsigned threads : {1U, 3U}) {
    Pool pool(threads);
    std::atomic<int> done{0};
    CHECK_THROWS_AS(pool.run_uneven(10000,
                                    [&](std::size_t b) {
                                      if (b == 5) throw std::runtime_error("5");
                                      ++done;
                                    }),
                    std::runtime_error);
    CHECK(done < 10000);
    done = 0;
    pool.run_uneven(10, [&](std::size_t) { ++done; });
    CHECK(done == 10);
  }
}
