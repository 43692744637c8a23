#include "core/h5/chunk_code.h"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>

namespace faba {
namespace {

// Level 1 of libdeflate takes half the time of zlib's level 1 for the same size; `ctest -R core.chunk_code`
// reads its output with zlib's inflate through HDF5.
constexpr int kLevel = 1;
constexpr std::uint32_t kDeflateSkipped = 1u << 1;  // deflate is the second filter

struct Freed {
  void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
};

libdeflate_compressor& compressor() {
  thread_local const std::unique_ptr<libdeflate_compressor, Freed> one(libdeflate_alloc_compressor(kLevel));
  if (!one) throw std::bad_alloc();
  return *one;
}

// HDF5's filter "shuffle": first byte of all elements, then the second byte of all elements ...
template <std::size_t kBytes>
void shuffle(std::span<const std::uint8_t> in, std::uint8_t* out) {
  const std::size_t n = in.size() / kBytes;
  for (std::size_t b = 0; b < kBytes; ++b)
    for (std::size_t i = 0; i < n; ++i) out[b * n + i] = in[kBytes * i + b];
}

void shuffle(std::span<const std::uint8_t> in, std::size_t element_bytes, std::uint8_t* out) {
  switch (element_bytes) {
    case 2:
      return shuffle<2>(in, out);
    case 4:
      return shuffle<4>(in, out);
    case 8:
      return shuffle<8>(in, out);
    default:
      std::copy(in.begin(), in.end(), out);  // HDF5 does not shuffle bytes
  }
}

// Fletcher's checksum of big-endian 16-bit words, as HDF5 stores it. The sums are reduced after 360 words,
// before the second one can exceed 32 bits.
std::uint32_t fletcher32(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kWords = 360;
  std::uint32_t a = 0, b = 0;
  const auto reduce = [](std::uint32_t s) { return (s & 0xFFFF) + (s >> 16); };
  std::size_t at = 0;
  for (std::size_t words = bytes.size() / 2; words > 0;) {
    const std::size_t some = std::min(words, kWords);
    words -= some;
    for (std::size_t i = 0; i < some; ++i, at += 2) {
      a += std::uint32_t(bytes[at] << 8 | bytes[at + 1]);
      b += a;
    }
    a = reduce(a);
    b = reduce(b);
  }
  if (bytes.size() % 2 != 0) {
    a += std::uint32_t(bytes[at] << 8);
    b += a;
    a = reduce(a);
    b = reduce(b);
  }
  return reduce(b) << 16 | reduce(a);
}

}  // namespace

void encode_chunk(std::span<const std::uint8_t> chunk, const ChunkFilters& filters, CodedChunk& out) {
  out.skipped = 0;
  if (filters.compress) {
    thread_local std::vector<std::uint8_t> shuffled;
    shuffled.resize(chunk.size());
    shuffle(chunk, filters.element_bytes, shuffled.data());
    out.bytes.resize(chunk.size());
    const std::size_t size = libdeflate_zlib_compress(&compressor(), shuffled.data(), shuffled.size(),
                                                      out.bytes.data(), out.bytes.size());
    if (size > 0) {
      out.bytes.resize(size);
    } else {  // it does not become smaller
      out.bytes = shuffled;
      out.skipped = kDeflateSkipped;
    }
  } else {
    out.bytes.assign(chunk.begin(), chunk.end());
  }
  const std::uint32_t sum = fletcher32(out.bytes);
  for (int i = 0; i < 4; ++i) out.bytes.push_back(std::uint8_t(sum >> (8 * i)));
}

}  // namespace faba
