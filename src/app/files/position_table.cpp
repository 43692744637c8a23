#include "app/files/position_table.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/error.h"

namespace faba {
namespace {

constexpr const char *kExact = "position_px", *kRounded = "position_steps";
constexpr std::uint64_t kChunkCells = 4096;
constexpr double kLargestStep = 32767;

}  // namespace

double PositionTable::finest_px(double reach_px) { return reach_px / kLargestStep; }

PositionTable::PositionTable(H5File& file, std::uint64_t cells, std::uint64_t chunk_rows, bool compress,
                             const std::optional<Rounding>& rounding)
    : rounding_(rounding), chunk_rows_(chunk_rows) {
  if (!rounding_) {
    table_ = file.table<float>(kExact, {cells, 2}, chunk_rows, kChunkCells, compress);
    file.attribute(kExact, "axes", std::string("row, cell, (x right, y down); pixel centres are integers"));
    file.attribute(kExact, "long_name", std::string("position of the cells in the picture"));
    file.attribute(kExact, "units", std::string("px"));
    return;
  }
  table_ = file.table<std::int16_t>(kRounded, {cells, 2}, chunk_rows, kChunkCells, compress);
  file.attribute(
      kRounded, "axes",
      std::string(
          "row, cell, (x right, y down); in rows that are a multiple of rows_per_chunk the position in "
          "units of resolution_px from the origin, in others its change from the row before"));
  file.attribute(kRounded, "long_name", std::string("position of the cells in the picture, in steps"));
  file.attribute(kRounded, "units", fmt::format("{:g} px", rounding_->resolution_px));
  file.attribute(kRounded, "resolution_px", rounding_->resolution_px);
  file.attribute(kRounded, "origin_x_px", rounding_->origin_px.x);
  file.attribute(kRounded, "origin_y_px", rounding_->origin_px.y);
  file.attribute(kRounded, "rows_per_chunk", double(chunk_rows));
  last_.assign(2 * cells, 0);
  steps_.resize(2 * cells);
}

PositionTable::PositionTable(const H5File& file) {
  if (!file.has(kRounded)) {
    table_ = file.table(kExact);
    return;
  }
  table_ = file.table(kRounded);
  rounding_ = {
      file.number_attribute(kRounded, "resolution_px"),
      {file.number_attribute(kRounded, "origin_x_px"), file.number_attribute(kRounded, "origin_y_px")}};
  chunk_rows_ = std::uint64_t(file.number_attribute(kRounded, "rows_per_chunk"));
  if (chunk_rows_ == 0 || !(rounding_->resolution_px > 0))
    throw Error(Errc::input, kRounded, "resolution_px and rows_per_chunk must be larger than 0");
  last_.assign(table_->row_size(), 0);
  steps_.resize(table_->row_size());
}

const char* PositionTable::name() const { return rounding_ ? kRounded : kExact; }

void PositionTable::append(std::span<const float> xy) {
  if (!rounding_) return table_->append<float>(xy);
  const bool first = table_->rows() % chunk_rows_ == 0;
  const double origin[2] = {rounding_->origin_px.x, rounding_->origin_px.y};
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const double units = std::nearbyint((double(xy[i]) - origin[i % 2]) / rounding_->resolution_px);
    if (!(std::fabs(units) <= kLargestStep))
      throw Error(
          Errc::internal, "record.resolution_px",
          fmt::format("the position {:g} px does not fit into 16 bits of {:g} px; increase the resolution",
                      double(xy[i]), rounding_->resolution_px));
    const auto value = std::uint16_t(std::int16_t(units));
    steps_[i] = std::int16_t(std::uint16_t(first ? value : value - last_[i]));
    last_[i] = value;
  }
  table_->append<std::int16_t>(steps_);
}

void PositionTable::read(std::uint64_t row, std::span<float> xy) {
  if (!rounding_) return table_->read<float>(row, xy);
  const std::uint64_t first = row - row % chunk_rows_;
  const bool onwards = has_last_ && last_row_ >= first && last_row_ <= row;
  for (std::uint64_t r = onwards ? last_row_ + 1 : first; r <= row; ++r) read_steps(r);
  const double origin[2] = {rounding_->origin_px.x, rounding_->origin_px.y};
  for (std::size_t i = 0; i < xy.size(); ++i)
    xy[i] = float(origin[i % 2] + rounding_->resolution_px * double(std::int16_t(last_[i])));
}

void PositionTable::read_steps(std::uint64_t row) {
  table_->read<std::int16_t>(row, steps_);
  const bool first = row % chunk_rows_ == 0;
  for (std::size_t i = 0; i < steps_.size(); ++i)
    last_[i] = std::uint16_t(std::uint16_t(steps_[i]) + (first ? 0 : last_[i]));
  last_row_ = row;
  has_last_ = true;
}

}  // namespace faba
