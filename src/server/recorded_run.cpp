#include "server/recorded_run.h"

#include <algorithm>

#include "app/files/position_table.h"
#include "app/recording/session.h"
#include "core/file.h"
#include "core/h5/h5.h"
#include "server/shown/frame_message.h"
#include "study/data/run_info.h"

namespace faba {
namespace {

// Data required by the page.
struct RecordedScene {
  RunInfo run;
  Vec2 view_px;
  ArenaOutline arena;
};

RecordedScene scene_of(const std::filesystem::path& dir) {
  const auto file = dir / run_files::kManifest;
  RunInfo run = read_run_info(file);
  if (!run.view_px || !run.arena)
    throw Error(Errc::input, file.string(), "needs view_px, and arena with centre_px");
  return {run, *run.view_px, *run.arena};
}

H5File tracks_of(const std::filesystem::path& dir) {
  if (!std::filesystem::exists(dir / "tracks.h5"))
    throw Error(Errc::input, dir.filename().string(),
                "the run has no tracks.h5; only its video can be displayed");
  return H5File::open(dir / "tracks.h5");
}

// Bounding box of the cells, px.
PictureBox box_of(const RecordedScene& s) {
  if (!s.arena.radius_px) return {-0.5, -0.5, s.view_px.x - 0.5, s.view_px.y - 0.5};
  const double x = s.arena.centre_px.x, y = s.arena.centre_px.y, r = *s.arena.radius_px;
  return {x - r - 1, y - r - 1, x + r + 1, y + r + 1};
}

}  // namespace

Json describe_run(const std::filesystem::path& dir) {
  const RecordedScene scene = scene_of(dir);
  const H5File f = tracks_of(dir);
  const PictureBox box = box_of(scene);
  Json populations = Json::array();
  std::uint64_t at = 0;
  for (const std::uint64_t n : scene.run.swarm_cells) {
    populations.push_back({{"begin", at}, {"end", at + n}});
    at += n;
  }
  double from = 0;
  if (const H5Table times = f.table("t_s"); times.rows() > 0) times.read<double>(0, {&from, 1});
  const double every = f.number_attribute("/", "every_frames"), fps = f.number_attribute("/", "fps");
  return {
      {"scene",
       {{"view",
         {{"width", int(scene.view_px.x)},
          {"height", int(scene.view_px.y)},
          {"um_per_px", scene.run.um_per_px ? Json(*scene.run.um_per_px) : Json()},
          {"nominal_um_per_px", scene.run.nominal_um_per_px ? Json(*scene.run.nominal_um_per_px) : Json()}}},
        {"outline",
         {{"centre_px", {scene.arena.centre_px.x, scene.arena.centre_px.y}},
          {"radius_px", scene.arena.radius_px ? Json(*scene.arena.radius_px) : Json(0)}}},
        {"box", {{"left", box.left}, {"top", box.top}, {"right", box.right}, {"bottom", box.bottom}}},
        {"setpoints", Json::array()}}},
      {"populations", populations},
      {"frames", PositionTable(f).rows()},
      {"from_s", from},
      {"rate", fps / every}};
}

std::string run_frames(const std::filesystem::path& dir, std::uint64_t from, std::uint64_t count) {
  const RecordedScene scene = scene_of(dir);
  const H5File f = tracks_of(dir);
  PositionTable positions(f);
  const H5Table times = f.table("t_s"), numbers = f.table("frame");
  const bool has_response = f.has("responding");
  const std::size_t n = positions.cells();
  std::vector<float> xy(2 * n), x(n), y(n), response(n, 1.0F);
  std::vector<std::uint8_t> responding(has_response ? n : 0);
  std::string out;
  const std::uint64_t end = std::min(positions.rows(), from + std::min(count, kMostRunFrames));
  for (std::uint64_t k = from; k < end; ++k) {
    FrameMessage frame;
    positions.read(k, xy);
    times.read(k, std::span<double>(&frame.t, 1));
    numbers.read(k, std::span<std::uint64_t>(&frame.frame, 1));
    // The message needs world positions: 1 m per pixel, origin at the corner of the image.
    frame.view = {1, int(scene.view_px.x), int(scene.view_px.y), {0, 0}};
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = xy[2 * i];
      y[i] = -xy[2 * i + 1];
    }
    if (has_response) {
      f.table("responding").read(k, std::span<std::uint8_t>(responding));
      for (std::size_t i = 0; i < n; ++i) response[i] = float(responding[i]);
    }
    frame.box = box_of(scene);
    frame.x = x;
    frame.y = y;
    frame.response = response;
    const std::string one = encode_frame(frame);
    const auto length = std::uint32_t(one.size());
    out.append(reinterpret_cast<const char*>(&length), sizeof length);
    out += one;
  }
  return out;
}

}  // namespace faba
