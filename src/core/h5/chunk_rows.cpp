#include "core/h5/chunk_rows.h"

#include <algorithm>
#include <utility>

#include "core/threads/job_thread.h"
#include "core/threads/parallel.h"

namespace faba {

struct ChunkRows::Coders {
  explicit Coders(unsigned threads) : pool(threads) {}
  Pool pool;
  JobThread thread{1};
};

ChunkRows::ChunkRows(ChunkShape shape, ChunkFilters filters, unsigned threads, Write write)
    : shape_(shape), filters_(filters), write_(std::move(write)) {
  if (threads > 1 && shape_.columns() > 1) coders_ = std::make_unique<Coders>(threads);
}

ChunkRows::~ChunkRows() = default;

void ChunkRows::append(const std::uint8_t* row) {
  filling_.rows.insert(filling_.rows.end(), row, row + shape_.row_bytes);
  unwritten_ = true;
  if (filling_.rows.size() < shape_.rows * shape_.row_bytes) return;
  write_coded();
  std::swap(coding_, filling_);
  coded_ = true;
  unwritten_ = false;
  if (coders_)
    coders_->thread.add([this] { encode(coding_); });
  else
    encode(coding_);
  filling_.rows.clear();
  filling_.first = coding_.first + shape_.rows;
}

void ChunkRows::flush() {
  write_coded();
  if (!std::exchange(unwritten_, false)) return;
  encode(filling_);
  write(filling_);
}

void ChunkRows::write_coded() {
  if (!std::exchange(coded_, false)) return;
  if (coders_) coders_->thread.wait();
  write(coding_);
}

void ChunkRows::write(const Batch& batch) {
  write_(batch.first, batch.rows.size() / shape_.row_bytes, batch.chunks);
}

void ChunkRows::encode(Batch& batch) const {
  batch.chunks.resize(shape_.columns());
  const auto job = [&](std::size_t column) { encode(batch, column); };
  if (coders_) {
    coders_->pool.run_uneven(shape_.columns(), job);
  } else {
    for (std::size_t column = 0; column < shape_.columns(); ++column) job(column);
  }
}

// A chunk is always stored in its full size; elements beyond the table are zero.
void ChunkRows::encode(Batch& batch, std::size_t column) const {
  thread_local std::vector<std::uint8_t> raw;
  raw.assign(std::size_t(shape_.rows) * shape_.part_bytes, 0);
  const std::size_t begin = column * shape_.part_bytes,
                    used = std::min(shape_.part_bytes, shape_.row_bytes - begin);
  for (std::size_t r = 0; r < batch.rows.size() / shape_.row_bytes; ++r)
    std::copy_n(batch.rows.data() + r * shape_.row_bytes + begin, used, raw.data() + r * shape_.part_bytes);
  encode_chunk(raw, filters_, batch.chunks[column]);
}

}  // namespace faba
