#include <cmath>

#include "app/sinks/sinks.h"
#include "vision/swarm_picture.h"
#include "vision/video_writer.h"

namespace faba {
namespace {

class Video final : public RunSink {
 public:
  Video(const SinkContext& c, bool lossless, std::uint64_t keep)
      : c_(c),
        lossless_(lossless),
        part_(c.dir / (lossless ? "video.avi.part" : "video.mp4.part")),
        final_(c.dir / (lossless ? "video.avi" : "video.mp4")) {
    // Killed after this file was completed and before the run was: there is nothing left to do.
    if (keep > 0 && !std::filesystem::exists(part_) && std::filesystem::exists(final_)) return;
    writer_.emplace(part_, lossless ? VideoFormat::lossless_avi : VideoFormat::mp4, c.frame.width,
                    c.frame.height, c.frame_rate / c.record.video_every, keep, grey(c, lossless));
    for (const Vec2 p : c.reference->setpoints()) route_.push_back(c.frame.image_from_world(p));
  }

  void take(const Tick& t) override {
    if (t.index % std::uint64_t(c_.record.video_every)) return;
    if (!writer_) return;
    if (!c_.record.as_seen)
      writer_->write(picture(t));
    else if (lossless_ && c_.rig->bits() == 16)
      writer_->write(c_.rig->deep_picture());
    else
      writer_->write(*c_.rig->picture());
  }

  void checkpoint(Archive& a) override {
    std::uint64_t bytes = writer_ ? writer_->sync() : 1;
    a& bytes;
  }

  void finish(bool keep) override {
    if (!writer_) return;
    if (c_.jitter) {
      const auto every = std::uint64_t(c_.record.video_every);
      writer_->finish(final_, keep,
                      [&](long long frame) { return c_.time_of(std::uint64_t(frame) * every); });
    } else {
      writer_->finish(final_, keep);
    }
  }

 private:
  RgbImage picture(const Tick& t) {
    const State& s = c_.world->state();
    const auto x = s.agents["x"], y = s.agents["y"], response = s.agents["response"];
    const auto& populations = c_.world->parts().populations;
    cells_.clear();
    double sx = 0, sy = 0;
    for (std::size_t k = 0; k < populations.size(); ++k)
      for (std::size_t i = populations[k].begin; i < populations[k].end; ++i) {
        const Vec2 p = c_.frame.image_from_world({double(x[i]), double(y[i])});
        cells_.push_back({float(p.x), float(p.y), std::uint8_t(k), response[i] != 0.0f});
        sx += double(x[i]), sy += double(y[i]);
      }
    const Vec2 mean{sx / double(x.size()), sy / double(x.size())};
    const Vec3 b = c_.world->parts().field->at({mean.x, mean.y, 0}, s.current);
    const Outline edge = c_.world->parts().arena->outline();
    SwarmScene scene;
    scene.width = c_.frame.width, scene.height = c_.frame.height;
    scene.um_per_px = c_.scale.m_per_px * 1e6;
    scene.t = double(t.index) / c_.frame_rate;
    scene.cells = cells_;
    scene.edge_centre = edge.centre_image, scene.edge_radius_px = edge.radius_px;
    scene.centroid = c_.frame.image_from_world(mean);
    if (std::isfinite(t.target.position.x)) scene.setpoint = c_.frame.image_from_world(t.target.position);
    scene.route = route_;
    scene.field_ut = {b.x * 1e6, b.y * 1e6};
    if (ground_.empty()) ground_ = draw_ground(scene);
    return draw_swarm(scene, ground_);
  }

  static VideoPixels grey(const SinkContext& c, bool lossless) {
    if (!c.record.as_seen) return VideoPixels::colour;
    return lossless && c.rig->bits() == 16 ? VideoPixels::grey16 : VideoPixels::grey8;
  }

  SinkContext c_;
  bool lossless_;
  std::filesystem::path part_, final_;
  std::optional<VideoWriter> writer_;
  std::vector<Vec2> route_;
  std::vector<SwarmScene::Cell> cells_;
  RgbImage ground_;
};

}  // namespace

std::unique_ptr<RunSink> video_sink(const SinkContext& c, bool lossless, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  return std::make_unique<Video>(c, lossless, keep);
}

}  // namespace faba
