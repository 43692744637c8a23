// Load on the machine that tests of the bench notice (tests/skip.h).
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "tests/e2e/child.h"
#include "tests/skip.h"
#include "tests/temporary_folder.h"

using namespace faba;

TEST_CASE("the cores are noticed to be taken if one busy process runs for each") {
  const test::TemporaryFolder folder("busy");
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::unique_ptr<Child>> busy;
  for (unsigned i = 0; i < cores; ++i)
    busy.push_back(std::make_unique<Child>(folder.path(), "/bin/sh -c 'while :; do :; done'"));
  CHECK(test::cores_taken());
}
