#pragma once
#include <fmt/format.h>
#include <hdf5.h>

#include <utility>

#include "core/error.h"
#include "core/h5/chunk_rows.h"
#include "core/h5/h5.h"

namespace faba {

// Only files of this folder include this header, because it includes that of HDF5.

namespace h5 {

/// A handle closed by the function that belongs to it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& o) noexcept : id_(std::exchange(o.id_, -1)), close_(o.close_) {}
  Handle& operator=(Handle&& o) noexcept {
    std::swap(id_, o.id_);
    std::swap(close_, o.close_);
    return *this;
  }
  ~Handle() { release(); }
  bool release() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }
  operator hid_t() const { return id_; }  // NOLINT: used as the id in calls of the C library

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// The innermost message of HDF5's error stack: "... No space left on device ..."
std::string reason();
/// Turns off the error messages that HDF5 prints itself; the setting is per thread.
void quiet();

}  // namespace h5

struct H5Table::Impl {
  h5::Handle set;
  hid_t type = -1;
  std::vector<hsize_t> dims, chunk;  ///< rows first
  std::string where;

  std::size_t element_bytes = 0;
  std::unique_ptr<ChunkRows> writing;  ///< of a table that is being written

  std::size_t row_size() const {
    std::size_t n = 1;
    for (std::size_t i = 1; i < dims.size(); ++i) n *= std::size_t(dims[i]);
    return n;
  }
  std::size_t row_bytes() const { return row_size() * element_bytes; }
  [[noreturn]] void fail(Errc code, const char* doing) const {
    throw Error(code, where, fmt::format("cannot {}: {}", doing, h5::reason()));
  }
  /// Selection of one row, in memory and in the file.
  struct Row {
    h5::Handle memory, in_file;
  };
  Row select(std::uint64_t row) const {
    std::vector<hsize_t> start(dims.size(), 0), count = dims;
    start[0] = row;
    count[0] = 1;
    h5::Handle in_file(H5Dget_space(set), H5Sclose);
    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    return {h5::Handle(H5Screate_simple(int(count.size()), count.data(), nullptr), H5Sclose),
            std::move(in_file)};
  }
  void write(std::uint64_t first, std::uint64_t rows, const std::vector<CodedChunk>& chunks);
  void start_writing(const ChunkFilters& filters, unsigned threads);
};

struct H5File::Impl {
  h5::Handle file;
  std::filesystem::path path;
  unsigned threads = 1;                                ///< that encode
  std::vector<std::shared_ptr<H5Table::Impl>> tables;  ///< that are being written
  [[noreturn]] void fail(Errc code, const char* doing) const {
    throw Error(code, path.string(), fmt::format("cannot {}: {}", doing, h5::reason()));
  }
};

}  // namespace faba
