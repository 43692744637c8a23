#include "field/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

namespace faba {
namespace {

constexpr const char* kFormat = "faba field library 1";
constexpr std::size_t kTies = 16;  // entries with one zero that are looked through for the least power

/// What a library is made of, in its file.
struct Tables {
  H5Table current, zero, gradient, field;
  explicit Tables(const H5File& f)
      : current(f.table("current_a")),
        zero(f.table("zero_m")),
        gradient(f.table("gradient_t_per_m")),
        field(f.table("field_t")) {}
  /// Entries that are there in full.
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

double power(const LibraryEntry& e) {
  double p = 0;
  for (const double i : e.current) p += i * i;
  return p;
}

Error no_library(const std::filesystem::path& file, const Error& reason) {
  return {
      Errc::input, file.string(),
      fmt::format("is not a whole field library ({}); make one with `faba field library RIG.toml --out FILE`",
                  std::string(reason.what()).substr(reason.where().empty() ? 0 : reason.where().size() + 2))};
}

H5File opened(const std::filesystem::path& file) {
  try {
    return H5File::open(file);
  } catch (const Error& e) {
    throw no_library(file, e);
  }
}

/// Zeros as nanoflann wants to see them.
struct Zeros {
  std::vector<std::size_t> entry;
  std::vector<Vec2> at;
  std::size_t kdtree_get_point_count() const { return at.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return axis ? at[i].y : at[i].x; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

struct FieldLibrary::Tree {
  Zeros zeros;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Zeros>, Zeros, 2> index;
  explicit Tree(Zeros z) : zeros(std::move(z)), index(2, zeros) { index.buildIndex(); }

  // The entries that draw cells of a polarity together.
  static std::unique_ptr<Tree> of(const std::vector<LibraryEntry>& all, int polarity) {
    // As seen by north-seekers, who come together where both gradients are negative.
    const auto worst = [&](const LibraryEntry& e) { return polarity > 0 ? e.gradient[1] : -e.gradient[0]; };
    const auto sum = [&](const LibraryEntry& e) { return polarity * (e.gradient[0] + e.gradient[1]); };
    const bool traps =
        std::any_of(all.begin(), all.end(), [&](const LibraryEntry& e) { return worst(e) < 0; });
    Zeros z;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!((traps ? worst(all[i]) : sum(all[i])) < 0)) continue;
      z.entry.push_back(i), z.at.push_back(all[i].zero);
    }
    return std::make_unique<Tree>(std::move(z));
  }
};

FieldLibrary::FieldLibrary(const std::filesystem::path& file) : path_(file), file_(opened(file)) {
  try {
    if (file_.text_attribute("/", "format") != kFormat) throw Error(Errc::input, "", "format");
    rig_ = file_.text_attribute("/", "rig");
    const auto number = [&](const char* name) { return file_.number_attribute("/", name); };
    grid_ = {{number("low_x_m"), number("low_y_m")},
             number("spacing_m"),
             int(number("columns")),
             int(number("rows"))};
    const Tables tables(file_);
    std::uint64_t entries = 0;
    file_.table("entries").read<std::uint64_t>(0, {&entries, 1});
    if (tables.rows() != entries || tables.field.row_size() != 2 * grid_.nodes())
      throw Error(Errc::input, "", "tables do not fit together");
    for (std::uint64_t i = 0; i < entries; ++i) entries_.push_back(tables.entry(i));
  } catch (const Error& e) {
    throw no_library(file, e);
  }
  north_ = Tree::of(entries_, 1);
  south_ = Tree::of(entries_, -1);
}

FieldLibrary::~FieldLibrary() = default;

std::string FieldLibrary::task(const std::filesystem::path& file) {
  const H5File h5 = opened(file);
  try {
    return h5.text_attribute("/", "task");
  } catch (const Error& e) {
    throw no_library(file, e);
  }
}

std::vector<float> FieldLibrary::field(std::size_t entry) const {
  std::vector<float> nodes(2 * grid_.nodes());
  file_.table("field_t").read<float>(entry, nodes);
  return nodes;
}

FieldTable FieldLibrary::table(const Field& field, const std::string& fingerprint) const {
  const auto other = [&] {
    return Error(
        Errc::input, path_.string(),
        "was made for another rig; make it again for this one with `faba field library RIG.toml --out "
        "FILE --force`");
  };
  if (rig_ != fingerprint || (!entries_.empty() && entries_.front().current.size() != field.coils()))
    throw other();
  FieldTable table(field, grid_);
  for (const std::size_t i : {std::size_t(0), entries_.size() / 2, entries_.size() - 1}) {
    if (i >= entries_.size()) continue;
    table.set(entries_[i].current);
    const std::vector<float> kept = this->field(i);
    if (!std::equal(kept.begin(), kept.end(), table.nodes().begin(), [](float a, float b) {
          return std::fabs(a - b) <= 1e-6f * std::max(std::fabs(a), 1e-6f);
        }))
      throw other();
  }
  return table;
}

std::optional<std::size_t> FieldLibrary::nearest(Vec2 at, int polarity) const {
  const Tree& tree = polarity > 0 ? *north_ : *south_;
  std::array<std::uint32_t, kTies> found{};
  std::array<double, kTies> square{};
  const std::array<double, 2> query{at.x, at.y};
  const std::size_t n = tree.index.knnSearch(query.data(), kTies, found.data(), square.data());
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < n; ++i) {
    // Zeros within a nanometre are one.
    if (std::sqrt(square[i]) > std::sqrt(square[0]) + 1e-9) break;
    const std::size_t entry = tree.zeros.entry[found[i]];
    if (!best || power(entries_[entry]) < power(entries_[*best])) best = entry;
  }
  return best;
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
  whole_ = file_.table<std::uint64_t>("entries", {}, 1, 1, false);
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
  take_over(task);
}

// HDF5 cannot go on in a file whose writer was killed, but it can read it.
void LibraryWriter::take_over(const std::string& task) {
  std::error_code ec;
  if (std::filesystem::exists(part_, ec)) try {
      const H5File old = H5File::open(part_);
      if (old.text_attribute("/", "task") == task) {
        const Tables tables(old);
        const H5Table combination = old.table("combination");
        const std::uint64_t whole = std::min(tables.rows(), combination.rows());
        std::vector<float> nodes(field_->row_size());
        for (std::uint64_t i = 0; i < whole; ++i) {
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
      if (e.code() != Errc::input) throw;  // else what could be read is kept, and the rest is made again
    }
  std::filesystem::rename(part_.string() + ".new", part_);
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
  file_.sync();  // entries first: what counts as tried must be there
  tried_->append<std::uint64_t>({&combinations, 1});
  done_ = combinations;
}

void LibraryWriter::finish() {
  const std::uint64_t n = entries();
  whole_->append<std::uint64_t>({&n, 1});
  for (auto* table : {&combination_, &current_, &zero_, &gradient_, &field_, &tried_, &whole_})
    table->reset();
  file_.close();
  std::filesystem::rename(part_, path_);
}

}  // namespace faba
