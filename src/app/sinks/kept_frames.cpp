#include "app/sinks/kept_frames.h"

#include <algorithm>

namespace faba {
namespace {

// The number of the i-th of `count` frames at equal intervals among `frames` frames, rounded.
std::uint64_t number_of(std::uint64_t i, std::uint64_t count, std::uint64_t frames) {
  if (count < 2) return 0;
  return (2 * i * (frames - 1) + (count - 1)) / (2 * (count - 1));
}

}  // namespace

bool KeptFrames::keeps(std::uint64_t frame) const {
  const std::uint64_t count = std::min(kMost, frames_);
  for (std::uint64_t i = 0; i < count; ++i)
    if (number_of(i, count, frames_) == frame) return true;
  return false;
}

std::vector<SmallFrame> KeptFrames::frames() const {
  return kept_.size() == std::min(kMost, frames_) ? kept_ : std::vector<SmallFrame>{};
}

void KeptFrames::archive(Archive& a) {
  auto count = std::uint64_t(kept_.size());
  a& count;
  if (count > kMost) throw Error(Errc::input, "checkpoint", "is corrupt");
  kept_.resize(count);
  for (SmallFrame& f : kept_) {
    std::vector<std::uint8_t> bytes;
    for (const Rgb p : f.picture.px) bytes.insert(bytes.end(), {p.r, p.g, p.b});
    a& f.t_s& f.picture.width& f.picture.height& bytes;
    f.picture.px.resize(bytes.size() / 3);
    for (std::size_t i = 0; i < f.picture.px.size(); ++i)
      f.picture.px[i] = {bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]};
  }
}

}  // namespace faba
