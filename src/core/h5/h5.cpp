#include "core/h5/h5.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <mutex>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/h5/chunk_rows.h"
#include "core/h5/handle.h"

namespace faba {
namespace {

// Cache of decoded chunks for readers, per table: a row of chunks of every file of this program fits.
constexpr std::size_t kCacheBytes = 64u << 20, kCacheSlots = 12421;
constexpr hsize_t kColumnChunk = 1 << 16;     // values
constexpr std::size_t kTextBuffer = 1 << 14;  // bytes; by default HDF5 clears 2 MB to convert two texts

template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
  if constexpr (std::is_same_v<T, std::int16_t>) return H5T_NATIVE_INT16;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
}

// The innermost message of HDF5's error stack: "... No space left on device ..."
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* e, void* out) -> herr_t {
        if (n == 0 && e->desc) *static_cast<std::string*>(out) = e->desc;
        return 0;
      },
      &text);
  if (const auto at = text.find("error message = '"); at != std::string::npos) {
    text = text.substr(at + 17);
    text = text.substr(0, text.find('\''));
  }
  return text.empty() ? "unknown HDF5 error" : text;
}

// Turns off the error messages that HDF5 prints itself; the setting is per thread.
void quiet() {
  thread_local bool done = false;
  if (std::exchange(done, true)) return;
  static std::once_flag once;
  std::call_once(once, [] {
    H5dont_atexit();  // the clean-up loops forever if a file cannot be flushed
    H5open();
  });
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

struct H5Table::Impl {
  Handle set;
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
    throw Error(code, where, fmt::format("cannot {}: {}", doing, reason()));
  }
  /// Selection of one row, in memory and in the file.
  struct Row {
    Handle memory, in_file;
  };
  Row select(std::uint64_t row) const {
    std::vector<hsize_t> start(dims.size(), 0), count = dims;
    start[0] = row;
    count[0] = 1;
    Handle in_file(H5Dget_space(set), H5Sclose);
    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    return {Handle(H5Screate_simple(int(count.size()), count.data(), nullptr), H5Sclose), std::move(in_file)};
  }
  void write(std::uint64_t first, std::uint64_t rows, const std::vector<CodedChunk>& chunks);
  void start_writing(const ChunkFilters& filters, unsigned threads);
};

void H5Table::Impl::write(std::uint64_t first, std::uint64_t rows, const std::vector<CodedChunk>& chunks) {
  std::vector<hsize_t> extent = dims, at(dims.size(), 0);
  at[0] = first;
  extent[0] = first + rows;
  if (H5Dset_extent(set, extent.data()) < 0) fail(Errc::internal, "write");
  for (std::size_t column = 0; column < chunks.size(); ++column) {
    if (at.size() > 1) at[1] = column * chunk[1];
    const CodedChunk& c = chunks[column];
    if (H5Dwrite_chunk(set, H5P_DEFAULT, c.skipped, at.data(), c.bytes.size(), c.bytes.data()) < 0)
      fail(Errc::internal, "write");
  }
}

void H5Table::Impl::start_writing(const ChunkFilters& filters, unsigned threads) {
  element_bytes = filters.element_bytes;
  std::size_t part = element_bytes;
  for (std::size_t i = 1; i < chunk.size(); ++i) part *= std::size_t(chunk[i]);
  writing = std::make_unique<ChunkRows>(
      ChunkShape{row_bytes(), chunk[0], part}, filters, threads,
      [this](std::uint64_t first, std::uint64_t rows, const std::vector<CodedChunk>& chunks) {
        write(first, rows, chunks);
      });
}

struct H5File::Impl {
  Handle file;
  std::filesystem::path path;
  unsigned threads = 1;                                ///< that encode
  std::vector<std::shared_ptr<H5Table::Impl>> tables;  ///< that are being written
  int descriptor() const;                              ///< of the open file
  [[noreturn]] void fail(Errc code, const char* doing) const {
    throw Error(code, path.string(), fmt::format("cannot {}: {}", doing, reason()));
  }
};

template <class T>
void H5Table::append(std::span<const T> row) {
  Impl& t = *impl_;
  quiet();
  if (row.size() != t.row_size() || type_of<T>() != t.type)
    throw Error(Errc::internal, t.where, "the row has the wrong shape or type");
  t.writing->append(reinterpret_cast<const std::uint8_t*>(row.data()));
  ++t.dims[0];
}

template <class T>
void H5Table::read(std::uint64_t row, std::span<T> out) const {
  const Impl& t = *impl_;
  quiet();
  if (row >= t.dims[0] || out.size() != t.row_size())
    throw Error(Errc::input, t.where,
                fmt::format("row {} not found, or its size differs; the table has {} rows of {} values", row,
                            t.dims[0], t.row_size()));
  const auto at = t.select(row);
  if (H5Dread(t.set, type_of<T>(), at.memory, at.in_file, H5P_DEFAULT, out.data()) < 0)
    t.fail(Errc::input, "read");
}

std::uint64_t H5Table::rows() const { return impl_->dims[0]; }
std::size_t H5Table::row_size() const { return impl_->row_size(); }

H5File::H5File(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
H5File::H5File(H5File&&) noexcept = default;
H5File& H5File::operator=(H5File&&) noexcept = default;
H5File::~H5File() {
  if (!impl_) return;
  quiet();
  try {
    for (const auto& t : impl_->tables) t->writing->flush();
  } catch (...) {  // close() and sync() report errors; a destructor cannot
  }
}

H5File H5File::create(const std::filesystem::path& file, unsigned threads) {
  quiet();
  auto impl = std::make_unique<Impl>();
  impl->path = file;
  impl->threads = threads;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110,
                       H5F_LIBVER_V110);  // required for single writer, multiple readers
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);  // equal content gives equal files
  impl->file = Handle(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  if (impl->file < 0) impl->fail(Errc::internal, "create");
  return H5File(std::move(impl));
}

H5File H5File::open(const std::filesystem::path& file) {
  quiet();
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    throw Error(Errc::input, file.string(), "file not found; check the name of the HDF5 file");
  if (std::filesystem::is_directory(file, ec))
    throw Error(Errc::input, file.string(), "is a directory; give the name of an HDF5 file");
  auto impl = std::make_unique<Impl>();
  impl->path = file;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_cache(access, 0, kCacheSlots, kCacheBytes, 1.0);
  impl->file = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  // HDF5 retries to read partly written metadata, with a pause that doubles each time; the default number of
  // attempts takes hours. A millisecond in total is enough for a running writer.
  constexpr unsigned kReadAttempts = 20;
  H5Pset_metadata_read_attempts(access, kReadAttempts);
  if (impl->file < 0)  // the writer was killed: the flag "open for writing" is still set
    impl->file = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), H5Fclose);
  if (impl->file < 0)
    throw Error(Errc::input, file.string(),
                fmt::format("cannot be opened as an HDF5 file ({}); check that it is a complete HDF5 file",
                            reason()));
  return H5File(std::move(impl));
}

template <class T>
H5Table H5File::table(const std::string& name, const std::vector<std::uint64_t>& row_shape,
                      std::uint64_t chunk_rows, std::uint64_t chunk_columns, bool compress) {
  auto t = std::make_shared<H5Table::Impl>();
  t->where = impl_->path.string();
  t->type = type_of<T>();
  t->dims.assign({0});
  t->dims.insert(t->dims.end(), row_shape.begin(), row_shape.end());
  std::vector<hsize_t> max_dims = t->dims, chunk = t->dims;
  max_dims[0] = H5S_UNLIMITED;
  chunk[0] = chunk_rows;
  if (chunk.size() > 1) chunk[1] = std::min<hsize_t>(chunk[1], chunk_columns);
  const Handle space(H5Screate_simple(int(t->dims.size()), t->dims.data(), max_dims.data()), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  H5Pset_chunk(creation, int(chunk.size()), chunk.data());
  if (compress) {
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 1);
  }
  H5Pset_fletcher32(creation);  // a flipped bit gives a read error
  t->set = Handle(H5Dcreate2(impl_->file, name.c_str(), t->type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                  H5Dclose);
  if (t->set < 0) impl_->fail(Errc::internal, "create a table");
  t->chunk = chunk;
  t->start_writing({sizeof(T), compress}, impl_->threads);
  impl_->tables.push_back(t);
  return H5Table(t);
}

H5Table H5File::table(const std::string& name) const {
  auto t = std::make_shared<H5Table::Impl>();
  t->where = impl_->path.string();
  t->set = Handle(H5Dopen2(impl_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (t->set < 0) throw Error(Errc::input, t->where, fmt::format("table \"{}\" not found", name));
  const Handle space(H5Dget_space(t->set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) throw Error(Errc::input, t->where, fmt::format("\"{}\" is not a table", name));
  t->dims.resize(std::size_t(rank));
  H5Sget_simple_extent_dims(space, t->dims.data(), nullptr);
  return H5Table(t);
}

bool H5File::has(const std::string& name) const {
  return H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) > 0;
}

template <class T>
void H5File::column(const std::string& name, const std::vector<T>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  const Handle type(H5Tcopy(std::is_same_v<T, std::string> ? H5T_C_S1 : H5T_NATIVE_UINT32), H5Tclose);
  std::vector<const char*> texts;
  const void* data = values.data();
  if constexpr (std::is_same_v<T, std::string>) {
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    for (const std::string& text : values) texts.push_back(text.c_str());
    data = texts.data();
  } else if (size > 0) {
    const hsize_t chunk = std::min<hsize_t>(size, kColumnChunk);
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 1);
    H5Pset_fletcher32(creation);
  }
  const Handle set(H5Dcreate2(impl_->file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                   H5Dclose);
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_buffer(transfer, kTextBuffer, nullptr, nullptr);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, transfer, data) < 0)
    impl_->fail(Errc::internal, "write");
}

void H5File::name_dimensions(const std::string& table, const std::vector<std::string>& scales) {
  const Handle set(H5Dopen2(impl_->file, table.c_str(), H5P_DEFAULT), H5Dclose);
  for (unsigned i = 0; i < scales.size(); ++i) {
    const Handle scale(H5Dopen2(impl_->file, scales[i].c_str(), H5P_DEFAULT), H5Dclose);
    if (H5DSis_scale(scale) == 0 && H5DSset_scale(scale, scales[i].c_str()) < 0)
      impl_->fail(Errc::internal, "write");
    if (H5DSattach_scale(set, scale, i) < 0) impl_->fail(Errc::internal, "write");
  }
}

void H5File::attribute(const std::string& object, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate_by_name(impl_->file, object.c_str(), name.c_str(), H5T_NATIVE_DOUBLE, space,
                                   H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a < 0 || H5Awrite(a, H5T_NATIVE_DOUBLE, &value) < 0) impl_->fail(Errc::internal, "write");
}

void H5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose), type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, value.size()));
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Handle a(H5Acreate_by_name(impl_->file, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a < 0 || H5Awrite(a, type, value.c_str()) < 0) impl_->fail(Errc::internal, "write");
}

double H5File::number_attribute(const std::string& object, const std::string& name) const {
  const Handle a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  double value = 0;
  if (a < 0 || H5Aread(a, H5T_NATIVE_DOUBLE, &value) < 0)
    throw Error(Errc::input, impl_->path.string(), fmt::format("numeric attribute \"{}\" not found", name));
  return value;
}

std::string H5File::text_attribute(const std::string& object, const std::string& name) const {
  const Handle a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a >= 0) {
    const Handle type(H5Aget_type(a), H5Tclose);
    std::string value(H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) ? H5Tget_size(type) : 0,
                      '\0');
    if (!value.empty() && H5Aread(a, type, value.data()) >= 0) return value.substr(0, value.find('\0'));
  }
  throw Error(Errc::input, impl_->path.string(), fmt::format("string attribute \"{}\" not found", name));
}

void H5File::begin_writing() {
  if (H5Fstart_swmr_write(impl_->file) < 0) impl_->fail(Errc::internal, "start writing");
}

int H5File::Impl::descriptor() const {
  void* handle = nullptr;  // pointer to the file descriptor of HDF5
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) fail(Errc::internal, "write");
  return *static_cast<const int*>(handle);
}

void H5File::start_sync() {
  quiet();
  start_flush(impl_->descriptor());
}

void H5File::sync() {
  quiet();
  for (const auto& t : impl_->tables) t->writing->flush();
  if (H5Fflush(impl_->file, H5F_SCOPE_GLOBAL) < 0) impl_->fail(Errc::internal, "write");
  flush_descriptor(impl_->descriptor(), impl_->path);
}

void H5File::rename_complete(const std::filesystem::path& to) {
  sync();
  faba::rename_complete(impl_->path, to);
  impl_->path = to;
  for (const auto& t : impl_->tables) t->where = to.string();
}

void H5File::close() {
  sync();
  for (const auto& t : impl_->tables)
    if (!t->set.release()) impl_->fail(Errc::internal, "write");
  if (!impl_->file.release()) impl_->fail(Errc::internal, "close");
}

#define FABA_H5_TYPE(T)                                                                                   \
  template void H5Table::append<T>(std::span<const T>);                                                   \
  template void H5Table::read<T>(std::uint64_t, std::span<T>) const;                                      \
  template H5Table H5File::table<T>(const std::string&, const std::vector<std::uint64_t>&, std::uint64_t, \
                                    std::uint64_t, bool);
FABA_H5_TYPE(float)
FABA_H5_TYPE(double)
FABA_H5_TYPE(std::uint8_t)
FABA_H5_TYPE(std::int16_t)
FABA_H5_TYPE(std::int32_t)
FABA_H5_TYPE(std::uint64_t)
#undef FABA_H5_TYPE
template void H5File::column<std::uint32_t>(const std::string&, const std::vector<std::uint32_t>&);
template void H5File::column<std::string>(const std::string&, const std::vector<std::string>&);

}  // namespace faba
