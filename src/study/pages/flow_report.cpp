#include "study/pages/flow_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/toml.h"
#include "study/pages/quality_output.h"
#include "vision/draw/flow_picture.h"
#include "vision/files/picture.h"
#include "vision/files/video_writer.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

/// Writes flows and overlay of a video under temporary names and renames them when all are complete.
class FlowOutputs {
 public:
  FlowOutputs(const FlowSource& source, const std::filesystem::path& video, const FlowJob& job) : job_(job) {
    if (!job.out.empty()) {
      FlowInfo info{source.width(),           source.height(), source.fps(),
                    source.scale().um_per_px, source.method(), video.string()};
      file_.emplace(part(job.out), info);
    }
    if (!job.overlay.empty())
      overlay_.emplace(part(job.overlay), VideoFormat::mp4, source.width(), source.height(),
                       source.fps() > 0 ? std::clamp(source.fps(), kMinFrameRate, kMaxFrameRate) : 15);
  }
  FlowOutputs(const FlowOutputs&) = delete;
  FlowOutputs& operator=(const FlowOutputs&) = delete;
  ~FlowOutputs() {
    file_.reset();
    overlay_.reset();
    std::error_code ec;
    for (const auto& name : {job_.out, job_.overlay})
      if (!name.empty()) std::filesystem::remove(part(name), ec);
  }
  void take(const FlowPair& p) {
    if (file_) file_->write(p.frame, p.t0_s, p.t1_s, p.flow);
    if (!overlay_) return;
    if (!p.image) throw Error(Errc::usage, "--overlay", "a flow file contains no frames; give the video");
    if (full_ <= 0) full_ = full_speed(p.flow);  // one scale for all frames
    FlowDrawing how;
    how.full_px = full_;
    overlay_->write(draw_flow_on(*p.image, p.flow, how));
  }
  void complete() {
    if (file_) file_->close();
    file_.reset();
    if (!job_.out.empty()) rename_complete(part(job_.out), job_.out);
    if (overlay_) overlay_->finish(job_.overlay);
  }

 private:
  static std::filesystem::path part(const std::filesystem::path& name) { return name.string() + ".part"; }
  const FlowJob& job_;
  std::optional<FlowFileWriter> file_;
  std::optional<VideoWriter> overlay_;
  double full_ = 0;
};

Json method_json(const std::string& method) { return Json::parse(method, nullptr, false); }

}  // namespace

nlohmann::ordered_json flow_json(const PairFlow& r) {
  Json j;
  j["image_size"] = {r.flow.width(), r.flow.height()};
  add_scale(j, r.scale);
  j["method"] = method_json(r.method);
  if (r.effort) {
    j["iterations"] = r.effort->iterations;
    j["converged"] = r.effort->converged;
  }
  j["mean_px"] = {r.mean_px.x, r.mean_px.y};
  j["mean_speed_px"] = r.mean_speed_px;
  j["largest_px"] = r.largest_px;
  if (r.error)
    j["truth"] = {{"endpoint_px", r.error->endpoint_px},
                  {"angular_deg", r.error->angular_deg},
                  {"known", r.error->known}};
  j["unexplained"] = r.unexplained ? Json(*r.unexplained) : Json();
  add_quality(j, r.warnings);
  j["notes"] = r.notes;
  return j;
}

nlohmann::ordered_json flow_json(const VideoFlow& r) {
  Json j;
  j["image_size"] = {r.width, r.height};
  add_scale(j, r.scale);
  j["method"] = method_json(r.method);
  j["pairs"] = r.pairs;
  j["seconds"] = r.seconds;
  j["mean_speed_px"] = r.mean_speed_px;
  j["unexplained"] = r.unexplained ? Json(*r.unexplained) : Json();
  add_quality(j, r.warnings);
  j["notes"] = r.notes;
  return j;
}

PairFlow flow_of_pair(const std::filesystem::path& a, const std::filesystem::path& b, const FlowJob& job) {
  Pool pool(job.threads);
  PairFlow r = measure_flow(a, b, job.method, job.truth, pool);
  if (!job.out.empty()) write_flo(job.out, r.flow);
  if (!job.picture.empty()) write_png(job.picture, draw_flow(r.flow));
  return r;
}

VideoFlow flow_of_video(const std::filesystem::path& video, const FlowJob& job) {
  FlowSource source(video, {.method = job.method,
                            .shrink = job.shrink,
                            .t0_s = job.from_s,
                            .t1_s = job.to_s,
                            .fps = job.fps,
                            .options_text = job.options_text,
                            .frames = true,
                            .threads = job.threads});
  FlowOutputs outputs(source, video, job);
  std::uint64_t pairs = 0;
  VideoFlow r = measure_flow(source, [&](const FlowPair& pair) {
    outputs.take(pair);
    job.progress(++pairs, source.pairs());
    if (job.stop()) throw Error(Errc::interrupted, video.string(), "stopped; nothing was written");
  });
  outputs.complete();
  return r;
}

}  // namespace faba
