#include "app/files/library_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/file.h"

namespace faba {
namespace {

constexpr const char* kFormat = "faba field library 1";

/// The tables of a library file.
struct Tables {
  H5Table current, zero, gradient, field;
  explicit Tables(const H5File& f)
      : current(f.table("current_a")),
        zero(f.table("zero_m")),
        gradient(f.table("gradient_t_per_m")),
        field(f.table("field_t")) {}
  /// Number of complete entries.
  std::uint64_t rows() const {
    return std::min({current.rows(), zero.rows(), gradient.rows(), field.rows()});
  }
  LibraryEntry entry(std::uint64_t row) const {
    LibraryEntry e;
    e.current.resize(current.row_size());
    std::array<double, 2> at{};
    current.read<double>(row, e.current);
    zero.read<double>(row, at);
    gradient.read<double>(row, e.gradient);
    e.zero = {at[0], at[1]};
    return e;
  }
};

Error invalid_library(const std::filesystem::path& file, const Error& reason) {
  return {
      Errc::input, file.string(),
      fmt::format(
          "is not a complete field library ({}); create one with `faba field library RIG.toml --out FILE`",
          std::string(reason.what()).substr(reason.where().empty() ? 0 : reason.where().size() + 2))};
}

void require_library(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    throw Error(
        Errc::input, file.string(),
        fmt::format("file not found; create it with `faba field library RIG.toml --out {}`", file.string()));
}

FieldLibrary::Content content_of(const std::filesystem::path& path) {
  const auto file = std::make_shared<const H5File>(H5File::open(path));
  FieldLibrary::Content c;
  c.source = path.string();
  if (file->text_attribute("/", "format") != kFormat) throw Error(Errc::input, "", "unknown format");
  c.rig = file->text_attribute("/", "rig");
  const auto number = [&](const char* name) { return file->number_attribute("/", name); };
  c.grid = {{number("low_x_m"), number("low_y_m")},
            number("spacing_m"),
            int(number("columns")),
            int(number("rows"))};
  const Tables tables(*file);
  std::uint64_t entries = 0;
  file->table("entries").read<std::uint64_t>(0, {&entries, 1});
  if (tables.rows() != entries || tables.field.row_size() != 2 * c.grid.nodes())
    throw Error(Errc::input, "", "the sizes of the tables do not match");
  for (std::uint64_t i = 0; i < entries; ++i) c.entries.push_back(tables.entry(i));
  c.field = [file, nodes = c.grid.nodes()](std::size_t entry) {
    std::vector<float> values(2 * nodes);
    file->table("field_t").read<float>(entry, values);
    return values;
  };
  return c;
}

}  // namespace

std::shared_ptr<const FieldLibrary> open_library(const std::filesystem::path& file) {
  require_library(file);
  try {
    return std::make_shared<const FieldLibrary>(content_of(file));
  } catch (const Error& e) {
    throw invalid_library(file, e);
  }
}

std::string library_task(const std::filesystem::path& file) {
  require_library(file);
  try {
    return H5File::open(file).text_attribute("/", "task");
  } catch (const Error& e) {
    throw invalid_library(file, e);
  }
}

LibraryWriter::LibraryWriter(const std::filesystem::path& file, const std::string& rig,
                             const std::string& task, const TableGrid& grid, std::size_t coils)
    : path_(file), part_(file.string() + ".part"), file_(H5File::create(part_.string() + ".new")) {
  const auto columns = std::uint64_t(grid.columns), rows = std::uint64_t(grid.rows);
  combination_ = file_.table<std::uint64_t>("combination", {}, 1024, 1, false);
  current_ = file_.table<double>("current_a", {coils}, 1024, coils, false);
  zero_ = file_.table<double>("zero_m", {2}, 1024, 2, false);
  gradient_ = file_.table<double>("gradient_t_per_m", {2}, 1024, 2, false);
  field_ = file_.table<float>("field_t", {rows, columns, 2}, 1, rows, true);
  tried_ = file_.table<std::uint64_t>("tried", {}, 1024, 1, false);
  entries_ = file_.table<std::uint64_t>("entries", {}, 1, 1, false);
  file_.attribute("/", "format", std::string(kFormat));
  file_.attribute("/", "rig", rig);
  file_.attribute("/", "task", task);
  for (const auto& [name, value] : {std::pair{"low_x_m", grid.low.x},
                                    {"low_y_m", grid.low.y},
                                    {"spacing_m", grid.spacing},
                                    {"columns", double(columns)},
                                    {"rows", double(rows)},
                                    {"coils", double(coils)}})
    file_.attribute("/", name, value);
  file_.begin_writing();
  import_unfinished(task);
}

// HDF5 cannot append to a file whose writer was killed, but can read it.
void LibraryWriter::import_unfinished(const std::string& task) {
  std::error_code ec;
  if (std::filesystem::exists(part_, ec)) try {
      const H5File old = H5File::open(part_);
      if (old.text_attribute("/", "task") == task) {
        const Tables tables(old);
        const H5Table combination = old.table("combination");
        const std::uint64_t complete = std::min(tables.rows(), combination.rows());
        std::vector<float> nodes(field_->row_size());
        for (std::uint64_t i = 0; i < complete; ++i) {
          std::uint64_t from = 0;
          combination.read<std::uint64_t>(i, {&from, 1});
          tables.field.read<float>(i, nodes);
          add(from, tables.entry(i), nodes);
        }
        std::uint64_t combinations = 0;
        const H5Table tried_before = old.table("tried");
        if (tried_before.rows() > 0)
          tried_before.read<std::uint64_t>(tried_before.rows() - 1, {&combinations, 1});
        if (combinations > done_) tried(combinations);
      }
    } catch (const Error& e) {
      if (e.code() != Errc::input)
        throw;  // otherwise the readable entries are kept, and the rest is computed again
    }
  file_.rename_complete(part_);
}

std::size_t LibraryWriter::entries() const { return std::size_t(field_->rows()); }

void LibraryWriter::add(std::uint64_t combination, const LibraryEntry& e, std::span<const float> field) {
  const std::array<double, 2> at{e.zero.x, e.zero.y};
  combination_->append<std::uint64_t>({&combination, 1});
  current_->append<double>(e.current);
  zero_->append<double>(at);
  gradient_->append<double>(e.gradient);
  field_->append<float>(field);
  done_ = combination + 1;
}

void LibraryWriter::tried(std::uint64_t combinations) {
  file_.sync();  // entries first: those of all tried sets must be on the disk
  tried_->append<std::uint64_t>({&combinations, 1});
  done_ = combinations;
}

void LibraryWriter::finish() {
  const std::uint64_t n = entries();
  entries_->append<std::uint64_t>({&n, 1});
  for (auto* table : {&combination_, &current_, &zero_, &gradient_, &field_, &tried_, &entries_})
    table->reset();
  file_.close();
  rename_complete(part_, path_);
}

}  // namespace faba
