#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/h5/chunk_code.h"

namespace faba {

/// Shape of the chunks of a table in bytes.
struct ChunkShape {
  std::size_t row_bytes = 0;   ///< of a row of the table
  std::uint64_t rows = 1;      ///< of a chunk
  std::size_t part_bytes = 0;  ///< of a row of a chunk; a row of the table is divided into parts of this size
  std::size_t columns() const { return row_bytes == 0 ? 1 : (row_bytes + part_bytes - 1) / part_bytes; }
};

/// Collects the rows of a table and encodes them, a row of chunks at a time: several threads encode one while
/// the caller fills the next. Encoded chunks are passed to `write` in order and by the calling thread,
/// because HDF5 compresses in one thread and under its global lock. One thread calls the functions.
class ChunkRows {
 public:
  /// Receives all chunks that begin at table row `first`; `rows` of their rows are used so far. The same
  /// chunks are passed again when they have more rows.
  using Write =
      std::function<void(std::uint64_t first, std::uint64_t rows, const std::vector<CodedChunk>& chunks)>;

  /// `threads`: that encode; 1: the calling thread.
  ChunkRows(ChunkShape shape, ChunkFilters filters, unsigned threads, Write write);
  ~ChunkRows();
  void append(const std::uint8_t* row);
  /// Writes all rows that are not written yet.
  void flush();

 private:
  struct Batch {
    std::vector<std::uint8_t> rows;
    std::uint64_t first = 0;
    std::vector<CodedChunk> chunks;
  };
  struct Coders;

  void encode(Batch& batch) const;
  void encode(Batch& batch, std::size_t column) const;
  void write(const Batch& batch);
  void write_coded();

  ChunkShape shape_;
  ChunkFilters filters_;
  Write write_;
  Batch filling_, coding_;
  bool unwritten_ = false;          ///< some rows of filling_ are not written
  bool coded_ = false;              ///< coding_ is being encoded, or encoded and not written
  std::unique_ptr<Coders> coders_;  ///< last: its threads use the other members
};

}  // namespace faba
