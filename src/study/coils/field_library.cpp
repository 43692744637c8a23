#include "study/coils/field_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/files/library_file.h"
#include "app/scenario/rig_file.h"
#include "core/file_lock.h"
#include "core/statistics.h"
#include "core/threads/parallel.h"
#include "field/null.h"

namespace faba {
namespace {

constexpr std::uint64_t kMostCombinations = 1'000'000'000;
constexpr std::size_t kBlock = 1 << 15;  // sets of currents between checks for progress and stop

/// All sets of currents on the lattice, numbered.
class Lattice {
 public:
  Lattice(std::vector<double> most, int levels) : most_(std::move(most)), levels_(levels) {
    double all = 1;
    for (std::size_t k = 0; k < most_.size(); ++k) all *= 2 * levels_ + 1;
    if (all > double(kMostCombinations))
      throw Error(
          Errc::usage, "--levels",
          fmt::format("{} levels of {} coils are {:.2g} sets of currents; at most {:.0e} are permitted",
                      levels_, most_.size(), all, double(kMostCombinations)));
    size_ = std::uint64_t(all);
  }
  /// The largest number of levels with at most 4 million sets.
  static int default_levels(std::size_t coils) {
    int n = 1;
    while (n < 100 && std::pow(2 * n + 3, double(coils)) <= 4e6) ++n;
    return n;
  }
  std::uint64_t size() const { return size_; }
  /// The set of currents of an index; none if no coil is at its limit.
  std::optional<std::vector<double>> at(std::uint64_t index) const {
    std::vector<double> current;
    bool full = false;
    for (const double most : most_) {
      const int level = int(index % std::uint64_t(2 * levels_ + 1)) - levels_;
      index /= std::uint64_t(2 * levels_ + 1);
      full = full || std::abs(level) == levels_;
      current.push_back(most * level / levels_);
    }
    return full ? std::optional(current) : std::nullopt;
  }

 private:
  std::vector<double> most_;
  int levels_;
  std::uint64_t size_ = 0;
};

/// Finds the zero of a set of currents in a rectangle about the centre; rejects weak traps.
class Search {
 public:
  Search(const Field& field, Vec2 half) : field_(field), half_(half) {
    const FieldNull best = null_at(field, {}, 1, current_limits(field));
    traps_ = !best.saddle;
    least_ = best.reachable ? kLeast * strength(best.gradient) : 0;
    for (const Vec2 corner : {Vec2{0, 0}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
      Start s{{0.5 * corner.x * half.x, 0.5 * corner.y * half.y}, {}, {}};
      s.b.resize(field.coils());
      s.g.resize(field.coils());
      field.basis({s.at.x, s.at.y, 0}, s.b, s.g);
      starts_.push_back(std::move(s));
    }
  }
  std::optional<LibraryEntry> operator()(const std::vector<double>& current) const {
    for (const Start& s : starts_) {
      if (!near(s, current)) continue;
      const Vec2 at = find_null(field_, current, s.at);
      if (!(std::fabs(at.x) <= half_.x && std::fabs(at.y) <= half_.y)) continue;
      const LibraryEntry e{current, at, null_gradient(field_, current, at)};
      return strength(e.gradient) >= least_ ? std::optional(e) : std::nullopt;
    }
    return std::nullopt;
  }

 private:
  static constexpr double kLeast = 0.5;  // of the strongest trap at the centre; weaker ones are rejected
  struct Start {
    Vec2 at;
    std::vector<Vec3> b;
    std::vector<Mat3> g;
  };
  // Of a trap the gradient of its weaker axis, for cells of either polarity; of a saddle the trapping
  // gradient minus the repelling one.
  double strength(const NullGradient& g) const {
    return traps_ ? std::max(-g[1], g[0]) : std::fabs(g[0] + g[1]);
  }
  // Whether the first step of Newton's method ends near the rectangle: it rejects most sets of currents at a
  // thousandth of the cost.
  bool near(const Start& s, const std::vector<double>& current) const {
    Vec3 b = field_.ambient();
    double xx = 0, xy = 0, yx = 0, yy = 0;
    for (std::size_t k = 0; k < current.size(); ++k) {
      b = b + current[k] * s.b[k];
      xx += current[k] * s.g[k][0][0];
      xy += current[k] * s.g[k][0][1];
      yx += current[k] * s.g[k][1][0];
      yy += current[k] * s.g[k][1][1];
    }
    const double d = xx * yy - xy * yx;
    const Vec2 zero = s.at - (1 / d) * Vec2{yy * b.x - xy * b.y, xx * b.y - yx * b.x};
    return std::fabs(zero.x) <= 2 * half_.x && std::fabs(zero.y) <= 2 * half_.y;  // not with d = 0
  }

  const Field& field_;
  Vec2 half_;
  bool traps_ = false;
  double least_ = 0;
  std::vector<Start> starts_;
};

// Compares the library with the solver at points on a grid over the rectangle.
void compare_with_solver(const Field& field, const FieldLibrary& library, Vec2 half,
                         FieldLibrarySummary& summary) {
  constexpr int kSide = 15;
  std::vector<double> off, strength;
  const std::vector<double> most = current_limits(field);
  for (int i = 0; i < kSide; ++i)
    for (int k = 0; k < kSide; ++k) {
      const Vec2 at{half.x * ((2 * i + 1.0) / kSide - 1), half.y * ((2 * k + 1.0) / kSide - 1)};
      const auto entry = library.nearest(at, 1);
      if (!entry) continue;
      const LibraryEntry& e = library.entries()[*entry];
      off.push_back(norm(e.zero - at));
      const FieldNull solved = null_at(field, at, 1, most);
      if (solved.reachable && !solved.saddle && e.gradient[1] < 0)
        strength.push_back(e.gradient[1] / solved.gradient[1]);
    }
  if (!off.empty())
    summary.off = {.median = median_high(off), .largest = *std::max_element(off.begin(), off.end())};
  if (!strength.empty()) summary.strength = median_high(strength);
}

struct Unlock {
  FileLock& lock;
  explicit Unlock(FileLock& l) : lock(l) {}
  Unlock(const Unlock&) = delete;
  Unlock& operator=(const Unlock&) = delete;
  ~Unlock() {
    try {
      lock.complete();
    } catch (const Error&) {  // an empty lock file remains, which does no harm
      return;
    }
  }
};

TableGrid library_grid(const FieldLibraryOptions& o) {
  const double spacing = o.spacing > 0 ? o.spacing : std::max(o.width, o.height) / 64;
  const TableGrid grid{{-0.5 * o.width, -0.5 * o.height},
                       spacing,
                       std::max(2, int(std::ceil(o.width / spacing - 1e-9)) + 1),
                       std::max(2, int(std::ceil(o.height / spacing - 1e-9)) + 1)};
  if (double(grid.columns) * grid.rows > 1 << 22)
    throw Error(Errc::usage, "--spacing",
                fmt::format("makes {} x {} nodes; at most 4 million are permitted", grid.columns, grid.rows));
  return grid;
}

FieldLibrarySummary summary_of(const FieldLibrary& library, const std::filesystem::path& out,
                               std::uint64_t combinations) {
  FieldLibrarySummary summary;
  summary.out = out;
  summary.combinations = combinations;
  summary.entries = library.entries().size();
  summary.traps = std::count_if(library.entries().begin(), library.entries().end(),
                                [](const LibraryEntry& e) { return e.gradient[1] < 0 || e.gradient[0] > 0; });
  return summary;
}

}  // namespace

FieldLibrarySummary build_field_library(const std::filesystem::path& rig, const std::filesystem::path& out,
                                        const FieldLibraryOptions& o) {
  const auto part = read_rig(rig, builtin_parts());
  const auto field = part.make({});
  const Vec2 half{0.5 * o.width, 0.5 * o.height};
  const TableGrid grid = library_grid(o);
  const int levels = o.levels > 0 ? o.levels : Lattice::default_levels(field->coils());
  const Lattice lattice(current_limits(*field), levels);
  FieldTable table(*field, grid);
  const std::string coil_hash = coil_system_hash(part.resolved);
  const Json task = {{"rig", coil_hash},     {"levels", levels},          {"width_m", o.width},
                     {"height_m", o.height}, {"spacing_m", grid.spacing}, {"version", FABA_VERSION}};

  FileLock lock(out.string() + ".lock", out, "");
  const Unlock unlock(lock);
  std::error_code ec;
  if (std::filesystem::exists(out, ec) && !o.force)
    throw Error(Errc::usage, out.string(), "already exists; name another file, or --force to replace it");
  LibraryWriter writer(out, coil_hash, task.dump(), grid, field->coils());
  Pool pool(o.threads);
  const Search search(*field, half);
  std::vector<std::optional<LibraryEntry>> found(kBlock);
  for (std::uint64_t begin = writer.done(); begin < lattice.size(); begin += kBlock) {
    if (o.stop()) {
      throw Error(Errc::interrupted, out.string(),
                  fmt::format("stopped at {} of {} sets of currents; the same command resumes there", begin,
                              lattice.size()));
    }
    o.progress(begin, lattice.size());
    const auto n = std::size_t(std::min<std::uint64_t>(kBlock, lattice.size() - begin));
    pool.for_blocks(n, 256, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        const auto current = lattice.at(begin + i);
        found[i] = current ? search(*current) : std::nullopt;
      }
    });
    for (std::size_t i = 0; i < n; ++i) {
      if (!found[i]) continue;
      table.set(found[i]->current);
      writer.add(begin + i, *found[i], table.nodes());
    }
    writer.tried(begin + n);
  }
  o.progress(lattice.size(), lattice.size());
  writer.finish();

  const std::shared_ptr<const FieldLibrary> library = open_library(out);
  FieldLibrarySummary summary = summary_of(*library, out, lattice.size());
  summary.levels = levels;
  summary.columns = grid.columns;
  summary.rows = grid.rows;
  compare_with_solver(*field, *library, half, summary);
  return summary;
}

}  // namespace faba
