#include "vision/files/kernels/yuv420.h"

#include <algorithm>
#include <vector>

#include "core/vectorised.h"

// Short loops over contiguous rows with one operation each, which the compiler vectorises.

namespace faba {
namespace {

using Byte = std::uint8_t;

// Fixed point with 16 fractional bits; the weights sum to exactly 65536, 0 and 0, so grey stays grey.
struct Weights {
  int r, g, b;
};
constexpr Weights kLuma{19595, 38470, 7471}, kBlue{-11059, -21709, 32768}, kRed{32768, -27439, -5329};
static_assert(kLuma.r + kLuma.g + kLuma.b == 1 << 16);
static_assert(kBlue.r + kBlue.g + kBlue.b == 0 && kRed.r + kRed.g + kRed.b == 0);

// The channels of one row in separate arrays, padded to an even number of pixels.
struct Row {
  explicit Row(int width) : r(padded(width)), g(padded(width)), b(padded(width)) {}
  static std::size_t padded(int width) {
    return static_cast<std::size_t>(width) + static_cast<std::size_t>(width % 2);
  }
  int width() const { return static_cast<int>(r.size()); }
  std::vector<Byte> r, g, b;
};

FABA_VECTORISED void split(const Rgb* in, int width, Byte* r, Byte* g, Byte* b) {
  for (int i = 0; i < width; ++i) {
    r[i] = in[i].r;
    g[i] = in[i].g;
    b[i] = in[i].b;
  }
}

void load(const Rgb* in, int width, Row& row) {
  split(in, width, row.r.data(), row.g.data(), row.b.data());
  if (width == row.width()) return;
  row.r.back() = in[width - 1].r;
  row.g.back() = in[width - 1].g;
  row.b.back() = in[width - 1].b;
}

FABA_VECTORISED void luma(const Byte* r, const Byte* g, const Byte* b, int width, Byte* y) {
  for (int i = 0; i < width; ++i) {
    y[i] = static_cast<Byte>((kLuma.r * r[i] + kLuma.g * g[i] + kLuma.b * b[i] + (1 << 15)) >> 16);
  }
}

// Sums of 2 x 2 pixels.
FABA_VECTORISED void sum_squares(const Byte* upper, const Byte* lower, int count, std::uint16_t* sums) {
  for (std::size_t i = 0; i < std::size_t(count); ++i) {
    sums[i] = static_cast<std::uint16_t>(upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1]);
  }
}

// The sums of four pixels have two more fractional bits.
FABA_VECTORISED void chroma(Weights weights, const std::uint16_t* r, const std::uint16_t* g,
                            const std::uint16_t* b, int count, Byte* out) {
  for (int i = 0; i < count; ++i) {
    const int value =
        (weights.r * r[i] + weights.g * g[i] + weights.b * b[i] + (128 << 18) + (1 << 17)) >> 18;
    out[i] = static_cast<Byte>(std::min(value, 255));  // pure blue and pure red would be 255.5
  }
}

}  // namespace

void to_yuv420(const RgbImage& picture, const Yuv420Planes& planes) {
  Row upper(picture.width), lower(picture.width);
  const int width = upper.width(), half = width / 2;
  std::vector<std::uint16_t> r(upper.r.size() / 2), g(r), b(r);
  for (int row = 0; row < picture.height; row += 2) {
    load(&picture.px[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width)], picture.width,
         upper);
    if (row + 1 < picture.height) {
      load(&picture.px[static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(picture.width)],
           picture.width, lower);
    } else {
      lower = upper;
    }
    luma(upper.r.data(), upper.g.data(), upper.b.data(), width, planes.y + row * planes.y_stride);
    luma(lower.r.data(), lower.g.data(), lower.b.data(), width, planes.y + (row + 1) * planes.y_stride);
    sum_squares(upper.r.data(), lower.r.data(), half, r.data());
    sum_squares(upper.g.data(), lower.g.data(), half, g.data());
    sum_squares(upper.b.data(), lower.b.data(), half, b.data());
    chroma(kBlue, r.data(), g.data(), b.data(), half, planes.cb + row / 2 * planes.cb_stride);
    chroma(kRed, r.data(), g.data(), b.data(), half, planes.cr + row / 2 * planes.cr_stride);
  }
}

}  // namespace faba
