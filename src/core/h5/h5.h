#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace faba {

/// A table of an HDF5 file that grows by rows. Element types: float, double, std::uint8_t, std::int32_t,
/// std::uint64_t. Valid as long as its file. Every failure throws Error(internal) with the file's name and
/// HDF5's reason.
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

/// An HDF5 file. While it is written it stays readable at any moment, also after the process was killed
/// (single writer, many readers). One thread at a time may use a file; several files may be open in several
/// threads, since Debian builds HDF5 thread-safe (its calls take turns).
class H5File {
 public:
  /// Throws Error(internal) when it cannot be made.
  static H5File create(const std::filesystem::path& file);
  /// For reading; also a file whose writer died. Throws Error(input).
  static H5File open(const std::filesystem::path& file);
  H5File(H5File&&) noexcept;
  H5File& operator=(H5File&&) noexcept;
  ~H5File();

  /// `row_shape`: shape of one row; {} for a single number. Element type T. Rows come in chunks of
  /// `chunk_rows` by, in the first dimension of the row, `chunk_columns`. Tables and attributes must be made
  /// before begin_writing().
  template <class T>
  H5Table table(const std::string& name, const std::vector<std::uint64_t>& row_shape,
                std::uint64_t chunk_rows, std::uint64_t chunk_columns, bool compress);
  /// An existing table. Throws Error(input) when it is absent or of another shape.
  H5Table table(const std::string& name) const;
  bool has(const std::string& name) const;

  /// `object` is a table's name or "/" for the file.
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  double number_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;

  void begin_writing();  ///< from here on readers may follow, and a crash leaves a readable file
  void sync();           ///< everything appended so far to the disk
  /// Brings all to the disk and gives the file its final name; writing may continue.
  void rename_complete(const std::filesystem::path& to);
  void close();  ///< reports what a destructor cannot

 private:
  struct Impl;
  explicit H5File(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
