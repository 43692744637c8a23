#include "vision/render/microscope.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "tests/skip.h"
#include "tests/vision/media.h"
#include "vision/cells/video_ground.h"
#include "vision/files/picture.h"
#include "vision/files/video_writer.h"

using namespace faba;

namespace {

const std::filesystem::path kShared = FABA_SHARED_DATA;
}  // namespace

TEST_CASE("the default light level and noise agree with a real video of a suspension") {
  if (test::skipped_without(kShared / "suspension")) return;
  const media::ScratchFolder folder;
  VideoWriter writer(folder / "part", VideoFormat::lossless_avi, 1376, 1096, 26.87, 0, VideoPixels::grey8);
  for (int k = 11; k < 36; ++k) {
    const GrayF grey = read_picture(kShared / "suspension" / fmt::format("frame_{:04d}.tif", k)).grey;
    Gray8 bytes(grey.width, grey.height);
    for (std::size_t i = 0; i < grey.px.size(); ++i) bytes.px[i] = std::uint8_t(grey.px[i]);
    writer.write(bytes);
  }
  writer.finish(folder / "real.avi");
  const VideoBackground real = read_video_background(folder / "real.avi");
  Frame frame;
  frame.width = 64;
  frame.height = 48;
  const Microscope ours(MicroscopeParams{}, frame, {}, 0.1, 1);
  CHECK(std::fabs(double(real.light.at(688, 548)) / MicroscopeParams{}.level - 1) < 0.05);
  CHECK(std::fabs(real.noise_sd / ours.noise_sd(MicroscopeParams{}.level) - 1) < 0.05);
  MESSAGE("noise of the suspension ", real.noise_sd * 255, " grey levels of 255");
}

TEST_CASE("background of a real video: it contains objects at rest and not moving ones") {
  if (test::skipped_without(kShared / "beads")) return;
  const VideoBackground real = read_video_background(kShared / "beads" / "bulk-water.mov");
  CHECK(real.light.width == 640);
  CHECK(real.light.height == 424);
  CHECK(real.noise_sd * 255 > 0.05);  // the codec has removed most of the noise
  CHECK(real.noise_sd * 255 < 3);
  // A fibre in the upper right corner is 10 grey levels darker than its surroundings. Elsewhere the
  // background varies by a few grey levels.
  CHECK(double(real.light.at(596, 48) - real.light.at(560, 48)) * 255 < -5);
}
