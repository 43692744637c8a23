#include "core/h5/chunk_code.h"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>
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

// The low bytes of floating-point numbers are noise to a compressor, which takes as long for them as for the
// others. A shuffled chunk begins with them: its first bytes are stored if a sample of them does not shrink.
// Twice the distance at which the values of a cell that does not move repeat (PositionTable's columns), so
// that a sample contains repetitions. It is taken at the end of the bytes, because cells stop in the course
// of a run.
constexpr std::size_t kSample = 16384;
// A sample shrinks if it loses 1/256 of its size: less is not worth the time of a level-1 compressor.
constexpr std::size_t kLeastGain = kSample / 256;

bool shrinks(std::span<const std::uint8_t> sample) {
  std::uint8_t shrunk[kSample - kLeastGain];
  return libdeflate_deflate_compress(&compressor(), sample.data(), sample.size(), shrunk, sizeof shrunk) > 0;
}

// The number of bytes at the beginning of a shuffled chunk that are to be stored.
std::size_t stored_bytes(std::span<const std::uint8_t> shuffled, std::size_t element_bytes) {
  const std::size_t plane = shuffled.size() / element_bytes;
  if (plane < 2 * kSample) return 0;  // a sample costs too much of the compression
  std::size_t stored = 0;
  while (stored + plane <= shuffled.size() && !shrinks(shuffled.subspan(stored + plane - kSample, kSample)))
    stored += plane;
  return stored;
}

// Compresses to zlib's format (RFC 1950, RFC 1951): blocks that are stored, then compressed ones. Returns the
// size, or 0 if it exceeds that of `out`.
std::size_t compress(std::span<const std::uint8_t> in, std::size_t stored, std::span<std::uint8_t> out) {
  constexpr std::size_t kBlock = 65535, kBlockHeader = 5, kEnds = 2 + 4;
  if (stored + kEnds + kBlockHeader * (stored / kBlock + 1) > out.size()) return 0;
  std::uint8_t* to = out.data();
  *to++ = 0x78;  // deflate with a window of 32 KiB
  *to++ = 0x01;  // fastest level; makes the two bytes a multiple of 31
  for (std::size_t at = 0; at < stored;) {
    const std::size_t n = std::min(kBlock, stored - at), not_n = ~n;
    for (const std::size_t byte : {std::size_t{0}, n, n >> 8, not_n, not_n >> 8})
      *to++ = std::uint8_t(byte & 0xFF);
    to = std::copy_n(in.data() + at, n, to);
    at += n;
  }
  const auto used = std::size_t(to - out.data());
  const std::size_t size = libdeflate_deflate_compress(&compressor(), in.data() + stored, in.size() - stored,
                                                       to, out.size() - used - 4);
  if (size == 0) return 0;
  to += size;
  const std::uint32_t sum = libdeflate_adler32(1, in.data(), in.size());
  for (int shift = 24; shift >= 0; shift -= 8) *to++ = std::uint8_t(sum >> shift & 0xFF);
  return std::size_t(to - out.data());
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
// before the second one can exceed 32 bits. The sums of such a block are independent of those before it, so
// that the compiler computes several words at once.
std::uint32_t fletcher32(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kWords = 360;
  const auto reduce = [](std::uint32_t s) { return (s & 0xFFFF) + (s >> 16); };
  std::uint32_t a = 0, b = 0;
  const auto add = [&](std::uint32_t words, std::uint32_t sum, std::uint32_t weighted) {
    b = reduce(b + words * a + weighted);
    a = reduce(a + sum);
  };
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size() / 2;
  for (; left >= kWords; left -= kWords) {
    std::uint32_t sum = 0, weighted = 0;
    for (std::uint32_t i = 0; i < kWords; ++i) {
      std::uint16_t word = 0;
      std::memcpy(&word, at + std::size_t{2} * i, 2);
      if constexpr (std::endian::native == std::endian::little) word = std::uint16_t(word << 8 | word >> 8);
      sum += word;
      weighted += (kWords - i) * word;
    }
    add(kWords, sum, weighted);
    at += std::size_t{2} * kWords;
  }
  for (; left > 0; --left, at += 2) {
    const auto word = std::uint32_t(at[0] << 8 | at[1]);
    add(1, word, word);
  }
  if (bytes.size() % 2 != 0) {
    const auto word = std::uint32_t(*at << 8);
    add(1, word, word);
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
    const std::size_t size = compress(shuffled, stored_bytes(shuffled, filters.element_bytes), out.bytes);
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
