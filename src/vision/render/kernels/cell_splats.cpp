#include "vision/render/kernels/cell_splats.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/random/draw_blocks.h"
#include "core/vectorised.h"

namespace faba {
namespace {

constexpr int kSubPixels = 64;               // sub-pixel positions per pixel
constexpr double kReach = 4;                 // sd, cut-off of a spot
constexpr double kSpacing = 1.2;             // sd between the spots of one cell: their sum is uniform to 1e-5
constexpr int kMostSpots = 64;               // maximum number along one direction
constexpr int kBand = 32;                    // rows per job of a thread
constexpr int kBlurLevels = 9;               // each 2^(1/4) wider than the previous one
constexpr double kStep = 1.189207115002721;  // 2^(1/4)
constexpr std::size_t kLane = 16;            // rows of a table are padded to full vectors

// Adds the outer product down * across to `rows` rows of a picture with row stride `stride`.
FABA_VECTORISED void add_product(float* to, std::ptrdiff_t stride, const float* across, std::size_t columns,
                                 const float* down, std::size_t rows) {
  for (std::size_t r = 0; r < rows; ++r, to += stride) {
    const float by = down[r];
    FABA_ELEMENTWISE
    for (std::size_t i = 0; i < columns; ++i) to[i] += by * across[i];
  }
}

// a + f (b - a), times `by`: interpolation between two rows of the table.
FABA_VECTORISED void between(const float* a, const float* b, float f, float by, std::size_t n, float* out) {
  for (std::size_t i = 0; i < n; ++i) out[i] = by * (a[i] + f * (b[i] - a[i]));
}

// Distance of a cell from focus in units of the sd; constant in time.
double depth_of(std::uint64_t seed, std::uint32_t cell) {
  const auto word = draw(seed, kDepthDraws, cell, 0);
  return double(normals(word[0], word[1])[0]);
}

}  // namespace

/// Position of a spot: first pixel, sub-pixel position, and blur level.
struct CellSplats::Spot {
  std::int32_t column, row;  // first pixel; may be outside
  float at_x, at_y;          // sub-pixel position in table rows, [0, kSubPixels)
  float weight;
  std::uint16_t blur_level;
};

/// Weights of a spot along one axis for all sub-pixel positions.
class CellSplats::Table {
 public:
  explicit Table(double sd_px)
      : sd_(sd_px),
        radius_(std::max(1, int(std::ceil(kReach * sd_px)))),
        stride_((2 * std::size_t(radius_) + 1 + kLane - 1) / kLane * kLane),
        weight_(std::size_t(kSubPixels + 1) * stride_) {
    for (int position = 0; position <= kSubPixels; ++position) {
      const double middle = double(position) / kSubPixels - 0.5;
      float* w = &weight_[std::size_t(position) * stride_];
      double sum = 0;
      for (int k = -radius_; k <= radius_; ++k) sum += pixel_fraction(k, middle);
      for (int k = -radius_; k <= radius_; ++k) w[k + radius_] = float(pixel_fraction(k, middle) / sum);
    }
  }
  double sd() const { return sd_; }
  int radius() const { return radius_; }
  std::size_t width() const { return 2 * std::size_t(radius_) + 1; }
  std::size_t stride() const { return stride_; }
  // Weights at a sub-pixel position (interpolated between two table rows), times `by`; padded with zeros to
  // stride().
  void at(float position, float by, float* out) const {
    const int row = std::min(int(position), kSubPixels - 1);
    const float* a = &weight_[std::size_t(row) * stride_];
    between(a, a + stride_, position - float(row), by, stride_, out);
  }

 private:
  double pixel_fraction(int k, double middle) const {
    return portable::normal_cdf((k + 0.5 - middle) / sd_) - portable::normal_cdf((k - 0.5 - middle) / sd_);
  }
  double sd_;
  int radius_;
  std::size_t stride_;
  std::vector<float> weight_;
};

CellSplats::CellSplats(const SplatShape& shape) : shape_(shape) {
  // The minimum blur is 0.02 px, because a spot of zero width cannot be tabulated.
  double blur = std::max(shape.psf_sd_px, 0.02);
  for (int s = 0; s < (shape.depth_spread > 0 ? kBlurLevels : 1); ++s, blur *= kStep)
    tables_.emplace_back(std::sqrt(blur * blur + shape.diameter_px * shape.diameter_px / 16));
}
CellSplats::~CellSplats() = default;
CellSplats::CellSplats(CellSplats&&) noexcept = default;
CellSplats& CellSplats::operator=(CellSplats&&) noexcept = default;

void CellSplats::add_spots(const CameraCell& cell, const Table& table, std::uint16_t blur_level,
                           const GrayF& sum) {
  const double rod = cell.ux != 0.0F || cell.uy != 0.0F ? shape_.length_px - shape_.diameter_px : 0;
  const double displacement =
      std::sqrt(double(cell.dx) * double(cell.dx) + double(cell.dy) * double(cell.dy));
  const auto spot_count = [&](double length) {
    return int(std::clamp(std::ceil(length / (kSpacing * table.sd())), 1.0, double(kMostSpots)));
  };
  const int along = spot_count(rod), moved = spot_count(displacement);
  const auto weight = float(shape_.weight / (along * moved));
  for (int a = 0; a < along; ++a)
    for (int m = 0; m < moved; ++m) {
      const double r = rod * ((a + 0.5) / along - 0.5), w = (m + 0.5) / moved - 0.5;
      const double x = double(cell.x) + r * double(cell.ux) + w * double(cell.dx) + 0.5;
      const double y = double(cell.y) + r * double(cell.uy) + w * double(cell.dy) + 0.5;
      const double reach = table.radius() + 1;
      if (!(x > -reach && y > -reach && x < sum.width + reach && y < sum.height + reach)) continue;
      const double column = std::floor(x), row = std::floor(y);
      spots_.push_back({std::int32_t(column) - table.radius(), std::int32_t(row) - table.radius(),
                        float((x - column) * kSubPixels), float((y - row) * kSubPixels), weight, blur_level});
    }
}

void CellSplats::make_spots(std::span<const CameraCell> cells, const GrayF& sum) {
  spots_.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::uint16_t blur_level = 0;
    if (tables_.size() > 1) {
      if (i >= depth_.size()) {
        const double z = shape_.depth_spread * depth_of(shape_.seed, std::uint32_t(i));
        double wider = std::sqrt(1 + z * z);
        std::uint8_t s = 0;
        for (; s + 1 < kBlurLevels && wider > 1.0905077326652577; ++s) wider /= kStep;  // 2^(1/8): nearest
        depth_.push_back(s);
      }
      blur_level = depth_[i];
    }
    add_spots(cells[i], tables_[blur_level], blur_level, sum);
  }
}

// Assigns the spots to all bands that they touch, in the order of the cells.
void CellSplats::sort_into_bands(int height) {
  const int bands = (height + kBand - 1) / kBand;
  const auto range = [&](const Spot& s) {
    const int last = s.row + 2 * tables_[s.blur_level].radius();
    return std::pair(std::max(s.row, 0) / kBand, last < 0 ? -1 : std::min(last, height - 1) / kBand);
  };
  band_begin_.assign(std::size_t(bands) + 1, 0);
  for (const Spot& s : spots_)
    for (auto [b, last] = range(s); b <= last; ++b) ++band_begin_[std::size_t(b) + 1];
  for (std::size_t b = 1; b < band_begin_.size(); ++b) band_begin_[b] += band_begin_[b - 1];
  in_band_.resize(band_begin_.back());
  std::vector<std::uint32_t> next(band_begin_.begin(), band_begin_.end() - 1);
  for (std::size_t i = 0; i < spots_.size(); ++i)
    for (auto [b, last] = range(spots_[i]); b <= last; ++b)
      in_band_[next[std::size_t(b)]++] = std::uint32_t(i);
}

void CellSplats::add(std::span<const CameraCell> cells, GrayF& sum, Pool& pool) {
  make_spots(cells, sum);
  sort_into_bands(sum.height);
  pool.run_uneven(band_begin_.size() - 1, [&](std::size_t band) {
    const int low = int(band) * kBand, high = std::min(low + kBand, sum.height);
    std::vector<float> across(tables_.back().stride()), down(tables_.back().stride());
    for (std::uint32_t k = band_begin_[band]; k < band_begin_[band + 1]; ++k) {
      const Spot& s = spots_[in_band_[k]];
      const Table& table = tables_[s.blur_level];
      const int width = int(table.width());
      const int left = std::max(0, -s.column), right = std::min(width, sum.width - s.column);
      const int top = std::max(0, low - s.row), bottom = std::min(width, high - s.row);
      if (left >= right || top >= bottom) continue;
      table.at(s.at_x, 1, across.data());
      table.at(s.at_y, s.weight, down.data());
      add_product(&sum.at(s.column + left, s.row + top), sum.width, &across[std::size_t(left)],
                  std::size_t(right - left), &down[std::size_t(top)], std::size_t(bottom - top));
    }
  });
}

}  // namespace faba
