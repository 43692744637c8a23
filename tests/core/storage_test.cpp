// archive, file and h5: written data are read back, damaged data are rejected.
#include <doctest/doctest.h>

#include "core/archive.h"
#include "core/h5/h5.h"
#include "core/threads/parallel.h"
#include "tests/app/run_directory.h"

using namespace faba;

TEST_CASE("archive: the same function writes and reads; reading past the end is an error") {
  std::vector<float> v{1, 2, 3};
  std::string s = "abc";
  double d = 0.1;
  Vec2 p{4, 5};
  Archive out;
  out& v& s& d& p;
  Archive in(out.bytes());
  std::vector<float> v2;
  std::string s2;
  double d2 = 0;
  Vec2 p2;
  in& v2& s2& d2& p2;
  CHECK(v2 == v);
  CHECK(s2 == s);
  CHECK(d2 == d);
  CHECK(p2 == p);
  CHECK(in.at_end());
  CHECK_THROWS_AS(in & d2, Error);
  auto bytes = out.bytes();
  for (int i = 0; i < 8; ++i) bytes[std::size_t(i)] = 0xFF;  // a length of 2^64 - 1
  Archive bad(bytes);
  CHECK_THROWS_AS(bad & v2, Error);
}

TEST_CASE("files are written completely or not at all; appended files are truncated") {
  const TestFolder f;
  write_file(f.path / "a", "one");
  write_file(f.path / "a", "two");
  CHECK(read_file(f.path / "a") == "two");
  sync_file(f.path / "a");
  CHECK_THROWS_WITH_AS(sync_file(f.path / "missing"), doctest::Contains("missing: cannot be flushed"), Error);
  CHECK_THROWS_AS(write_file("/dev/full/x", "y"), Error);
  CHECK_THROWS_AS(read_file(f.path), Error);
  CHECK_THROWS_AS(read_file(f.path / "none"), Error);
  {
    OutputFile file(f.path / "log");
    file.append("hello ");
    file.sync();
    CHECK(file.size() == 6);
    file.append("lost");
  }
  {
    OutputFile file(f.path / "log", 6);
    file.append("world");
    file.close();
  }
  CHECK(read_file(f.path / "log") == "hello world");
  CHECK_THROWS_AS(OutputFile(f.path / "log", 100), Error);
  OutputFile full("/dev/full");
  CHECK_THROWS_AS(full.append("x"), Error);
  CHECK(full.size() == 0);
}

TEST_CASE("HDF5: rows are read back, also from a file that was not closed") {
  const TestFolder f;
  const auto write = [&](bool close) {
    H5File file = H5File::create(f.path / "t.h5");
    H5Table t = file.table<float>("p", {3, 2}, 4, 2, true);
    file.attribute("/", "fps", 15.5);
    file.begin_writing();
    for (int k = 0; k < 10; ++k) {
      const std::vector<float> row(6, float(k));
      t.append<float>(row);
    }
    CHECK_THROWS_AS(t.append<float>(std::vector<float>(5)), Error);
    close ? file.close() : file.sync();
    if (!close) std::filesystem::copy_file(f.path / "t.h5", f.path / "torn.h5");
  };
  write(false);
  write(true);
  for (const char* name : {"t.h5", "torn.h5"}) {
    const H5File file = H5File::open(f.path / name);
    CHECK(file.number_attribute("/", "fps") == 15.5);
    const H5Table t = file.table("p");
    REQUIRE(t.rows() == 10);
    std::vector<float> row(6);
    t.read<float>(7, row);
    CHECK(row == std::vector<float>(6, 7));
    CHECK_THROWS_AS(t.read<float>(10, row), Error);
    CHECK_THROWS_AS(file.table("q"), Error);
  }
  write_file(f.path / "not.h5", "nothing");
  CHECK_THROWS_AS(H5File::open(f.path / "not.h5"), Error);
}

TEST_CASE("pool: every block is run once, exceptions are rethrown, for any number of threads") {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Pool pool(threads);
    for (int round = 0; round < 200; ++round) {
      std::vector<int> seen(97, 0);
      pool.for_blocks(97, 10, [&](std::size_t b, std::size_t e) {
        for (std::size_t i = b; i < e; ++i) ++seen[i];
      });
      REQUIRE(seen == std::vector<int>(97, 1));
    }
    CHECK_THROWS_AS(pool.run(8,
                             [](std::size_t b) {
                               if (b == 5) throw Error(Errc::input, "x", "y");
                             }),
                    Error);
    int n = 0;
    pool.run(1, [&](std::size_t) { ++n; });
    CHECK(n == 1);
  }
}
