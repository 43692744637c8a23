#include "rig/simulated/sim_rig.h"

#include <algorithm>
#include <cmath>

#include "core/random/draw_blocks.h"

namespace faba {
namespace {

constexpr double kMaxJitter = 0.4;  // frames: keeps the times in order

}  // namespace

SimRig::SimRig(World& world, const Params& p)
    : world_(world), p_(p), frame_(world.parts().arena->frame()), camera_(frame_) {
  if (p_.microscope && !p_.pool) throw Error(Errc::internal, "camera", "a microscope needs a thread pool");
  if (p_.frames && !p_.microscope) throw Error(Errc::internal, "camera", "frames need a microscope");
}

std::uint64_t SimRig::step_of(std::uint64_t frame) const {
  const auto n = std::uint64_t(p_.steps_per_frame);
  if (p_.jitter <= 0 || frame == 0) return frame * n;
  const auto word =
      draw(world_.parts().seed, kFrameDraws, std::uint32_t(FrameDraw::time), std::uint32_t(frame));
  const double late = p_.jitter / p_.frame_period * double(normals(word[0], word[1])[0]);
  const double shift = std::clamp(late, -kMaxJitter, kMaxJitter) * double(n);
  return std::uint64_t(std::int64_t(frame * n) + std::int64_t(std::floor(shift + 0.5)));
}

double SimRig::time_of(std::uint64_t frame) const {
  return p_.jitter > 0 ? double(step_of(frame)) * (p_.frame_period / p_.steps_per_frame)
                       : double(frame) * p_.frame_period;
}

std::vector<Detection> SimRig::detections() const {
  const auto x = world_.state().agents["x"], y = world_.state().agents["y"];
  std::vector<Detection> seen(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    seen[i] = {x[i], y[i], frame_.in_view(frame_.image_from_world({double(x[i]), double(y[i])}))};
  return seen;
}

// Steps the world to a frame. Positions are stored half an exposure before it, or one step before it if steps
// are longer.
bool SimRig::step_to(std::uint64_t frame) {
  const std::uint64_t steps = step_of(frame) - step_of(frame - 1);
  std::uint64_t since = 1;
  if (p_.microscope)
    since = std::max<std::uint64_t>(
        1, std::uint64_t(std::llround(0.5 * p_.microscope->exposure_time() / world_.parts().dt)));
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (p_.microscope && i == steps - std::min(since, steps)) camera_.remember(world_.state());
    if (keep_running_ && !keep_running_()) return false;
    world_.step();
  }
  world_.check_finite();
  return true;
}

Exposure SimRig::exposure() {
  const double open = p_.microscope->exposure_time();
  return {next_ - 1, time_of(next_ - 1), camera_.look(world_.state(), open)};
}

ImageRef SimRig::picture() {
  if (newest_) return newest_;
  const auto picture = std::make_shared<Gray8>();
  p_.microscope->render(exposure(), *p_.pool, *picture);
  newest_ = picture;
  return newest_;
}

const Image<std::uint16_t>& SimRig::deep_picture() {
  p_.microscope->render(exposure(), *p_.pool, deep_);
  return deep_;
}

bool SimRig::read(Observation& out) {
  if (next_ > 0 && !step_to(next_)) return false;
  const std::uint64_t now = next_++;
  newest_.reset();
  Seen& latest = seen_.emplace_back();
  latest.t = time_of(now);
  if (p_.frames)
    latest.image = picture();
  else
    latest.cells = detections();
  if (seen_.size() > std::size_t(p_.delay_frames) + 1) seen_.pop_front();
  out.frame = now;
  // Frames before frame 0 have regular times.
  out.t = p_.jitter > 0 && now >= std::uint64_t(p_.delay_frames)
              ? seen_.front().t
              : (double(now) - p_.delay_frames) * p_.frame_period;
  out.age = p_.jitter > 0 ? time_of(now) - out.t : p_.delay_frames * p_.frame_period;
  out.seen = seen_.front().cells;
  out.image = seen_.front().image;
  return true;
}

void SimRig::safe() noexcept {
  try {
    world_.command(std::vector<double>(world_.parts().field->coils(), 0.0));
  } catch (...) {  // out of memory while stopping a simulation: no real coil is affected
    return;
  }
}

void SimRig::archive_cells(Archive& a, std::vector<Detection>& cells) const {
  std::vector<float> xy;
  xy.reserve(2 * cells.size());
  for (const Detection& d : cells) xy.insert(xy.end(), {d.x, d.y});
  a& xy;
  if (!a.reading()) return;
  cells.resize(xy.size() / 2);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const float x = xy[2 * i], y = xy[2 * i + 1];
    cells[i] = {x, y, frame_.in_view(frame_.image_from_world({double(x), double(y)}))};
  }
}

void SimRig::archive(Archive& a) {
  a& next_;
  std::uint64_t kept = seen_.size();
  a& kept;
  seen_.resize(std::size_t(std::min<std::uint64_t>(kept, std::uint64_t(p_.delay_frames) + 1)));
  std::uint64_t frame = next_ - seen_.size();
  for (Seen& one : seen_) {
    one.t = time_of(frame++);
    archive_cells(a, one.cells);
    if (!p_.frames) continue;
    Gray8 image = one.image ? *one.image : Gray8{};
    a& image.width& image.height& image.px;
    if (a.reading()) one.image = std::make_shared<Gray8>(std::move(image));
  }
}

}  // namespace faba
