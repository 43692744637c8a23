#include "server/frame_message.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/portable_math.h"

namespace faba {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the message is little-endian and copied from memory");

constexpr double kFinest = 0.1;     // px
constexpr double kSteps = 65535;    // 16 bits
constexpr double kTurnParts = 255;  // 0 and 255 both mean heading 0

enum Bit : std::uint16_t { kCells = 1, kFloats = 2, kHeadings = 4, kPicture = 8 };

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

}  // namespace

bool quantised(const PictureBox& box) {
  return std::max(box.right - box.left, box.bottom - box.top) <= kFinest * kSteps;
}

std::string encode_frame(const FrameMessage& m) {
  const std::size_t n = m.x.size();
  const bool floats = !quantised(m.box), headings = m.ux.size() == n && n > 0;
  std::string out;
  out.reserve(64 + m.rows.size_bytes() + m.field.size_bytes() + n * 10 + m.picture.size());
  out += "FABA";
  put(out, std::uint16_t(1));
  put(out, std::uint16_t(kCells | (floats ? kFloats : 0) | (headings ? kHeadings : 0) |
                         (m.picture.empty() ? 0 : kPicture)));
  put(out, m.run);
  put(out, std::uint32_t(n));
  put(out, std::uint32_t(m.rows.size() / m.columns));
  put(out, std::uint16_t(m.picture_columns));
  put(out, std::uint16_t(m.picture_rows));
  put(out, std::uint16_t(m.field_columns));
  put(out, std::uint16_t(m.field_rows));
  put(out, std::uint32_t(0));
  put(out, m.frame);
  put(out, m.t);
  put_all(out, m.rows);
  put_all(out, m.field);
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
  put_all(out, m.picture);
  return out;
}

}  // namespace faba
