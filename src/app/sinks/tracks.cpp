#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "app/files/position_table.h"
#include "app/sinks/sinks.h"
#include "core/h5/h5.h"

namespace faba {
namespace {

constexpr std::uint64_t kChunkBytes = 8u << 20;  // of the row of chunks being filled, which is in memory

// Positions are rounded relative to the centre of the arena, which cells do not leave.
std::optional<PositionTable::Rounding> rounding_of(const SinkContext& c) {
  const double resolution = c.record.resolution_px;
  if (!(resolution > 0)) return {};
  const Grid grid = c.truth->parts().arena->grid();
  const double finest = PositionTable::finest_px(std::max(grid.columns, grid.rows) / 2.0 + 1);
  if (resolution < finest)
    throw Error(
        Errc::usage, "record.resolution_px",
        fmt::format("{:g} px is too fine for 16 bits in an arena of {} x {} px; it must be at least {:.4g} "
                    "px, or 0 for exact positions",
                    resolution, grid.columns, grid.rows, finest));
  return PositionTable::Rounding{resolution, c.frame.centre_image};
}

class Tracks final : public RunSink {
 public:
  // Copies `keep` rows of an earlier file: HDF5 cannot append to a file whose writer was killed, but can read
  // it.
  Tracks(const SinkContext& c, std::uint64_t keep)
      : c_(c),
        path_(c.dir / "tracks.h5"),
        file_(H5File::create(path_.string() + ".new", c.pool ? c.pool->threads() : 1)) {
    const auto n = std::uint64_t(c.truth->state().agents.size());
    const std::uint64_t rows = std::clamp<std::uint64_t>(kChunkBytes / (8 * n), 1, 64);
    // All tables have chunks of the same number of rows, so that they grow together.
    frame_ = std::make_unique<H5Table>(file_.table<std::uint64_t>("frame", {}, rows, 1, false));
    t_ = std::make_unique<H5Table>(file_.table<double>("t_s", {}, rows, 1, false));
    position_ = std::make_unique<PositionTable>(file_, n, rows, c.record.compress, rounding_of(c));
    if (c.dose)
      responding_ = std::make_unique<H5Table>(
          file_.table<std::uint8_t>("responding", {n}, rows, 4096, c.record.compress));
    describe();
    describe_dimensions(n);
    file_.begin_writing();
    if (keep) import_rows(keep);
    // Only now other programs can read it, also when the run is killed at once.
    file_.rename_complete(path_);
  }

  void take(const Tick& t) override {
    if ((t.index - c_.recorded.first) % std::uint64_t(c_.record.tracks_every)) return;
    const State& s = c_.truth->state();
    const auto x = s.agents["x"], y = s.agents["y"], response = s.agents["response"];
    row_.resize(2 * x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec2 p = c_.frame.image_from_world({double(x[i]), double(y[i])});
      row_[2 * i] = float(p.x);
      row_[2 * i + 1] = float(p.y);
    }
    append(t.index, c_.frames->time_of(t));
    if (responding_) {
      flags_.resize(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) flags_[i] = response[i] != 0.0f;
      responding_->append<std::uint8_t>(flags_);
    }
    file_.start_sync();
  }

  void checkpoint(Archive& a) override {
    file_.sync();
    std::uint64_t rows = position_->rows();
    a& rows;
  }
  void finish(bool) override {
    frame_.reset();
    t_.reset();
    position_.reset();
    responding_.reset();
    file_.close();
  }

 private:
  void append(std::uint64_t frame, double t) {
    frame_->append<std::uint64_t>({&frame, 1});
    t_->append<double>({&t, 1});
    position_->append(row_);
  }

  void describe() {
    file_.attribute("/", "format", std::string("faba tracks 1"));
    file_.attribute("/", "fps", c_.frame_rate);
    file_.attribute("/", "um_per_px", c_.um_per_px.value_or(std::numeric_limits<double>::quiet_NaN()));
    file_.attribute("/", "every_frames", double(c_.record.tracks_every));
    file_.attribute("/", "width_px", double(c_.frame.width));
    file_.attribute("/", "height_px", double(c_.frame.height));
    // range of cells of each [[swarm]]; the numbers of cells are in the order of the swarms
    for (std::size_t k = 0; k < c_.truth->parts().populations.size(); ++k) {
      const auto& p = c_.truth->parts().populations[k];
      file_.attribute("/", fmt::format("swarm_{}_first_cell", k), double(p.begin));
      file_.attribute("/", fmt::format("swarm_{}_cells", k), double(p.end - p.begin));
    }
  }

  // Names of the dimensions and units, as netCDF programs read them.
  void describe_dimensions(std::uint64_t cells) {
    std::vector<std::uint32_t> numbers(cells);
    std::iota(numbers.begin(), numbers.end(), 0u);
    file_.column<std::uint32_t>("cell", numbers);
    file_.column<std::string>("axis", {"x", "y"});
    const auto describe = [this](const char* table, const char* long_name, const char* units) {
      file_.attribute(table, "long_name", std::string(long_name));
      file_.attribute(table, "units", std::string(units));
    };
    describe("frame", "number of the frame", "1");
    describe("t_s", "time", "s");
    describe("cell", "number of the cell", "1");
    describe("axis", "x to the right, y down", "1");
    file_.name_dimensions("t_s", {"frame"});
    file_.name_dimensions(position_->name(), {"frame", "cell", "axis"});
    file_.attribute(position_->name(), "coordinates", std::string("t_s"));
    if (!responding_) return;
    describe("responding", "1 while the cell responds to the field", "1");
    file_.name_dimensions("responding", {"frame", "cell"});
    file_.attribute("responding", "coordinates", std::string("t_s"));
  }

  void import_rows(std::uint64_t keep) {
    const H5File old = H5File::open(path_);
    const H5Table frame = old.table("frame"), t = old.table("t_s"),
                  responding = responding_ ? old.table("responding") : frame;
    PositionTable position(old);
    if (position.rows() < keep)
      throw Error(Errc::input, path_.string(),
                  fmt::format("has {} frames, but the checkpoint has {}", position.rows(), keep));
    row_.resize(2 * position.cells());
    flags_.resize(position.cells());
    for (std::uint64_t r = 0; r < keep; ++r) {
      std::uint64_t index = 0;
      double time = 0;
      frame.read<std::uint64_t>(r, {&index, 1});
      t.read<double>(r, {&time, 1});
      position.read(r, row_);
      append(index, time);
      if (!responding_) continue;
      responding.read<std::uint8_t>(r, flags_);
      responding_->append<std::uint8_t>(flags_);
    }
  }

  SinkContext c_;
  std::filesystem::path path_;
  H5File file_;
  std::unique_ptr<H5Table> frame_, t_, responding_;
  std::unique_ptr<PositionTable> position_;
  std::vector<float> row_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace

std::unique_ptr<RunSink> tracks_sink(const SinkContext& c, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  return std::make_unique<Tracks>(c, keep);
}

}  // namespace faba
