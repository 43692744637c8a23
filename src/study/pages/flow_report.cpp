#include "study/pages/flow_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/file.h"
#include "study/data/flow_source.h"
#include "vision/draw/flow_picture.h"
#include "vision/files/picture.h"
#include "vision/files/video_writer.h"
#include "vision/flow/flow_file.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

struct FlowSums {
  double u = 0, v = 0, speed = 0, largest = 0;
  std::uint64_t n = 0;
  void add(const Flow& f) {
    for (std::size_t i = 0; i < f.u.px.size(); ++i) {
      const double a = double(f.u.px[i]), b = double(f.v.px[i]), s = std::hypot(a, b);
      u += a, v += b, speed += s, largest = std::max(largest, s);
    }
    n += f.u.px.size();
  }
};

nlohmann::ordered_json against_truth(const Flow& flow, const std::filesystem::path& file) {
  const Flow truth = read_flo(file);
  if (truth.width() != flow.width() || truth.height() != flow.height())
    throw Error(Errc::input, file.string(),
                fmt::format("is a flow of {} x {} px; the pictures have {} x {}", truth.width(),
                            truth.height(), flow.width(), flow.height()));
  double endpoint = 0, angle = 0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < flow.u.px.size(); ++i) {
    const double u = double(flow.u.px[i]), v = double(flow.v.px[i]);
    const double a = double(truth.u.px[i]), b = double(truth.v.px[i]);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    endpoint += std::hypot(u - a, v - b);
    const double c = (u * a + v * b + 1) / std::sqrt((u * u + v * v + 1) * (a * a + b * b + 1));
    angle += std::acos(std::clamp(c, -1.0, 1.0));
    ++known;
  }
  if (known == 0) throw Error(Errc::input, file.string(), "knows the flow of no pixel");
  const double n = double(known);
  return {{"endpoint_px", endpoint / n},
          {"angular_deg", angle / n * 180 / 3.14159265358979323846},
          {"known", n / double(flow.u.px.size())}};
}

/// Writes flows and overlay of a video under temporary names and names them when all are whole.
class FlowOutputs {
 public:
  FlowOutputs(const FlowSource& source, const std::filesystem::path& video, const FlowJob& job) : job_(job) {
    if (!job.out.empty()) {
      FlowInfo info{source.width(),     source.height(), source.fps(),
                    source.um_per_px(), source.method(), video.string()};
      file_.emplace(part(job.out), info, job.compress);
    }
    if (!job.overlay.empty())
      overlay_.emplace(part(job.overlay), VideoFormat::mp4, source.width(), source.height(),
                       source.fps() > 0 ? std::clamp(source.fps(), kSlowestVideo, kFastestVideo) : 15);
  }
  FlowOutputs(const FlowOutputs&) = delete;
  FlowOutputs& operator=(const FlowOutputs&) = delete;
  ~FlowOutputs() {
    file_.reset(), overlay_.reset();
    std::error_code ec;
    for (const auto& name : {job_.out, job_.overlay})
      if (!name.empty()) std::filesystem::remove(part(name), ec);
  }
  void take(const FlowPair& p) {
    if (file_) file_->write(p.frame, p.t0_s, p.t1_s, p.flow);
    if (!overlay_) return;
    if (p.image.empty())
      throw Error(Errc::usage, "--overlay",
                  "needs the frames, and a file of flows holds none; give the video");
    if (full_ <= 0) full_ = full_speed(p.flow);  // one scale for all frames
    FlowDrawing how;
    how.full_px = full_;
    overlay_->write(draw_flow_on(p.image, p.flow, how));
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

}  // namespace

nlohmann::ordered_json flow_of_pair(const std::filesystem::path& a, const std::filesystem::path& b,
                                    const FlowJob& job) {
  Picture first = read_picture(a), second = read_picture(b);
  if (first.grey.width != second.grey.width || first.grey.height != second.grey.height)
    throw Error(
        Errc::input, b.string(),
        fmt::format("has {} x {} px, {} has {} x {}; a flow is between pictures of one size",
                    second.grey.width, second.grey.height, a.string(), first.grey.width, first.grey.height));
  if (first.bits != second.bits)
    throw Error(Errc::input, b.string(),
                fmt::format("has {} bits, {} has {}; a flow is between pictures of one kind", second.bits,
                            a.string(), first.bits));
  const GreyScale greys(first.bits, first.grey);
  greys.apply(first.grey), greys.apply(second.grey);

  Pool pool(job.threads);
  const auto method = job.method.make({&pool});
  Flow flow;
  method->between(first.grey, second.grey, flow);
  FlowSums sums;
  sums.add(flow);

  nlohmann::ordered_json j;
  j["image_size"] = {flow.width(), flow.height()};
  j["method"] = job.method.resolved;
  j.update(method->effort());
  const double n = double(sums.n);
  j["mean_px"] = {sums.u / n, sums.v / n};
  j["mean_speed_px"] = sums.speed / n;
  j["largest_px"] = sums.largest;
  if (!job.truth.empty()) j["truth"] = against_truth(flow, job.truth);
  j["notes"] = nlohmann::ordered_json::array();
  if (!greys.words().empty()) j["notes"].push_back(greys.words());
  if (!j.value("converged", true))
    j["notes"].push_back("the iteration was not at its end: the flow is still drawn towards zero");
  if (!job.out.empty()) write_flo(job.out, flow);
  if (!job.picture.empty()) write_png(job.picture, draw_flow(flow));
  return j;
}

nlohmann::ordered_json flow_of_video(const std::filesystem::path& video, const FlowJob& job) {
  Pool pool(job.threads);
  FlowSource source(video,
                    {.method = job.method,
                     .shrink = job.shrink,
                     .fps = job.fps,
                     .said = job.said,
                     .frames = !job.overlay.empty()},
                    pool);
  FlowOutputs outputs(source, video, job);
  FlowPair pair;
  FlowSums sums;
  std::uint64_t pairs = 0;
  double t0 = 0;
  while (source.next(pair)) {
    if (pairs++ == 0) t0 = pair.t0_s;
    outputs.take(pair);
    sums.add(pair.flow);
    job.progress(pairs, source.pairs());
    if (job.stop()) throw Error(Errc::interrupted, video.string(), "stopped; nothing was written");
  }
  if (pairs == 0) throw Error(Errc::input, video.string(), "has one frame only; motion needs two or more");
  outputs.complete();
  nlohmann::ordered_json j;
  j["image_size"] = {source.width(), source.height()};
  j["method"] = nlohmann::ordered_json::parse(source.method(), nullptr, false);
  j["pairs"] = pairs;
  j["seconds"] = pair.t1_s - t0;
  j["mean_speed_px"] = sums.speed / double(sums.n);
  j["notes"] = source.notes();
  return j;
}

}  // namespace faba
