#include "core/h5/h5.h"

#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <thread>

#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

TEST_CASE("equal content gives equal files, at any time") {
  const test::TemporaryFolder folder("h5");
  const auto write = [&](const char* name) {
    H5File f = H5File::create(folder.path() / name);
    H5Table t = f.table<float>("x", {3}, 4, 3, true);
    f.attribute("x", "unit", std::string("px"));
    f.begin_writing();
    t.append<float>(std::array{1.0F, 2.0F, 3.0F});
    f.close();
    return read_file(folder.path() / name);
  };
  const std::string first = write("a.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 stores times in s, if it does
  CHECK(write("b.h5") == first);
}
