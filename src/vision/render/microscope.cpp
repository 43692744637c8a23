#include "vision/render/microscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/portable_math.h"
#include "core/random/draw_blocks.h"
#include "vision/render/illuminated_background.h"
#include "vision/render/kernels/camera_noise.h"

namespace faba {
namespace {

constexpr double kWidestSpot = 200;  // px, sd; limits the memory of the tables
constexpr double kMostPixels = 1 << 28;
constexpr double kDefaultExposure = 0.01;  // s

// Light in fluorescence is additive, as that of bright cells on the background of the medium; there is no
// refraction at the edge of a drop.
MicroscopeParams as_bright_field(MicroscopeParams p) {
  if (p.mode != MicroscopeParams::Mode::fluorescence) return p;
  p.level = p.background_emission;
  p.contrast = p.emission / p.background_emission;
  p.edge_contrast = 0;
  return p;
}

// Phase contrast is a density of either sign, because the light stays above zero where halos overlap.
bool absorbing(const MicroscopeParams& p) {
  return p.contrast < 0 || p.mode == MicroscopeParams::Mode::phase_contrast;
}

// Sum over the pixels of the contribution of one cell: optical density, or added light.
double weight_of(const MicroscopeParams& p, double m_per_px) {
  const double d = p.cell_diameter / m_per_px, rod = (p.length() - p.cell_diameter) / m_per_px;
  const double area = portable::kPi / 4 * d * d + d * rod;
  return area * (absorbing(p) ? -portable::log(1 + p.contrast) : p.contrast);
}

SplatShape shape_of(const MicroscopeParams& p, double m_per_px, std::uint64_t seed) {
  if (std::max({p.psf_sd, p.cell_diameter / 4, p.length() / 64}) > kWidestSpot * m_per_px)
    throw Error(Errc::usage, "microscope",
                fmt::format("the blur of a cell or of its halo exceeds {:g} px at this scale; reduce psf_sd, "
                            "halo_width, cell_diameter or cell_length, or increase scale.um_per_px",
                            kWidestSpot));
  SplatShape s;
  s.psf_sd_px = p.psf_sd / m_per_px;
  s.diameter_px = p.cell_diameter / m_per_px;
  s.length_px = p.length() / m_per_px;
  s.depth_spread = p.depth_spread / p.depth_of_field;
  s.weight = weight_of(p, m_per_px);
  s.seed = seed;
  return s;
}

// The halo: the part of the diffracted light that passes the phase ring is a blurred copy of the cell with
// the opposite sign.
std::optional<CellSplats> halos_of(const MicroscopeParams& p, double m_per_px, std::uint64_t seed) {
  if (p.mode != MicroscopeParams::Mode::phase_contrast || p.halo <= 0) return {};
  MicroscopeParams wide = p;
  wide.psf_sd = std::sqrt(p.psf_sd * p.psf_sd + p.halo_width * p.halo_width);
  SplatShape s = shape_of(wide, m_per_px, seed);
  s.weight *= -p.halo;
  return CellSplats(s);
}

double exposure_of(const MicroscopeParams& p, double frame_period) {
  const double t = p.exposure_time.value_or(std::min(kDefaultExposure, 0.5 * frame_period));
  if (t > frame_period * (1 + 1e-9))
    throw Error(
        Errc::usage, "microscope.exposure_time",
        fmt::format("{:g} s is longer than the frame period of {:g} s; shorten it or lower camera.rate", t,
                    frame_period));
  return t;
}

// Checks the size before any memory of that size is allocated.
const Frame& checked_size(const Frame& frame) {
  if (double(frame.width) * double(frame.height) > kMostPixels)
    throw Error(
        Errc::usage, "arena",
        fmt::format(
            "a picture of {} x {} px is too large to render; the maximum is 2^28 px, choose a smaller view",
            frame.width, frame.height));
  return frame;
}

}  // namespace

Microscope::Microscope(const MicroscopeParams& params, const Frame& frame, const Circle& edge,
                       double frame_period, std::uint64_t seed, const VideoBackground* ground)
    : params_(as_bright_field(params)),
      seed_(seed),
      exposure_time_(exposure_of(params, frame_period)),
      sum_(checked_size(frame).width, frame.height),
      splats_(shape_of(params_, frame.m_per_px, seed)),
      halos_(halos_of(params_, frame.m_per_px, seed)) {
  const MicroscopeParams& p = params_;
  if (p.background.empty()) {
    ground_ = illuminated_background(p, frame, edge, seed);
    const double read = p.read_noise / p.full_well;
    shot_ = 1 / p.full_well;
    constant_ = read * read;
  } else {
    if (!ground) throw Error(Errc::internal, "microscope.background", "the background video was not read");
    VideoBackground video = *ground;
    if (video.light.width != frame.width || video.light.height != frame.height)
      throw Error(
          Errc::usage, "microscope.background",
          fmt::format("{} is {} x {} px, but the view is {} x {} px; set the view of the arena to the size "
                      "of the video",
                      p.background, video.light.width, video.light.height, frame.width, frame.height));
    ground_ = std::move(video.light);
    constant_ = video.noise_sd * video.noise_sd;
  }
  if (p.noise) {
    shot_ = 0;
    constant_ = *p.noise * *p.noise;
  }
}

double Microscope::noise_sd(double light) const { return std::sqrt(shot_ * light + constant_); }

template <class T>
void Microscope::render_as(const Exposure& e, Pool& pool, Image<T>& out) {
  std::fill(sum_.px.begin(), sum_.px.end(), 0.0F);
  splats_.add(e.cells, sum_, pool);
  if (halos_) halos_->add(e.cells, sum_, pool);
  CameraSensor s;
  s.seed = seed_;
  s.frame = std::uint32_t(e.frame);
  const auto word = draw(seed_, kFrameDraws, std::uint32_t(FrameDraw::lamp), s.frame);
  s.lamp = (1 + params_.drift * e.t) * (1 + params_.flicker * double(normals(word[0], word[1])[0]));
  s.lamp = std::max(s.lamp, 0.0);
  s.shot = shot_;
  s.constant = constant_;
  s.absorbing = absorbing(params_);
  if (params_.bleaching_time && params_.mode == MicroscopeParams::Mode::fluorescence)
    s.emission = portable::exp(-e.t / *params_.bleaching_time);
  expose(s, ground_, sum_, pool, out);
}

void Microscope::render(const Exposure& e, Pool& pool, Gray8& out) { render_as(e, pool, out); }
void Microscope::render(const Exposure& e, Pool& pool, Image<std::uint16_t>& out) { render_as(e, pool, out); }

}  // namespace faba
