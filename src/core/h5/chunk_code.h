#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace faba {

/// How the chunks of a dataset are stored.
struct ChunkFilters {
  std::size_t element_bytes = 1;
  bool compress = false;
};

/// A chunk as it is stored in an HDF5 file.
struct CodedChunk {
  std::vector<std::uint8_t> bytes;
  std::uint32_t skipped = 0;  ///< HDF5's filter mask: bit i is set if filter i was not applied
};

/// Applies HDF5's standard filters to a chunk, as H5Dwrite does: shuffle and deflate if `compress` is set,
/// then the Fletcher-32 checksum. Every HDF5 reader reads the result. It may be called from several threads
/// at the same time, unlike the functions of HDF5. The bytes depend on the input and the version of
/// libdeflate only.
void encode_chunk(std::span<const std::uint8_t> chunk, const ChunkFilters& filters, CodedChunk& out);

}  // namespace faba
