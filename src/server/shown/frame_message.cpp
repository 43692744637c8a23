#include "server/shown/frame_message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/portable_math.h"

namespace faba {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the message is little-endian and copied from memory");

constexpr double kFinest = 0.1;     // px
constexpr double kSteps = 65535;    // 16 bits
constexpr double kTurnParts = 255;  // 0 and 255 both mean heading 0

constexpr std::size_t kMostGridSwarms =
    8;                               // 16 bits for two planes each; the page repeats its colours earlier
constexpr int kDensitySquares = 64;  // along the longer side of the box

enum Bit : std::uint16_t {
  kCells = 1,
  kFloats = 2,
  kHeadings = 4,
  kPicture = 8,
  kSites = 16,
  kEstimate = 32,
  kPlan = 64
};

template <class T>
void put(std::string& out, T v) {
  out.append(reinterpret_cast<const char*>(&v), sizeof v);
}

template <class T>
void put_all(std::string& out, std::span<const T> v) {
  out.append(reinterpret_cast<const char*>(v.data()), v.size_bytes());
}

// Up to 0.5 MB at 60 Hz: one pass without branches.
void put_positions(std::string& out, const FrameMessage& m, bool floats) {
  const std::size_t n = m.x.size(), at = out.size();
  const auto scale = float(1 / m.view.m_per_px);
  const auto cx = float(m.view.centre_image.x), cy = float(m.view.centre_image.y);
  if (floats) {
    out.resize(at + n * 2 * sizeof(float));
    for (std::size_t i = 0; i < n; ++i) {
      const float p[2] = {cx + m.x[i] * scale, cy - m.y[i] * scale};
      std::memcpy(out.data() + at + i * sizeof p, p, sizeof p);
    }
    return;
  }
  out.resize(at + n * 2 * sizeof(std::uint16_t));
  const auto left = float(m.box.left), top = float(m.box.top);
  const auto kx = float(kSteps / (m.box.right - m.box.left)), ky = float(kSteps / (m.box.bottom - m.box.top));
  // Rounds to nearest by truncation, valid because the values are not negative.
  constexpr float kHalf = 0.5F;
  const auto part = [](float v) {
    const float shifted = std::clamp(v, 0.0F, float(kSteps)) + kHalf;
    return std::uint16_t(shifted);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t p[2] = {part((cx + m.x[i] * scale - left) * kx),
                                part((cy - m.y[i] * scale - top) * ky)};
    std::memcpy(out.data() + at + i * sizeof p, p, sizeof p);
  }
}

// Positions, headings, and whether the cells respond.
void put_cells(std::string& out, const FrameMessage& m, bool floats, bool headings) {
  const std::size_t n = m.x.size();
  put_positions(out, m, floats);
  if (headings)
    for (std::size_t i = 0; i < n; ++i) {
      const double turn = std::atan2(double(m.uy[i]), double(m.ux[i])) / (2 * portable::kPi);
      out += char(std::uint8_t(std::lround((turn < 0 ? turn + 1 : turn) * kTurnParts)));
    }
  for (std::size_t i = 0; i < n; i += 8) {
    unsigned bits = 0;
    for (std::size_t k = i; k < std::min(i + 8, n); ++k) bits |= unsigned(m.response[k] != 0) << (k - i);
    out += char(std::uint8_t(bits));
  }
}

// A grid of squares over the box, px.
struct SquareGrid {
  int columns, rows;
  float per_px;

  SquareGrid(const PictureBox& b, int along) {
    constexpr double kRounding = 1e-9;  // a side that is a multiple of the square's has no further square
    const double width = b.right - b.left, height = b.bottom - b.top, side = std::max(width, height) / along;
    columns = std::max(1, int(std::ceil(width / side - kRounding)));
    rows = std::max(1, int(std::ceil(height / side - kRounding)));
    per_px = float(1 / side);
  }
  std::size_t size() const { return std::size_t(columns) * std::size_t(rows); }
  /// The square at a distance from the upper left corner of the box, px.
  std::size_t at(float x, float y) const {
    const int c = std::clamp(int(x * per_px), 0, columns - 1), r = std::clamp(int(y * per_px), 0, rows - 1);
    return std::size_t(r) * std::size_t(columns) + std::size_t(c);
  }
};

// Two bit planes for each swarm, of responsive and of unresponsive cells, without the empty ones; then the
// number of cells in the squares of a coarse grid, because several cells may be at one site.
void put_sites(std::string& out, const FrameMessage& m, const SquareGrid& sites) {
  const SquareGrid squares(m.box, kDensitySquares);
  const std::size_t bytes = (sites.size() + 7) / 8;
  std::vector<std::string> planes(2 * std::min(m.ends.size(), kMostGridSwarms));
  std::vector<std::uint32_t> counts(squares.size());
  const auto scale = float(1 / m.view.m_per_px);
  const auto cx = float(m.view.centre_image.x - m.box.left), cy = float(m.view.centre_image.y - m.box.top);
  for (std::size_t s = 0, i = 0; s < m.ends.size(); ++s)
    for (; i < m.ends[s]; ++i) {
      const float x = cx + m.x[i] * scale, y = cy - m.y[i] * scale;
      const std::size_t site = sites.at(x, y);
      std::string& plane = planes[2 * (s % kMostGridSwarms) + (m.response[i] != 0 ? 0 : 1)];
      if (plane.empty()) plane.resize(bytes);
      plane[site / 8] = char(std::uint8_t(plane[site / 8]) | (1U << (site % 8)));
      ++counts[squares.at(x, y)];
    }
  unsigned present = 0;
  for (std::size_t p = 0; p < planes.size(); ++p) present |= unsigned(!planes[p].empty()) << p;
  put(out, std::uint16_t(planes.size()));
  put(out, std::uint16_t(squares.columns));
  put(out, std::uint16_t(squares.rows));
  put(out, std::uint16_t(present));
  for (const std::string& plane : planes) out += plane;
  put_all(out, std::span<const std::uint32_t>(counts));
}

void put_position(std::string& out, const FrameMessage& m, Vec2 world) {
  const Vec2 px = m.view.image_from_world(world);
  put(out, float(px.x));
  put(out, float(px.y));
}

// Whether the estimate has the covariance of the error of its centroid.
bool has_error(const Estimate* e) {
  if (!e || !(e->visible > 0)) return false;
  const Mat2& c = e->centroid_cov;
  return c.xx + c.yy > 0 && std::isfinite(c.xx + c.xy + c.yy + norm(e->centroid));
}

// Image axes: y down.
void put_estimate(std::string& out, const FrameMessage& m) {
  const double px2 = 1 / (m.view.m_per_px * m.view.m_per_px);
  const Mat2& c = m.estimate->centroid_cov;
  put(out, std::uint32_t(m.estimate->predicted));
  put_position(out, m, m.estimate->centroid);
  for (const double v : {c.xx, -c.xy, c.yy}) put(out, float(v * px2));
}

void put_plan(std::string& out, const FrameMessage& m) {
  put(out, std::uint16_t(m.path.size()));
  put(out, m.limits);
  put(out, float(m.path_step));
  for (const Vec2 p : m.path) put_position(out, m, p);
}

}  // namespace

bool quantised(const PictureBox& box) {
  return std::max(box.right - box.left, box.bottom - box.top) <= kFinest * kSteps;
}

std::string encode_frame(const FrameMessage& m) {
  const std::size_t n = m.x.size();
  const SquareGrid sites(m.box, std::max(1, m.sites));
  const bool gridded = m.sites > 0, floats = !gridded && !quantised(m.box);
  const bool headings = !gridded && m.ux.size() == n && n > 0;
  std::string out;
  out.reserve(64 + m.rows.size_bytes() + m.field.size_bytes() + n * 10 + m.picture.size());
  out += "FABA";
  put(out, std::uint16_t(1));
  put(out, std::uint16_t(kCells | (floats ? kFloats : 0) | (headings ? kHeadings : 0) |
                         (m.picture.empty() ? 0 : kPicture) | (gridded ? kSites : 0) |
                         (has_error(m.estimate) ? kEstimate : 0) | (m.path.empty() ? 0 : kPlan)));
  put(out, m.run);
  put(out, std::uint32_t(n));
  put(out, std::uint32_t(m.rows.size() / m.columns));
  put(out, std::uint16_t(m.picture_columns));
  put(out, std::uint16_t(m.picture_rows));
  put(out, std::uint16_t(m.field_columns));
  put(out, std::uint16_t(m.field_rows));
  put(out, std::uint16_t(gridded ? sites.columns : 0));
  put(out, std::uint16_t(gridded ? sites.rows : 0));
  put(out, m.frame);
  put(out, m.t);
  put_all(out, m.rows);
  put_all(out, m.field);
  if (gridded)
    put_sites(out, m, sites);
  else
    put_cells(out, m, floats, headings);
  put_all(out, m.picture);
  if (has_error(m.estimate)) put_estimate(out, m);
  if (!m.path.empty()) put_plan(out, m);
  return out;
}

}  // namespace faba
