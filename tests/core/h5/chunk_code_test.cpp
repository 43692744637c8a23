// chunk_code and h5: HDF5 reads the chunks that this program encodes, for all element sizes, shapes and
// numbers of threads, and checks their checksums.
#include "core/h5/chunk_code.h"

#include <doctest/doctest.h>

#include <array>

#include "core/h5/h5.h"
#include "core/random/splitmix64.h"
#include "core/threads/parallel.h"
#include "tests/app/run_directory.h"

using namespace faba;

namespace {

// Values of which deflate saves nothing (`noise`), or much.
template <class T>
std::vector<T> row_of(std::size_t n, std::uint64_t row, bool noise) {
  std::vector<T> v(n);
  for (std::size_t i = 0; i < n; ++i) v[i] = T(noise ? splitmix64(i + n * row) >> 40 : (i + row) / 100);
  return v;
}

template <class T>
void check_round_trip(const std::filesystem::path& file, const std::vector<std::uint64_t>& shape, bool noise,
                      unsigned threads) {
  constexpr std::uint64_t kRows = 11;  // two complete chunks of 4 rows, and 3 rows
  std::size_t n = 1;
  for (const std::uint64_t side : shape) n *= std::size_t(side);
  {
    H5File f = H5File::create(file, threads);
    H5Table compressed = f.table<T>("compressed", shape, 4, 7, true);
    H5Table plain = f.table<T>("plain", shape, 4, 7, false);
    f.begin_writing();
    for (std::uint64_t r = 0; r < kRows; ++r) {
      compressed.append<T>(row_of<T>(n, r, noise));
      plain.append<T>(row_of<T>(n, r, noise));
      if (r == 5) f.sync();  // in the middle of a chunk, which is written again
    }
    f.close();
  }
  const H5File f = H5File::open(file);
  for (const char* name : {"compressed", "plain"}) {
    const H5Table t = f.table(name);
    REQUIRE(t.rows() == kRows);
    std::vector<T> row(n);
    for (std::uint64_t r = 0; r < kRows; ++r) {
      t.read<T>(r, row);
      CHECK(row == row_of<T>(n, r, noise));
    }
  }
}

}  // namespace

TEST_CASE("HDF5 reads what encode_chunk wrote") {
  const TestFolder folder;
  const auto file = folder.path / "t.h5";
  for (const unsigned threads : {1U, 3U})
    for (const bool noise : {false, true})
      for (const std::vector<std::uint64_t>& shape :
           {std::vector<std::uint64_t>{}, {1}, {7}, {20}, {20, 2}, {9, 13}}) {
        check_round_trip<std::uint8_t>(file, shape, noise, threads);
        check_round_trip<std::int32_t>(file, shape, noise, threads);
        check_round_trip<float>(file, shape, noise, threads);
        check_round_trip<double>(file, shape, noise, threads);
      }
}

TEST_CASE("a changed byte of a chunk is detected by its checksum") {
  const TestFolder folder;
  const auto file = folder.path / "t.h5";
  for (const bool compress : {false, true}) {
    const std::vector<double> row = row_of<double>(500, 0, true);
    {
      H5File f = H5File::create(file);
      H5Table t = f.table<double>("t", {500}, 1, 500, compress);
      f.begin_writing();
      t.append<double>(row);
      f.close();
    }
    std::vector<double> read(500);
    H5File::open(file).table("t").read<double>(0, read);
    CHECK(read == row);
    // The chunk is searched by its checksum, which ends it.
    CodedChunk chunk;
    encode_chunk({reinterpret_cast<const std::uint8_t*>(row.data()), 8 * row.size()}, {8, compress}, chunk);
    std::string bytes = read_file(file);
    const auto at = bytes.find(std::string(chunk.bytes.begin(), chunk.bytes.end()));
    REQUIRE(at != std::string::npos);
    bytes[at + chunk.bytes.size() / 2] ^= 1;
    write_file(file, bytes);
    const H5File damaged = H5File::open(file);
    CHECK_THROWS_AS(damaged.table("t").read<double>(0, read), Error);
  }
}

TEST_CASE("the bytes of a chunk do not depend on the thread") {
  std::vector<std::uint8_t> bytes(40000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::uint8_t(i / 50 * (i % 3));
  std::array<CodedChunk, 6> coded;
  Pool pool(3);
  pool.run(coded.size(), [&](std::size_t i) { encode_chunk(bytes, {4, true}, coded[i]); });
  CHECK(coded[0].bytes.size() < bytes.size() / 4);
  for (const CodedChunk& c : coded) CHECK(c.bytes == coded[0].bytes);
}

TEST_CASE("bytes that do not shrink are stored, and HDF5 reads the others beside them") {
  constexpr std::size_t kCells = 8192, kChunkRows = 5;
  const TestFolder folder;
  const auto file = folder.path / "t.h5";
  // Numbers of which only the high bytes are similar, and numbers of which all bytes are.
  const auto noise = [](std::size_t i) { return 512 + float(splitmix64(i) >> 40) / float(1 << 17); };
  const auto steps = [](std::size_t i) { return float(i / 64); };
  const auto stored_at_start = [&](const auto& number) {
    std::vector<float> chunk(kChunkRows * kCells);
    for (std::size_t i = 0; i < chunk.size(); ++i) chunk[i] = number(i);
    CodedChunk coded;
    encode_chunk({reinterpret_cast<const std::uint8_t*>(chunk.data()), 4 * chunk.size()}, {4, true}, coded);
    CHECK(coded.skipped == 0);
    CHECK(coded.bytes.size() < 4 * chunk.size());
    // RFC 1951, 3.2.3: the first bits after the two bytes of zlib's header are 0, 00 for a stored block that
    // is not the last.
    return (coded.bytes[2] & 7) == 0;
  };
  CHECK(stored_at_start(noise));
  CHECK_FALSE(stored_at_start(steps));
  constexpr std::uint64_t kRows = 2 * kChunkRows + 1;
  const auto row = [&](std::uint64_t r) {
    std::vector<float> v(kCells);
    for (std::size_t i = 0; i < kCells; ++i) v[i] = r < kChunkRows ? noise(i + r * kCells) : steps(i + r);
    return v;
  };
  {
    H5File f = H5File::create(file, 2);
    H5Table t = f.table<float>("t", {kCells}, kChunkRows, kCells, true);
    f.begin_writing();
    for (std::uint64_t r = 0; r < kRows; ++r) t.append<float>(row(r));
    f.close();
  }
  const H5File f = H5File::open(file);
  std::vector<float> read(kCells);
  for (std::uint64_t r = 0; r < kRows; ++r) {
    f.table("t").read<float>(r, read);
    CHECK(read == row(r));
  }
}
