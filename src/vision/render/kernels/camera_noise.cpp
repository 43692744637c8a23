#include "vision/render/kernels/camera_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/kernels/philox_row.h"
#include "core/portable_math.h"
#include "core/vectorised.h"

namespace faba {
namespace {

constexpr std::size_t kRow = PhiloxRow::kLength, kBlock = 4 * kRow;  // four normals per draw

struct SensorConstants {
  float lamp, shot, constant, white;
  bool absorbing;
  float emission;
};

FABA_VECTORISED void make_normals(const PhiloxRow& row, float* z) {
  for (std::size_t i = 0; i < kRow; ++i) {
    const auto a = normals(row.w0[i], row.w1[i]), b = normals(row.w2[i], row.w3[i]);
    z[i] = a[0];
    z[i + kRow] = a[1];
    z[i + 2 * kRow] = b[0];
    z[i + 3 * kRow] = b[1];
  }
}

FABA_VECTORISED void make_light(const SensorConstants& k, const float* ground, const float* cells,
                                std::size_t n, float* light) {
  if (k.absorbing)
    for (std::size_t i = 0; i < n; ++i) light[i] = k.lamp * ground[i] * portable::exp(-cells[i]);
  else
    for (std::size_t i = 0; i < n; ++i) light[i] = k.lamp * ground[i] * (1.0F + k.emission * cells[i]);
}

FABA_VECTORISED void make_grey(const SensorConstants& k, const float* light, const float* z, std::size_t n,
                               float* grey) {
  for (std::size_t i = 0; i < n; ++i) {
    const float noisy = light[i] + std::sqrt(k.shot * light[i] + k.constant) * z[i];
    const float g = noisy * k.white;
    grey[i] = g < 0.0F ? 0.0F : g > k.white ? k.white : g;
  }
}

FABA_VECTORISED void round_to_integer(const float* grey, std::size_t n, std::uint8_t* out) {
  for (std::size_t i = 0; i < n; ++i) {
    const float half_up = grey[i] + 0.5F;  // >= 0, so truncation rounds
    out[i] = std::uint8_t(std::int32_t(half_up));
  }
}
FABA_VECTORISED void round_to_integer(const float* grey, std::size_t n, std::uint16_t* out) {
  for (std::size_t i = 0; i < n; ++i) {
    const float half_up = grey[i] + 0.5F;  // >= 0, so truncation rounds
    out[i] = std::uint16_t(std::int32_t(half_up));
  }
}

template <class T>
void expose_as(const CameraSensor& s, const GrayF& ground, const GrayF& cells, Pool& pool, Image<T>& out) {
  const std::size_t n = ground.px.size();
  if (cells.px.size() != n) throw Error(Errc::internal, "microscope", "light and cells differ in size");
  out.width = ground.width;
  out.height = ground.height;
  out.px.resize(n);
  const SensorConstants k{float(s.lamp),     float(s.shot),
                          float(s.constant), float(std::numeric_limits<T>::max()),
                          s.absorbing,       float(s.emission)};
  const bool noisy = s.shot > 0 || s.constant > 0;
  pool.for_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) {
    alignas(64) float z[kBlock] = {}, light[kBlock], grey[kBlock];
    if (noisy) {
      PhiloxRow row;
      draw_row(s.seed, Stream::camera, std::uint32_t(begin / 4), s.frame, kRow, row);
      make_normals(row, z);
    }
    make_light(k, &ground.px[begin], &cells.px[begin], end - begin, light);
    make_grey(k, light, z, end - begin, grey);
    round_to_integer(grey, end - begin, &out.px[begin]);
  });
}

}  // namespace

void expose(const CameraSensor& s, const GrayF& ground, const GrayF& cells, Pool& pool, Gray8& out) {
  expose_as(s, ground, cells, pool, out);
}
void expose(const CameraSensor& s, const GrayF& ground, const GrayF& cells, Pool& pool,
            Image<std::uint16_t>& out) {
  expose_as(s, ground, cells, pool, out);
}

}  // namespace faba
