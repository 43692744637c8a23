#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// An HDF5 dataset to which rows are appended. Rows are kept in memory until a row of chunks is complete, or
/// until H5File::sync(); so is the row of chunks before. Element types: float,
/// double, std::uint8_t, std::int16_t, std::int32_t, std::uint64_t. Valid as long as its file is open. Every
/// failure throws Error(internal) with the file name and the reason given by HDF5.
class H5Table {
 public:
  template <class T>
  void append(std::span<const T> row);
  template <class T>
  void read(std::uint64_t row, std::span<T> out) const;
  std::uint64_t rows() const;
  std::size_t row_size() const;  ///< elements

  struct Impl;
  explicit H5Table(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

 private:
  std::shared_ptr<Impl> impl_;
};

/// An HDF5 file. It is readable at any time while it is written, and after the writing process was killed
/// (SWMR: single writer, multiple readers). One thread at a time may use a file. Several threads may use
/// several files, because Debian builds HDF5 thread-safe (its calls are serialised).
class H5File {
 public:
  /// `threads`: number of threads that compress a row of chunks while the next one is filled; 1: the calling
  /// thread compresses. Throws Error(internal) if the file cannot be created.
  static H5File create(const std::filesystem::path& file, unsigned threads = 1);
  /// Opens for reading, also a file whose writer was killed. Throws Error(input).
  static H5File open(const std::filesystem::path& file);
  H5File(H5File&&) noexcept;
  H5File& operator=(H5File&&) noexcept;
  ~H5File();  ///< writes the rows that are still in memory, without a report of errors

  /// `row_shape`: shape of one row; {} for a scalar. Element type T. A chunk has `chunk_rows` rows and
  /// `chunk_columns` elements along the first dimension of a row. Tables and attributes must be created
  /// before begin_writing().
  template <class T>
  H5Table table(const std::string& name, const std::vector<std::uint64_t>& row_shape,
                std::uint64_t chunk_rows, std::uint64_t chunk_columns, bool compress);
  /// An existing table. Throws Error(input) if it does not exist or has no rows dimension.
  H5Table table(const std::string& name) const;
  bool has(const std::string& name) const;

  /// Writes a dataset of fixed length. T: std::uint32_t or std::string.
  template <class T>
  void column(const std::string& name, const std::vector<T>& values);
  /// Attaches the one-dimensional dataset `scale` as HDF5 dimension scale to dimensions of `table`, which
  /// gives the dimension its name in xarray and netCDF programs: one for each of the first dimensions. Before
  /// begin_writing().
  void name_dimensions(const std::string& table, const std::vector<std::string>& scales);

  /// `object` is a table's name or "/" for the file.
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  double number_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;

  void begin_writing();  ///< from here on other processes can read, and a crash leaves a readable file
  void sync();           ///< writes everything appended so far to the disk
  void start_sync();     ///< begins to write complete rows of chunks to the disk; sync() takes less time then
  /// Syncs and renames the file to its final name; writing may continue.
  void rename_complete(const std::filesystem::path& to);
  void close();  ///< throws on errors, which the destructor cannot

 private:
  struct Impl;
  explicit H5File(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
